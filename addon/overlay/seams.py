# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams that are not marked yet, drawn over the 3D view; the mesh stays as it is."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import bpy
import gpu
from gpu_extras.batch import batch_for_shader

from ..blender import scene_changes, vertex_positions
from ..surfaces.arrays import Integers
from .drawing import BEHIND, DARK, is_drawn, nearer_to_eye, redraw

_WIDTH, _RIM = 3.0, 2.5
_COLOR = (1.0, 0.4, 0.15)


class Lines(NamedTuple):
    """Edges (k, 2), as pairs of vertices, on the object of a name."""

    object_name: str
    edges: Integers


_lines: list[Lines] = []
# The lines ready to be drawn, by the names of their objects; and the `scene_changes` by then.
_batches: dict[str, Any] = {}
_made: int | None = None
_handle: Any = None


def show(context: bpy.types.Context, lines: Sequence[Lines]) -> None:
    """Draws these lines from now on, instead of any before."""
    global _made
    _lines[:] = [line for line in lines if len(line.edges)]
    _made = None
    redraw(context)


def shown() -> list[Lines]:
    """The lines that are drawn."""
    return list(_lines)


def _draw() -> None:
    context = bpy.context
    if not _lines or not is_drawn(context):
        return
    batches = _prepared(context)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_mask_set(False)
    passes: tuple[tuple[Any, float], ...] = (("NONE", BEHIND), ("LESS_EQUAL", 1.0))
    for depth_test, alpha in passes:
        gpu.state.depth_test_set(depth_test)
        with gpu.matrix.push_pop():  # type: ignore[attr-defined]
            gpu.matrix.load_matrix(nearer_to_eye(context) @ gpu.matrix.get_model_view_matrix())
            for name, batch in batches.items():
                _draw_batch(context, name, batch, alpha)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def _prepared(context: bpy.types.Context) -> dict[str, Any]:
    """Batches of the lines in the coordinates of their objects."""
    global _made
    if _made != scene_changes.count():
        _batches.clear()
        _made = scene_changes.count()
        shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
        for line in _lines:
            obj: Any = context.view_layer.objects.get(line.object_name)
            if obj is not None and line.edges.max() < vertex_positions.count(obj):
                graph = context.evaluated_depsgraph_get()
                points = vertex_positions.many(obj, line.edges.ravel().tolist(), graph).tolist()
                _batches[line.object_name] = batch_for_shader(shader, "LINES", {"pos": points})
    return _batches


def _draw_batch(context: bpy.types.Context, name: str, batch: Any, alpha: float) -> None:
    obj: Any = context.view_layer.objects.get(name)
    if obj is None or not obj.visible_get(viewport=context.space_data):
        return
    scale = context.preferences.system.ui_scale
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.uniform_float("viewportSize", (context.region.width, context.region.height))
    with gpu.matrix.push_pop():  # type: ignore[attr-defined]
        gpu.matrix.multiply_matrix(obj.matrix_world)
        for color, width in ((DARK, _WIDTH + _RIM), (_COLOR, _WIDTH)):
            shader.uniform_float("lineWidth", width * scale)
            shader.uniform_float("color", (*color, alpha))
            batch.draw(shader)


def register() -> None:
    global _handle
    _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW")


def unregister() -> None:
    bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
    _lines.clear()
    _batches.clear()
