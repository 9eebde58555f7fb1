# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths along edges that are found again after a mesh was edited, by marks (see `element_marks`).

All edges of a path have its mark, and so have the parts into which edits divide them. The first vertex has
the mark too, the last one its negative. Each key has a pair of attributes: no two paths of the same key share
an edge on one mesh.
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
# The last search: (session id of a mesh, key) -> (counts of its elements, {mark: `_Found`}), and the
# `scene_changes` at which it was last known to be true.
_seen: dict[tuple[int, str], tuple[tuple[int, int, int], "dict[int, _Found]"]] = {}
_true: dict[tuple[int, str], int] = {}


class MarkedPath(NamedTuple):
    """A marked path as the mesh has it now.

    `vertices` run from start to end; a loop ends with its first vertex. If the path is not certain there are
    none, and `problem` says why; it is read behind the name of the curve and before that of the object.
    """

    vertices: Path
    edges: tuple[Edge, ...]
    problem: str | None

    @property
    def is_closed(self) -> bool:
        return paths.is_closed(self.vertices)


ABSENT = MarkedPath((), (), "has no edges")


class _Found(NamedTuple):
    """A path, the numbers of its edges, and its end vertices with their marks."""

    path: MarkedPath
    edges: list[int]
    ends: list[tuple[int, int]]


def new() -> int:
    """A mark that no path has."""
    return element_marks.new(_BITS)


def key(source: MeshObject, side: str) -> str:
    """The key of the curves of a source object on its "source" or "target" mesh; "" if it has none yet."""
    source_key = source.authalic_curve_key
    return f"{side}_{source_key}" if source_key else ""


def put(mesh: bpy.types.Mesh, key: str, mark: int, path: Path) -> None:
    """Moves a mark to the edges of a path. Raises `NoEdge`."""
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
    """Removes a mark from a mesh, and the attributes with the last mark."""
    _drop(mesh, key)
    for kind in _kinds(key):
        marked = kind.all(mesh)
        cleared = [element for element, value in marked.items() if abs(value) == mark]
        kind.write(mesh, cleared, 0)
        if len(cleared) == len(marked):
            kind.drop(mesh)


def copy(mesh: bpy.types.Mesh, key: str, new_key: str, wanted: Collection[int]) -> None:
    """Copies the wanted marks of a key to a new key."""
    for kind, new_kind in zip(_kinds(key), _kinds(new_key), strict=True):
        for value, elements in _by_value(kind, mesh).items():
            if abs(value) in wanted:
                new_kind.write(mesh, elements, value)
    _drop(mesh, new_key)


def keep(mesh: bpy.types.Mesh, key: str, wanted: Collection[int]) -> None:
    """Removes all but the wanted marks of a key from a mesh, and the attributes with the last mark."""
    for kind in _kinds(key):
        if kind.is_on(mesh):
            by_value = _by_value(kind, mesh)
            unwanted = [value for value in by_value if abs(value) not in wanted]
            if unwanted:
                kind.write(mesh, [element for value in unwanted for element in by_value[value]], 0)
                _drop(mesh, key)
            if len(unwanted) == len(by_value):
                kind.drop(mesh)


def find(mesh: bpy.types.Mesh, key: str, *, drawing: bool = False) -> dict[int, MarkedPath]:
    """{mark: `MarkedPath`} of the paths of a key on a mesh.

    With `drawing`, paths that were found before are not searched again while no geometry has changed, nor
    while they have their marks and the mesh its number of elements: fast enough for drawing.
    """
    held, place = element_marks.hold(mesh), (mesh.session_uid, key)
    counts, by_mark = _seen.get(place, (None, {}))
    if not drawing or _true.get(place) != scene_changes.count():
        if not drawing or counts != element_counts(mesh) or not _holds(mesh, key, by_mark):
            by_mark = _search(mesh, key)
            _seen[place] = element_counts(mesh), by_mark
        _true[place] = scene_changes.count()
    del held
    return {mark: result.path for mark, result in by_mark.items()}


def forget() -> None:
    """Forgets all paths that were found before, as undo may have moved them."""
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
    by_value: dict[int, list[int]] = {}
    for element, value in kind.all(mesh).items():
        by_value.setdefault(value, []).append(element)
    return by_value


def _search(mesh: bpy.types.Mesh, key: str) -> dict[int, _Found]:
    edges: dict[int, list[int]] = {}
    ends: dict[int, list[int]] = {}
    for edge, mark in _of_edges(key).all(mesh).items():
        edges.setdefault(mark, []).append(edge)
    for vertex, mark in _of_ends(key).all(mesh).items():
        ends.setdefault(mark, []).append(vertex)
    by_mark = {}
    for mark, marked in edges.items():
        path = _path(ends_of_edges(mesh, marked), ends.get(mark, []), ends.get(-mark, []))
        terminal = [path.vertices[0], path.vertices[-1]] if path.vertices else []
        by_mark[mark] = _Found(
            path, marked, list(zip(terminal, _of_ends(key).of(mesh, terminal), strict=True))
        )
    return by_mark


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


def _holds(mesh: bpy.types.Mesh, key: str, by_mark: dict[int, _Found]) -> bool:
    """Whether paths that were found before still have their marks, edges and ends."""
    edges = [edge for result in by_mark.values() for edge in result.edges]
    values = [mark for mark, result in by_mark.items() for _ in result.edges]
    ends = [end for result in by_mark.values() for end in result.ends]
    return (
        _of_edges(key).of(mesh, edges) == values
        and ends_of_edges(mesh, edges) == [pair for result in by_mark.values() for pair in result.path.edges]
        and _of_ends(key).of(mesh, [vertex for vertex, _ in ends]) == [value for _, value in ends]
    )


def _mark_ends(mesh: bpy.types.Mesh, key: str, mark: int, path: Path) -> None:
    _drop(mesh, key)
    marked = [element for element, value in _of_ends(key).all(mesh).items() if abs(value) == mark]
    _of_ends(key).write(mesh, marked, 0)
    _of_ends(key).write(mesh, [path[0]], mark)
    if not paths.is_closed(path):
        _of_ends(key).write(mesh, [path[-1]], -mark)
