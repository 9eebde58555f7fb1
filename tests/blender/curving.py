# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmark curves for the tests: two grids of 7 and of 9 vertices a side, and paths on them."""

import heapq
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from installed import part
from meshes import Array, MeshObject

ROW = (8, 9, 10, 11)  # inside Head A
OTHER = (22, 23, 24, 25)
ROW_B = (10, 11, 12, 13, 14)  # inside Head B
OTHER_B = (38, 39, 40)
LOOP = (16, 17, 18, 25, 32, 31, 30, 23, 16)
LOOP_B = (20, 21, 22, 31, 40, 39, 38, 29, 20)


def text(path: Sequence[int]) -> str:
    return " ".join(map(str, path))


def add(source: Sequence[int] | None = (), target: Sequence[int] | None = (), **options: Any) -> None:
    options |= {"source_vertices": text(source), "target_vertices": text(target)}
    assert bpy.ops.authalic.landmark_curve_add(**options) == {"FINISHED"}


def listed(obj: MeshObject | None = None) -> list[tuple[Any, ...]]:
    """(name, source path, target path, problem) of each curve."""
    curves = part("landmarks.curves").pairs(obj or bpy.data.objects["Head A"])
    return [(curve.name, curve.source.vertices, curve.target.vertices, curve.problem) for curve in curves]


def refused(words: str, call: Callable[..., Any], **options: Any) -> None:
    before = listed()
    with pytest.raises(RuntimeError, match=words):
        call(**options)
    assert listed() == before


def select_path(obj: MeshObject, *paths: Sequence[int], active: Any = None) -> None:
    """Selects only the edges of some paths in edit mode; `active` is a vertex or an edge."""
    edit = bmesh.from_edit_mesh(obj.data)
    for elements in (edit.faces, edit.edges, edit.verts):
        for element in elements:
            element.select = False
    edit.verts.ensure_lookup_table()
    for path in paths:
        for first, second in pairwise(path):
            edge_between(edit, first, second).select_set(True)
    edit.select_history.clear()
    if active is not None:
        chosen = edge_between(edit, *active) if isinstance(active, tuple) else edit.verts[active]
        edit.select_history.add(chosen)
    bmesh.update_edit_mesh(obj.data)


def edge_between(edit: bmesh.types.BMesh, first: int, second: int) -> bmesh.types.BMEdge:
    return edit.edges.get((edit.verts[first], edit.verts[second]))


def selected_edges(obj: MeshObject) -> list[tuple[int, ...]]:
    """The selected edges as sorted pairs of vertices, in either mode."""
    if obj.data.is_editmode:
        edit = bmesh.from_edit_mesh(obj.data)
        edges = [[vertex.index for vertex in edge.verts] for edge in edit.edges if edge.select]
    else:
        edges = [list(edge.vertices) for edge in obj.data.edges if edge.select]
    return sorted(tuple(sorted(pair)) for pair in edges)


def route(obj: MeshObject, *stops: Sequence[float]) -> tuple[int, ...]:
    """The vertices of shortest edge paths on an object from stop to stop, which are points."""
    points = np.array([vertex.co for vertex in obj.data.vertices])
    near = [int(np.argmin(np.linalg.norm(points - stop, axis=1))) for stop in stops]
    around: dict[int, list[int]] = {}
    for first, second in (tuple(edge.vertices) for edge in obj.data.edges):
        around.setdefault(first, []).append(second)
        around.setdefault(second, []).append(first)
    path = [near[0]]
    for first, last in pairwise(near):
        path += _shortest(points, around, first, last)[1:]
    return tuple(path)


def _shortest(points: Array, around: dict[int, list[int]], first: int, last: int) -> list[int]:
    heap, before = [(0.0, first, first)], {}
    while last not in before:
        length, vertex, origin = heapq.heappop(heap)
        if vertex in before:
            continue
        before[vertex] = origin
        for neighbor in around[vertex]:
            step = float(np.linalg.norm(points[neighbor] - points[vertex]))
            heapq.heappush(heap, (length + step, neighbor, vertex))
    path = [last]
    while path[-1] != first:
        path.append(before[path[-1]])
    return path[::-1]
