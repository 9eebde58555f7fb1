# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tasks onto workers: one at a time on each, the largest first, each until it has a record."""

import contextlib
import queue
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..io.errors import require
from ..runs.record import Record
from .errors import SchedulerError
from .memory import in_words
from .store import in_unicode, read_record, write_record
from .task import Task, failure, run_task

PATIENCE = 120.0
"""Seconds to wait for a worker when there is none."""
LOOK = 1.0
"""Seconds between looks at the workers."""
LOOK_PER_WORKER = 0.005
"""Seconds more for each worker, so that looking at thousands of them stays cheap."""
_GATHER = 5.0
"""Seconds to wait for a record from a worker."""


class Schedule:
    """Runs tasks on the workers of a client.

    A worker has one task at a time, so that nobody else's work is lost with it. Where a task runs is decided
    here and not by Dask, which would let a task wait for ever for a worker that is gone.

    Parameters
    ----------
    client : distributed.Client
        Workers may come and go.
    tasks : iterable of Task
        What is to be done.
    retries : int
        How often a task is tried again.
    collected : callable
        Called with the record of each task, once.
    """

    def __init__(
        self, client: Any, tasks: Iterable[Task], retries: int, collected: Callable[[Record], None]
    ) -> None:
        self._client, self._retries, self._collected = client, retries, collected
        self._waiting = deque(sorted(tasks, key=lambda task: -task.memory))
        self._running: dict[Any, tuple[Task, str]] = {}
        self._ended: queue.Queue[Any] = queue.Queue()
        self._memory: dict[str, int] = {}
        self._looked = self._last_worker = time.monotonic()

    def run(self) -> None:
        """Returns when every task has a record."""
        try:
            while self._waiting or self._running:
                self._look()
                self._submit()
                with contextlib.suppress(queue.Empty):
                    self._collect(self._ended.get(timeout=LOOK if self._running else LOOK / 10))
        finally:
            if self._running:
                self._client.cancel(list(self._running), force=True)

    def _look(self) -> None:
        """Looks now and then who is there: takes tasks back from workers that are gone."""
        interval = LOOK + LOOK_PER_WORKER * len(self._memory)
        if self._memory and time.monotonic() - self._looked < interval:
            return
        if self._client.status != "running":
            raise SchedulerError("the connection to the scheduler was lost; run the batch again to go on")
        workers = self._client.scheduler_info(n_workers=-1)["workers"]
        # to Dask 0 is no limit
        self._memory = {address: worker["memory_limit"] or 2**62 for address, worker in workers.items()}
        self._looked = time.monotonic()
        for future, (task, address) in list(self._running.items()):
            if address not in self._memory and not future.done():
                self._take_back(future, task)
        if self._memory:
            self._last_worker = self._looked
        elif self._looked - self._last_worker > PATIENCE:
            raise SchedulerError(f"there was no worker for {PATIENCE:.0f} s; start some and run again")

    def _submit(self) -> None:
        """Gives each free worker the first task that its memory allows."""
        if self._memory:
            self._refuse_too_large(max(self._memory.values()))
        busy = {address for _, address in self._running.values()}
        for address in self._memory.keys() - busy:
            task = next((task for task in self._waiting if task.memory <= self._memory[address]), None)
            if task is not None:
                self._waiting.remove(task)
                self._start(task, address)

    def _start(self, task: Task, address: str) -> None:
        key = f"authalic-{in_unicode(task.subject)}-{task.attempt}-{time.monotonic_ns()}"
        future = self._client.submit(run_task, task, key=key, workers=[address], pure=False)
        self._running[future] = task, address
        future.add_done_callback(self._ended.put)

    def _collect(self, future: Any) -> None:
        """Takes the record of a task that ended, or tries it again."""
        if future not in self._running:
            return  # it was taken back
        task, _ = self._running[future]
        distributed = _distributed()
        try:
            record = future.result(timeout=_GATHER)
        except (distributed.TimeoutError, distributed.CancelledError, distributed.KilledWorker):
            self._take_back(future, task)
        except Exception as error:  # what the task raised
            del self._running[future]
            self._again_or_fail(task, error)
        else:
            del self._running[future]
            self._collected(record)

    def _take_back(self, future: Any, task: Task) -> None:
        """The worker of a task was killed, or lost; perhaps after it had written the record."""
        del self._running[future]
        self._client.cancel([future], force=True)
        record = read_record(Path(task.folder), task.subject)
        if record is not None:
            self._collected(record)
            return
        message = f"{task.attempt} workers were lost while they ran it: were they killed, for lack of memory?"
        self._again_or_fail(task, RuntimeError(message), "worker_lost")

    def _again_or_fail(self, task: Task, error: BaseException, kind: str | None = None) -> None:
        if task.attempt <= self._retries:
            self._waiting.appendleft(replace(task, attempt=task.attempt + 1))
        else:
            self._fail(task, error, kind)

    def _fail(self, task: Task, error: BaseException, kind: str | None = None) -> None:
        record = failure(task, error, kind)
        write_record(Path(task.folder), record)
        self._collected(record)

    def _refuse_too_large(self, limit: int) -> None:
        for task in [task for task in self._waiting if task.memory > limit]:
            self._waiting.remove(task)
            needed, there = in_words(task.memory), in_words(limit)
            message = f"it needs about {needed}, but no worker has more than {there}: use larger workers"
            self._fail(task, MemoryError(message), "memory")


def _distributed() -> Any:
    return require("distributed", "a batch", "batch")
