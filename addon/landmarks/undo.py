# SPDX-License-Identifier: GPL-3.0-or-later
"""Undo of landmarks in edit mode, where Blender takes back changes of meshes alone.

The lists of pairs of points and of curves are a part of the object: when a step of edit mode is undone or
redone, they stay, or become what they were when edit mode was entered. The marks on the meshes come and go
with the steps. So the lists follow the marks: a pair returns when its mark does, and a pair leaves when its
mark goes or when it has come without. A pair whose vertices or edges were deleted stays; such a step changes
the number of elements.
"""

from collections.abc import Iterable
from typing import Any, NamedTuple

import bpy
from bpy.app.handlers import persistent

from ..blender import editability, element_marks
from ..blender.types import MeshObject, mesh_objects
from . import curve_marks, point_marks


class Listed(NamedTuple):
    """A list of pairs: its property on objects, the mark of a pair and all its values."""

    name: str
    mark: str
    kept: tuple[str, ...]


POINTS = Listed(
    "authalic_landmarks",
    "source_mark",
    ("name", "source_mark", "target_mark", "waiting", "is_soft", "weight", "error"),
)
CURVES = Listed("authalic_landmark_curves", "mark", ("name", "mark", "error"))
# All pairs seen of late: (list, session id of the source, mark) -> (place in the list, the pair's values).
_known: dict[tuple[str, int, int], tuple[int, dict[str, Any]]] = {}
# The keys of the curves of sources, by session id, which are a part of the object too.
_keys: dict[int, str] = {}
# Before the step: (list, session id of a source) -> marks in its list, and what `_state` found.
_before: dict[tuple[str, int], tuple[set[int], Any, set[tuple[str, int]]]] = {}


def remember(source: MeshObject, index: int, listed: Listed = POINTS) -> None:
    """Keeps the values of a pair that is about to be removed with its mark."""
    pair = getattr(source, listed.name)[index]
    values = {name: getattr(pair, name) for name in listed.kept}
    _known[listed.name, source.session_uid, getattr(pair, listed.mark)] = index, values


def forget(source: MeshObject, mark: int) -> None:
    """Forgets a removed pair whose mark stays for another pair and so does not say that it is back."""
    _known.pop((POINTS.name, source.session_uid, mark), None)


@persistent  # type: ignore[untyped-decorator]
def _look(_scene: bpy.types.Scene, *_: object) -> None:
    _before.clear()
    for source in _sources():
        if source.authalic_curve_key:
            _keys[source.session_uid] = source.authalic_curve_key
        for listed in (POINTS, CURVES):
            for index in range(len(getattr(source, listed.name))):
                remember(source, index, listed)
            _before[listed.name, source.session_uid] = _marks(source, listed), *_state(source, listed)


@persistent  # type: ignore[untyped-decorator]
def _after_undo(_scene: bpy.types.Scene, *_: object) -> None:
    _follow(is_redone=False)


@persistent  # type: ignore[untyped-decorator]
def _after_redo(_scene: bpy.types.Scene, *_: object) -> None:
    _follow(is_redone=True)


def _follow(is_redone: bool) -> None:
    curve_marks.forget()
    for source in _sources():
        if not source.authalic_curve_key and _edited(source, CURVES):
            source.authalic_curve_key = _keys.get(source.session_uid, "")
        for listed in (POINTS, CURVES):
            if _edited(source, listed):
                _update(source, listed, is_redone)
    _before.clear()


def _update(source: MeshObject, listed: Listed, is_redone: bool) -> None:
    """Makes a list follow the marks that a step has brought or taken away."""
    in_list, size, before = _before.get((listed.name, source.session_uid), (set(), None, set()))
    new_size, after = _state(source, listed)
    present = _only_marks(after)
    # A pair can have lost one of its two marks because it was removed, or because that was added later.
    gone = _only_marks(before - after) if is_redone else _only_marks(before) - present
    went = gone if size == new_size else set()
    came = _marks(source, listed) - in_list - present
    _drop(source, listed, went | came)
    back = present & (in_list | _only_marks(after - before))
    _restore(source, listed, back - went)


def _sources() -> list[MeshObject]:
    return [obj for obj in mesh_objects() if editability.is_writable(obj)]


def _marks(source: MeshObject, listed: Listed) -> set[int]:
    return {getattr(pair, listed.mark) for pair in getattr(source, listed.name)}


def _edited(source: MeshObject, listed: Listed) -> list[bpy.types.Mesh]:
    """The meshes in edit mode that have marks of a list."""
    objects = [source] if listed is POINTS else [source, source.authalic_target]
    return [obj.data for obj in objects if obj is not None and obj.type == "MESH" and obj.data.is_editmode]


def _state(
    source: MeshObject, listed: Listed
) -> tuple[list[tuple[int, int, int]] | None, set[tuple[str, int]]]:
    """The sizes of the meshes in edit mode, and (side, mark) of the marks there."""
    meshes = _edited(source, listed)
    if not meshes:
        return None, set()
    sizes = [element_marks.element_counts(mesh) for mesh in meshes]
    if listed is POINTS:
        return sizes, {("source", mark) for mark in point_marks.find(source.data)}
    return sizes, {(side, mark) for side in ("source", "target") for mark in _of_curves(source, side)}


def _of_curves(source: MeshObject, side: str) -> Iterable[int]:
    """The marks of curves on a side."""
    obj = source if side == "source" else source.authalic_target
    if obj is None or obj.type != "MESH" or not source.authalic_curve_key:
        return ()
    return curve_marks.find(obj.data, curve_marks.key(source, side))


def _only_marks(sides_and_marks: set[tuple[str, int]]) -> set[int]:
    return {mark for _, mark in sides_and_marks}


def _drop(source: MeshObject, listed: Listed, gone: set[int]) -> None:
    pairs = getattr(source, listed.name)
    for index in reversed(range(len(pairs))):
        if getattr(pairs[index], listed.mark) in gone:
            remember(source, index, listed)
            pairs.remove(index)


def _restore(source: MeshObject, listed: Listed, wanted: set[int]) -> None:
    pairs = getattr(source, listed.name)
    missing = [(listed.name, source.session_uid, mark) for mark in wanted - _marks(source, listed)]
    back = [_known[key] for key in missing if key in _known]
    for index, values in sorted(back, key=lambda index_and_values: index_and_values[0]):
        pair = pairs.add()
        for name, value in values.items():
            setattr(pair, name, value)
        pairs.move(len(pairs) - 1, index)


_HANDLERS = (
    ("undo_pre", _look),
    ("redo_pre", _look),
    ("undo_post", _after_undo),
    ("redo_post", _after_redo),
)


def register() -> None:
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
    _known.clear()
    _keys.clear()
    _before.clear()
