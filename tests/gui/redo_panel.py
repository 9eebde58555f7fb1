# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of the redo panel are dragged; the window never freezes; see README.md beside this file."""

from collections.abc import Callable, Iterator
from typing import Any

import bpy
import numpy as np
from driver import (
    Place,
    Pulse,
    Until,
    check,
    click,
    click_button,
    only_panels,
    picture,
    region,
    running,
    say,
    send,
    settled,
    sidebar,
    suzanne_with_seams,
    until_done,
    uvs_of_suzanne,
    window,
)

RESPONSE = 1.5
"""The most seconds in which the window may do nothing, on a slow machine that draws by software."""
MARGIN, WEIGHT = "0.0123", "0.4321"
"""Values by which the fields are found in the panel."""

pulse = Pulse()
seen: dict[str, Any] = {}
fields: dict[str, Place] = {}


def values() -> None:
    properties = bpy.context.window_manager.operator_properties_last("authalic.unwrap")
    properties.margin, properties.angle_weight = float(MARGIN), float(WEIGHT)


def head() -> Place:
    """The head of the redo panel."""
    panel = region("HUD")
    return panel.x + 30, panel.y + panel.height - 12


def find(value: str) -> Callable[[], Iterator[None]]:
    """A step that finds the field with a value: Ctrl+C copies that of the field below the mouse."""

    def seek() -> Iterator[None]:
        panel = region("HUD")
        for height in range(panel.height - 30, 0, -11):
            place = panel.x + int(0.7 * panel.width), panel.y + height
            bpy.context.window_manager.clipboard = ""
            send("MOUSEMOVE", "NOTHING", place)
            yield
            send("C", "PRESS", place, ctrl=True)
            send("C", "RELEASE", place, ctrl=True)
            yield
            if bpy.context.window_manager.clipboard.startswith(value):
                fields[value] = place
                return
        raise AssertionError(f"no field has the value {value}")

    return seek


def drag(value: str, pixels: int) -> Callable[[], Iterator[None]]:
    """A step that drags the field that had a value to the right, in ten steps."""

    def act() -> Iterator[None]:
        x, y = fields[value]
        send("MOUSEMOVE", "NOTHING", (x, y))
        yield
        send("LEFTMOUSE", "PRESS", (x, y))
        yield
        for part in range(1, 11):
            send("MOUSEMOVE", "NOTHING", (x + pixels * part / 10, y), shift=True)
            yield
        send("LEFTMOUSE", "RELEASE", (x + pixels, y))
        yield

    return act


def remember(name: str) -> Callable[[], None]:
    def act() -> None:
        seen[name] = uvs_of_suzanne()

    return act


def last() -> Any:
    return bpy.context.window_manager.operators[-1]


def steady() -> bool:
    say("longest time without an answer", round(pulse.longest, 2))
    return pulse.longest < RESPONSE


STEPS = [
    only_panels("Authalic Unwrap"),
    suzanne_with_seams,
    values,
    *sidebar(),
    *click_button("authalic.unwrap"),
    Until("the button starts the unwrap", lambda: running() == ["AUTHALIC_OT_unwrap"]),
    until_done("the unwrap ends"),
    settled,
    remember("first"),
    *click(head),
    *[settled] * 4,
    picture("redo_panel"),
    find(MARGIN),
    find(WEIGHT),
    pulse.start,
    drag(MARGIN, 60),
    settled,
    check("the drag changes the margin", lambda: last().margin > float(MARGIN), True),
    Until("the UVs follow", lambda: not np.array_equal(uvs_of_suzanne(), seen["first"])),
    until_done("nothing runs any more"),
    check("the window stays alive while the margin changes", steady, True),
    picture("redo_margin"),
    remember("margin"),
    pulse.start,
    drag(WEIGHT, 40),
    settled,
    check("the drag changes the weight", lambda: last().angle_weight > float(WEIGHT), True),
    Until("the UVs follow the weight", lambda: not np.array_equal(uvs_of_suzanne(), seen["margin"])),
    until_done("nothing runs any more"),
    check("the window stays alive while the weight changes", steady, True),
    pulse.stop,
    picture("redo_weight"),
    lambda: window(),
]
