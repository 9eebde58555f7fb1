# SPDX-License-Identifier: MIT OR Apache-2.0
"""The frame around a run: its files or streams, threads, progress, and what is printed at the end."""

import contextlib
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import click

from .progress import ProgressBar
from .report import show_notes, show_record

STREAM = Path("-")
"""stdin or stdout in the place of a file."""


class Frame(NamedTuple):
    """The options that all runs share."""

    as_json: bool = False
    quiet: bool = False
    threads: int | None = None
    input_format: str | None = None
    output_format: str | None = None

    def run(self, run: Callable[..., dict[str, Any]], source: Path, output: Path, **arguments: Any) -> None:
        """Runs from a file to a file, and prints the record.

        Parameters
        ----------
        run : callable
            One of `authalic.runs`, by the name of its command with _run behind it.
        source, output : Path
            What it reads and writes; `STREAM` stands for stdin and stdout.
        **arguments
            Its further arguments.
        """
        if self.threads is not None:
            from .._native import set_threads

            set_threads(self.threads)
        title = run.__name__.removesuffix("_run")
        with (
            written_file(output, self.output_format) as to_file,
            read_file(source, self.input_format) as from_file,
            self.progress(title) as progress,
        ):
            formats = {"input_format": self.input_format, "output_format": self.output_format}
            record = run(from_file, to_file, progress=progress, **formats, **arguments)
        self.show(record, source, output)

    def progress(self, title: str) -> ProgressBar:
        return ProgressBar(title, self.quiet or self.as_json)

    def show(self, record: dict[str, Any], source: Path, output: Path | None = None) -> None:
        """The record on stdout, or on stderr if the mesh went to stdout."""
        named = {"input": source, "output": output}  # not the copies of streams
        record = record | {key: str(path) for key, path in named.items() if path is not None}
        stream = sys.stderr if output == STREAM else sys.stdout
        if self.as_json or not self.quiet:
            show_record(record, self.as_json, stream)
        if not self.as_json and not self.quiet:
            show_notes(record)


@contextlib.contextmanager
def read_file(path: Path, format: str | None) -> Iterator[Path]:
    """The file to read: a copy of what cannot be read twice, stdin or a pipe with a name."""
    if path != STREAM and path.is_file():
        yield path
        return
    if format is None:
        name = "stdin" if path == STREAM else f"the pipe {path}"
        raise click.UsageError(f"name the format of {name} with --input-format")
    with _scratch() as folder:
        (folder / "stdin").write_bytes(sys.stdin.buffer.read() if path == STREAM else path.read_bytes())
        yield folder / "stdin"


@contextlib.contextmanager
def written_file(path: Path, format: str | None) -> Iterator[Path]:
    """The file to write, which then goes to stdout if that is meant."""
    if path != STREAM:
        yield path
        return
    if format is None:
        raise click.UsageError("name the format of stdout with --output-format")
    with _scratch() as folder:
        yield folder / "stdout"
        sys.stdout.buffer.write((folder / "stdout").read_bytes())
        sys.stdout.buffer.flush()


@contextlib.contextmanager
def _scratch() -> Iterator[Path]:
    import tempfile  # takes longer to load than the rest of the command

    with tempfile.TemporaryDirectory(prefix="authalic-") as folder:
        yield Path(folder)
