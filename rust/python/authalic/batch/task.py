# SPDX-License-Identifier: MIT OR Apache-2.0
"""What a worker does for one subject."""

import os
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .._native import MeshError, SolverError, __version__, set_threads
from ..io import FileError, MissingExtra
from ..runs.disk import disk_run
from ..runs.record import Record, problem
from ..runs.sphere import sphere_run
from ..runs.unwrap import unwrap_run
from .store import write_record

RUNS = {"sphere": sphere_run, "disk": disk_run, "unwrap": unwrap_run}
"""The runs that a batch can make of every subject."""


class VersionError(RuntimeError):
    """A worker has another version of Authalic than the batch."""


@dataclass(frozen=True)
class Task:
    """One subject with all that its run needs, small enough to be sent.

    Parameters
    ----------
    subject, surface, output : str
        The subject's name, and the files to read and to write.
    folder : str
        The batch's folder.
    command : str
        The key of one of `RUNS`.
    arguments : dict
        Arguments of the run.
    fingerprint : str
        What the result depends on.
    version : str
        The version of Authalic that the batch has, and every worker must have.
    threads : int or None
        Native threads; None: as many as the worker has.
    memory : int
        An estimate of the bytes that it needs.
    attempt : int
        1 at first.
    """

    subject: str
    surface: str
    output: str
    folder: str
    command: str
    arguments: dict[str, Any] = field(default_factory=dict)
    fingerprint: str = ""
    version: str = __version__
    threads: int | None = None
    memory: int = 0
    attempt: int = 1


def run_task(task: Task) -> Record:
    """Maps one subject and writes its map and its record.

    What is wrong with the surface, its file or the installation comes back as a record too, because it would
    be wrong again; other exceptions are raised, and the batch tries again.
    """
    # 1. One pool of native threads
    began = time.monotonic()
    set_threads(_worker_threads() if task.threads is None else task.threads)
    # 2. The map
    try:
        _check_version(task)
        Path(task.output).parent.mkdir(parents=True, exist_ok=True)
        record = RUNS[task.command](Path(task.surface), Path(task.output), **_arguments(task))
        record["outcome"] = "done"
    except (MeshError, SolverError, FileError, MissingExtra, FileNotFoundError, VersionError) as error:
        record = failure(task, error)
    # 3. The record, once the map is there
    record |= {"subject": task.subject, "fingerprint": task.fingerprint, "attempts": task.attempt}
    record |= {"worker": _worker_name(), "total_seconds": time.monotonic() - began}
    write_record(Path(task.folder), record)
    return record


def failure(task: Task, error: BaseException, kind: str | None = None) -> Record:
    """The record of a subject that failed."""
    data = problem(error)  # type: ignore[arg-type]
    data.setdefault("kind", kind or type(error).__name__)
    return {
        **{"outcome": "failed", "command": task.command, "subject": task.subject, "input": task.surface},
        **{"fingerprint": task.fingerprint, "attempts": task.attempt, "error": data},
    }


def _check_version(task: Task) -> None:
    if task.version != __version__:
        raise VersionError(
            f"the worker {_worker_name()} has Authalic {__version__}, but the batch {task.version}: "
            "install the same everywhere"
        )


def _arguments(task: Task) -> dict[str, Any]:
    arguments = dict(task.arguments)
    if arguments.get("areal") is not None:
        arguments["areal"] = Path(arguments["areal"])
    return arguments


def _worker_threads() -> int:
    try:
        from distributed import get_worker

        return int(get_worker().state.nthreads)
    except (ImportError, ValueError):
        return 0


def _worker_name() -> str:
    try:
        from distributed import get_worker

        return str(get_worker().address)
    except (ImportError, ValueError):
        return f"process {os.getpid()}"
