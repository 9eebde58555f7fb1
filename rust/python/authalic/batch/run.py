# SPDX-License-Identifier: MIT OR Apache-2.0
"""A batch: every subject to its map, and all figures into one table."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from .._native import __version__
from ..io import mesh_format
from ..io.atomic import remove_leftovers
from ..io.errors import require
from ..runs.names import areal_output, map_output
from ..runs.record import Record, given
from .cluster import connected, native_threads
from .errors import SubjectsError
from .memory import estimate
from .options import check_options
from .schedule import Schedule
from .store import is_done, make_folder, map_place, read_records, remove_record, write_table
from .subjects import Subject
from .task import Task

OUTPUT_FORMATS = {"sphere": None, "disk": "obj", "unwrap": "obj"}
"""What maps are written as; None: as the surface."""


@dataclass
class Summary:
    """How a batch ended.

    Parameters
    ----------
    subjects : int
        All subjects of this run.
    before : int
        Those that were done before.
    done : int
        Those that were done now.
    failed : list of dict
        The records of those that failed.
    table : str
        The file with the figures of all subjects of the folder.
    """

    subjects: int
    before: int = 0
    done: int = 0
    failed: list[Record] = field(default_factory=list)
    table: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Return the fields as a dictionary that fits into JSON.

        Returns
        -------
        dict
            The fields by name.

        Examples
        --------
        >>> from authalic.batch import Summary
        >>> summary = Summary(subjects=3, done=3)
        >>> summary.as_dict()["done"]
        3
        """
        return asdict(self)


def run_batch(
    subjects: Sequence[Subject],
    folder: str | Path,
    command: str = "sphere",
    *,
    options: Mapping[str, Any] | None = None,
    input_format: str | None = None,
    output_format: str | None = None,
    areal: bool = False,
    scheduler: str | None = None,
    workers: int | None = None,
    threads: int | None = None,
    memory: int | None = None,
    retries: int = 2,
    again: bool = False,
    progress: Callable[[float, str], object] | None = None,
    announce: Callable[[str], object] | None = None,
) -> Summary:
    """Map every subject of a batch, and write their figures into one table.

    Subjects that are done, from the same file with the same options and version, are left as they are.

    Parameters
    ----------
    subjects : sequence of Subject
        The surfaces.
    folder : str or Path
        The batch's folder; it is made if there is none. On a cluster every worker must see it, and the
        surfaces, under the same path.
    command : {"sphere", "disk", "unwrap"}
        The map.
    options : mapping, optional
        Arguments of `authalic.sphere_map`, `authalic.disk_map` or `authalic.unwrap`.
    input_format, output_format : str, optional
        Names of formats. Default: by the files' names; spheres as their surfaces, other maps as OBJ.
    areal : bool
        Also write log₂ of each vertex's areal distortion: a curv file, GIFTI or npy, as the map's format. Not
        for "unwrap", whose vertices on seams have none.
    scheduler : str, optional
        The address of a Dask scheduler. Default: a cluster of processes on this machine.
    workers : int, optional
        Number of processes on this machine. Default: one per processor, but no more than memory allows.
    threads : int, optional
        Native threads of each worker. Default: the processors of this machine shared out; elsewhere those of
        a worker.
    memory : int, optional
        Bytes of each process on this machine. Default: 90 % of the memory shared out.
    retries : int
        How often a subject is tried again after an exception or after its worker was killed. What is wrong
        with a surface is reported at once.
    again : bool
        Map all subjects again.
    progress : callable, optional
        Called with the share that is done and a text.
    announce : callable, optional
        Called with the address of Dask's dashboard.

    Returns
    -------
    Summary
        Counts, failures and the table.

    Raises
    ------
    SubjectsError
        If two subjects would write the same file.
    ValueError, TypeError
        If an option is wrong for every subject.
    SchedulerError
        If the scheduler cannot be reached, or has no workers for two minutes. What is done stays.
    MissingExtra
        Without `authalic[batch]`.

    Examples
    --------
    >>> import pathlib, tempfile, authalic.io
    >>> from authalic.batch import find_subjects, run_batch
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    >>> mesh = authalic.io.MeshData(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]])
    >>> authalic.io.write_mesh(folder / "simplex.obj", mesh)
    >>> run_batch(find_subjects([folder]), folder / "out", workers=1).done  # doctest: +SKIP
    1
    """
    # 1. What is needed, before work starts
    require("distributed", "a batch", "batch")
    require("pyarrow.parquet", "the table of figures", "batch")
    folder = Path(folder).resolve()
    check_options(command, given(options or {}))
    tasks = _tasks(subjects, folder, command, given(options or {}), input_format, output_format, areal)
    # 2. What is done
    make_folder(folder)
    remove_leftovers(folder)
    records = read_records(folder)
    missing = [task for task in tasks if again or not _is_done(task, records)]
    summary = Summary(len(tasks), before=len(tasks) - len(missing))
    # 3. What is missing
    for task in missing:
        remove_record(folder, task.subject)
        records.pop(task.subject, None)
    try:
        if missing:
            tracked = _Tracked(summary, records, progress)
            _run(missing, _Where(scheduler, workers, threads, memory), retries, tracked, announce)
    except BaseException:
        # workers may have written records that were not collected
        records |= read_records(folder)
        raise
    finally:
        # 4. The table, also of a run that is interrupted
        if scheduler is None:
            remove_leftovers(folder)
        summary.table = str(write_table(folder, records.values()))
    return summary


