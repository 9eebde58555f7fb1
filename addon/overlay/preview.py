# SPDX-License-Identifier: GPL-3.0-or-later
"""The source as it lies on its target by now, drawn as a wire over the 3D view while it is registered."""

from typing import Any, NamedTuple

import bpy
import gpu
import numpy as np

from ..surfaces.arrays import Floats, Integers
from .drawing import is_drawn, nearer_to_eye, redraw

_COLOR = (0.35, 0.75, 1.0)
_BEHIND, _IN_FRONT = 0.08, 0.7


class Preview(NamedTuple):
    """Points (u, 3) in the world of the object of a name, and lines (k, 2) between them."""

    object_name: str
    points: Floats
    edges: Integers


_shown: Preview | None = None
# The lines ready to be drawn, and the edges that their indices were made of.
_batch: Any = None
_indices: tuple[Integers, Any] | None = None
_handle: Any = None


def show(context: bpy.types.Context, preview: Preview | None) -> None:
    """Draws a preview from now on, instead of any before; None draws nothing."""
    global _shown, _batch, _indices
    _shown, _batch = preview, None
    if preview is None:
        _indices = None
    redraw(context)


def shown() -> Preview | None:
    """What is drawn."""
    return _shown


def _draw() -> None:
    context = bpy.context
    if _shown is None or not is_drawn(context):
        return
    batch = _prepared(_shown)
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_mask_set(False)
    passes: tuple[tuple[Any, float], ...] = (("NONE", _BEHIND), ("LESS_EQUAL", _IN_FRONT))
    with gpu.matrix.push_pop():  # type: ignore[attr-defined]
        gpu.matrix.load_matrix(nearer_to_eye(context) @ gpu.matrix.get_model_view_matrix())
        for depth_test, alpha in passes:
            gpu.state.depth_test_set(depth_test)
            shader.uniform_float("color", (*_COLOR, alpha))
            batch.draw(shader)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def _prepared(preview: Preview) -> Any:
    """The batch of the lines; the indices are made once for each registration."""
    global _batch, _indices
    if _batch is None:
        shader = gpu.shader.from_builtin("UNIFORM_COLOR")
        points: Any = np.ascontiguousarray(preview.points, np.float32)
        buffer = gpu.types.GPUVertBuf(shader.format_calc(), len(points))
        buffer.attr_fill("pos", points)
        if _indices is None or _indices[0] is not preview.edges:
            lines: Any = np.ascontiguousarray(preview.edges, np.int32)
            _indices = preview.edges, gpu.types.GPUIndexBuf(type="LINES", seq=lines)
        _batch = gpu.types.GPUBatch(type="LINES", buf=buffer, elem=_indices[1])
    return _batch


def register() -> None:
    global _handle
    _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW")


def unregister() -> None:
    global _handle, _shown, _batch, _indices
    bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
    _handle = _shown = _batch = _indices = None
