# SPDX-License-Identifier: GPL-3.0-or-later
"""Key frames of shape keys, in Blender's old actions and in those with layers."""

from collections.abc import Collection
from typing import Any

import bpy

from .. import messages
from . import editability, shape_keys
from .types import MeshObject

_OF_POINT = (
    *("co", "interpolation", "easing", "back", "amplitude", "period", "type"),
    *("handle_left_type", "handle_right_type", "handle_left", "handle_right"),
)


def why_not(obj: MeshObject) -> str | None:
    """Why the shape keys of an object cannot be key-framed, or None."""
    keys = obj.data.shape_keys
    action = keys.animation_data.action if keys and keys.animation_data else None
    if action is None or editability.is_writable(action):
        return None
    return f'the action "{action.name}" of its shape keys is linked from another file; make it local first'


def rise(obj: MeshObject, name: str, first: int, last: int) -> None:
    """Key-frames a shape key's value from 0 at one frame to 1 at another, in place of what it had."""
    keys = obj.data.shape_keys
    key = keys.key_blocks[name]
    path = f'key_blocks["{bpy.utils.escape_identifier(name)}"].value'
    _remove(keys, path)
    for frame, value in ((first, 0.0), (last, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    # Inserting leaves the value of the last frame, whatever frame is shown.
    key.value = _curve(keys, path).evaluate(bpy.context.scene.frame_current_final)


def copy(origin: MeshObject, obj: MeshObject, names: Collection[str]) -> tuple[str, list[str]]:
    """Copies the key frames of some shape keys to an object's keys of these names, in place of theirs.

    They come into the action of the object's keys, which is added if need be. Returns a phrase that names the
    animated keys, "" without any, and a line for each curve that is not copied.
    """
    given, keys = origin.data.shape_keys, obj.data.shape_keys
    if not names or _is_shared(given, keys):
        return "", []
    wanted = [curve for curve in _all(given) if shape_keys.in_path(curve.data_path) in names]
    copied, problems = [], []
    if wanted and (reason := why_not(obj)):
        return "", [f"key frames: {reason}"]
    for curve in wanted:
        name = str(shape_keys.in_path(curve.data_path))
        problem = _copied(curve, keys)
        if problem is None:
            copied.append(name)
        else:
            problems.append(f"key frames of shape key {name}: {problem}")
    if given.animation_data and any(track.strips for track in given.animation_data.nla_tracks):
        problems.append(f"NLA strips of the shape keys of {origin.name}")
    return f"key frames of {messages.named(list(dict.fromkeys(copied)))}" if copied else "", problems


def _copied(curve: Any, keys: bpy.types.Key) -> str | None:
    """Copies an F-curve to the same path of other keys; returns why not, or None."""
    if not curve.keyframe_points:
        return "they are baked to samples; bake them to key frames first"
    try:
        keys.path_resolve(curve.data_path)
        _remove(keys, curve.data_path)
        keys.keyframe_insert(curve.data_path, frame=curve.keyframe_points[0].co.x)
    except (RuntimeError, TypeError, ValueError) as problem:
        return str(problem).strip()
    new = _curve(keys, curve.data_path)
    new.keyframe_points.clear()
    new.keyframe_points.add(len(curve.keyframe_points))
    for point, given in zip(new.keyframe_points, curve.keyframe_points, strict=True):
        for attribute in _OF_POINT:
            setattr(point, attribute, getattr(given, attribute))
    new.extrapolation, new.mute = curve.extrapolation, curve.mute
    new.auto_smoothing = curve.auto_smoothing
    for modifier in curve.modifiers:
        _copy_modifier(modifier, new.modifiers.new(modifier.type))
    new.update()
    return None


def _copy_modifier(given: Any, new: Any) -> None:
    for each in given.bl_rna.properties:
        if not each.is_readonly:
            setattr(new, each.identifier, getattr(given, each.identifier))
    for point in given.control_points if given.type == "ENVELOPE" else ():
        added = new.control_points.add(point.frame)
        added.min, added.max = point.min, point.max


def _is_shared(first: bpy.types.Key, second: bpy.types.Key) -> bool:
    """Whether the same F-curves move the keys of two meshes."""
    data: list[Any] = [first.animation_data, second.animation_data]
    if None in data or data[0].action is None or data[0].action != data[1].action:
        return False
    return bool(getattr(data[0], "action_slot", None) == getattr(data[1], "action_slot", None))


def _remove(keys: bpy.types.Key, path: str) -> None:
    for curves in _curves(keys):
        for curve in [curve for curve in curves if curve.data_path == path]:
            curves.remove(curve)


def _curve(keys: bpy.types.Key, path: str) -> Any:
    return next(curve for curve in _all(keys) if curve.data_path == path)


def _all(keys: bpy.types.Key) -> list[Any]:
    """The F-curves that move shape keys."""
    return [curve for curves in _curves(keys) for curve in curves]


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
