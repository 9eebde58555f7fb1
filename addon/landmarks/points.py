# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmark pairs: a vertex of a source object and the vertex of its target object that it corresponds to.

They live on the source object, as `authalic_landmarks` with the target in `authalic_target`, and are saved
with it. A pair keeps marks (see `point_marks`), so that its vertices are found again after the meshes were
edited. `pairs` alone says which vertices these are now, and where they are lost.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from ..blender import editability
from ..blender.types import Landmark, MeshObject, mesh_objects, owner_of
from . import point_marks, undo
from .objects import NONE, CannotPair, check_lists, check_target, check_vertex, target_problem


class Pair(NamedTuple):
    """A landmark pair as it is now; -1 for a vertex that is not certain, and then the problem in words."""

    name: str
    source_vertex: int
    target_vertex: int
    problem: str | None


def _getter(side: str) -> Callable[[Landmark], int]:
    return lambda landmark: _vertex(landmark, side)


def _setter(side: str) -> Callable[[Landmark, int], None]:
    return lambda landmark, vertex: _bind(landmark, side, vertex)


def _weighed_anew(landmark: Landmark, _context: bpy.types.Context) -> None:
    landmark.error = -1.0


class AUTHALIC_PG_landmark(bpy.types.PropertyGroup):
    """One pair. Its vertices have their current numbers, whatever was edited."""

    name: StringProperty(name="Name", description="The name of this pair of landmarks")
    source_vertex: IntProperty(
        name="Source Vertex",
        description="The vertex on this object, -1 if it was lost",
        get=_getter("source"),
        set=_setter("source"),
    )
    target_vertex: IntProperty(
        name="Target Vertex",
        description="The vertex on the target object, -1 if it was lost",
        get=_getter("target"),
        set=_setter("target"),
    )
    source_mark: IntProperty(options={"HIDDEN"})
    target_mark: IntProperty(options={"HIDDEN"})
    # A vertex that was set before there was a target to find it on.
    waiting: IntProperty(default=NONE, options={"HIDDEN"})
    is_soft: BoolProperty(
        name="Soft",
        description="The pair pulls by a weight, instead of meeting exactly. For shapes that are kept",
        default=False,
        options=set(),
        update=_weighed_anew,
    )
    weight: FloatProperty(
        name="Weight",
        description="How strongly a soft pair pulls",
        min=1e-3,
        soft_max=1000.0,
        default=10.0,
        options=set(),
        update=_weighed_anew,
    )
    error: FloatProperty(
        name="Error",
        description="Error of the last registration at this pair, in percent of the target's size. "
        "Negative if there was none",
        default=-1.0,
    )


def pairs(source: MeshObject, *, drawing: bool = False) -> list[Pair]:
    """All pairs of a source object, with the problem of each in words.

    With `drawing`, large meshes in edit mode are not searched anew unless they have changed visibly.
    """
    target, without_target = source.authalic_target, target_problem(source)
    on_source = _found(source, source, "source", drawing)
    on_target = {} if without_target else _found(source, target, "target", drawing)
    listed: list[Pair] = []
    taken: dict[tuple[str, int], str] = {}
    for landmark in source.authalic_landmarks:
        vertex, problem = _where(landmark.source_mark, on_source, source)
        if without_target:
            listed.append(Pair(landmark.name, vertex, NONE, problem or without_target))
            continue
        goal, lost = _where(landmark.target_mark, on_target, target)
        problem = problem or lost or _repeated(taken, landmark.name, (vertex, goal), (source, target))
        listed.append(Pair(landmark.name, vertex, goal, problem))
    return listed


def add(source: MeshObject, source_vertex: int, target_vertex: int, name: str = "") -> Landmark:
    """Adds a pair and makes it the active one; returns it. Raises `CannotPair` and then changes nothing."""
    _check_new(source, source_vertex, target_vertex)
    landmark = source.authalic_landmarks.add()
    landmark.name = name or _free_name(source)
    landmark.source_vertex, landmark.target_vertex = source_vertex, target_vertex
    source.authalic_landmark_index = len(source.authalic_landmarks) - 1
    return landmark


