# SPDX-License-Identifier: GPL-3.0-or-later
"""The UVs follow an option while it is dragged; the window never freezes; see README.md beside this file."""

from collections.abc import Iterator
from typing import Any

import bpy
import numpy as np
from driver import (
    Pulse,
    Until,
    area,
    call,
    check,
    only_panels,
    picture,
    say,
    settled,
    sidebar,
    start,
    suzanne_with_seams,
    until_done,
    uvs_of_suzanne,
)

RESPONSE = 1.5
"""The most seconds in which the window may do nothing, on a slow machine that draws by software."""

pulse = Pulse()
seen: list[Any] = []


def live(is_on: bool) -> None:
    manager: Any = bpy.context.window_manager
    manager.authalic_live = is_on


def figures() -> str:
    manager: Any = bpy.context.window_manager
    return str(manager.authalic_live_figures)


def drag() -> Iterator[None]:
    """Moves the slider of the angles; notes how the UVs change on the way."""
    options = bpy.context.window_manager.operator_properties_last("authalic.unwrap")
    for step in range(20):
        options.angle_weight = 0.4 + 0.01 * step
        area().tag_redraw()
        if not seen or not np.array_equal(seen[-1], uvs_of_suzanne()):
            seen.append(uvs_of_suzanne())
        yield


def is_new() -> bool:
    return not np.array_equal(seen[-1], uvs_of_suzanne())


def steady() -> bool:
    say("longest time without an answer", round(pulse.longest, 2))
    return pulse.longest < RESPONSE


STEPS = [
    only_panels("Authalic Unwrap"),
    suzanne_with_seams,
    *sidebar(),
    start("unwrap"),
    until_done("the unwrap ends"),
    lambda: seen.append(uvs_of_suzanne()),
    lambda: live(True),
    *[settled] * 4,
    check("nothing changes while no option does", is_new, False),
    pulse.start,
    drag,
    Until("the UVs follow", is_new),
    Until("the last map has figures", figures),
    check("the window stays alive", steady, True),
    pulse.stop,
    settled,
    picture("live"),
    lambda: live(False),
    lambda: call(bpy.ops.ed.undo),
    check("undo takes the drag back", lambda: np.array_equal(uvs_of_suzanne(), seen[0]), True),
]
