# SPDX-License-Identifier: GPL-3.0-or-later
"""UVs that follow the options of the unwrap while they are dragged.

A timer compares the options with those of the last map. Each map begins with the one before.
"""

from dataclasses import dataclass, replace
from typing import Any

import bpy
from bpy.props import BoolProperty, StringProperty

from ..blender.types import MeshObject, is_mesh
from ..jobs import densities, seam_groups, targets
from ..jobs import unwrap as unwrapping
from ..jobs.job import Cancelled, Job
from . import modal, unwrap
from .timer import Timer

_INTERVAL = 0.05

Wanted = tuple[str, str, unwrapping.Settings]
"""The name of the object, the mode, and the options."""


@dataclass
class _State:
    """What the UVs were made of, or None as long as nothing has changed; and what is being made."""

    made: Wanted | None = None
    making: Wanted | None = None
    running: Job[Any, unwrapping.Report] | None = None


_state = _State()
# The editor in which it was turned on: in the UV editor its selection and its image count.
_place: dict[str, Any] = {}


def tick(context: bpy.types.Context) -> bool:
    """Takes the UVs one step further; whether there is to be another tick."""
    global _state
    manager: Any = context.window_manager
    if not manager.authalic_live:
        if _state.running is not None:
            _state.running.cancel()
        _state = _State()
        return False
    if modal.is_busy():  # with meshes that must not change meanwhile
        return True
    wanted = _wanted(context)
    if _state.running is not None:
        _collect(context, _state.running, wanted)
    elif wanted is not None and (_state.made is None or _state.made[:2] != wanted[:2]):
        _state.made = wanted  # another object: its UVs are as they are until an option changes
    elif wanted is not None and wanted != _state.made:
        _start(context, wanted)
    return True


def _wanted(context: bpy.types.Context) -> Wanted | None:
    """The active object with the options; None if there is none to unwrap."""
    obj = context.view_layer.objects.active if context.view_layer else None
    if not is_mesh(obj) or context.mode not in {"OBJECT", "EDIT_MESH"}:
        return None
    # seams are marked by the button: as they change, they would add up
    return obj.name, context.mode, replace(unwrap.last_settings(context), mark_seams=False)


def _start(context: bpy.types.Context, wanted: Wanted) -> None:
    obj: MeshObject = context.view_layer.objects[wanted[0]]  # type: ignore[assignment]
    _state.making = wanted
    try:
        _state.running = unwrapping.job(context, wanted[2], obj).start()
    except _REFUSED as problem:
        _end(context, str(problem))


def _collect(context: bpy.types.Context, running: Job[Any, unwrapping.Report], wanted: Wanted | None) -> None:
    """Writes a map that is ready; a step of undo for the last one of a drag."""
    if running.poll()[0]:
        return
    _state.running = None
    try:
        report = running.apply()
    except _REFUSED as problem:
        _end(context, str(problem))
        return
    is_last = wanted == _state.making
    _end(context, f"Area ratio SD {report.figures.deviation:.3g}, shear {report.figures.shear:.2f}")
    if is_last:
        bpy.ops.ed.undo_push(message="Live Unwrap")


def _end(context: bpy.types.Context, said: str) -> None:
    manager: Any = context.window_manager
    manager.authalic_live_figures = said
    _state.made, _state.making = _state.making, None


_REFUSED = (
    *(unwrapping.CannotUnwrap, seam_groups.NoGroup, densities.NoDensity, targets.NothingToDo),
    *(targets.CannotWrite, Cancelled),
)


def _override(windows: Any) -> dict[str, Any]:
    """The editor in which it was turned on, if it is still there; else a window."""
    for window in windows:
        for area in window.screen.areas:
            if area == _place.get("area") and area.ui_type == _place["kind"]:
                region = next(region for region in area.regions if region.type == "WINDOW")
                return {"window": window, "area": area, "region": region}
    return {"window": windows[0]}


_timer = Timer(tick, _INTERVAL, _override)


def _toggled(_manager: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    _place.clear()
    if context.area is not None:
        _place.update(area=context.area, kind=context.area.ui_type)
    _timer.start()


_PROPERTIES: Any = bpy.types.WindowManager


def register() -> None:
    _PROPERTIES.authalic_live = BoolProperty(
        name="Live",
        description="Unwrap the active object again while options change",
        update=_toggled,
        options={"SKIP_SAVE"},
    )
    _PROPERTIES.authalic_live_figures = StringProperty(
        name="Figures", description="The figures of the last live unwrap", options={"SKIP_SAVE"}
    )


def unregister() -> None:
    _timer.stop()
    if _state.running is not None:
        _state.running.cancel()
    del _PROPERTIES.authalic_live_figures
    del _PROPERTIES.authalic_live
