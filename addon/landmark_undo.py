# SPDX-License-Identifier: GPL-3.0-or-later
"""Undo of landmarks in edit mode, where Blender takes back changes of meshes alone.

The list of pairs is a part of the object: when a step of edit mode is undone or redone, it stays as it is, or
becomes what it was when edit mode was entered. The marks on the vertices come and go with the steps. So the
list is made to follow the marks: a pair returns whose mark is there again, and one leaves whose mark went
away, or that has come without. A pair whose vertex was deleted, which changes the number of vertices, stays.
"""

import bpy
from bpy.app.handlers import persistent

from . import vertex_marks

# All pairs seen of late: (session id of the source, mark there) -> (place in the list, the pair's values).
_known = {}
# Before the step: session id of a source -> marks in its list, size of its mesh in edit mode, marks there.
_before = {}
_KEPT = ("name", "source_mark", "target_mark", "waiting", "error")


def remember(source, index):
    """To be called before a pair is removed, the mark of which goes too."""
    landmark = source.authalic_landmarks[index]
    values = {name: getattr(landmark, name) for name in _KEPT}
    _known[source.session_uid, landmark.source_mark] = index, values


def forget(source, mark):
    """The same if the mark stays, for the sake of another pair: it says nothing about this one."""
    _known.pop((source.session_uid, mark), None)


@persistent
def _look(_scene, *_):
    _before.clear()
    for source in _sources():
        for index in range(len(source.authalic_landmarks)):
            remember(source, index)
        size, marks = _state(source.data)
        _before[source.session_uid] = _listed(source), size, marks


@persistent
def _follow(_scene, *_):
    for source in _sources():
        if source.data.is_editmode:
            listed, size, marks = _before.get(source.session_uid, (set(), None, set()))
            new_size, new_marks = _state(source.data)
            went = marks - new_marks if size == new_size else set()
            came = _listed(source) - listed - new_marks
            _drop(source, went | came)
            _restore(source, new_marks)
    _before.clear()


def _sources():
    return [obj for obj in bpy.data.objects if obj.type == "MESH"]


def _listed(source):
    return {landmark.source_mark for landmark in source.authalic_landmarks}


def _state(mesh):
    if not mesh.is_editmode:
        return None, set()
    return vertex_marks.element_counts(mesh), set(vertex_marks.find(mesh))


def _drop(source, marks):
    for index in reversed(range(len(source.authalic_landmarks))):
        if source.authalic_landmarks[index].source_mark in marks:
            remember(source, index)
            source.authalic_landmarks.remove(index)


def _restore(source, marks):
    missing = [(source.session_uid, mark) for mark in marks - _listed(source)]
    back = [_known[key] for key in missing if key in _known]
    for index, values in sorted(back, key=lambda one: one[0]):
        landmark = source.authalic_landmarks.add()
        for name, value in values.items():
            setattr(landmark, name, value)
        source.authalic_landmarks.move(len(source.authalic_landmarks) - 1, index)


_HANDLERS = (
    ("undo_pre", _look),
    ("redo_pre", _look),
    ("undo_post", _follow),
    ("redo_post", _follow),
)


def register():
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister():
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
    _known.clear()
    _before.clear()
