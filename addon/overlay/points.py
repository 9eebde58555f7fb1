# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbered markers on the landmarks of the source and of its target, drawn over the 3D view."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import bpy
import gpu
from bpy.props import BoolProperty
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Vector

from ..blender import element_marks, vertex_positions
from ..blender.types import MeshObject
from ..landmarks import points as landmark_points
from ..landmarks.objects import NONE, active_source
from .drawing import ACTIVE, BEHIND, DARK, PROBLEM, disk, faces_eye, is_drawn, label, redraw, sources

_COLORS = {"source": (0.16, 0.55, 1.0), "target": (1.0, 0.58, 0.1)}
_RADIUS = 5.0
_handle: Any = None


class Marker(NamedTuple):
    """A vertex of the object of a name, what is written beside it, and how it is drawn."""

    object_name: str
    vertex: int
    text: str
    side: str
    is_active: bool = False
    has_problem: bool = False


# Markers that picking shows for vertices that are no landmarks yet.
hints: list[Marker] = []
# Where markers are drawn that are being dragged: (name of a source, number in its list, side) -> vertex.
dragged: dict[tuple[str, int, str], int] = {}


def shown(context: bpy.types.Context) -> list[Marker]:
    """The markers of the selected sources, of those whose target is selected, and the hints of picking."""
    scene: Any = context.scene
    if not scene.authalic_show_landmarks:
        return list(hints)
    listed = [source for source in sources(context) if source.authalic_landmarks]
    return [marker for source in listed for marker in _of(source, context)] + hints


def _of(source: MeshObject, context: bpy.types.Context) -> Iterator[Marker]:
    active, is_meant = source.authalic_landmark_index, source == active_source(context)
    for index, pair in enumerate(landmark_points.pairs(source, drawing=True)):
        looks = (is_meant and index == active, pair.problem is not None)
        for side, vertex in (("source", pair.source_vertex), ("target", pair.target_vertex)):
            if vertex != NONE:
                name = source.name if side == "source" else source.authalic_target.name
                shown_at = dragged.get((source.name, index, side), vertex)
                yield Marker(name, shown_at, str(index + 1), side, *looks)


def _draw() -> None:
    context = bpy.context
    if not is_drawn(context):
        return
    scale = context.preferences.system.ui_scale
    held = [element_marks.hold(obj.data) for obj in sources(context)]
    placed = [place for marker in shown(context) if (place := _place(marker, context))]
    del held
    placed.sort(key=lambda place: (place[2], place[0].is_active))  # those in front over the others
    gpu.state.blend_set("ALPHA")
    for marker, pixel, is_front in placed:
        _draw_disk(marker, pixel, scale, 1.0 if is_front else BEHIND)
    gpu.state.blend_set("NONE")
    for marker, pixel, is_front in placed:
        _draw_text(marker, pixel, scale, 1.0 if is_front else BEHIND)


def _place(marker: Marker, context: bpy.types.Context) -> tuple[Marker, Vector, bool] | None:
    """(marker, its pixel, whether its surface faces the eye), or None where it cannot be seen."""
    obj: Any = context.view_layer.objects.get(marker.object_name)
    if obj is None or not obj.visible_get(viewport=context.space_data):
        return None
    point, normal = vertex_positions.in_world(obj, marker.vertex, context.evaluated_depsgraph_get())
    pixel = location_3d_to_region_2d(context.region, context.region_data, point)
    return (marker, pixel, faces_eye(context, point, normal)) if pixel else None


def _draw_disk(marker: Marker, pixel: Vector, scale: float, alpha: float) -> None:
    color = PROBLEM if marker.has_problem else _COLORS[marker.side]
    radius = _RADIUS * scale * (1.3 if marker.is_active else 1.0)
    disk(pixel, radius + 1.5 * scale, (*(ACTIVE if marker.is_active else DARK), alpha))
    disk(pixel, radius, (*color, alpha))


def _draw_text(marker: Marker, pixel: Vector, scale: float, alpha: float) -> None:
    color = PROBLEM if marker.has_problem else ACTIVE
    label(marker.text, pixel, scale * (14 if marker.is_active else 12), (*color, alpha))


def _toggled(_scene: bpy.types.Scene, context: bpy.types.Context) -> None:
    redraw(context)


_PROPERTIES: Any = bpy.types.Scene


def register() -> None:
    global _handle
    _PROPERTIES.authalic_show_landmarks = BoolProperty(
        name="Show Markers",
        description="Draw the landmarks and landmark curves of selected objects, with their numbers",
        default=True,
        update=_toggled,
    )
    _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")


def unregister() -> None:
    global _handle
    bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
    _handle = None
    hints.clear()
    dragged.clear()
    del _PROPERTIES.authalic_show_landmarks
