# SPDX-License-Identifier: GPL-3.0-or-later
"""The selection of vertices, edges and faces, in object mode and in edit mode."""

from collections.abc import Sequence
from typing import Any

import bmesh
import bpy
import numpy as np

from ..surfaces.arrays import Booleans, Edge, Integers
from .element_marks import element_counts
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


def counts_in_uvs(context: bpy.types.Context, obj: MeshObject) -> bool:
    """Whether the selection of UVs counts beside that of the mesh: where one works in the UV editor.

    Without synchronization UVs have a selection of their own. With it they may have one since Blender 5.0,
    of corners.
    """
    space: Any = context.space_data
    if space is None or space.type != "IMAGE_EDITOR" or not obj.data.is_editmode:
        return False
    if not context.scene.tool_settings.use_uv_select_sync:
        return True
    return bool(getattr(bmesh.from_edit_mesh(obj.data), "uv_select_sync_valid", False))


def uv_faces(mesh: bpy.types.Mesh, layer: str, first_corner: Integers) -> Booleans:
    """Which polygons (p,), by their first corners (p,), are selected in a UV map of a mesh.

    All of their corners and edges are. Before Blender 5.0 every UV map has a selection of its own.
    """
    if not len(first_corner):
        return np.zeros(0, bool)
    names = (
        (".uv_select_vert", ".uv_select_edge")
        if bpy.app.version >= (5, 0)
        else (f".vs.{layer}", f".es.{layer}")
    )
    corners = _corner_values(mesh, names[0]) & _corner_values(mesh, names[1])
    return np.logical_and.reduceat(corners, first_corner)


def _corner_values(mesh: bpy.types.Mesh, name: str) -> Booleans:
    """A truth value (c,) of each corner; False where the mesh has no such attribute."""
    values = np.zeros(len(mesh.loops), bool)
    attribute: Any = mesh.attributes.get(name)
    if attribute is not None:
        attribute.data.foreach_get("value", values)
    return values


def _deselect_all(mesh: bpy.types.Mesh) -> None:
    """Drops the attributes of the selection: Blender 5.0 crashes where edges of a script get new values."""
    for name in (".select_vert", ".select_edge", ".select_poly"):
        if name in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[name])


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


def has_polygons(obj: MeshObject, polygons: Integers) -> bool:
    """Whether the mesh of an object has polygons of these numbers."""
    return len(polygons) == 0 or int(polygons.max()) < element_counts(obj.data)[2]


def select_polygons(obj: MeshObject, polygons: Integers) -> None:
    """Selects polygons and nothing else of an object in edit mode; those that are hidden are shown."""
    edit, wanted = bmesh.from_edit_mesh(obj.data), {*polygons.tolist()}
    for elements in (edit.verts, edit.edges, edit.faces):
        for element in elements:
            element.select = False
    for number, face in enumerate(edit.faces):
        if number in wanted:
            face.hide_set(False)
            face.select_set(True)
    edit.select_history.clear()
    bmesh.update_edit_mesh(obj.data, loop_triangles=False, destructive=False)
