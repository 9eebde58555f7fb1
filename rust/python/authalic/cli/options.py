# SPDX-License-Identifier: MIT OR Apache-2.0
"""Options that commands share, and the frame around a run."""

import contextlib
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import click

from ..io import MESH_FORMATS
from .progress import ProgressBar
from .report import show_notes, show_record

Command = TypeVar("Command", bound=Callable[..., Any])

STREAM = Path("-")
format_names = click.Choice([format.name for format in MESH_FORMATS])
existing_or_stream = click.Path(exists=True, dir_okay=False, allow_dash=True, path_type=Path)
existing = click.Path(exists=True, dir_okay=False, path_type=Path)
writable = click.Path(dir_okay=False, allow_dash=True, path_type=Path)
writable_file = click.Path(dir_okay=False, path_type=Path)


def common(command: Command) -> Command:
    """--json, --quiet, --threads, --input-format, --output-format."""
    options = (
        click.option("--json", "as_json", is_flag=True, help="Print figures and errors as JSON."),
        click.option("--quiet", "-q", is_flag=True, help="Print errors only."),
        click.option("--threads", type=click.IntRange(0), help="Number of threads. 0: one per processor."),
        click.option("--input-format", type=format_names, help="Where the name does not say it."),
        click.option("--output-format", type=format_names, help="Where the name does not say it."),
    )
    return _all(options, command)


def descent(command: Command) -> Command:
    """Options of disk and sphere maps alike."""
    options = (
        click.option("--angle-weight", type=float, help="Trade-off: 0 preserves areas, 1 preserves angles."),
        click.option(
            "--area-tolerance", type=float, help="Least shear with areas within this, such as 0.01."
        ),
        click.option("--max-iterations", type=click.IntRange(0), help="Iteration limit."),
        click.option("--tolerance", type=float, help="Area deviation below which the map has converged."),
        click.option(
            "--repair", is_flag=True, default=None, help="Repair first; the map is of the repaired mesh."
        ),
    )
    return _all(options, command)


fill_holes = click.option(
    "--fill-holes", is_flag=True, default=None, help="Fill holes virtually: their areas do not count."
)


def boundary(command: Command) -> Command:
    """Options of disk maps."""
    options = (
        click.option(
            "--boundary",
            type=click.Choice(["sliding", "arc_length", "free", "rectangle"]),
            help="Where the boundary goes. [default: sliding]",
        ),
        click.option("--aspect", type=float, help="Width over height of the rectangle."),
        fill_holes,
        click.option("--overlap", is_flag=True, default=None, help="A free outline may cross itself."),
    )
    return _all(options, command)


def search(command: Command) -> Command:
    """Options of the search for seams."""
    options = (
        click.option("--target", type=float, help="Shear wanted; less takes longer seams. [default: 1.4]"),
        click.option("--symmetry", type=click.Choice(["auto", "off"]), help="[default: auto]"),
        click.option("--max-islands", type=click.IntRange(1), help="Limit of the number of islands."),
        click.option("--overlap", is_flag=True, default=None, help="Islands may overlap themselves."),
    )
    return _all(options, command)


areal_option = click.option(
    "--areal",
    type=writable_file,
    help="Write log2 of each vertex's areal distortion (.shape.gii, curv, npy, csv).",
)


class Frame:
    """Options that are not a run's own: threads, progress, and what is printed at the end."""

    def __init__(self, as_json: bool, quiet: bool, threads: int | None) -> None:
        self.as_json, self.quiet = as_json, quiet
        if threads is not None:
            from .._native import set_threads

            set_threads(threads)

    def progress(self, title: str) -> ProgressBar:
        return ProgressBar(title, self.quiet or self.as_json)

    def show(self, record: dict[str, Any], source: Path, output: Path | None = None) -> None:
        """The record on stdout, or on stderr if the mesh went to stdout."""
        streams = {"input": source, "output": output}
        record = record | {key: "-" for key, path in streams.items() if path == STREAM}
        stream = sys.stderr if output == STREAM else sys.stdout
        if self.as_json or not self.quiet:
            show_record(record, self.as_json, stream)
        if not self.as_json and not self.quiet:
            show_notes(record)


@contextlib.contextmanager
def files(source: Path, output: Path) -> Iterator[tuple[Path, Path]]:
    """The paths to read and to write, where `-` stands for stdin and stdout."""
    if STREAM not in (source, output):
        yield source, output
        return
    import tempfile

    with tempfile.TemporaryDirectory(prefix="authalic-") as folder:
        if source == STREAM:
            source = Path(folder) / "stdin"
            source.write_bytes(sys.stdin.buffer.read())
        place = Path(folder) / "stdout" if output == STREAM else output
        yield source, place
        if output == STREAM:
            sys.stdout.buffer.write(place.read_bytes())
            sys.stdout.buffer.flush()


def check_streams(source: Path, output: Path, input_format: str | None, output_format: str | None) -> None:
    """Streams have no names that say their format."""
    if source == STREAM and input_format is None:
        raise click.UsageError("name the format of stdin with --input-format")
    if output == STREAM and output_format is None:
        raise click.UsageError("name the format of stdout with --output-format")


def _all(options: tuple[Callable[[Command], Command], ...], command: Command) -> Command:
    for option in reversed(options):
        command = option(command)
    return command
