# SPDX-License-Identifier: GPL-3.0-or-later
"""Key frames of a shape key's value, in Blender's old actions and in those with layers."""

from typing import Any

import bpy

from .types import MeshObject


def rise(obj: MeshObject, name: str, first: int, last: int) -> None:
    """Key-frames a shape key's value from 0 at one frame to 1 at another, in place of what it had."""
    keys = obj.data.shape_keys
    key = keys.key_blocks[name]
    path = f'key_blocks["{bpy.utils.escape_identifier(name)}"].value'
    for curves in _curves(keys):
        for curve in [curve for curve in curves if curve.data_path == path]:
            curves.remove(curve)
    for frame, value in ((first, 0.0), (last, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    # Inserting leaves the value of the last frame, whatever frame is shown.
    shown = bpy.context.scene.frame_current_final
    curve = next(curve for curves in _curves(keys) for curve in curves if curve.data_path == path)
    key.value = curve.evaluate(shown)


def _curves(keys: bpy.types.Key) -> list[Any]:
    """The collections of F-curves that move shape keys."""
    data: Any = keys.animation_data  # whose actions have had layers since 4.4
    if data is None or data.action is None:
        return []
    if not hasattr(data, "action_slot"):  # before 4.4
        return [data.action.fcurves]
    strips = [strip for layer in data.action.layers for strip in layer.strips]
    bags = [strip.channelbag(data.action_slot) for strip in strips] if data.action_slot else []
    return [bag.fcurves for bag in bags if bag is not None]
