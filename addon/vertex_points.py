# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the vertices of a mesh are seen: moved by its shape keys and modifiers, or as they are edited."""

import bmesh
import numpy as np
from mathutils import Vector

Z = Vector((0.0, 0.0, 1.0))
# Modifiers that may give the vertices of the mesh other numbers; others add some behind them, if any.
_RENUMBERING = {
    *("BEVEL", "BOOLEAN", "BUILD", "DECIMATE", "EDGE_SPLIT", "MASK", "NODES", "REMESH", "SCREW", "SKIN"),
    *("VOLUME_TO_MESH", "WELD", "WIREFRAME"),
}


def in_world(obj, vertex, depsgraph):
    """The point and the normal, of length 1 or 0, of a vertex in the world."""
    point, normal = _local(obj, vertex, depsgraph)
    matrix = obj.matrix_world
    turned = matrix.to_3x3().inverted_safe().transposed() @ normal
    return matrix @ point, turned.normalized()


def triangles(obj, depsgraph):
    """The visible surface: points (n, 3) of all vertices, and triangles (t, 3) of their numbers, local."""
    mesh = obj.data
    if mesh.is_editmode:
        return _edited(bmesh.from_edit_mesh(mesh))
    shown = shown_mesh(obj, depsgraph)
    points = np.empty(3 * len(shown.vertices), np.float32)
    shown.vertices.foreach_get("co", points)
    mesh.calc_loop_triangles()
    corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    return points.reshape(-1, 3)[: len(mesh.vertices)].astype(float), corners.reshape(-1, 3)


def shown_mesh(obj, depsgraph):
    """The mesh with shape keys and modifiers where its vertices begin with the object's own, else that."""
    mesh, shown = obj.data, obj.evaluated_get(depsgraph).data
    renumbered = any(each.show_viewport and each.type in _RENUMBERING for each in obj.modifiers)
    added = len(shown.vertices) - len(mesh.vertices)
    return shown if added == 0 or (added > 0 and not renumbered) else mesh


def _local(obj, vertex, depsgraph):
    mesh = obj.data
    if mesh.is_editmode:
        edit = bmesh.from_edit_mesh(mesh)
        edit.verts.ensure_lookup_table()
        one = edit.verts[vertex]
    else:
        one = shown_mesh(obj, depsgraph).vertices[vertex]
    return one.co.copy(), one.normal.copy()


def _edited(edit):
    numbers = {vertex: number for number, vertex in enumerate(edit.verts)}
    points = np.array([vertex.co[:] for vertex in edit.verts], float).reshape(-1, 3)
    corners = [
        [numbers[loop.vert] for loop in loops]
        for loops in edit.calc_loop_triangles()
        if not loops[0].face.hide
    ]
    return points, np.array(corners, np.int32).reshape(-1, 3)