def move(source: MeshObject, index: int, side: str, vertex: int) -> None:
    """Moves a pair to another vertex on one side. Raises `CannotPair` and then changes nothing."""
    check_move(source, index, side, vertex)
    obj, landmark = source if side == "source" else source.authalic_target, source.authalic_landmarks[index]
    mark = getattr(landmark, f"{side}_mark")
    # With the mark that it has, a step of undo in edit mode moves it back.
    if mark > 0 and _users(mark) == 1 and not point_marks.is_marked(obj.data, vertex):
        point_marks.move(obj.data, mark, vertex)
    else:
        setattr(landmark, f"{side}_vertex", vertex)
        if mark != getattr(landmark, f"{side}_mark"):
            _release(obj, mark)
    landmark.error = -1.0


def check_move(source: MeshObject, index: int, side: str, vertex: int) -> None:
    """Raises `CannotPair` unless a pair can be moved to a vertex on one side."""
    check_target(source)
    obj = source if side == "source" else source.authalic_target
    check_vertex(obj, vertex)
    _check_free([pair for number, pair in enumerate(pairs(source)) if number != index], side, obj, vertex)


def replace(source: MeshObject, wanted: Sequence[tuple[str, int, int]]) -> None:
    """Replaces all pairs by pairs (name, source vertex, target vertex), or none of them.

    Raises `CannotPair` and then changes nothing.
    """
    check_target(source)
    for side, obj in enumerate((source, source.authalic_target)):
        first: dict[int, str] = {}
        for name, *vertices in wanted:
            vertex = vertices[side]
            check_vertex(obj, vertex)
            if vertex in first:
                raise CannotPair(
                    f'vertex {vertex} of {obj.name} is in two pairs, "{first[vertex]}", "{name}"'
                )
            first[vertex] = name
    clear(source)
    for name, source_vertex, target_vertex in wanted:
        add(source, source_vertex, target_vertex, name)


def remove(source: MeshObject, index: int) -> None:
    """Removes a pair; the next one becomes the active pair. Raises `CannotPair` and then changes nothing."""
    check_lists(source)
    undo.remember(source, index)
    gone = source.authalic_landmarks[index]
    source_mark, target_mark = gone.source_mark, gone.target_mark
    source.authalic_landmarks.remove(index)
    if not _release(source, source_mark):
        undo.forget(source, source_mark)
    target = source.authalic_target
    # In another mode the mark would stay away when the step is undone.
    if target is not None and target.data.is_editmode == source.data.is_editmode:
        _release(target, target_mark)
    last = len(source.authalic_landmarks) - 1
    source.authalic_landmark_index = max(min(source.authalic_landmark_index, last), 0)


def clear(source: MeshObject) -> None:
    """Removes all pairs. Raises `CannotPair` and then changes nothing."""
    for index in reversed(range(len(source.authalic_landmarks))):
        remove(source, index)


def _check_new(source: MeshObject, source_vertex: int, target_vertex: int) -> None:
    check_target(source)
    existing = pairs(source)
    for vertex, side, obj in (
        (source_vertex, "source", source),
        (target_vertex, "target", source.authalic_target),
    ):
        check_vertex(obj, vertex)
        _check_free(existing, side, obj, vertex)


def _check_free(existing: Sequence[Pair], side: str, obj: MeshObject, vertex: int) -> None:
    """Raises `CannotPair` if a pair has a vertex."""
    taken = next((pair for pair in existing if getattr(pair, f"{side}_vertex") == vertex), None)
    if taken is not None:
        raise CannotPair(f'vertex {vertex} of {obj.name} is in the pair "{taken.name}" already')


def _free_name(source: MeshObject) -> str:
    taken = {landmark.name for landmark in source.authalic_landmarks}
    number = len(source.authalic_landmarks)  # as its marker will have it
    while f"Landmark {number}" in taken:
        number += 1
    return f"Landmark {number}"


def _found(source: MeshObject, obj: MeshObject, side: str, drawing: bool) -> dict[int, list[int]]:
    wanted = [getattr(landmark, f"{side}_mark") for landmark in source.authalic_landmarks]
    return point_marks.find(obj.data, wanted=wanted if drawing else None)