def _is_done(task: Task, records: Mapping[str, Record]) -> bool:
    return is_done(records.get(task.subject), task.fingerprint, task.output)


class _Tracked:
    """Counts records, keeps them, and tells how far the batch is."""

    def __init__(
        self, summary: Summary, records: dict[str, Record], progress: Callable[[float, str], object] | None
    ) -> None:
        self._summary, self._records, self._progress = summary, records, progress

    def __call__(self, record: Record) -> None:
        summary = self._summary
        self._records[record["subject"]] = record
        if record["outcome"] == "done":
            summary.done += 1
        else:
            summary.failed.append(record)
        if self._progress is not None:
            ended = summary.before + summary.done + len(summary.failed)
            failed = f", {len(summary.failed)} failed" if summary.failed else ""
            self._progress(ended / summary.subjects, f"{ended} of {summary.subjects} subjects{failed}")


class _Where(NamedTuple):
    """Arguments of `run_batch` that say where it runs."""

    scheduler: str | None
    workers: int | None
    threads: int | None
    memory: int | None


def _run(
    tasks: list[Task],
    where: _Where,
    retries: int,
    tracked: _Tracked,
    announce: Callable[[str], object] | None,
) -> None:
    largest = max(task.memory for task in tasks)
    workers = None if where.workers is None else min(where.workers, len(tasks))
    with connected(where.scheduler, workers, where.memory, largest) as client:
        if announce is not None:
            announce(client.dashboard_link)
        threads = where.threads
        if threads is None and where.scheduler is None:
            threads = native_threads(len(client.scheduler_info(n_workers=-1)["workers"]))
        tasks = [replace(task, threads=threads) for task in tasks]
        Schedule(client, tasks, retries, tracked).run()


def _tasks(
    subjects: Sequence[Subject],
    folder: Path,
    command: str,
    options: dict[str, Any],
    input_format: str | None,
    output_format: str | None,
    areal: bool,
) -> list[Task]:
    if areal and command == "unwrap":
        raise ValueError("areal is not for unwrap: vertices on seams have no single areal distortion")
    tasks = []
    for subject in subjects:
        surface = Path(subject.surface)
        format = output_format or OUTPUT_FORMATS[command] or mesh_format(surface, input_format).name
        output = map_output(map_place(folder, subject.name, surface), command, format)
        arguments: dict[str, Any] = {
            "options": options,
            "input_format": input_format,
            "output_format": format,
        }
        fingerprint = _fingerprint(surface, command, arguments | {"areal": areal})
        if areal:
            arguments["areal"] = str(areal_output(output, format))
        tasks.append(
            Task(
                subject=subject.name,
                surface=str(surface),
                output=str(output),
                folder=str(folder),
                command=command,
                arguments=arguments,
                fingerprint=fingerprint,
                memory=estimate(surface, input_format),
            )
        )
    _check_outputs(tasks)
    return tasks


def _fingerprint(surface: Path, command: str, arguments: dict[str, Any]) -> str:
    """What the result depends on, without reading the surface."""
    try:
        state = surface.stat()
        seen = [state.st_size, state.st_mtime_ns]
    except OSError:
        seen = []
    return json.dumps([__version__, command, seen, arguments], sort_keys=True)


def _check_outputs(tasks: list[Task]) -> None:
    seen: dict[str, str] = {}
    for task in tasks:
        if task.output in seen:
            raise SubjectsError(
                f"{seen[task.output]} and {task.subject} would both be written to {task.output}; "
                "choose the files of each subject by a pattern, such as '*.white'"
            )
        seen[task.output] = task.subject
