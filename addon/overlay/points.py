# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbered markers on the landmarks of the source and of its target, drawn over the 3D view."""

import math
from typing import NamedTuple

import blf
import bpy
import gpu
from bpy.props import BoolProperty
from bpy_extras.view3d_utils import location_3d_to_region_2d
from gpu_extras.batch import batch_for_shader

from ..blender import element_marks as marks
from ..blender import vertex_positions as vertex_points
from ..landmarks import points as landmarks

_COLORS = {"source": (0.16, 0.55, 1.0), "target": (1.0, 0.58, 0.1)}
PROBLEM, ACTIVE, DARK = (1.0, 0.2, 0.2), (1.0, 1.0, 1.0), (0.05, 0.05, 0.05)
_RADIUS, _SIDES, BEHIND = 5.0, 24, 0.22
_handle = None
# What picking shows besides: markers of vertices that are no landmarks yet.
hints = []


class Marker(NamedTuple):
    """A vertex of the object of a name, what is written beside it, and how it is drawn."""

    object_name: str
    vertex: int
    text: str
    side: str
    is_active: bool = False
    has_problem: bool = False


def shown(context):
    """The markers for what is selected: of sources and of those whose target is."""
    if not context.scene.authalic_show_landmarks:
        return list(hints)
    listed = [source for source in sources(context) if source.authalic_landmarks]
    return [marker for source in listed for marker in _of(source, context)] + hints


def redraw(context):
    """Asks for all 3D views to be drawn again."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def sources(context):
    """The mesh objects that are selected, and those whose target is."""
    chosen = {context.object, *context.selected_objects, *(getattr(context, "objects_in_mode", None) or ())}
    return [
        obj
        for obj in context.view_layer.objects
        if obj.type == "MESH" and chosen & {obj, obj.authalic_target}
    ]


def is_drawn(context):
    """Whether there is a view to draw on, with its overlays turned on."""
    space = context.space_data
    return not bpy.app.background and space is not None and space.overlay.show_overlays


def _of(source, context):
    active, is_meant = source.authalic_landmark_index, source == landmarks.source(context)
    for index, pair in enumerate(landmarks.pairs(source, drawing=True)):
        looks = (is_meant and index == active, pair.problem is not None)
        if pair.source_vertex != landmarks.NONE:
            yield Marker(source.name, pair.source_vertex, str(index + 1), "source", *looks)
        if pair.target_vertex != landmarks.NONE:
            yield Marker(source.authalic_target.name, pair.target_vertex, str(index + 1), "target", *looks)


def _draw():
    context = bpy.context
    if not is_drawn(context):
        return
    scale = context.preferences.system.ui_scale
    held = [marks.hold(obj.data) for obj in sources(context)]
    placed = [found for marker in shown(context) if (found := _place(marker, context))]
    del held
    placed.sort(key=lambda found: (found[2], found[0].is_active))  # those in front over the others
    gpu.state.blend_set("ALPHA")
    for marker, pixel, is_front in placed:
        _draw_disc(marker, pixel, scale, 1.0 if is_front else BEHIND)
    gpu.state.blend_set("NONE")
    for marker, pixel, is_front in placed:
        _draw_text(marker, pixel, scale, 1.0 if is_front else BEHIND)


def _place(marker, context):
    """(marker, its pixel, whether its surface faces the eye), or None where it cannot be seen."""
    obj = context.view_layer.objects.get(marker.object_name)
    if obj is None or not obj.visible_get(viewport=context.space_data):
        return None
    point, normal = vertex_points.in_world(obj, marker.vertex, context.evaluated_depsgraph_get())
    pixel = location_3d_to_region_2d(context.region, context.region_data, point)
    return pixel and (marker, pixel, faces_eye(context, point, normal))


def faces_eye(context, point, normal):
    """Whether a surface is seen from its front at a point."""
    return normal.length == 0 or normal.dot(_to_eye(context, point)) > -0.05


def _to_eye(context, point):
    view = context.region_data
    if view.is_perspective:
        return (view.view_matrix.inverted().translation - point).normalized()
    return view.view_matrix.inverted().to_3x3() @ vertex_points.Z


def _draw_disc(marker, pixel, scale, alpha):
    color = PROBLEM if marker.has_problem else _COLORS[marker.side]
    radius = _RADIUS * scale * (1.3 if marker.is_active else 1.0)
    disc(pixel, radius + 1.5 * scale, (*(ACTIVE if marker.is_active else DARK), alpha))
    disc(pixel, radius, (*color, alpha))


def disc(center, radius, color):
    """A disc whose rim fades out over a pixel."""
    inner, outer = _circle(center, radius - 0.5), _circle(center, radius + 0.5)
    clear = (*color[:3], 0.0)
    points = [tuple(center), *inner, *outer]
    triangles = []
    for k in range(_SIDES):
        a, b = 1 + k, 1 + (k + 1) % _SIDES
        triangles += [(0, a, b), (a, a + _SIDES, b), (b, a + _SIDES, b + _SIDES)]
    colors = [color] * (1 + _SIDES) + [clear] * _SIDES
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    flat = [(x, y, 0.0) for x, y in points]
    batch_for_shader(shader, "TRIS", {"pos": flat, "color": colors}, indices=triangles).draw(shader)


def _circle(center, radius):
    turns = [2 * math.pi * k / _SIDES for k in range(_SIDES)]
    return [(center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)) for a in turns]


def _draw_text(marker, pixel, scale, alpha):
    color = PROBLEM if marker.has_problem else ACTIVE
    label(marker.text, pixel, scale * (14 if marker.is_active else 12), (*color, alpha))


def label(text, pixel, size, color):
    """A text of a size to the right of a pixel, on a dark ground."""
    font, scale = 0, bpy.context.preferences.system.ui_scale
    blf.size(font, size)
    left, bottom = pixel[0] + 11 * scale, pixel[1] + 4 * scale
    width, height = blf.dimensions(font, text)
    gpu.state.blend_set("ALPHA")
    _plate(left - 3 * scale, bottom - 3 * scale, width + 6 * scale, height + 6 * scale, 0.6 * color[3])
    gpu.state.blend_set("NONE")
    blf.color(font, *color)
    blf.position(font, left, bottom, 0)
    blf.draw(font, text)


def _plate(left, bottom, width, height, alpha):
    """A dark ground that makes text readable over wires."""
    right, top = left + width, bottom + height
    corners = [(left, bottom, 0.0), (right, bottom, 0.0), (right, top, 0.0), (left, top, 0.0)]
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    shader.uniform_float("color", (*DARK, alpha))
    batch_for_shader(shader, "TRIS", {"pos": corners}, indices=[(0, 1, 2), (0, 2, 3)]).draw(shader)


def _toggled(_scene, context):
    redraw(context)


def register():
    global _handle
    bpy.types.Scene.authalic_show_landmarks = BoolProperty(
        name="Show Markers",
        description="Draw the landmarks and landmark curves of selected objects, with their numbers",
        default=True,
        update=_toggled,
    )
    _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")


def unregister():
    global _handle
    bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
    _handle = None
    hints.clear()
    del bpy.types.Scene.authalic_show_landmarks
