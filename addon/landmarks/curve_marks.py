# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths along edges that can be found again after a mesh was edited, by marks (see `element_marks`).

All edges of a path have its mark, and so have the parts into which they are divided. Its first vertex has the
mark too, its last one the negative of it. The attributes are those of a key: no two paths of the same key
share an edge on one mesh.
"""

from collections.abc import Collection, Sequence
from typing import NamedTuple

import bpy

from ..blender import element_marks, scene_changes
from ..blender.edges import edges_between, ends_of_edges
from ..blender.element_marks import element_counts
from ..blender.types import MeshObject
from ..surfaces.arrays import Edge, Path
from . import paths

_NAME = "authalic_curve_"
_BITS = 24
# What was found last: (session id of a mesh, key) -> (counts of its elements, {mark: `_Found`}), and the
# `scene_changes` when it was true last.
_seen: dict[tuple[int, str], tuple[tuple[int, int, int], "dict[int, _Found]"]] = {}
_true: dict[tuple[int, str], int] = {}


class MarkedPath(NamedTuple):
    """A marked path as it is today.

    `vertices` are from its start to its end, a loop's first one again at the end; none if it is not certain,
    and then the problem in words, to be read behind the name of the curve and before that of the object.
    `edges` are pairs of vertices.
    """

    vertices: Path
    edges: tuple[Edge, ...]
    problem: str | None

    @property
    def is_closed(self) -> bool:
        return paths.is_closed(self.vertices)


ABSENT = MarkedPath((), (), "has no edges")


class _Found(NamedTuple):
    """A path, the numbers of its edges, and what its ends had for marks."""

    path: MarkedPath
    edges: list[int]
    ends: list[tuple[int, int]]


def new() -> int:
    """A mark that no path has."""
    return element_marks.new(_BITS)


def key(source: MeshObject, side: str) -> str:
    """The key of the curves of a source object on its "source" or "target" mesh; "" if it has none yet."""
    own = source.authalic_curve_key
    return f"{side}_{own}" if own else ""


def put(mesh: bpy.types.Mesh, key: str, mark: int, path: Path) -> None:
    """Gives the edges of a path (vertices) a mark in place of those that have it. Raises `NoEdge`."""
    edges = edges_between(mesh, paths.edges(path))
    clear(mesh, key, mark)
    _of_edges(key).write(mesh, edges, mark)
    _mark_ends(mesh, key, mark, path)


def reverse(mesh: bpy.types.Mesh, key: str, mark: int) -> None:
    """Makes the end of a path its start."""
    path = find(mesh, key).get(mark, ABSENT)
    if path.vertices:
        _mark_ends(mesh, key, mark, path.vertices[::-1])


def clear(mesh: bpy.types.Mesh, key: str, mark: int) -> None:
    """Takes a mark off a mesh; with the last one go the attributes."""
    _drop(mesh, key)
    for kind in _kinds(key):
        there = kind.all(mesh)
        own = [element for element, value in there.items() if abs(value) == mark]
        kind.write(mesh, own, 0)
        if len(own) == len(there):
            kind.drop(mesh)


def copy(mesh: bpy.types.Mesh, key: str, new_key: str, wanted: Collection[int]) -> None:
    """Gives what has wanted marks of a key the same under a new one."""
    for kind, new_kind in zip(_kinds(key), _kinds(new_key), strict=True):
        for value, elements in _by_value(kind, mesh).items():
            if abs(value) in wanted:
                new_kind.write(mesh, elements, value)
    _drop(mesh, new_key)


def keep(mesh: bpy.types.Mesh, key: str, wanted: Collection[int]) -> None:
    """Takes all marks of a key off a mesh but the wanted ones; with the last one go the attributes."""
    for kind in _kinds(key):
        if kind.is_on(mesh):
            by_value = _by_value(kind, mesh)
            others = [one for value, own in by_value.items() if abs(value) not in wanted for one in own]
            if others:
                kind.write(mesh, others, 0)
                _drop(mesh, key)
            if all(abs(value) not in wanted for value in by_value):
                kind.drop(mesh)


def find(mesh: bpy.types.Mesh, key: str, *, drawing: bool = False) -> dict[int, MarkedPath]:
    """{mark: `MarkedPath`} of the paths of a key on a mesh.

    With `drawing`, what was found before is taken for true unless geometry has changed, and then if the paths
    are where they were and the mesh has as many elements: fast enough for drawing.
    """
    held, own = element_marks.hold(mesh), (mesh.session_uid, key)
    counts, found = _seen.get(own, (None, {}))
    if not drawing or _true.get(own) != scene_changes.count():
        if not drawing or counts != element_counts(mesh) or not _holds(mesh, key, found):
            found = _search(mesh, key)
            _seen[own] = element_counts(mesh), found
        _true[own] = scene_changes.count()
    del held
    return {mark: one.path for mark, one in found.items()}


def forget() -> None:
    """What was found before counts no longer, as after undo."""
    _seen.clear()
    _true.clear()


def check(mesh: bpy.types.Mesh, path: Path) -> None:
    """Raises `NoEdge` unless edges join the consecutive vertices of a path."""
    edges_between(mesh, paths.edges(path))


def owners(mesh: bpy.types.Mesh, key: str, path: Path) -> set[int]:
    """The marks that the edges and the ends of a path have. Raises `NoEdge`."""
    on_edges = _of_edges(key).of(mesh, edges_between(mesh, paths.edges(path)))
    return {abs(mark) for mark in [*on_edges, *_of_ends(key).of(mesh, [path[0], path[-1]])]} - {0}


def _drop(mesh: bpy.types.Mesh, key: str) -> None:
    _seen.pop((mesh.session_uid, key), None)
    _true.pop((mesh.session_uid, key), None)
    scene_changes.note()


def _of_edges(key: str) -> element_marks.Marks:
    return element_marks.Marks(_NAME + key, "EDGE")


def _of_ends(key: str) -> element_marks.Marks:
    return element_marks.Marks(f"{_NAME}{key}_ends", "POINT")


def _kinds(key: str) -> tuple[element_marks.Marks, element_marks.Marks]:
    return _of_edges(key), _of_ends(key)


def _by_value(kind: element_marks.Marks, mesh: bpy.types.Mesh) -> dict[int, list[int]]:
    """{mark: elements} of a kind of marks."""
    found: dict[int, list[int]] = {}
    for element, value in kind.all(mesh).items():
        found.setdefault(value, []).append(element)
    return found


def _search(mesh: bpy.types.Mesh, key: str) -> dict[int, _Found]:
    edges: dict[int, list[int]] = {}
    ends: dict[int, list[int]] = {}
    for edge, mark in _of_edges(key).all(mesh).items():
        edges.setdefault(mark, []).append(edge)
    for vertex, mark in _of_ends(key).all(mesh).items():
        ends.setdefault(mark, []).append(vertex)
    found = {}
    for mark, own in edges.items():
        path = _path(ends_of_edges(mesh, own), ends.get(mark, []), ends.get(-mark, []))
        terminal = [path.vertices[0], path.vertices[-1]] if path.vertices else []
        found[mark] = _Found(path, own, list(zip(terminal, _of_ends(key).of(mesh, terminal), strict=True)))
    return found


def _path(edges: Sequence[Edge], starts: Sequence[int], ends: Sequence[int]) -> MarkedPath:
    """The `MarkedPath` along edges, of which some vertices are marked as the start and the end."""
    edges = tuple(edges)
    try:
        line = paths.ordered(edges)
    except paths.NoPath as problem:
        return MarkedPath((), edges, f"has edges that {problem}")
    if paths.is_closed(line):
        inside = [vertex for vertex in starts if vertex in line]
        return MarkedPath(paths.started(line, inside[0]) if inside else line, edges, None)
    tips = line[0], line[-1]
    first = next((vertex for vertex in starts if vertex in tips), None)
    last = next((vertex for vertex in ends if vertex in tips), None)
    directed = paths.along(line, first, last)
    if directed is None:
        return MarkedPath((), edges, "has lost " + _lost(first, last))
    return MarkedPath(directed, edges, None)


def _lost(first: int | None, last: int | None) -> str:
    if first is None and last is None:
        return "its start and its end"
    return "its start" if first is None else "its end"


def _holds(mesh: bpy.types.Mesh, key: str, found: dict[int, _Found]) -> bool:
    """Whether the paths that were found have their marks, edges and ends still."""
    edges = [edge for one in found.values() for edge in one.edges]
    values = [mark for mark, one in found.items() for _ in one.edges]
    ends = [end for one in found.values() for end in one.ends]
    return (
        _of_edges(key).of(mesh, edges) == values
        and ends_of_edges(mesh, edges) == [pair for one in found.values() for pair in one.path.edges]
        and _of_ends(key).of(mesh, [vertex for vertex, _ in ends]) == [value for _, value in ends]
    )


def _mark_ends(mesh: bpy.types.Mesh, key: str, mark: int, path: Path) -> None:
    _drop(mesh, key)
    own = [element for element, value in _of_ends(key).all(mesh).items() if abs(value) == mark]
    _of_ends(key).write(mesh, own, 0)
    _of_ends(key).write(mesh, [path[0]], mark)
    if not paths.is_closed(path):
        _of_ends(key).write(mesh, [path[-1]], -mark)
