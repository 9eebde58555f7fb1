# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges, as pairs of vertices, that make up one path or one closed loop. Plain logic, no bpy.

A path is a tuple of vertices from its start to its end; a loop ends with its first vertex.
"""

from collections.abc import Sequence
from itertools import pairwise

from .. import messages
from ..surfaces.arrays import Edge, Path


class NoPath(Exception):
    """The edges are no single path; says what they are instead, to be read behind "the edges"."""


def ordered(edges: Sequence[Edge]) -> Path:
    """The path along all edges, from its end with the lower number; a loop from its lowest vertex.

    Raises `NoPath`.
    """
    near: dict[int, list[int]] = {}
    for first, second in edges:
        near.setdefault(first, []).append(second)
        near.setdefault(second, []).append(first)
    pieces = _pieces(near)
    branches = sorted(vertex for vertex, neighbors in near.items() if len(neighbors) > 2)
    if not edges or pieces > 1 or branches:
        raise NoPath(_reason(pieces, branches))
    ends = sorted(vertex for vertex, neighbors in near.items() if len(neighbors) == 1)
    return _walk(near, ends[0] if ends else min(near))


def is_closed(path: Path) -> bool:
    return len(path) > 1 and path[0] == path[-1]


def edges(path: Path) -> list[Edge]:
    """The pairs of consecutive vertices."""
    return list(pairwise(path))


def along(path: Path, first: int | None, last: int | None) -> Path | None:
    """The path from its end `first` to its end `last`; a loop begins at `first`. None where that is no end.

    An unknown end is None.
    """
    if is_closed(path):
        return started(path, first) if first in path else None
    if path[0] != first and path[-1] != last:
        path = path[::-1]
    return path if (path[0], path[-1]) == (first, last) else None


def started(path: Path, vertex: int) -> Path:
    """The path from the end that is nearer to one of its vertices; a loop from this vertex."""
    place = path.index(vertex)
    if is_closed(path):
        return path[place:-1] + path[:place] + (vertex,)
    return path[::-1] if 2 * place > len(path) - 1 else path


def repeated(path: Path) -> int | None:
    """A vertex that the path visits twice, or None; the start of a loop does not count."""
    seen = set()
    for vertex in path[:-1] if is_closed(path) else path:
        if vertex in seen:
            return vertex
        seen.add(vertex)
    return None


def _walk(near: dict[int, list[int]], start: int) -> Path:
    path, before = [start], None
    while True:
        here = path[-1]
        onward = [vertex for vertex in near[here] if vertex != before]
        if not onward:
            return tuple(path)
        before = here
        path.append(min(onward) if here == start else onward[0])
        if path[-1] == start:
            return tuple(path)


def _pieces(near: dict[int, list[int]]) -> int:
    """The number of connected components."""
    count, left = 0, set(near)
    while left:
        count += 1
        border = [left.pop()]
        while border:
            reached = left.intersection(near[border.pop()])
            left -= reached
            border.extend(reached)
    return count


def _reason(pieces: int, branches: Sequence[int]) -> str:
    parts = [f"make up {pieces} pieces"] if pieces > 1 else []
    if branches:
        parts.append(f"branch at {messages.count(len(branches), 'vertex')} ({messages.numbers(branches)})")
    return " and ".join(parts) or "are none"
