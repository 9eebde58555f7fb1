# SPDX-License-Identifier: GPL-3.0-or-later
"""Automatic seams behind a living window: panel, preview, Esc and undo; see README.md beside this file."""

import importlib
from collections.abc import Callable
from typing import Any

import bpy
from driver import Until, area, call, check, key, only_panels, picture, sidebar, start, until_done

NAME = "Suzanne"


def scene() -> None:
    call(bpy.ops.mesh.primitive_monkey_add)
    modifier = bpy.context.object.modifiers.new("Subdivision", "SUBSURF")
    call(bpy.ops.object.modifier_apply, modifier=modifier.name)
    call(bpy.ops.object.mode_set, mode="EDIT")
    call(bpy.ops.mesh.mark_seam, clear=True)
    call(bpy.ops.object.mode_set, mode="OBJECT")
    call(bpy.ops.ed.undo_push, message="Suzanne")


def options() -> Any:
    return bpy.context.window_manager.operator_properties_last("authalic.mark_seams")


def shear(value: float) -> Callable[[], None]:
    """A step that moves the slider."""

    def act() -> None:
        options().shear = value
        area().tag_redraw()

    return act


def preview(is_on: bool) -> Callable[[], None]:
    """A step that turns the preview on or off."""

    def act() -> None:
        manager: Any = bpy.context.window_manager
        manager.authalic_seam_preview = is_on

    return act


def figures() -> str:
    manager: Any = bpy.context.window_manager
    return str(manager.authalic_seam_figures)


def still() -> bool:
    """Whether the preview is neither sought nor of other meshes than the present ones."""
    state = importlib.import_module("bl_ext.user_default.authalic.operators.seam_preview")._state
    return state.running is None and state.wanted is not None and state.wanted[0] == state.meshes


def marked() -> int:
    mesh: Any = bpy.data.objects[NAME].data
    return sum(edge.use_seam for edge in mesh.edges)


STEPS = [
    only_panels("Seams"),
    scene,
    *sidebar(),
    lambda: call(bpy.ops.view3d.view_selected),
    check("no seams at first", marked, 0),
    picture("seams_panel"),
    preview(True),
    Until("the preview has figures", lambda: "length of new seams" in figures()),
    check("the preview marks nothing", marked, 0),
    picture("seams_preview"),
    shear(1.8),
    Until("the preview follows the slider", still),
    check("the slider clears the preset", lambda: options().shear_preset, "CUSTOM"),
    picture("seams_preview_few"),
    start("mark_seams"),
    *key("ESC"),
    until_done("Esc ends the search"),
    check("Esc marks nothing", marked, 0),
    start("mark_seams"),
    until_done("the seams are found"),
    check("seams are marked", lambda: marked() > 0, True),
    picture("seams_marked"),
    lambda: call(bpy.ops.object.mode_set, mode="EDIT"),
    lambda: call(bpy.ops.mesh.select_all, action="SELECT"),
    Until("the preview works in edit mode", lambda: "length of new seams" in figures()),
    Until("and comes to rest", still),
    lambda: call(bpy.ops.object.mode_set, mode="OBJECT"),
    preview(False),
    lambda: call(bpy.ops.ed.undo),
    check("undo takes the seams away", marked, 0),
    Until("and the preview", lambda: figures() == ""),
    start("unwrap", seams="AUTOMATIC"),
    until_done("the unwrap ends"),
    check("the unwrap marks its seams", lambda: marked() > 0, True),
    lambda: call(bpy.ops.object.mode_set, mode="EDIT"),
    lambda: call(bpy.ops.mesh.select_all, action="DESELECT"),
    picture("seams_unwrapped"),
]
