# SPDX-License-Identifier: MIT OR Apache-2.0
"""The commands together, and how each of them ends."""

import contextlib
import io
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from types import FrameType

import click

from .._native import __version__
from . import batch, cutting, maps, meshes, registering
from .report import Exit, show_error, show_usage_error


class _Terminated(BaseException):
    """SIGTERM or SIGHUP."""


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="authalic", message="%(prog)s %(version)s")
def authalic() -> None:
    """Area-preserving maps of triangle meshes, from files to files.

    Formats: OBJ, PLY, STL, OFF, GLB, glTF, VTK, VTU, npz, GIFTI and FreeSurfer's, known by the files' names.
    Errors go to stderr with the elements at fault. No file is half written.
    """


for group in (maps.COMMANDS, cutting.COMMANDS, registering.COMMANDS, meshes.COMMANDS, batch.COMMANDS):
    for command in group:
        authalic.add_command(command)


def run(arguments: Sequence[str]) -> int:
    """Runs a command; returns its exit code, whatever happens."""
    as_json = "--json" in arguments
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # no name of a file and no σ is an error, whatever the encoding of the terminal or pipe
            stream.reconfigure(errors="backslashreplace")
    try:
        # click's own main would end the process on a broken pipe
        with _termination_raises(), authalic.make_context("authalic", list(arguments)) as context:
            result = authalic.invoke(context)
        sys.stdout.flush()
        return int(result) if isinstance(result, int) else Exit.DONE
    except click.exceptions.Exit as end:
        return end.exit_code
    except click.ClickException as error:
        return show_usage_error(error, as_json)
    except (KeyboardInterrupt, click.Abort):
        print("authalic: interrupted; nothing was left half written", file=sys.stderr)
        return Exit.INTERRUPTED
    except _Terminated:
        return Exit.TERMINATED
    except BrokenPipeError:
        # who read the output has gone; Python must not try to flush it again
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return Exit.DONE
    except Exception as error:
        return show_error(error, as_json)


@contextlib.contextmanager
def _termination_raises() -> Iterator[None]:
    """Lets SIGTERM and SIGHUP end the process as Ctrl-C does, so that temporary files are removed."""

    def end(number: int, frame: FrameType | None) -> None:
        raise _Terminated

    names = ("SIGTERM", "SIGHUP")
    numbers = [getattr(signal, name) for name in names if hasattr(signal, name)]
    try:
        before = {number: signal.signal(number, end) for number in numbers}
    except ValueError:  # not the main thread
        before = {}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
