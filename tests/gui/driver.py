# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps in a living Blender window: events, pictures of the screen, checks.

The event loop has to run between an event and its check. So a script is a list of steps, which the driver
takes one after the other: functions, functions that pause where they yield, and conditions to wait for. What
it has checked goes to checks.log, line by line.
"""

import importlib
import os
import subprocess
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d

MODULE = "bl_ext.user_default.authalic"
_OUT = os.environ.get("AUTHALIC_GUI_OUT", "/tmp")
_START = os.path.join(_OUT, "start.blend")
_PAUSE = 0.05
_PATIENCE = 60.0

Place = tuple[float, float]
"""Pixels from the left and from below, in the window."""


@dataclass
class Until:
    """A step that waits for a condition."""

    what: str
    holds: Callable[[], object]
    seconds: float = _PATIENCE


Step = Callable[[], object] | Until


def say(*words: object) -> None:
    with open(os.path.join(_OUT, "checks.log"), "a") as log:
        print(*words, file=log, flush=True)


# The window


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def area(kind: str = "VIEW_3D") -> Any:
    """The first editor of a kind, e.g. VIEW_3D or UV."""
    return next(area for area in window().screen.areas if area.ui_type == kind)


def region(kind: str = "WINDOW", editor: str = "VIEW_3D") -> Any:
    """A region of an editor, e.g. UI for its sidebar."""
    return next(region for region in area(editor).regions if region.type == kind)


def view() -> dict[str, Any]:
    """The context with which operators run as if called from the 3D view."""
    return {"window": window(), "area": area(), "region": region()}


def call(operator: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
    """Calls an operator in the 3D view."""
    with bpy.context.temp_override(**view()):
        return operator(*arguments, **options)


def start(name: str, **settings: Any) -> Callable[[], None]:
    """A step that starts one of the extension's operators as its button does, with undo."""

    def act() -> None:
        operator = getattr(bpy.ops.authalic, name)
        assert call(operator, "INVOKE_DEFAULT", True, **settings) == {"RUNNING_MODAL"}

    return act


def running() -> list[str]:
    """The operators that run in the window."""
    return [operator.bl_idname for operator in window().modal_operators]


def until_done(what: str = "the operator has ended", seconds: float = _PATIENCE) -> Until:
    return Until(what, lambda: not running(), seconds)


def sidebar(editor: str = "VIEW_3D") -> list[Step]:
    """Steps that show the extension's tab in the sidebar of an editor."""

    def show() -> None:
        area(editor).spaces.active.show_region_ui = True
        area(editor).tag_redraw()

    def choose() -> None:
        region("UI", editor).active_panel_category = "Authalic"
        area(editor).tag_redraw()

    return [show, choose, settled]


def suzanne_with_seams() -> None:
    """A step that adds Suzanne, subdivided twice, with seams between the islands of her UVs."""
    call(bpy.ops.mesh.primitive_monkey_add)
    call(bpy.ops.object.mode_set, mode="EDIT")
    call(bpy.ops.mesh.select_all, action="SELECT")
    call(bpy.ops.uv.select_all, action="SELECT")
    call(bpy.ops.uv.seams_from_islands)
    call(bpy.ops.object.mode_set, mode="OBJECT")
    modifier = bpy.context.object.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = 2
    call(bpy.ops.object.modifier_apply, modifier=modifier.name)
    call(bpy.ops.ed.undo_push, message="Suzanne")


def uvs_of_suzanne() -> Any:
    """The UVs (2c,) of all corners of Suzanne."""
    layer = bpy.data.objects["Suzanne"].data.uv_layers.active.uv
    flat = np.empty(2 * len(layer), np.float32)
    layer.foreach_get("vector", flat)
    return flat


def uvs_in_view() -> None:
    """A step that fits the view of the UV editor to the UVs."""
    with bpy.context.temp_override(window=window(), area=area("UV"), region=region("WINDOW", "UV")):
        bpy.ops.image.view_all(fit_view=True)


def settled() -> None:
    """A step that lets the window draw once more."""
    for part in window().screen.areas:
        part.tag_redraw()


def only_panels(*labels: str) -> Callable[[], None]:
    """A step that registers the extension again, with only these panels open. Later it has no effect."""

    def act() -> None:
        extension = importlib.import_module(MODULE)
        panels = [panel for panel in bpy.types.Panel.__subclasses__() if panel.__module__.startswith(MODULE)]
        unknown = {*labels} - {panel.bl_label for panel in panels}
        assert not unknown, f"no such panels: {unknown}"
        extension.unregister()
        for panel in panels:
            options = {*getattr(panel, "bl_options", ())} - {"DEFAULT_CLOSED"}
            panel.bl_options = options if panel.bl_label in labels else options | {"DEFAULT_CLOSED"}
        extension.register()

    return act


# Events


def pixel(name: str, vertex: int) -> Place:
    """The place of a vertex of an object in the window."""
    obj, space = bpy.data.objects[name], area().spaces.active
    place = location_3d_to_region_2d(
        region(), space.region_3d, obj.matrix_world @ obj.data.vertices[vertex].co
    )
    return int(region().x + place.x), int(region().y + place.y)


def send(kind: str, value: str, place: Place = (500, 400), **modifiers: Any) -> None:
    window().event_simulate(kind, value, x=int(place[0]), y=int(place[1]), **modifiers)