def _where(mark: int, by_mark: dict[int, list[int]], obj: MeshObject) -> tuple[int, str | None]:
    """The vertex that has a mark, or -1 and the problem."""
    vertices = by_mark.get(mark, ())
    if len(vertices) == 1:
        return vertices[0], None
    if vertices:
        return NONE, f"{len(vertices)} vertices of {obj.name} are copies of the chosen one"
    return NONE, f"its vertex on {obj.name} is gone"


def _repeated(
    taken: dict[tuple[str, int], str],
    name: str,
    vertices: tuple[int, int],
    objects: tuple[MeshObject, MeshObject],
) -> str | None:
    """The problem if an earlier pair has one of the vertices; else remembers the vertices in `taken`."""
    for vertex, obj, side in zip(vertices, objects, ("source", "target"), strict=True):
        if vertex != NONE and (side, vertex) in taken:
            return f'has vertex {vertex} of {obj.name}, as "{taken[side, vertex]}" has'
        taken[side, vertex] = name
    return None


def _release(obj: MeshObject, mark: int) -> bool:
    """Removes a mark from a mesh if no pair of any object needs it; returns whether it did."""
    if _users(mark):
        return False
    if obj.type == "MESH" and editability.is_writable(obj.data):
        point_marks.clear(obj.data, mark)
    return True


def _users(mark: int) -> int:
    """How many pairs of all objects need a mark."""
    listed = [landmark for obj in mesh_objects() for landmark in obj.authalic_landmarks]
    return sum(mark in (landmark.source_mark, landmark.target_mark) for landmark in listed)


def _object(landmark: Landmark, side: str) -> MeshObject | None:
    source = owner_of(landmark)
    if side == "source":
        return source
    return None if target_problem(source) else source.authalic_target


def _vertex(landmark: Landmark, side: str) -> int:
    obj, mark = _object(landmark, side), getattr(landmark, f"{side}_mark")
    if side == "target" and landmark.waiting != NONE:
        return landmark.waiting
    if obj is None or obj.type != "MESH":
        return NONE
    return _where(mark, point_marks.find(obj.data, wanted=[mark]), obj)[0]


def _bind(landmark: Landmark, side: str, vertex: int) -> None:
    """Marks the vertex, if the mesh has it."""
    obj, mark = _object(landmark, side), 0
    if side == "target":
        landmark.waiting = vertex if obj is None else NONE
    is_writable = obj is not None and obj.type == "MESH" and editability.is_writable(obj.data)
    if obj is not None and is_writable and 0 <= vertex < point_marks.vertex_count(obj.data):
        mark = point_marks.put(obj.data, vertex)
    setattr(landmark, f"{side}_mark", mark)
    landmark.error = -1.0


def _may_be_target(source: MeshObject, obj: bpy.types.Object) -> bool:
    return obj.type == "MESH" and obj != source


def _target_changed(source: MeshObject, _context: bpy.types.Context) -> None:
    for landmark in source.authalic_landmarks:
        landmark.error = -1.0
        if landmark.waiting != NONE and target_problem(source) is None:
            _bind(landmark, "target", landmark.waiting)
    for curve in source.authalic_landmark_curves:
        curve.error = -1.0
    source.authalic_registration.method = source.authalic_registered_by = ""


_PROPERTIES: Any = bpy.types.Object


def register() -> None:
    bpy.utils.register_class(AUTHALIC_PG_landmark)
    undo.register()
    _PROPERTIES.authalic_landmarks = CollectionProperty(
        type=AUTHALIC_PG_landmark, name="Landmarks", description="Pairs of vertices, here and on the target"
    )
    _PROPERTIES.authalic_landmark_index = IntProperty(
        name="Active Landmark", description="The pair of landmarks that is selected in the list", min=0
    )
    _PROPERTIES.authalic_target = PointerProperty(
        type=bpy.types.Object,
        name="Target",
        description="The mesh object that this one is registered with",
        poll=_may_be_target,
        update=_target_changed,
    )


def unregister() -> None:
    del _PROPERTIES.authalic_target
    del _PROPERTIES.authalic_landmark_index
    del _PROPERTIES.authalic_landmarks
    undo.unregister()
    bpy.utils.unregister_class(AUTHALIC_PG_landmark)
