# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices that are found again after a mesh was edited, by marks (see `element_marks`).

Deleting a vertex renumbers those behind it, but their marks go with them. Duplicating or extruding a vertex
copies its mark; the vertex is then no longer certain.
"""

from collections.abc import Sequence

import bpy

from ..blender import element_marks
from ..blender.element_marks import element_counts

NAME = "authalic_landmark"
_MARKS = element_marks.Marks(NAME, "POINT")
# The last search: session id of a mesh -> (counts of its elements, marks).
_seen: dict[int, tuple[tuple[int, int, int], dict[int, list[int]]]] = {}


def put(mesh: bpy.types.Mesh, vertex: int) -> int:
    """The mark of a vertex; it gets a new one if it has none, or shares its mark."""
    (old,) = _MARKS.of(mesh, [vertex])
    if old > 0 and len(find(mesh).get(old, ())) == 1:
        return old
    mark = element_marks.new()
    _write(mesh, [vertex], mark)
    return mark


def is_marked(mesh: bpy.types.Mesh, vertex: int) -> bool:
    """Whether a vertex has a mark."""
    return _MARKS.of(mesh, [vertex])[0] > 0


def move(mesh: bpy.types.Mesh, mark: int, vertex: int) -> None:
    """Takes a mark from all vertices that have it to one that has none."""
    clear(mesh, mark)
    _write(mesh, [vertex], mark)


def clear(mesh: bpy.types.Mesh, mark: int) -> None:
    """Removes a mark from all vertices that have it."""
    _write(mesh, find(mesh).get(mark, ()), 0)


def find(mesh: bpy.types.Mesh, *, wanted: Sequence[int] | None = None) -> dict[int, list[int]]:
    """The vertices, a list of numbers, for each mark on a mesh.

    With `wanted`, some marks, vertices that were found before are not searched again while these marks are
    where they were and the mesh has its number of elements: fast enough for drawing.
    """
    counts, by_mark = _seen.get(mesh.session_uid, (None, {}))
    if wanted is None or counts != element_counts(mesh) or not _holds(mesh, by_mark, wanted):
        by_mark = {}
        for vertex, mark in _MARKS.all(mesh).items():
            by_mark.setdefault(mark, []).append(vertex)
        _seen[mesh.session_uid] = element_counts(mesh), by_mark
    return by_mark


def vertex_count(mesh: bpy.types.Mesh) -> int:
    """The number of vertices, in edit mode too."""
    return element_counts(mesh)[0]


def _holds(mesh: bpy.types.Mesh, by_mark: dict[int, list[int]], wanted: Sequence[int]) -> bool:
    """Whether the wanted marks are there, and on the vertices where they were found."""
    if any(mark not in by_mark for mark in wanted):
        return False
    placed = [(mark, vertex) for mark in wanted for vertex in by_mark[mark]]
    return _MARKS.of(mesh, [vertex for _, vertex in placed]) == [mark for mark, _ in placed]


def _write(mesh: bpy.types.Mesh, vertices: Sequence[int], value: int) -> None:
    if len(vertices):
        _seen.pop(mesh.session_uid, None)
        _MARKS.write(mesh, vertices, value)
