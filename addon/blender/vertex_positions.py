# SPDX-License-Identifier: GPL-3.0-or-later
"""The visible positions of vertices: moved by shape keys and modifiers, or as they are edited."""

from collections.abc import Callable, Sequence
from typing import Any

import bmesh
import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from ..surfaces.arrays import Booleans, Floats
from .types import MeshObject

Hit = tuple[Vector, list[int]]
"""A point of a surface and the vertices of the face there."""
Cast = Callable[[Vector, Vector], Hit | None]
"""The first hit of a ray with an origin and a direction."""

Z = Vector((0.0, 0.0, 1.0))
# Modifiers that may give the vertices of the mesh other numbers; others add some behind them, if any.
_RENUMBERING = {
    *("BEVEL", "BOOLEAN", "BUILD", "DECIMATE", "EDGE_SPLIT", "MASK", "NODES", "REMESH", "SCREW", "SKIN"),
    *("VOLUME_TO_MESH", "WELD", "WIREFRAME"),
}
_HIDDEN_LAYERS = 64


def in_world(obj: MeshObject, vertex: int, depsgraph: bpy.types.Depsgraph) -> tuple[Vector, Vector]:
    """The point and the normal, of length 1 or 0, of a vertex in the world."""
    return to_world(obj, *local(obj, vertex, depsgraph))


def to_world(obj: MeshObject, point: Vector, normal: Vector) -> tuple[Vector, Vector]:
    """A point and a normal in the coordinates of an object, moved into the world."""
    matrix = obj.matrix_world
    turned = matrix.to_3x3().inverted_safe().transposed() @ normal
    return matrix @ point, turned.normalized()


def local(obj: MeshObject, vertex: int, depsgraph: bpy.types.Depsgraph) -> tuple[Vector, Vector]:
    """The point and the normal of a vertex in the coordinates of the object."""
    mesh = obj.data
    if mesh.is_editmode:
        edit = bmesh.from_edit_mesh(mesh)
        edit.verts.ensure_lookup_table()
        element: Any = edit.verts[vertex]
    else:
        element = _shown_mesh(obj, depsgraph).vertices[vertex]
    return element.co.copy(), element.normal.copy()


def count(obj: MeshObject) -> int:
    """The number of vertices of an object's mesh."""
    mesh = obj.data
    return len(bmesh.from_edit_mesh(mesh).verts) if mesh.is_editmode else len(mesh.vertices)


def many(obj: MeshObject, vertices: Sequence[int], depsgraph: bpy.types.Depsgraph) -> Floats:
    """The points (k, 3) of some vertices in the coordinates of the object."""
    mesh = obj.data
    if mesh.is_editmode:
        elements: Any = bmesh.from_edit_mesh(mesh).verts
        elements.ensure_lookup_table()
    else:
        elements = _shown_mesh(obj, depsgraph).vertices
    return np.array([elements[vertex].co[:] for vertex in vertices], float).reshape(-1, 3)


def undeformed(obj: MeshObject, vertices: Sequence[int]) -> Floats:
    """The points (k, 3) of some vertices in the mesh itself, without shape keys and modifiers."""
    mesh = obj.data
    if mesh.is_editmode:
        elements: Any = bmesh.from_edit_mesh(mesh).verts
        elements.ensure_lookup_table()
    else:
        elements = mesh.vertices
    return np.array([elements[vertex].co[:] for vertex in vertices], float).reshape(-1, 3)


def undeformed_surface(obj: MeshObject) -> tuple[Floats, Booleans]:
    """All points (n, 3) of a mesh, without shape keys and modifiers, and a mask (n,) of those on a face."""
    mesh = obj.data
    if mesh.is_editmode:
        edited = bmesh.from_edit_mesh(mesh).verts
        points = np.array([vertex.co[:] for vertex in edited], float).reshape(-1, 3)
        return points, np.array([bool(vertex.link_faces) for vertex in edited], bool)
    values = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", values)
    return values.reshape(-1, 3).astype(float), _on_faces(mesh)


