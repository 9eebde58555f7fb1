# SPDX-License-Identifier: GPL-3.0-or-later
"""A heat map of UV maps, drawn over the meshes of the 3D view and over the UVs of the UV editor."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import blf
import bpy
import gpu
from gpu_extras.batch import batch_for_shader

from ..surfaces import heat_map
from ..surfaces.heat_map import Colors, Painted, Scale
from .drawing import ACTIVE, is_drawn, nearer_to_eye, plate, redraw

_SPACES = ("VIEW_3D", "IMAGE_EDITOR")
# The legend, in pixels at the scale 1 of the interface.
_BAR, _HEIGHT, _MARGIN, _TEXT = 220.0, 12.0, 24.0, 11.0
_STEPS = 32
_TITLES = {heat_map.AREA: "UV area over its share", heat_map.SHEAR: "Shear"}


class Layer(NamedTuple):
    """The colored triangles of the object of a name, in its own coordinates and in its UV map."""

    object_name: str
    in_space: Painted
    in_plane: Painted


_layers: list[Layer] = []
_scale: Scale | None = None
_colors = Colors()
# The triangles ready to be drawn, in space and in the plane, by the names of their objects.
_batches: dict[str, tuple[Any, Any]] = {}
_handles: list[tuple[Any, Any]] = []


def colors() -> Colors:
    """The colors in use."""
    return _colors


def use(chosen: Colors) -> None:
    """Draws in other colors from now on; what is drawn already stays until it is shown again."""
    global _colors
    _colors = chosen


def show(context: bpy.types.Context, layers: Sequence[Layer], scale: Scale | None) -> None:
    """Draws these layers with the legend of a scale from now on, instead of any before."""
    global _scale
    _layers[:] = layers
    _scale = scale
    _batches.clear()
    redraw_all(context)


def redraw_all(context: bpy.types.Context) -> None:
    """Asks for all 3D views and UV editors to be drawn again."""
    redraw(context, _SPACES)


def shown() -> list[Layer]:
    """The layers that are drawn."""
    return list(_layers)


def legend() -> Scale | None:
    """The scale whose legend is drawn, if one is."""
    manager: Any = bpy.context.window_manager
    return _scale if _layers and manager.authalic_heat_map.legend else None


def _prepared() -> dict[str, tuple[Any, Any]]:
    if not _batches:
        for layer in _layers:
            _batches[layer.object_name] = _batch(layer.in_space), _batch(layer.in_plane)
    return _batches


def _batch(painted: Painted) -> Any:
    shader = gpu.shader.from_builtin("FLAT_COLOR")
    arrays: Any = {"pos": painted.points, "color": painted.colors}
    return batch_for_shader(shader, "TRIS", arrays)


def _draw_in_space() -> None:
    context = bpy.context
    if not _layers or not is_drawn(context):
        return
    shader = gpu.shader.from_builtin("FLAT_COLOR")
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.depth_mask_set(True)
    with gpu.matrix.push_pop():  # type: ignore[attr-defined]
        gpu.matrix.load_matrix(nearer_to_eye(context) @ gpu.matrix.get_model_view_matrix())
        for name, (in_space, _) in _prepared().items():
            obj: Any = context.view_layer.objects.get(name)
            if obj is not None and obj.visible_get(viewport=context.space_data):
                with gpu.matrix.push_pop():  # type: ignore[attr-defined]
                    gpu.matrix.multiply_matrix(obj.matrix_world)
                    in_space.draw(shader)
    gpu.state.depth_mask_set(False)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def _draw_in_plane() -> None:
    context = bpy.context
    space: Any = context.space_data
    if not _layers or not is_drawn(context) or space.mode != "UV":
        return
    view: Any = context.region.view2d
    left, bottom = view.view_to_region(0, 0, clip=False)
    right, top = view.view_to_region(1, 1, clip=False)
    shader = gpu.shader.from_builtin("FLAT_COLOR")
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():  # type: ignore[attr-defined]
        gpu.matrix.translate((left, bottom))
        gpu.matrix.scale((right - left, top - bottom))
        for _, in_plane in _prepared().values():
            in_plane.draw(shader)
    gpu.state.blend_set("NONE")
    _draw_legend()


def _draw_legend() -> None:
    """A bar of the colors in the lower left corner, with the numbers that they stand for."""
    context, scale = bpy.context, legend()
    if scale is None or not is_drawn(context):
        return
    unit: float = context.preferences.system.ui_scale
    left, bottom = _toolbar_width(context) + _MARGIN * unit, _MARGIN * unit
    width, height, text = _BAR * unit, _HEIGHT * unit, _TEXT * unit
    gpu.state.blend_set("ALPHA")
    plate(left - 1.5 * text, bottom - text, width + 3 * text, height + 5 * text, 0.6)
    gpu.state.blend_set("NONE")
    _draw_bar(scale, left, bottom + 1.5 * text, width, height)
    _write(_TITLES[scale.quantity], left, bottom + height + 2.4 * text, text)
    for place, number in scale.ticks():
        _write(number, left + place * width, bottom, text, is_centered=True)


def _draw_bar(scale: Scale, left: float, bottom: float, width: float, height: float) -> None:
    places = heat_map.steps(scale, _STEPS)
    shades = heat_map.ramp(places, colors())
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    points, tints = [], []
    for step, shade in enumerate(shades.tolist()):
        x = left + width * step / (len(places) - 1)
        points += [(x, bottom, 0.0), (x, bottom + height, 0.0)]
        tints += [(*shade, 1.0)] * 2
    batch_for_shader(shader, "TRI_STRIP", {"pos": points, "color": tints}).draw(shader)


def _write(text: str, x: float, y: float, size: float, *, is_centered: bool = False) -> None:
    blf.size(0, size)
    blf.color(0, *ACTIVE, 1.0)
    blf.position(0, x - blf.dimensions(0, text)[0] / 2 * is_centered, y, 0)
    blf.draw(0, text)


def _toolbar_width(context: bpy.types.Context) -> float:
    """The width of the toolbar, where it lies over the view."""
    regions = context.area.regions if context.preferences.system.use_region_overlap else ()
    return max((region.width for region in regions if region.type == "TOOLS" and region.width > 1), default=0)


_CALLBACKS: tuple[tuple[Any, Any, str], ...] = (
    (bpy.types.SpaceView3D, _draw_in_space, "POST_VIEW"),
    (bpy.types.SpaceView3D, _draw_legend, "POST_PIXEL"),
    (bpy.types.SpaceImageEditor, _draw_in_plane, "POST_PIXEL"),
)


def register() -> None:
    for space, callback, event in _CALLBACKS:
        _handles.append((space, space.draw_handler_add(callback, (), "WINDOW", event)))


def unregister() -> None:
    for space, handle in _handles:
        space.draw_handler_remove(handle, "WINDOW")
    _handles.clear()
    _layers.clear()
    _batches.clear()
