# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps in a living Blender window: events, pictures of the screen, checks; then ends Blender.

The event loop has to run between an event and its check, so a script is a list of functions, which the driver
calls one after the other.
"""

import os
import subprocess
import time
import traceback
from collections.abc import Callable, Iterable
from typing import Any

import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d

_OUT = os.environ.get("AUTHALIC_GUI_OUT", "/tmp")
_log = open(os.path.join(_OUT, "checks.log"), "w")  # noqa: SIM115 (open until Blender ends)
_PAUSE, _LONGEST = 0.4, 380.0


def say(*words: object) -> None:
    print(*words, file=_log, flush=True)


def view() -> dict[str, Any]:
    """The context with which operators run as if called from the 3D view."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    return {"window": window, "area": area, "region": region}


def call(operator: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
    """Calls an operator in the 3D view."""
    with bpy.context.temp_override(**view()):
        return operator(*arguments, **options)


def pixel(name: str, vertex: int) -> tuple[float, float]:
    """The place of a vertex of an object in the window."""
    window, obj = view(), bpy.data.objects[name]
    point = obj.matrix_world @ obj.data.vertices[vertex].co
    space = window["area"].spaces.active
    place = location_3d_to_region_2d(window["region"], space.region_3d, point)
    return int(window["region"].x + place.x), int(window["region"].y + place.y)


def send(kind: str, value: str, place: tuple[float, float] = (500, 400), **modifiers: Any) -> None:
    view()["window"].event_simulate(kind, value, x=place[0], y=place[1], **modifiers)


def move(where: Callable[[], tuple[float, float]]) -> Callable[[], None]:
    """A step that moves the mouse to the place that `where()` returns."""
    return lambda: send("MOUSEMOVE", "NOTHING", where())


def click(where: Callable[[], tuple[float, float]], **modifiers: Any) -> list[Callable[[], None]]:
    """Steps that click at the place that `where()` returns."""
    return [
        move(where),
        lambda: send("LEFTMOUSE", "PRESS", where(), **modifiers),
        lambda: send("LEFTMOUSE", "RELEASE", where(), **modifiers),
    ]


def key(kind: str, **modifiers: Any) -> list[Callable[[], None]]:
    """Steps that strike a key over the 3D view."""
    return [lambda: send(kind, "PRESS", **modifiers), lambda: send(kind, "RELEASE", **modifiers)]


def picture(name: str) -> Callable[[], None]:
    """A step that takes a picture of the screen (Blender's own are black here)."""

    def take() -> None:
        subprocess.run(["import", "-window", "root", os.path.join(_OUT, f"{name}.png")], check=True)

    return take


def check(what: str, get: Callable[[], object], expected: object) -> Callable[[], None]:
    """A step that compares the value of `get()` with the expected one."""

    def compare() -> None:
        value = get()
        assert value == expected, f"{what}: {value!r} instead of {expected!r}"
        say("ok", what)

    return compare


def run(steps: Iterable[Callable[[], object]]) -> None:
    """Runs the steps one after the other; the last line of checks.log has the outcome."""
    bpy.context.preferences.view.show_splash = False
    started, waiting = time.monotonic(), iter(steps)

    def tick() -> float | None:
        step = next(waiting, None)
        if step is None:
            return _end("PASSED")
        try:
            step()
        except Exception:
            say(traceback.format_exc())
            return _end("FAILED")
        return _PAUSE if time.monotonic() - started < _LONGEST else _end("FAILED: it took too long")

    bpy.app.timers.register(tick, first_interval=1.0)


def _end(word: str) -> None:
    say(word)
    bpy.ops.wm.quit_blender()
