# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview of seams, which is drawn while options change and marks nothing.

A timer compares what the preview should show with what it shows. So it needs no calls from what may change:
options, meshes, the selection, undo.
"""

from dataclasses import dataclass
from typing import Any

import bpy
from bpy.props import BoolProperty, StringProperty

from ..blender import scene_changes, selection
from ..jobs import mark_seams as marking
from ..jobs import seam_groups, targets
from ..jobs.job import Job
from ..overlay import seams as overlay
from . import mark_seams
from .timer import Timer

_INTERVAL = 0.1

Meshes = tuple[object, ...]
"""The names of the objects, and a number for the state of their meshes."""
Wanted = tuple[Meshes, marking.Settings]
"""All that a preview depends on."""


@dataclass
class _State:
    """The preview that is shown or sought, its search while it runs, and the meshes at the last tick."""

    wanted: Wanted | None = None
    running: Job[Any, Any] | None = None
    meshes: Meshes | None = None


_state = _State()


def tick(context: bpy.types.Context) -> bool:
    """Takes the preview one step further; whether there is to be another tick."""
    global _state
    manager: Any = context.window_manager
    if not manager.authalic_seam_preview:
        if _state.running is not None:
            _state.running.cancel()
        _state = _State()
        _show(context, [], "")
        return False
    meshes = _meshes(context)
    is_still, _state.meshes = meshes == _state.meshes, meshes
    if not is_still:  # wait for the end of a drag or of an edit
        _forget(context)
    elif _state.running is not None:
        _collect(context, _state.running)
    elif meshes is not None and (wanted := (meshes, _settings(context))) != _state.wanted:
        _start(context, wanted)
    return True


def _meshes(context: bpy.types.Context) -> Meshes | None:
    """The meshes to find seams on; None if there are none."""
    if context.mode not in {"OBJECT", "EDIT_MESH"}:
        return None
    chosen = [(obj.name, selection.face_count(obj)) for obj in targets.meshes(context)]
    return (*chosen, context.mode, scene_changes.count()) if chosen else None


def _settings(context: bpy.types.Context) -> marking.Settings:
    return mark_seams.settings(context.window_manager.operator_properties_last("authalic.mark_seams"))


def _forget(context: bpy.types.Context) -> None:
    """Removes a preview of meshes that have changed."""
    if _state.running is not None:
        _state.running.cancel()
    _state.running = None
    if _state.wanted is not None:
        _state.wanted = None
        _show(context, [], "")


def _start(context: bpy.types.Context, wanted: Wanted) -> None:
    _state.wanted = wanted
    try:
        _state.running = marking.preview(context, wanted[1]).start()
    except (seam_groups.NoGroup, targets.NothingToDo) as problem:
        _show(context, [], str(problem))


def _collect(context: bpy.types.Context, running: Job[Any, Any]) -> None:
    """Shows what was found, once the search is over."""
    if running.poll()[0]:
        return
    _state.running = None
    names, found = running.apply()
    lines = [overlay.Lines(name, edges) for name, edges in zip(names, found.edges, strict=True)]
    _show(context, lines, marking.in_words(found) if found.islands else "")


def _show(context: bpy.types.Context, lines: list[overlay.Lines], text: str) -> None:
    manager: Any = context.window_manager
    manager.authalic_seam_figures = text
    overlay.show(context, lines)


_timer = Timer(tick, _INTERVAL)


def _toggled(_manager: bpy.types.WindowManager, _context: bpy.types.Context) -> None:
    _timer.start()


_PROPERTIES: Any = bpy.types.WindowManager


def register() -> None:
    _PROPERTIES.authalic_seam_preview = BoolProperty(
        name="Preview",
        description="Draw quick seams over the 3D view while the options change. Nothing is marked",
        update=_toggled,
        options={"SKIP_SAVE"},
    )
    _PROPERTIES.authalic_seam_figures = StringProperty(
        name="Figures", description="The figures of the preview", options={"SKIP_SAVE"}
    )


def unregister() -> None:
    _timer.stop()
    if _state.running is not None:
        _state.running.cancel()
    del _PROPERTIES.authalic_seam_figures
    del _PROPERTIES.authalic_seam_preview
