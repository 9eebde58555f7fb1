# SPDX-License-Identifier: MIT OR Apache-2.0
"""Many surfaces: batch."""

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..io import strict_json
from . import options
from .frame import Frame
from .options import Command
from .report import Exit, in_command_words

if TYPE_CHECKING:
    from ..batch import Summary

_SIZE = re.compile(r"(\d+(?:\.\d+)?) ?([KMGT]?)B?", re.IGNORECASE)
_POWERS = {"": 0, "K": 1, "M": 2, "G": 3, "T": 4}
_SHOWN = 20
"""Failures that are listed; the table has them all."""

folder = click.Path(file_okay=False, path_type=Path)
place = click.Path(exists=True, path_type=Path)


def _size(context: click.Context, option: click.Parameter, value: str | None) -> int | None:
    """The bytes of a size such as 4GB."""
    if value is None:
        return None
    match = _SIZE.fullmatch(value.strip())
    if match is None:
        raise click.BadParameter(f"{value} is no size; write for example 4GB", context, option)
    return int(float(match[1]) * 1000 ** _POWERS[match[2].upper()])


def _shared(command: Command) -> Command:
    """Options of every batch."""
    return options.decorated(
        command,
        click.option("--out", required=True, type=folder, help="The folder of the batch."),
        click.option("--pattern", help="Names of files in folders, such as '*.pial'."),
        click.option("--scheduler", help="Address of a Dask scheduler, such as tcp://host:8786."),
        click.option("--workers", type=click.IntRange(1, 10_000), help="Processes on this machine."),
        click.option("--memory", callback=_size, help="Of each process on this machine, such as 4GB."),
        click.option(
            "--retries", type=click.IntRange(0, 10_000), default=2, show_default=True, help="After failures."
        ),
        click.option("--again", is_flag=True, help="Map also what is done."),
        options.common,
    )


_AREAL = click.option("--areal", is_flag=True, help="Also write log2 of each vertex's areal distortion.")
_PLACES = click.argument("surfaces", nargs=-1, required=True, type=place)


@click.group()
def batch() -> None:
    """Map many surfaces, on this machine or on a Dask cluster.

    SURFACES are files, folders, and tables (csv with the columns subject and surface). The folder --out gets
    the maps, a record of each subject, and figures.parquet. A batch that was stopped goes on where it was
    when it is run again.
    """


@batch.command()
@_PLACES
@options.closed
@options.descent
@_AREAL
@_shared
def sphere(frame: Frame, surfaces: tuple[Path, ...], **given: Any) -> int:
    """Map closed SURFACES to the sphere."""
    return _run(frame, "sphere", surfaces, **given)


@batch.command()
@_PLACES
@options.boundary
@options.descent
@_AREAL
@_shared
def disk(frame: Frame, surfaces: tuple[Path, ...], **given: Any) -> int:
    """Map SURFACES with a boundary to the disk."""
    return _run(frame, "disk", surfaces, **given)


@batch.command()
@_PLACES
@options.search
@options.packing
@_shared
def unwrap(frame: Frame, surfaces: tuple[Path, ...], **given: Any) -> int:
    """Unwrap any SURFACES."""
    return _run(frame, "unwrap", surfaces, **given)


def _run(
    frame: Frame,
    command: str,
    surfaces: tuple[Path, ...],
    *,
    out: Path,
    pattern: str | None,
    scheduler: str | None,
    workers: int | None,
    memory: int | None,
    retries: int,
    again: bool,
    areal: bool = False,
    **arguments: Any,
) -> int:
    from ..batch import find_subjects, run_batch

    with frame.progress(f"batch {command}") as progress:
        summary = run_batch(
            find_subjects(surfaces, pattern),
            out,
            command,
            options=arguments,
            input_format=frame.input_format,
            output_format=frame.output_format,
            areal=areal,
            scheduler=scheduler,
            workers=workers,
            threads=frame.threads,
            memory=memory,
            retries=retries,
            again=again,
            progress=progress,
            announce=progress.announce,
        )
    _show(summary, frame)
    return Exit.SUBJECTS if summary.failed else Exit.DONE


def _show(summary: "Summary", frame: Frame) -> None:
    if frame.as_json:
        print(strict_json.dumps(summary.as_dict()))
        return
    for record in summary.failed[:_SHOWN]:
        error = record["error"]
        message = in_command_words(error["message"])
        print(f"authalic: failed: {record['subject']}: {error['kind']}: {message}", file=sys.stderr)
    if len(summary.failed) > _SHOWN:
        print(f"authalic: failed: {len(summary.failed) - _SHOWN} more, see the table", file=sys.stderr)
    if not frame.quiet:
        print(f"{summary.done} done, {summary.before} done before, {len(summary.failed)} failed")
        print(f"  {summary.table}")


COMMANDS = (batch,)
