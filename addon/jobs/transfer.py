# SPDX-License-Identifier: GPL-3.0-or-later
"""The transfer of layers from a target to one or several objects, through their registrations.

One object that cannot have them does not keep the others from getting theirs.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from .. import messages
from ..blender.types import MeshObject
from ..bridge.progress import Progress
from ..landmarks import objects
from . import couple, targets
from .couple import CannotRegister
from .job import Job
from .transfer_layers import Carried, Report, Settings, Task, carried, prepared, written

__all__ = ("Report", "Reports", "Settings", "job")


@dataclass
class Reports:
    """A report for each object that got layers, and a line for each that did not."""

    reports: list[Report]
    failures: list[str]


Computed = list[Carried | Exception]
"""What was carried to each object, or why nothing was."""


def job(context: bpy.types.Context, settings: Settings) -> Job[Computed, Reports]:
    """A `Job` that transfers to the active object and to selected objects with the same target.

    Its `apply` writes the layers and returns `Reports`. Raises `targets.NothingToDo` or `CannotRegister`
    before anything is computed, and later if no object can have anything.
    """
    started = time.perf_counter()
    tasks: list[Task] = []
    failures: list[Exception] = []
    sources: list[MeshObject | None] = [*objects.sources(context)]
    feature = settings.registration.feature if settings.registration is not None else ""
    for source in sources or [None]:
        try:
            tasks.append(prepared(couple.of_source(source, feature), settings))
        except (CannotRegister, targets.NothingToDo) as problem:
            failures.append(problem)
    if not tasks:
        raise _all_of(failures)

    def work(progress: Progress) -> Computed:
        return [_attempted(task, _part(progress, number, len(tasks))) for number, task in enumerate(tasks)]

    def finish(computed: Computed) -> Reports:
        reports, problems = [], list(failures)
        for task, values in zip(tasks, computed, strict=True):
            try:
                if isinstance(values, Exception):
                    raise values
                reports.append(written(task, values))
            except CannotRegister as problem:
                problems.append(problem)
        if not reports:
            raise _all_of(problems)
        reports[-1].seconds = time.perf_counter() - started
        return Reports(reports, [str(problem) for problem in problems])

    return Job(work, finish)


def _attempted(task: Task, progress: Progress) -> Carried | Exception:
    try:
        return carried(task, progress)
    except CannotRegister as problem:
        return problem


def _part(progress: Progress, number: int, count: int) -> Progress:
    """The progress of one of several tasks as that of all."""
    return lambda fraction, message: progress((number + fraction) / count, message)


def _all_of(problems: Sequence[Exception]) -> Exception:
    """One exception for several."""
    if len(problems) == 1:
        return problems[0]
    return CannotRegister(messages.listed(problems))
