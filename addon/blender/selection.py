# SPDX-License-Identifier: GPL-3.0-or-later
"""The selection of vertices, edges and faces, in object mode and in edit mode."""

from collections.abc import Sequence
from typing import Any

import bmesh
import bpy

from ..surfaces.arrays import Edge
from .types import MeshObject


def vertices(obj: MeshObject) -> list[int]:
    """The selected, visible vertices of an object in edit mode."""
    edit = bmesh.from_edit_mesh(obj.data)
    return [number for number, vertex in enumerate(edit.verts) if vertex.select and not vertex.hide]


def edges(obj: MeshObject) -> list[Edge]:
    """The selected, visible edges of an object in edit mode, as pairs of vertices."""
    edit = bmesh.from_edit_mesh(obj.data)
    edit.verts.index_update()
    chosen = [edge for edge in edit.edges if edge.select and not edge.hide]
    return [tuple(vertex.index for vertex in edge.verts) for edge in chosen]


def has_faces(obj: MeshObject) -> bool:
    """Whether an object in edit mode has selected, visible faces."""
    return any(face.select and not face.hide for face in bmesh.from_edit_mesh(obj.data).faces)


def face_count(obj: MeshObject) -> int:
    """The number of selected faces of an object in edit mode; 0 in object mode."""
    return obj.data.total_face_sel if obj.data.is_editmode else 0


def active_vertices(obj: MeshObject) -> list[int]:
    """The active vertex of an object in edit mode, or the two of the active edge."""
    edit = bmesh.from_edit_mesh(obj.data)
    edit.verts.index_update()
    active = edit.select_history.active
    chosen = active.verts if isinstance(active, bmesh.types.BMEdge) else [active]
    return [vertex.index for vertex in chosen if isinstance(vertex, bmesh.types.BMVert)]


def select_vertex(obj: MeshObject, vertex: int) -> None:
    """Selects a vertex and nothing else of a mesh."""
    mesh = obj.data
    if not mesh.is_editmode:
        _deselect_all(mesh)
        mesh.vertices[vertex].select = True
        return
    edit = bmesh.from_edit_mesh(mesh)
    for element in edit.verts:
        element.select = False
    edit.select_flush(False)
    edit.verts.ensure_lookup_table()
    edit.verts[vertex].hide_set(False)
    edit.verts[vertex].select_set(True)
    edit.select_history.clear()
    edit.select_history.add(edit.verts[vertex])
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def select_edges(obj: MeshObject, edges: Sequence[Edge]) -> None:
    """Selects edges (pairs of vertices) and nothing else of a mesh."""
    mesh, wanted = obj.data, {frozenset(edge) for edge in edges}
    if mesh.is_editmode:
        _select_edited_edges(mesh, edges)
        return
    _deselect_all(mesh)
    for edge in mesh.edges:
        ends: Any = edge.vertices
        edge.select = frozenset(ends) in wanted
    for vertex in {vertex for edge in edges for vertex in edge}:
        mesh.vertices[vertex].select = True


def _deselect_all(mesh: bpy.types.Mesh) -> None:
    for elements in (mesh.polygons, mesh.edges, mesh.vertices):
        elements.foreach_set("select", [False] * len(elements))


def _select_edited_edges(mesh: bpy.types.Mesh, edges: Sequence[Edge]) -> None:
    edit = bmesh.from_edit_mesh(mesh)
    for elements in (edit.verts, edit.edges, edit.faces):
        for element in elements:
            element.select = False
    edit.verts.ensure_lookup_table()
    for first, second in edges:
        edge = edit.edges.get((edit.verts[first], edit.verts[second]))
        edge.hide_set(False)
        edge.select_set(True)
    edit.select_history.clear()
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
