# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that run a `Job`: at once for scripts, else while the window stays alive.

One at a time: while an operator runs in a window, all others are refused.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import bpy

from ..blender.types import OperatorMixin, Status
from ..jobs import reported, targets
from ..jobs.job import Cancelled, Job
from . import redo, status_bar

_INTERVAL = 0.1
# Events that only move the view. Any other could change the meshes of the job.
_PASSED_ON = {
    *("MOUSEMOVE", "INBETWEEN_MOUSEMOVE", "MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "TRACKPADPAN"),
    *("TRACKPADZOOM", "MOUSEROTATE", "NDOF_MOTION", "WINDOW_DEACTIVATE"),
}

_in_window: list[str] = []
"""The label of the operator that runs in a window, if any."""


class Busy(Exception):
    """Another operator runs in a window."""


class Modal(OperatorMixin):
    """A mixin for operators with `job(context)`, its exceptions `refused`, and `line(report)`."""

    if TYPE_CHECKING:
        refused: tuple[type[Exception], ...]

        def job(self, context: bpy.types.Context) -> Job[Any, Any]: ...
        def line(self, report: Any) -> str: ...

    is_redo = False
    """Whether the operator is run again because its options have changed."""
    _running: Any = None
    _timer: Any = None

    def execute(self, context: bpy.types.Context) -> Status:
        return self._attempt(lambda: self._execute(context))

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> Status:
        if bpy.app.background or context.window is None:  # without a window nothing would wake the operator
            return self.execute(context)
        return self._attempt(lambda: self._start(context))

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> Status:
        if event.type == "TIMER":
            running, fraction, message = self._running.poll()
            if not running:
                self._leave(context)
                return self._attempt(lambda: self._say(self._running.apply()))
            self._show(context, fraction, message)
            preview = self._running.preview()
            if preview is not None:
                self.show_preview(context, preview)
        elif event.value == "PRESS" and event.type == "ESC":
            self._running.cancel()
        elif event.value == "PRESS" and event.type in {"RET", "NUMPAD_ENTER"}:
            self._running.end_early()
        return {"PASS_THROUGH" if event.type in _PASSED_ON else "RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender closes the window or loads another file."""
        self._running.cancel()
        self._leave(context)

    def _execute(self, context: bpy.types.Context) -> Status:
        _refuse_if_busy()
        self.is_redo = redo.is_one(self, context)
        if not self.is_redo:
            redo.cancel()
            return self._say(self.job(context).execute())
        report = redo.run(self, context, self.job(context))
        return {"CANCELLED"} if report is None else self._say(report)

    def _start(self, context: bpy.types.Context) -> Status:
        _refuse_if_busy()
        redo.cancel()
        self._running = self.job(context).start()
        _in_window.append(self.bl_label)
        manager = context.window_manager
        self._timer = manager.event_timer_add(_INTERVAL, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        self._show(context, *self._running.poll()[1:])
        return {"RUNNING_MODAL"}

    def _show(self, context: bpy.types.Context, fraction: float, message: str) -> None:
        context.window_manager.progress_update(round(100 * fraction))
        status_bar.show(context, self.bl_label, fraction, message)

    def _leave(self, context: bpy.types.Context) -> None:
        _in_window.clear()
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        status_bar.clear(context)
        self.show_preview(context, None)

    def _attempt(self, step: Callable[[], Status]) -> Status:
        """Runs a step; if the job is refused, reports the reason. Nothing has changed then."""
        try:
            return step()
        except Cancelled as outcome:
            self.report({"INFO"}, f"{self.bl_label}: {outcome}")
        except (Busy, targets.CannotWrite, *self.refused) as problem:  # type: ignore[misc]
            reported.remember((), getattr(problem, "refusals", ()))
            self.report({"ERROR"}, str(problem))
        except targets.NothingToDo as problem:
            self.report({"WARNING"}, str(problem))
        return {"CANCELLED"}

    def show_preview(self, context: bpy.types.Context, preview: Any) -> None:
        """Shows what there is of the result by now, or with None nothing any more."""

    def applied(self, report: Any) -> None:
        """What is left to do once the job has written its result."""

    def _say(self, report: Any) -> Status:
        self.applied(report)
        reported.remember(getattr(report, "places", ()), report.refusals)
        self.report({"WARNING"} if report.refusals or report.notes else {"INFO"}, self.line(report))
        return {"FINISHED"}


def is_busy() -> bool:
    """Whether an operator runs in a window."""
    return bool(_in_window)


def _refuse_if_busy() -> None:
    for label in _in_window:
        raise Busy(f"{label} is still running; wait for its end, or cancel it with Esc")
