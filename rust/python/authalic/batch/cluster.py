# SPDX-License-Identifier: MIT OR Apache-2.0
"""Where a batch runs: a cluster on this machine, or a scheduler with workers elsewhere."""

import contextlib
import logging
import os
from collections.abc import Iterator
from typing import Any

from ..io.errors import require
from .errors import SchedulerError

CONNECT_SECONDS = 10
_SHARE = 0.9
"""Of the machine's memory, for all workers together."""


@contextlib.contextmanager
def connected(scheduler: str | None, workers: int | None, memory: int | None, largest: int) -> Iterator[Any]:
    """A client of the scheduler at an address, or of a cluster on this machine for the time being.

    Parameters
    ----------
    scheduler : str or None
        An address such as tcp://host:8786; None: a cluster of processes on this machine.
    workers, memory : int or None
        Of the cluster on this machine: its processes, and the bytes of each of them.
    largest : int
        Bytes that the largest subject needs.

    Yields
    ------
    distributed.Client
        The client.
    """
    require("distributed", "a batch", "batch")
    with _quiet("distributed"), _client(scheduler, workers, memory, largest) as client:
        yield client


def native_threads(workers: int) -> int:
    """The share of this machine's processors that each of its workers has."""
    return max(1, _processors() // workers)


@contextlib.contextmanager
def _client(scheduler: str | None, workers: int | None, memory: int | None, largest: int) -> Iterator[Any]:
    distributed, dask = require("distributed", "a batch", "batch"), require("dask", "a batch", "batch")
    if scheduler is not None:
        try:
            client = distributed.Client(scheduler, timeout=CONNECT_SECONDS, set_as_default=False)
        except (OSError, ValueError) as error:
            raise SchedulerError(f"the scheduler {scheduler} cannot be reached: {error}") from error
        with client:
            yield client
        return
    workers, memory = _shares(workers, memory, largest)
    settings = {
        "distributed.worker.memory.target": False,
        "distributed.worker.memory.spill": False,
        "distributed.worker.memory.pause": False,
    }
    with (
        dask.config.set(settings),
        distributed.LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            memory_limit=memory,
            dashboard_address="127.0.0.1:0",
            silence_logs=logging.CRITICAL,
            preload=[f"{__package__}.preload"],
        ) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        yield client


@contextlib.contextmanager
def _quiet(package: str) -> Iterator[None]:
    """Silences a package: workers and schedulers that come and go are told by the batch itself."""
    names = [name for name in logging.root.manager.loggerDict if name.split(".")[0] == package]
    levels = {name: logging.getLogger(name).level for name in names}
    for name in names:
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for name, level in levels.items():
            logging.getLogger(name).setLevel(level)


def _shares(workers: int | None, memory: int | None, largest: int) -> tuple[int, int]:
    """As many workers as processors, but no more than memory allows; and the memory of each."""
    total = int(_SHARE * require("distributed.system", "a batch", "batch").MEMORY_LIMIT)
    if workers is None:
        workers = max(1, min(_processors(), total // max(memory or largest, 1)))
    return workers, memory or total // workers


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
