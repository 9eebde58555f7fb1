# SPDX-License-Identifier: GPL-3.0-or-later
"""The heat map over the 3D view and the UV editor, and its panel; see README.md beside this file."""

import importlib
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
from driver import (
    MODULE,
    Until,
    area,
    blue,
    call,
    check,
    only_panels,
    picture,
    settled,
    sidebar,
    uvs_in_view,
)

NAME = "Camel"


FEW, MANY = 0.04, 0.08
"""Shares of blue pixels, without and with a heat map."""


def scene() -> None:
    call(bpy.ops.mesh.primitive_monkey_add)
    obj = bpy.context.object
    obj.name = NAME
    modifier = obj.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = 2
    call(bpy.ops.object.modifier_apply, modifier=modifier.name)
    call(bpy.ops.view3d.view_selected)


def part(name: str) -> Any:
    return importlib.import_module(f"{MODULE}.{name}")


def choose(**values: object) -> Callable[[], None]:
    """A step that sets options of the heat map in the panel."""

    def act() -> None:
        settings: Any = bpy.context.window_manager
        for name, value in values.items():
            setattr(settings.authalic_heat_map, name, value)

    return act


def up_to_date() -> Until:
    return Until("the heat map is up to date", lambda: part("operators.heat_map").is_settled(bpy.context))


def tangle() -> None:
    """Moves the UVs of some vertices across their neighbors."""
    mesh = bpy.data.objects[NAME].data
    vertices = np.array([loop.vertex_index for loop in mesh.loops])
    uv = np.empty((len(vertices), 2), np.float32)
    mesh.uv_layers.active.uv.foreach_get("vector", uv.ravel())
    foremost = np.argsort([vertex.co.y for vertex in mesh.vertices])[:6]
    uv[np.isin(vertices, foremost)] += 0.08
    mesh.attributes[mesh.uv_layers.active.name].data.foreach_set("vector", uv.ravel())
    mesh.update()


def flipped() -> bool:
    return "none flipped" not in part("operators.heat_map").current(bpy.context).sentence


def measure() -> None:
    call(bpy.ops.authalic.measure)


def measured() -> bool:
    """Whether the panel still has the figures of the last measurement."""
    return part("operators.measure").current(bpy.context) is not None


def edit() -> None:
    call(bpy.ops.object.mode_set, mode="EDIT")
    call(bpy.ops.mesh.select_all, action="SELECT")


def uv_editor() -> None:
    area().ui_type = "UV"


STEPS = [
    only_panels("Distortion", "Texel Density", "Advanced"),
    scene,
    *sidebar(),
    measure,
    *[settled] * 3,
    check("figures stay while nothing changes", measured, True),
    check("hardly anything is blue", lambda: blue() < FEW, True),
    choose(show=True),
    up_to_date(),
    settled,
    check("the heat map is seen", lambda: blue() > MANY, True),
    check("nothing is flipped", flipped, False),
    settled,
    picture("heat_map_of_areas"),
    choose(quantity="SHEAR"),
    up_to_date(),
    settled,
    picture("heat_map_of_shear"),
    choose(quantity="AREA"),
    tangle,
    settled,
    check("figures go when UVs change", measured, False),
    up_to_date(),
    check("the heat map has found the flips", flipped, True),
    settled,
    picture("heat_map_of_flips"),
    edit,
    measure,
    *[settled] * 3,
    check("figures stay in edit mode", measured, True),
    up_to_date(),
    settled,
    picture("heat_map_in_edit_mode"),
    uv_editor,
    *sidebar("UV"),
    uvs_in_view,
    up_to_date(),
    settled,
    picture("heat_map_of_uvs"),
    check("it is seen in the UV editor", lambda: blue("UV") > MANY, True),
    choose(show=False),
    settled,
    check("and no longer when it is off", lambda: blue("UV") < FEW, True),
]