def move(where: Callable[[], Place]) -> Callable[[], None]:
    """A step that moves the mouse to the place that `where()` returns."""
    return lambda: send("MOUSEMOVE", "NOTHING", where())


def click(where: Callable[[], Place], **modifiers: Any) -> list[Step]:
    """Steps that click at the place that `where()` returns."""
    return [
        move(where),
        lambda: send("LEFTMOUSE", "PRESS", where(), **modifiers),
        lambda: send("LEFTMOUSE", "RELEASE", where(), **modifiers),
    ]


def click_button(operator: str, editor: str = "VIEW_3D") -> list[Step]:
    """Steps that move the mouse down the sidebar to the button of an operator, and press it."""
    found: list[Place] = []

    def places() -> Iterator[Place]:
        bar = region("UI", editor)
        for height in range(bar.height - 45, 0, -12):
            yield bar.x + bar.width // 2 - 20, bar.y + height

    def seek() -> Iterator[None]:
        for place in places():
            send("MOUSEMOVE", "NOTHING", place)
            yield
            if _button_below(editor) == operator:
                found.append(place)
                return
        raise AssertionError(f"there is no button for {operator}")

    return [seek, *click(lambda: found[-1])]


def _button_below(editor: str) -> str:
    """The operator of the button below the mouse; empty if there is none."""
    context = {"window": window(), "area": area(editor), "region": region("UI", editor)}
    copy, window_manager = bpy.ops.ui.copy_python_command_button, bpy.context.window_manager
    window_manager.clipboard = ""
    with bpy.context.temp_override(**context), suppress(RuntimeError):
        copy()
    return window_manager.clipboard.removeprefix("bpy.ops.").partition("(")[0]


def key(kind: str, **modifiers: Any) -> list[Step]:
    """Steps that strike a key over the 3D view."""
    return [lambda: send(kind, "PRESS", **modifiers), lambda: send(kind, "RELEASE", **modifiers)]


# Pictures and checks


def picture(name: str) -> Callable[[], None]:
    """A step that takes a picture of the screen (Blender's own are black here)."""

    def take() -> None:
        subprocess.run(["import", "-window", "root", os.path.join(_OUT, f"{name}.png")], check=True)

    return take


def blue(editor: str = "VIEW_3D") -> float:
    """The share of an editor's pixels that are blue."""
    part = region("WINDOW", editor)
    crop = f"{part.width}x{part.height}+{part.x}+{window().height - part.y - part.height}"
    command = ["import", "-window", "root", "-crop", crop, "-depth", "8", "rgb:-"]
    pixels = np.frombuffer(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout, np.uint8)
    colors = pixels.reshape(-1, 3).astype(int)
    return float(np.mean(colors[:, 2] > colors[:, 0] + 80))


def check(what: str, get: Callable[[], object], expected: object) -> Callable[[], None]:
    """A step that compares the value of `get()` with the expected one."""

    def compare() -> None:
        value = get()
        assert value == expected, f"{what}: {value!r} instead of {expected!r}"
        say("ok", what)

    return compare


class Pulse:
    """Notes the longest time in which the window did nothing."""

    def __init__(self) -> None:
        self._last = 0.0
        self.longest = 0.0
        self._timer = self._beat  # Blender knows a timer by the function object

    def start(self) -> None:
        self._last, self.longest = time.monotonic(), 0.0
        if not bpy.app.timers.is_registered(self._timer):
            bpy.app.timers.register(self._timer)

    def stop(self) -> None:
        bpy.app.timers.unregister(self._timer)

    def _beat(self) -> float:
        now = time.monotonic()
        self.longest = max(self.longest, now - self._last)
        self._last = now
        return 0.01


# Scripts


def run(scripts: dict[str, Sequence[Step]]) -> None:
    """Takes the steps of the scripts, each in an empty file, and ends Blender."""
    bpy.context.preferences.view.show_splash = False
    bpy.context.preferences.view.show_statusbar_stats = False
    ticks = _ticks(scripts)

    def tick() -> float | None:
        for pause in ticks:
            return pause
        bpy.ops.wm.quit_blender()
        return None

    bpy.app.timers.register(tick, first_interval=0.5, persistent=True)


def _ticks(scripts: dict[str, Sequence[Step]]) -> Iterator[float]:
    """The pauses between the steps of all scripts."""
    _empty()
    bpy.ops.wm.save_as_mainfile(filepath=_START)
    for name, steps in scripts.items():
        began = time.monotonic()
        bpy.ops.wm.open_mainfile(filepath=_START, load_ui=True)
        yield _PAUSE
        try:
            for step in steps:
                yield from _taken(step)
        except Exception:
            say("FAILED", name, "\n", traceback.format_exc())
            picture(f"failed_{name}")()
        say(f"-- {name}: {time.monotonic() - began:.0f} s")
    say("END")


def _taken(step: Step) -> Iterator[float]:
    """Takes one step; the pauses until it is done."""
    if not isinstance(step, Until):
        more = step()
        for _ in more if isinstance(more, Iterator) else ():
            yield _PAUSE
        yield _PAUSE
        return
    deadline = time.monotonic() + step.seconds
    while not step.holds():
        assert time.monotonic() < deadline, f"waited {step.seconds:.0f} s in vain: {step.what}"
        yield _PAUSE
    say("ok", step.what)
    yield _PAUSE


def _empty() -> None:
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
