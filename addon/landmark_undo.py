# SPDX-License-Identifier: GPL-3.0-or-later
"""Undo of landmarks in edit mode, where Blender takes back changes of meshes alone.

The list of pairs is a part of the object, and stays as it is when a step in edit mode is undone or redone;
the marks on the vertices come and go with the steps. Where marks of a pair have gone although the mesh has as
many vertices as before, it is the adding of the pair that was undone, or its removal that was done again:
it leaves the list, and is remembered. Where they have come back, it returns to its place.
"""

import bpy
from bpy.app.handlers import persistent

from . import vertex_marks

# Pairs that left lists: (session id of the source, its mark) -> (place, the values of the pair).
_gone = {}
# What the meshes in edit mode had before the step: session id of the mesh -> (counts, marks).
_before = {}
_KEPT = ("name", "source_mark", "target_mark", "waiting", "error")


def remember(source, index):
    """To be called before a pair is removed."""
    landmark = source.authalic_landmarks[index]
    values = {name: getattr(landmark, name) for name in _KEPT}
    _gone[source.session_uid, landmark.source_mark] = index, values


@persistent
def _look(_scene, *_):
    _before.clear()
    _before.update({mesh.session_uid: _state(mesh) for mesh in _edited()})


@persistent
def _follow(_scene, *_):
    for source in bpy.data.objects:
        mesh = source.data if source.type == "MESH" else None
        if mesh is None or not mesh.is_editmode or mesh.session_uid not in _before:
            continue
        (counts, marks), (new_counts, new_marks) = _before[mesh.session_uid], _state(mesh)
        if counts == new_counts:
            _drop(source, marks - new_marks)
            _restore(source, new_marks - marks)
    _before.clear()


def _edited():
    return [mesh for mesh in bpy.data.meshes if mesh.is_editmode]


def _state(mesh):
    return vertex_marks.element_counts(mesh), set(vertex_marks.find(mesh))


def _drop(source, marks):
    for index in reversed(range(len(source.authalic_landmarks))):
        if source.authalic_landmarks[index].source_mark in marks:
            remember(source, index)
            source.authalic_landmarks.remove(index)


def _restore(source, marks):
    there = {landmark.source_mark for landmark in source.authalic_landmarks}
    back = [_gone[source.session_uid, mark] for mark in marks - there if (source.session_uid, mark) in _gone]
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
    _gone.clear()
    _before.clear()
