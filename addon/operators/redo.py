# SPDX-License-Identifier: GPL-3.0-or-later
"""Changed options of the last operator, without a frozen window.

Where an option changes in the panel of the last operator, Blender undoes the operator, runs it with the new
option, and waits. What takes longer than a moment goes on in the background instead: the run is answered as
cancelled, at which Blender restores the former result. When the computation ends, the operator is repeated,
and takes what was computed.
"""

from dataclasses import dataclass
from typing import Any

import bpy

from ..blender.types import Status
from ..jobs.job import Job
from . import status_bar

_MOMENT = 0.12
"""How long the window may wait for a result, in seconds."""
_INTERVAL = 0.05


@dataclass
class _Pending:
    """A computation in the background: for which operator and options, and where it is to be repeated."""

    label: str
    key: tuple[str, dict[str, Any]]
    place: dict[str, Any]
    job: Job[Any, Any]


_pending: _Pending | None = None


def is_one(operator: bpy.types.Operator, context: bpy.types.Context) -> bool:
    """Whether an operator that is run was run before, and only its options have changed."""
    if bpy.app.background or context.window is None:
        return False
    pointer = operator.as_pointer()
    return any(each.as_pointer() == pointer for each in context.window_manager.operators)


def run(operator: bpy.types.Operator, context: bpy.types.Context, job: Job[Any, Any]) -> Any:
    """What the job of an operator returns; None if the operator is to be cancelled, since the job goes on."""
    global _pending
    pending, _pending = _pending, None
    key = _key(operator)
    if pending is not None and pending.key == key and not pending.job.poll()[0]:
        return job.apply_result_of(pending.job)
    if pending is not None:
        pending.job.cancel()
    job.start()
    if job.wait(_MOMENT):
        return job.apply()
    place = {name: getattr(context, name) for name in ("window", "area", "region")}
    _pending = _Pending(operator.bl_label, key, place, job)
    operators: Any = bpy.ops
    operators.authalic.redo("INVOKE_DEFAULT")
    return None


def cancel() -> None:
    """Ends the computation in the background, if there is one."""
    global _pending
    if _pending is not None:
        _pending.job.cancel()
    _pending = None


def _key(operator: bpy.types.Operator) -> tuple[str, dict[str, Any]]:
    """The name and the options of an operator."""
    names = [each.identifier for each in operator.bl_rna.properties if not each.is_readonly]
    return operator.bl_idname, {name: _plain(getattr(operator, name)) for name in names}


def _plain(value: Any) -> Any:
    return tuple(value) if hasattr(value, "__len__") and not isinstance(value, str) else value


class AUTHALIC_OT_redo(bpy.types.Operator):
    """Wait for the result of changed options"""

    bl_idname = "authalic.redo"
    bl_label = "Update Last Operation"
    bl_options = {"INTERNAL"}  # noqa: RUF012 (Blender reads a plain set)

    _waits_for: Any = None
    _timer: Any = None

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> Status:
        if _pending is None:
            return {"CANCELLED"}
        self._waits_for = _pending
        self._timer = context.window_manager.event_timer_add(_INTERVAL, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> Status:
        pending = self._waits_for
        if pending is not _pending:  # other options, or another operator
            return self._leave(context)
        if event.type == "ESC" and event.value == "PRESS":
            cancel()
            self.report({"INFO"}, f"{pending.label}: cancelled, the last result stays")
            return self._leave(context)
        if event.type == "TIMER":
            running, fraction, message = pending.job.poll()
            if not running:
                # not from within an operator: it undoes what this one runs on
                bpy.app.timers.register(_repeat, first_interval=0)
                return self._leave(context)
            status_bar.show(context, pending.label, fraction, message, can_end_early=False)
        return {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender closes the window or loads another file."""
        cancel()
        self._leave(context)

    def _leave(self, context: bpy.types.Context) -> Status:
        context.window_manager.event_timer_remove(self._timer)
        status_bar.clear(context)
        return {"CANCELLED"}


def _repeat() -> None:
    """Repeats the last operator, if it is still the one with the options that were computed."""
    pending = _pending
    last = bpy.context.window_manager.operators[-1:]
    if pending is None or not last or _key(last[0]) != pending.key:
        cancel()
        return
    with bpy.context.temp_override(**pending.place):
        bpy.ops.ed.undo_redo()


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_redo)


def unregister() -> None:
    cancel()
    if bpy.app.timers.is_registered(_repeat):
        bpy.app.timers.unregister(_repeat)
    bpy.utils.unregister_class(AUTHALIC_OT_redo)
