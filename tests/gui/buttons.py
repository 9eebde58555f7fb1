# SPDX-License-Identifier: GPL-3.0-or-later
"""The button, Esc, Enter, and a second job while one runs; see README.md beside this file."""

import bpy
import numpy as np
from driver import (
    Pulse,
    Until,
    area,
    call,
    check,
    click_button,
    key,
    only_panels,
    picture,
    running,
    say,
    settled,
    sidebar,
    start,
    until_done,
    window,
)

RESPONSE = 1.5
"""The most seconds in which the window may do nothing, on a slow machine that draws by software."""
LONG = {"method": "GRADIENT_DESCENT", "iterations": 100000}

pulse = Pulse()


def scene() -> None:
    call(bpy.ops.mesh.primitive_monkey_add)
    obj = bpy.context.object
    obj.data.uv_layers.active.name = "Old"
    call(bpy.ops.object.mode_set, mode="EDIT")
    call(bpy.ops.mesh.select_all, action="SELECT")
    call(bpy.ops.uv.select_all, action="SELECT")
    call(bpy.ops.uv.seams_from_islands)
    call(bpy.ops.object.mode_set, mode="OBJECT")
    modifier = obj.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = 2
    call(bpy.ops.object.modifier_apply, modifier=modifier.name)
    call(bpy.ops.view3d.view_selected)


def layers() -> list[str]:
    return [layer.name for layer in bpy.data.objects["Suzanne"].data.uv_layers]


def spread(layer: str) -> float:
    """The smaller side of the box about the UVs of a layer."""
    uv = np.array([item.vector for item in bpy.data.objects["Suzanne"].data.uv_layers[layer].uv])
    return float(np.ptp(uv, axis=0).min())


def is_refused() -> bool:
    """Whether a script that starts a second job is told why it may not."""
    try:
        call(bpy.ops.authalic.unwrap, "EXEC_DEFAULT", uv_layer="Second")
    except RuntimeError as problem:
        return "Authalic Unwrap is still running" in str(problem)
    return False


def steady() -> bool:
    say("longest time without an answer", round(pulse.longest, 2))
    return pulse.longest < RESPONSE


def look_around() -> None:
    """Turns the view with the middle button, which a running job allows."""
    for place in ((500, 400), (560, 420)):
        window().event_simulate("MOUSEMOVE", "NOTHING", x=place[0], y=place[1])


STEPS = [
    only_panels("Authalic Unwrap"),
    scene,
    *sidebar(),
    *click_button("authalic.unwrap"),
    Until("the button starts the unwrap", lambda: running() == ["AUTHALIC_OT_unwrap"]),
    until_done("the unwrap ends by itself"),
    settled,
    picture("unwrapped"),
    check("it has written UVs", lambda: spread("Old") > 0.5, True),
    start("unwrap", uv_layer="New", **LONG),
    pulse.start,
    *[settled] * 6,
    look_around,
    picture("status_bar"),
    check("a second job is refused", is_refused, True),
    *key("ESC"),
    until_done("Esc ends the unwrap", 3),
    check("the window stayed alive", steady, True),
    pulse.stop,
    settled,
    picture("cancelled"),
    check("Esc changes nothing", layers, ["Old"]),
    start("unwrap", uv_layer="New", **LONG),
    *[settled] * 6,
    *key("RET"),
    until_done("Enter ends the unwrap"),
    settled,
    picture("finished_early"),
    check("Enter keeps the best so far", lambda: spread("New") > 0.5, True),
    lambda: call(bpy.ops.ed.undo),
    check("undo takes it back", layers, ["Old"]),
    check("the editor is still there", lambda: area().type, "VIEW_3D"),
]
