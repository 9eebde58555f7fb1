# SPDX-License-Identifier: GPL-3.0-or-later
"""Drivers of shape keys: the rules by which their values follow bones and properties."""

import re
from collections.abc import Collection
from typing import Any

import bpy

from .. import messages
from .types import MeshObject

_OF_KEY = re.compile(r'key_blocks\["((?:[^"\\]|\\.)*)"\]')


def copy(origin: MeshObject, obj: MeshObject, names: Collection[str]) -> str:
    """Copies the drivers of some shape keys to an object's keys of these names, in place of theirs.

    Variables that look at the keys of origin look at the new ones then; all others look where they did.
    Returns a phrase that names the driven keys and what drives them; "" without drivers.
    """
    if not names:
        return ""
    of_origin, keys = origin.data.shape_keys, obj.data.shape_keys
    wanted = [driver for driver in _drivers(of_origin) if _key_of(driver.data_path) in names]
    if not wanted:
        return ""
    animation: Any = keys.animation_data_create()
    for driver in wanted:
        for old in [old for old in animation.drivers if old.data_path == driver.data_path]:
            animation.drivers.remove(old)
        _retarget(animation.drivers.from_existing(src_driver=driver), of_origin, keys)
    driven = dict.fromkeys(_key_of(driver.data_path) for driver in wanted)
    used = dict.fromkeys(target.id.name for driver in wanted for target in _targets(driver) if target.id)
    used.pop(of_origin.name, None)
    by = f", which follow {messages.named(list(used))}" if used else ""
    return f"drivers of {messages.named([str(name) for name in driven])}{by}"


def _drivers(keys: bpy.types.Key) -> list[Any]:
    return list(keys.animation_data.drivers) if keys.animation_data else []


def _key_of(path: str) -> str | None:
    """The name of the shape key in a data path, or None."""
    match = _OF_KEY.match(path)
    return bpy.utils.unescape_identifier(match[1]) if match else None


def _targets(driver: Any) -> list[Any]:
    return [target for variable in driver.driver.variables for target in variable.targets]


def _retarget(driver: Any, origin: bpy.types.Key, keys: bpy.types.Key) -> None:
    for target in _targets(driver):
        name = _key_of(target.data_path)
        if target.id == origin and (name is None or name in keys.key_blocks):
            target.id = keys
