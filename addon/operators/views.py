# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves the 3D view to a place on an object."""

from typing import Any

import bpy
import numpy as np
from mathutils import Vector

from ..blender import vertex_positions
from ..blender.types import MeshObject
from ..surfaces.arrays import Floats

_SENSOR = 36.0  # millimeters that half the longer side of a view takes at the distance of its lens
_AROUND = 1.05


def show(context: bpy.types.Context, obj: MeshObject, vertex: int) -> None:
    """Selects an object and puts one of its vertices into the middle of the 3D view, if there is one."""
    if obj.visible_get():
        obj.select_set(True)
    _look_at(context, *vertex_positions.in_world(obj, vertex, context.evaluated_depsgraph_get()))


def frame(context: bpy.types.Context, low: Floats, high: Floats) -> None:
    """Moves the 3D view, if there is one, so that it shows the box between two corners (3,) in the world."""
    space: Any = context.space_data
    view, region = getattr(space, "region_3d", None), context.region
    if view is None or region is None:
        return
    if view.view_perspective == "CAMERA":
        view.view_perspective = "PERSP"
    covered = _covered(context)
    wide, high_up = max(region.width - covered, 1), region.height
    longer = max(region.width, region.height)
    radius = _AROUND * float(np.linalg.norm(high - low)) / 2
    view.view_distance = radius * space.lens / _SENSOR * longer / min(wide, high_up)
    per_pixel = 2 * view.view_distance * _SENSOR / space.lens / longer
    to_the_right = view.view_rotation @ Vector((covered / 2 * per_pixel, 0.0, 0.0))
    view.view_location = Vector(((low + high) / 2).tolist()) + to_the_right


def _covered(context: bpy.types.Context) -> int:
    """The pixels at the right of a view that its sidebar lies over."""
    if not context.preferences.system.use_region_overlap:
        return 0
    return sum(part.width for part in context.area.regions if part.type == "UI" and part.width > 1)


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
