# SPDX-License-Identifier: GPL-3.0-or-later
"""The heat map, which is drawn over meshes and UVs and follows them.

A timer compares what should be shown with what is shown. So it needs no calls from what may change: UVs,
meshes, the selection, options, undo.
"""

import time
from dataclasses import dataclass
from typing import Any

import bpy
from bpy.app.handlers import persistent
from bpy.props import BoolProperty, EnumProperty, FloatProperty, PointerProperty

from ..blender import scene_changes, uv_maps
from ..blender.types import MeshObject, Status
from ..jobs import densities
from ..jobs import heat_map as mapping
from ..jobs.job import Job
from ..overlay import heat_map as overlay
from ..surfaces import heat_map
from . import density, poll
from .measure import Figures, figures_of
from .timer import Timer

_INTERVAL = 0.1
# Reading meshes may take this part of the time at most, so that large ones can be edited meanwhile.
_SHARE = 0.2

Meshes = tuple[object, ...]
"""The objects with their UV maps and scales, a number for the state of all meshes, and the density."""
Look = tuple[heat_map.Scale, float, heat_map.Colors]
"""The scale of the colors, their opacity, and the colors."""


@dataclass
class _State:
    """What is shown, or in the making: the meshes, the look, and the job of either while it runs.

    The next reading of meshes may begin at `pause_until`.
    """

    meshes: Meshes | None = None
    look: Look | None = None
    map: mapping.HeatMap | None = None
    measuring: Job[Any, mapping.HeatMap] | None = None
    painting: Job[Any, list[overlay.Layer]] | None = None
    pause_until: float = 0.0


_state = _State()


def tick(context: bpy.types.Context) -> bool:
    """Takes the heat map one step further; whether there is to be another tick."""
    settings = _settings(context)
    if not settings.show:
        _clear(context)
        return False
    meshes, look = _meshes(context), _look(settings)
    if _state.measuring is not None:
        _collect(_state.measuring)
    elif meshes != _state.meshes and time.perf_counter() >= _state.pause_until:
        _start(context, meshes)
    if _state.painting is not None:
        _show(context, _state.painting)
    elif _state.map is not None and look != _state.look:
        _paint(_state.map, look)
    return True


def is_settled(context: bpy.types.Context) -> bool:
    """Whether the heat map shows the meshes and options as they are."""
    is_at_work = _state.measuring is not None or _state.painting is not None
    is_shown = (_meshes(context), _look(_settings(context))) == (_state.meshes, _state.look)
    return is_shown and not is_at_work


def current(context: bpy.types.Context) -> Figures | None:
    """The figures of the heat map; None where none is shown, or they do not apply any more."""
    is_current = _settings(context).show and _state.meshes == _meshes(context)
    report = _state.map.report if is_current and _state.map is not None else None
    return figures_of(report) if report is not None else None


def _settings(context: bpy.types.Context) -> Any:
    manager: Any = context.window_manager
    return manager.authalic_heat_map


def _meshes(context: bpy.types.Context) -> Meshes:
    objects = [(obj.name, uv_maps.active(obj), _scale(obj)) for obj in mapping.objects(context)]
    return context.mode, tuple(objects), scene_changes.count(), _settings(context).density_source


def _scale(obj: MeshObject) -> tuple[float, ...]:
    scale: Any = obj.matrix_world.to_scale()
    return tuple(round(factor, 4) for factor in scale)


def _look(settings: Any) -> Look:
    is_area = settings.quantity == heat_map.AREA
    end = settings.area_end if is_area else settings.shear_end
    return heat_map.Scale(settings.quantity, round(end, 4)), round(settings.opacity, 4), overlay.colors()


def _start(context: bpy.types.Context, meshes: Meshes) -> None:
    began = time.perf_counter()
    _state.meshes = meshes
    try:
        _state.measuring = mapping.job(context, _settings(context).density_source).start()
    except densities.NoDensity:  # it was removed or renamed
        _state.measuring = mapping.job(context).start()
    now = time.perf_counter()
    _state.pause_until = now + (now - began) * (1 / _SHARE - 1)


