# SPDX-License-Identifier: GPL-3.0-or-later
"""Disks and labels drawn over a 3D view, and the objects that they are drawn for."""

import math
from collections.abc import Sequence
from typing import Any

import blf
import bpy
import gpu
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix, Vector

from ..blender import vertex_positions
from ..blender.types import MeshObject, is_mesh

PROBLEM, ACTIVE, DARK = (1.0, 0.2, 0.2), (1.0, 1.0, 1.0), (0.05, 0.05, 0.05)
BEHIND = 0.22  # the opacity of hidden markers
_SIDES = 24
# Lines are drawn nearer to the eye than their surface, by this part of the distance.
_NEARER = 2e-3


def sources(context: bpy.types.Context) -> list[MeshObject]:
    """The mesh objects that are selected, and those whose target is."""
    chosen = {context.object, *context.selected_objects, *(getattr(context, "objects_in_mode", None) or ())}
    objects = context.view_layer.objects
    return [obj for obj in objects if is_mesh(obj) and chosen & {obj, obj.authalic_target}]


def redraw(context: bpy.types.Context, spaces: Sequence[str] = ("VIEW_3D",)) -> None:
    """Asks for all areas of some types to be drawn again."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in spaces:
                area.tag_redraw()


def is_drawn(context: bpy.types.Context) -> bool:
    """Whether there is a view to draw on, with its overlays turned on."""
    space: Any = context.space_data
    return not bpy.app.background and space is not None and space.overlay.show_overlays


def faces_eye(context: bpy.types.Context, point: Vector, normal: Vector) -> bool:
    """Whether a surface is seen from its front at a point."""
    return normal.length == 0 or normal.dot(_to_eye(context, point)) > -0.05


def _to_eye(context: bpy.types.Context, point: Vector) -> Vector:
    view = context.region_data
    if view.is_perspective:
        return (view.view_matrix.inverted().translation - point).normalized()
    return view.view_matrix.inverted().to_3x3() @ vertex_positions.Z


def nearer_to_eye(context: bpy.types.Context) -> Matrix:
    """The matrix that moves points of the view nearer to the eye, at the same pixels."""
    view = context.region_data
    if view.is_perspective:
        return Matrix.Diagonal((*[1 - _NEARER] * 3, 1))
    return Matrix.Translation((0, 0, _NEARER * view.view_distance))


def disk(center: Sequence[float] | Vector, radius: float, color: Sequence[float]) -> None:
    """A disk whose rim fades out over a pixel."""
    inner, outer = _circle(center, radius - 0.5), _circle(center, radius + 0.5)
    clear = (*color[:3], 0.0)
    points = [(center[0], center[1]), *inner, *outer]
    triangles = []
    for k in range(_SIDES):
        a, b = 1 + k, 1 + (k + 1) % _SIDES
        triangles += [(0, a, b), (a, a + _SIDES, b), (b, a + _SIDES, b + _SIDES)]
    colors = [color] * (1 + _SIDES) + [clear] * _SIDES
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    flat = [(x, y, 0.0) for x, y in points]
    batch_for_shader(shader, "TRIS", {"pos": flat, "color": colors}, indices=triangles).draw(shader)


def _circle(center: Sequence[float] | Vector, radius: float) -> list[tuple[float, float]]:
    turns = [2 * math.pi * k / _SIDES for k in range(_SIDES)]
    return [(center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)) for a in turns]


def label(text: str, pixel: Sequence[float] | Vector, size: float, color: Sequence[float]) -> None:
    """A text to the right of a pixel, on a dark ground."""
    font, scale = 0, bpy.context.preferences.system.ui_scale
    blf.size(font, size)
    left, bottom = pixel[0] + 11 * scale, pixel[1] + 4 * scale
    width, height = blf.dimensions(font, text)
    gpu.state.blend_set("ALPHA")
    plate(left - 3 * scale, bottom - 3 * scale, width + 6 * scale, height + 6 * scale, 0.6 * color[3])
    gpu.state.blend_set("NONE")
    blf.color(font, *color)
    blf.position(font, left, bottom, 0)
    blf.draw(font, text)


def plate(left: float, bottom: float, width: float, height: float, alpha: float) -> None:
    """A dark ground that makes text readable over wires."""
    right, top = left + width, bottom + height
    corners = [(left, bottom, 0.0), (right, bottom, 0.0), (right, top, 0.0), (left, top, 0.0)]
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    shader.uniform_float("color", (*DARK, alpha))
    batch_for_shader(shader, "TRIS", {"pos": corners}, indices=[(0, 1, 2), (0, 2, 3)]).draw(shader)
