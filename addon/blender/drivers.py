# SPDX-License-Identifier: GPL-3.0-or-later
"""Drivers of shape keys: the rules by which their values follow bones and properties."""

from collections.abc import Collection
from typing import Any

import bpy

from .. import messages
from . import shape_keys
from .types import MeshObject


def copy(origin: MeshObject, obj: MeshObject, names: Collection[str]) -> tuple[str, list[str]]:
    """Copies the drivers of some shape keys to an object's keys of these names, in place of theirs.

    Variables that look at origin, its mesh or its keys look at those of the object then, if it has what they
    look at; all others look where they did. Returns a phrase that names the driven keys and what drives them,
    "" without drivers, and a line for each driver that is not copied or that follows nothing.
    """
    of_origin, keys = origin.data.shape_keys, obj.data.shape_keys
    wanted = [driver for driver in _drivers(of_origin) if shape_keys.in_path(driver.data_path) in names]
    if not wanted:
        return "", []
    animation: Any = keys.animation_data_create()
    copied, problems = [], []
    for driver in wanted:
        for old in [old for old in animation.drivers if old.data_path == driver.data_path]:
            animation.drivers.remove(old)
        try:
            copied.append(animation.drivers.from_existing(src_driver=driver))
        except (RuntimeError, TypeError) as problem:
            problems.append(_line(driver, str(problem)))
    for driver in copied:
        _retarget(driver, origin, obj)
        if any(target.id is None for target in _targets(driver)):
            problems.append(_line(driver, "a variable has no target"))
    return _phrase(copied, {obj, obj.data, keys}), problems


def _line(driver: Any, problem: str) -> str:
    return f"driver of shape key {shape_keys.in_path(driver.data_path)}: {problem}"


def _phrase(drivers: list[Any], own: Collection[bpy.types.ID]) -> str:
    """The driven keys and what drives them besides the `own` data of their object."""
    if not drivers:
        return ""
    driven = dict.fromkeys(str(shape_keys.in_path(driver.data_path)) for driver in drivers)
    used = {target.id for driver in drivers for target in _targets(driver)} - {None, *own}
    by = f", which follow {messages.named(sorted(each.name for each in used))}" if used else ""
    return f"drivers of {messages.named(list(driven))}{by}"


def _drivers(keys: bpy.types.Key | None) -> list[Any]:
    return list(keys.animation_data.drivers) if keys and keys.animation_data else []


def _targets(driver: Any) -> list[Any]:
    """The targets of all variables; those of properties of the scene have no data block of their own."""
    variables = [variable for variable in driver.driver.variables if variable.type != "CONTEXT_PROP"]
    return [target for variable in variables for target in variable.targets]


def _retarget(driver: Any, origin: MeshObject, obj: MeshObject) -> None:
    """Lets a driver look at an object where it looked at origin, if the object has what it looks at."""
    pairs = {
        origin: obj,
        origin.data: obj.data,
        origin.data.shape_keys: obj.data.shape_keys,
    }
    for variable in driver.driver.variables:
        for target in variable.targets if variable.type != "CONTEXT_PROP" else ():
            own = pairs.get(target.id)
            if own is not None and (variable.type != "SINGLE_PROP" or _has(own, target.data_path)):
                target.id = own


def _has(data: bpy.types.ID, path: str) -> bool:
    """Whether a data block has a property."""
    try:
        data.path_resolve(path)
    except ValueError:
        return False
    return True
