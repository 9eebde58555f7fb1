# SPDX-License-Identifier: GPL-3.0-or-later
"""The edges of meshes, the vertices at their ends and their seams, in object mode and in edit mode."""

from collections.abc import Sequence
from typing import Any

import bmesh
import bpy
import numpy as np

from ..surfaces.arrays import Edge, Integers


class NoEdge(Exception):
    """No edge joins two vertices."""


def ends_of_edges(mesh: bpy.types.Mesh, edges: Sequence[int]) -> list[Edge]:
    """The two vertices of each edge."""
    if not mesh.is_editmode:
        ends: list[Any] = [mesh.edges[edge].vertices for edge in edges]
        return [(first, second) for first, second in ends]
    edit = bmesh.from_edit_mesh(mesh)
    edit.verts.index_update()
    edit.edges.ensure_lookup_table()
    return [tuple(vertex.index for vertex in edit.edges[edge].verts) for edge in edges]


def edges_between(mesh: bpy.types.Mesh, pairs: Sequence[Edge]) -> list[int]:
    """The edges that join pairs of vertices. Raises `NoEdge`."""
    if mesh.is_editmode:
        return _edited_between(bmesh.from_edit_mesh(mesh), pairs)
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    count = len(mesh.vertices)
    keys = _keys(ends.reshape(-1, 2), count)
    order = np.argsort(keys)
    wanted = _keys(np.array(pairs).reshape(-1, 2), count)
    places = np.searchsorted(keys, wanted, sorter=order).clip(max=max(len(keys) - 1, 0))
    bad = np.flatnonzero(keys[order[places]] != wanted) if len(keys) else np.zeros(1, int)
    if len(bad):
        raise NoEdge("no edge joins vertices {} and {}".format(*pairs[bad[0]]))
    edges: list[int] = order[places].tolist()
    return edges


def mark_seams(mesh: bpy.types.Mesh, marked: Sequence[int], cleared: Sequence[int] = ()) -> None:
    """Clears seams, then marks edges as seams; all other edges stay as they are."""
    if mesh.is_editmode:
        edit = bmesh.from_edit_mesh(mesh)
        edit.edges.ensure_lookup_table()
        for is_seam, edges in ((False, cleared), (True, marked)):
            for edge in edges:
                edit.edges[edge].seam = is_seam
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
        return
    seam = np.empty(len(mesh.edges), bool)
    mesh.edges.foreach_get("use_seam", seam)
    seam[np.array(cleared, int)] = False
    seam[np.array(marked, int)] = True
    mesh.edges.foreach_set("use_seam", seam)
    mesh.update()


def _edited_between(edit: bmesh.types.BMesh, pairs: Sequence[Edge]) -> list[int]:
    edit.verts.ensure_lookup_table()
    edit.edges.index_update()
    numbers = []
    for first, second in pairs:
        edge = edit.edges.get((edit.verts[first], edit.verts[second]))
        if edge is None:
            raise NoEdge(f"no edge joins vertices {first} and {second}")
        numbers.append(edge.index)
    return numbers


def _keys(pairs: Integers, count: int) -> Integers:
    pairs = np.sort(pairs.astype(np.int64), axis=1)
    return pairs[:, 0] * count + pairs[:, 1]
