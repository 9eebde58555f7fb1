# SPDX-License-Identifier: GPL-3.0-or-later
"""A computation on a thread of its own, so that a window stays alive, and its end on the main thread."""

import threading
from collections import deque
from collections.abc import Callable
from typing import Any, Generic, Self, TypeVar

from ..bridge.progress import Progress

Computed = TypeVar("Computed")
Result = TypeVar("Result")


_AS_IT_IS: Any = lambda computed: computed  # noqa: E731
_NOTHING: Any = lambda: None  # noqa: E731


class Cancelled(Exception):
    """The job was cancelled; nothing was written."""


Item = TypeVar("Item")


class Latest(Generic[Item]):
    """What one thread puts and another takes: the newest alone, and each once."""

    def __init__(self) -> None:
        self._items: deque[Item] = deque(maxlen=1)

    def put(self, item: Item) -> None:
        self._items.append(item)

    def take(self) -> Item | None:
        """The newest item, or None where none has come since the last."""
        try:
            return self._items.pop()
        except IndexError:
            return None


class Job(Generic[Computed, Result]):
    """Runs `work(progress)` on a thread, then `finish(result)` on the thread that calls `apply`.

    `work` must not touch bpy; `progress(fraction, message)` is False once the job is to end early, when what
    `work` returns counts. It raises `Cancelled` once the job is cancelled. The main thread calls `preview()`:
    what there is to show of the result by now, or None where there is nothing new.
    """

    def __init__(
        self,
        work: Callable[[Progress], Computed],
        finish: Callable[[Computed], Result] = _AS_IT_IS,
        preview: Callable[[], Any] = _NOTHING,
    ) -> None:
        self._work, self._finish, self.preview = work, finish, preview
        self._thread = threading.Thread(target=self._run, name="authalic", daemon=True)
        self._cancel, self._end = threading.Event(), threading.Event()
        self._state = (0.0, "Reading")
        self._result: Computed
        self._error: BaseException | None = None

    def start(self) -> Self:
        self._thread.start()
        return self

    def poll(self) -> tuple[bool, float, str]:
        """(running, fraction, message); a cancelled job does not run, whatever its thread does."""
        return (self._thread.is_alive() and not self._cancel.is_set(), *self._state)

    def cancel(self) -> None:
        """Asks the computation to stop; `apply` will raise `Cancelled` and change nothing."""
        self._cancel.set()
        self._end.set()

    def end_early(self) -> None:
        """Asks the computation to stop; `apply` will write the best that it has by then."""
        self._end.set()

    def apply(self) -> Result:
        """Waits for the end of the computation and hands its result to `finish`.

        A cancelled job raises at once: its thread has nothing to give any more.
        """
        if not self._cancel.is_set():
            self._thread.join()
        return self.apply_result_of(self)

    def apply_result_of(self, other: "Job[Computed, Any]") -> Result:
        """Hands what another job has computed to `finish`."""
        if other._cancel.is_set():
            raise Cancelled("cancelled, nothing was changed")
        if other._error is not None:
            raise other._error
        return self._finish(other._result)

    def wait(self, seconds: float) -> bool:
        """Waits for the end of the computation, up to a time; whether it has ended."""
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def execute(self) -> Result:
        """The whole job at once, for scripts; Ctrl-C cancels it."""
        self.start()
        try:
            while self._thread.is_alive():
                self._thread.join(0.05)
        except BaseException:
            self.cancel()
            self._thread.join()
            raise
        return self.apply()

    def _run(self) -> None:
        try:
            self._result = self._work(self._report)
        except BaseException as error:  # raised again by apply, on the caller's thread
            self._error = error

    def _report(self, fraction: float, message: str) -> bool:
        if self._cancel.is_set():
            raise Cancelled("cancelled, nothing was changed")
        self._state = (fraction, message)
        return not self._end.is_set()
