# SPDX-License-Identifier: GPL-3.0-or-later
"""Automatic seams behind a living window: panel, preview, Esc and undo; see README.md beside this file."""

import importlib
from collections.abc import Callable
from typing import Any

import bpy
from driver import call, check, key, picture, run, view

NAME = "Suzanne"


def scene() -> None:
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    call(bpy.ops.mesh.primitive_monkey_add)
    modifier = bpy.context.object.modifiers.new("Subdivision", "SUBSURF")
    call(bpy.ops.object.modifier_apply, modifier=modifier.name)
    call(bpy.ops.object.mode_set, mode="EDIT")
    call(bpy.ops.mesh.mark_seam, clear=True)
    call(bpy.ops.object.mode_set, mode="OBJECT")
    call(bpy.ops.ed.undo_push, message="Suzanne")
    view()["area"].spaces.active.show_region_ui = True


def tab() -> None:
    region = next(region for region in view()["area"].regions if region.type == "UI")
    region.active_panel_category = "Authalic"
    view()["area"].tag_redraw()


def scroll() -> None:
    """Brings the panel of seams into view."""
    area = view()["area"]
    region = next(region for region in area.regions if region.type == "UI")
    with bpy.context.temp_override(window=view()["window"], area=area, region=region):
        bpy.ops.view2d.scroll_down(page=True)


def options() -> Any:
    return bpy.context.window_manager.operator_properties_last("authalic.mark_seams")


def shear(value: float) -> Callable[[], None]:
    """A step that moves the slider."""

    def act() -> None:
        options().shear = value
        view()["area"].tag_redraw()

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


def start(name: str, **settings: Any) -> Callable[[], None]:
    """A step that starts an operator as its button does."""

    def act() -> None:
        operator = getattr(bpy.ops.authalic, name)
        assert call(operator, "INVOKE_DEFAULT", **settings) == {"RUNNING_MODAL"}

    return act


def running() -> list[str]:
    return [operator.bl_idname for operator in view()["window"].modal_operators]


def marked() -> int:
    mesh: Any = bpy.data.objects[NAME].data
    return sum(edge.use_seam for edge in mesh.edges)


def until_done() -> list[Callable[[], None]]:
    return [lambda: None] * 40


STEPS = [
    scene,
    tab,
    scroll,
    lambda: call(bpy.ops.view3d.view_selected),
    check("no seams at first", marked, 0),
    picture("seams_panel"),
    preview(True),
    *[lambda: None] * 15,
    check("the preview has figures", lambda: "length of new seams" in figures(), True),
    check("the preview marks nothing", marked, 0),
    picture("seams_preview"),
    shear(1.8),
    *[lambda: None] * 8,
    check("the slider clears the preset", lambda: options().shear_preset, "CUSTOM"),
    picture("seams_preview_few"),
    start("mark_seams"),
    *key("ESC"),
    *[lambda: None] * 8,
    check("Esc ends the search", running, []),
    check("Esc marks nothing", marked, 0),
    start("mark_seams"),
    *until_done(),
    check("no operator runs on", running, []),
    check("seams are marked", lambda: marked() > 0, True),
    picture("seams_marked"),
    lambda: call(bpy.ops.object.mode_set, mode="EDIT"),
    lambda: call(bpy.ops.mesh.select_all, action="SELECT"),
    *[lambda: None] * 15,
    check("the preview works in edit mode", lambda: "length of new seams" in figures(), True),
    check("and comes to rest", still, True),
    lambda: call(bpy.ops.object.mode_set, mode="OBJECT"),
    preview(False),
    lambda: call(bpy.ops.ed.undo),
    check("undo takes the seams away", marked, 0),
    check("and the preview", figures, ""),
    start("unwrap", seams="AUTOMATIC"),
    *until_done(),
    check("no operator runs on", running, []),
    check("the unwrap marks its seams", lambda: marked() > 0, True),
    lambda: call(bpy.ops.object.mode_set, mode="EDIT"),
    lambda: call(bpy.ops.mesh.select_all, action="DESELECT"),
    picture("seams_unwrapped"),
]

run(STEPS)