def _collect(measuring: Job[Any, mapping.HeatMap]) -> None:
    if not measuring.poll()[0]:
        _state.measuring, _state.look = None, None
        _state.map = measuring.apply()


def _paint(map_: mapping.HeatMap, look: Look) -> None:
    scale, alpha, colors = look

    def work(_progress: Any) -> list[overlay.Layer]:
        return [
            overlay.Layer(
                layer.object_name,
                layer.in_space.painted(scale, colors, alpha),
                layer.in_plane.painted(scale, colors, alpha),
            )
            for layer in map_.layers
        ]

    _state.look = look
    _state.painting = Job(work).start()


def _show(context: bpy.types.Context, painting: Job[Any, list[overlay.Layer]]) -> None:
    if not painting.poll()[0]:
        _state.painting = None
        overlay.show(context, painting.apply(), _state.look[0] if _state.look else None)


def _clear(context: bpy.types.Context) -> None:
    global _state
    for running in (_state.measuring, _state.painting):
        if running is not None:
            running.cancel()
    _state = _State()
    overlay.show(context, [], None)


_timer = Timer(tick, _INTERVAL)


def _toggled(_settings_: Any, _context: bpy.types.Context) -> None:
    _timer.start()


@persistent  # type: ignore[untyped-decorator]
def _loaded(*_: object) -> None:
    """A startup file may have been saved with the heat map on."""
    settings = _settings(bpy.context)
    if settings.show:
        _toggled(settings, bpy.context)


def _redraw(_settings_: Any, context: bpy.types.Context) -> None:
    overlay.redraw_all(context)


class AUTHALIC_PG_heat_map(bpy.types.PropertyGroup):
    """The options of the heat map."""

    show: BoolProperty(
        name="Heat Map",
        description="Color the faces of selected meshes by how their UV map treats them, in the 3D view and "
        "in the UV editor. Flipped faces have stripes",
        update=_toggled,
        options={"SKIP_SAVE"},
    )
    quantity: EnumProperty(
        name="Heat Map of",
        description="What the colors stand for",
        items=(
            (
                heat_map.AREA,
                "Area",
                "The UV area of faces over their share: blue is too small, red too large",
            ),
            (
                heat_map.SHEAR,
                "Shear",
                "The long over the short axis of what the UV map makes of a circle: 1 keeps angles",
            ),
        ),
        default=heat_map.AREA,
    )
    area_end: FloatProperty(
        name="Range",
        description="The factor above or below its share at which a face has the full color",
        min=1.01,
        soft_max=16.0,
        max=1e4,
        default=2.0,
    )
    shear_end: FloatProperty(
        name="Range",
        description="The shear at which a face has the full color",
        min=1.01,
        soft_max=10.0,
        max=1e4,
        default=3.0,
    )
    opacity: FloatProperty(
        name="Opacity",
        description="Opacity of the heat map",
        subtype="FACTOR",
        min=0.0,
        max=1.0,
        default=0.85,
    )
    density_source: density.property_of_sources()
    legend: BoolProperty(
        name="Legend",
        description="Draw what the colors stand for into the corner of the views",
        default=True,
        update=_redraw,
    )


class AUTHALIC_OT_show_heat_map(bpy.types.Operator):
    """Show or hide the heat map of UV areas or shear"""

    bl_idname = "authalic.show_heat_map"
    bl_label = "Show Heat Map"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender reads a plain set)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _settings(context).show or poll.has_uv_maps(cls, context)

    def execute(self, context: bpy.types.Context) -> Status:
        settings = _settings(context)
        settings.show = not settings.show
        return {"FINISHED"}


_CLASSES = (AUTHALIC_PG_heat_map, AUTHALIC_OT_show_heat_map)
_PROPERTIES: Any = bpy.types.WindowManager


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    _PROPERTIES.authalic_heat_map = PointerProperty(type=AUTHALIC_PG_heat_map)
    bpy.app.handlers.load_post.append(_loaded)


def unregister() -> None:
    global _state
    bpy.app.handlers.load_post.remove(_loaded)
    _timer.stop()
    for running in (_state.measuring, _state.painting):
        if running is not None:
            running.cancel()
    _state = _State()
    del _PROPERTIES.authalic_heat_map
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