def surface(obj: MeshObject, depsgraph: bpy.types.Depsgraph) -> tuple[Floats, Booleans, Cast]:
    """The visible surface of an object, in its own coordinates, for finding vertices.

    Returns the points (n, 3) of all vertices, a mask (n,) of those on a visible face, and a `Cast`.
    """
    mesh = obj.data
    if mesh.is_editmode:
        edit = bmesh.from_edit_mesh(mesh)
        points = np.array([vertex.co[:] for vertex in edit.verts], float).reshape(-1, 3)
        used = np.array([bool(vertex.link_faces) and not vertex.hide for vertex in edit.verts], bool)
        return points, used, _cast_on_edited(mesh)
    shown = _shown_mesh(obj, depsgraph)
    values = np.empty(3 * len(shown.vertices), np.float32)
    shown.vertices.foreach_get("co", values)
    points = values.reshape(-1, 3)[: len(mesh.vertices)].astype(float)
    same_faces = len(shown.polygons) == len(mesh.polygons)
    return points, _on_faces(mesh), _cast_on_shown(obj) if same_faces else _cast_on_own(mesh, points)


def _on_faces(mesh: bpy.types.Mesh) -> Booleans:
    """Which vertices (n,) of a mesh that is not in edit mode have a face."""
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    used = np.zeros(len(mesh.vertices), bool)
    used[corners] = True
    return used


def keeps_topology(obj: MeshObject, shown: bpy.types.Mesh) -> bool:
    """Whether an evaluated mesh has the vertices and faces of its object's mesh, moved at most."""
    mesh = obj.data
    pairs = ((mesh.vertices, shown.vertices), (mesh.loops, shown.loops), (mesh.polygons, shown.polygons))
    return not _is_renumbered(obj) and all(len(own) == len(other) for own, other in pairs)


def _shown_mesh(obj: MeshObject, depsgraph: bpy.types.Depsgraph) -> bpy.types.Mesh:
    """The evaluated mesh if its first vertices are those of the object's mesh; else the object's mesh."""
    mesh, shown = obj.data, obj.evaluated_get(depsgraph).data
    added = len(shown.vertices) - len(mesh.vertices)
    return shown if added == 0 or (added > 0 and not _is_renumbered(obj)) else mesh


def _is_renumbered(obj: MeshObject) -> bool:
    """Whether modifiers in use may give the vertices of the mesh other numbers."""
    return any(modifier.show_viewport and modifier.type in _RENUMBERING for modifier in obj.modifiers)


def _cast_on_shown(obj: MeshObject) -> Cast:
    """Rays on the tree that Blender itself keeps of the mesh with its modifiers."""

    def cast(origin: Vector, direction: Vector) -> Hit | None:
        shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
        is_hit, point, _, face = shown.ray_cast(origin, direction)
        polygons: Any = obj.data.polygons
        return (point, list(polygons[face].vertices)) if is_hit and face >= 0 else None

    return cast


def _cast_on_own(mesh: bpy.types.Mesh, points: Floats) -> Cast:
    """Rays on the faces of the mesh, which the modifiers have divided, between points (n, 3)."""
    polygons: Any = mesh.polygons
    faces = [list(polygon.vertices) for polygon in polygons]
    tree = BVHTree.FromPolygons(points.tolist(), faces)

    def cast(origin: Vector, direction: Vector) -> Hit | None:
        point, _, face, _ = tree.ray_cast(origin, direction)
        return (point, faces[face]) if point is not None else None

    return cast


def _cast_on_edited(mesh: bpy.types.Mesh) -> Cast:
    """Rays on the faces that are not hidden in edit mode."""
    tree = BVHTree.FromBMesh(bmesh.from_edit_mesh(mesh))

    def cast(origin: Vector, direction: Vector) -> Hit | None:
        edit, start = bmesh.from_edit_mesh(mesh), origin.copy()
        edit.faces.ensure_lookup_table()
        edit.verts.index_update()
        for _ in range(_HIDDEN_LAYERS):
            point, _, face, _ = tree.ray_cast(start, direction)
            if point is None or face >= len(edit.faces):
                return None
            if not edit.faces[face].hide:
                return point, [vertex.index for vertex in edit.faces[face].verts]
            start = point + direction.normalized() * max((point - origin).length * 1e-5, 1e-6)
        return None

    return cast
