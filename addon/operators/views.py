# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves the 3D view to a place on an object."""

import bpy
from mathutils import Vector

from ..blender import vertex_positions
from ..blender.types import MeshObject


def show(context: bpy.types.Context, obj: MeshObject, vertex: int) -> None:
    """Selects an object and puts one of its vertices into the middle of the 3D view, if there is one."""
    if obj.visible_get():
        obj.select_set(True)
    _look_at(context, *vertex_positions.in_world(obj, vertex, context.evaluated_depsgraph_get()))


def _look_at(context: bpy.types.Context, point: Vector, normal: Vector) -> None:
    """Puts a point into the middle of the 3D view and turns to its front."""
    view = getattr(context.space_data, "region_3d", None)
    if view is None:
        return
    if view.view_perspective == "CAMERA":
        view.view_perspective = "PERSP"
    to_viewer = view.view_rotation @ vertex_positions.Z
    if normal.dot(to_viewer) < 0.2 and normal.length > 0:
        view.view_rotation = normal.to_track_quat("Z", "Y")
    view.view_location = point
