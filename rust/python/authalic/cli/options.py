# SPDX-License-Identifier: MIT OR Apache-2.0
"""Options that commands share."""

import functools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from ..io import MESH_FORMATS
from .frame import Frame

Command = Callable[..., Any]

_MOST_THREADS = 1024
"""The core starts no more."""

MOST = 2**31 - 1
"""Of other numbers that are options: far beyond any use, and within what the library takes."""

format_names = click.Choice([format.name for format in MESH_FORMATS])
existing_or_stream = click.Path(exists=True, dir_okay=False, allow_dash=True, path_type=Path)
existing = click.Path(exists=True, dir_okay=False, path_type=Path)
writable_or_stream = click.Path(dir_okay=False, allow_dash=True, path_type=Path)
writable = click.Path(dir_okay=False, path_type=Path)
as_json = click.option("--json", "as_json", is_flag=True, help="Print figures and errors as JSON.")
input_format = click.option("--input-format", type=format_names, help="Where the name does not say it.")


def common(command: Command) -> Command:
    """--json, --quiet, --threads, --input-format, --output-format: the command takes them as a frame."""

    @functools.wraps(command)
    def framed(**given: Any) -> Any:
        return command(Frame(**{name: given.pop(name) for name in Frame._fields}), **given)

    return decorated(
        framed,
        as_json,
        click.option("--quiet", "-q", is_flag=True, help="Print errors only."),
        click.option(
            "--threads",
            type=click.IntRange(0, _MOST_THREADS),
            help="Number of threads. 0: one per processor.",
        ),
        input_format,
        click.option("--output-format", type=format_names, help="Where the name does not say it."),
    )


def descent(command: Command) -> Command:
    """Options of disk and sphere maps alike."""
    return decorated(
        command,
        click.option("--angle-weight", type=float, help="Trade-off: 0 preserves areas, 1 preserves angles."),
        click.option(
            "--area-tolerance", type=float, help="Least shear with areas within this, such as 0.01."
        ),
        click.option("--max-iterations", type=click.IntRange(0, MOST), help="Iteration limit."),
        click.option("--tolerance", type=float, help="Area deviation below which the map has converged."),
        click.option(
            "--repair", is_flag=True, default=None, help="Repair first; the map is of the repaired mesh."
        ),
    )


fill_holes = click.option(
    "--fill-holes", is_flag=True, default=None, help="Fill holes virtually: their areas do not count."
)


def closed(command: Command) -> Command:
    """Options of sphere maps."""
    return decorated(
        command,
        click.option(
            "--method",
            type=click.Choice(["gauss_newton", "gradient_descent", "fixed_point"]),
            help="The optimizer. [default: gauss_newton]",
        ),
        fill_holes,
    )


def boundary(command: Command) -> Command:
    """Options of disk maps."""
    return decorated(
        command,
        click.option(
            "--boundary",
            type=click.Choice(["sliding", "arc_length", "free", "rectangle"]),
            help="Where the boundary goes. [default: sliding]",
        ),
        click.option("--aspect", type=float, help="Width over height of the rectangle."),
        fill_holes,
        click.option("--overlap", is_flag=True, default=None, help="A free outline may cross itself."),
    )


def search(command: Command) -> Command:
    """Options of the search for seams."""
    return decorated(
        command,
        click.option("--target", type=float, help="Shear wanted; less takes longer seams. [default: 1.4]"),
        click.option("--symmetry", type=click.Choice(["auto", "off"]), help="[default: auto]"),
        click.option("--max-islands", type=click.IntRange(1, MOST), help="Limit of the number of islands."),
        click.option("--overlap", is_flag=True, default=None, help="Islands may overlap themselves."),
    )


def packing(command: Command) -> Command:
    """Where islands lie."""
    return decorated(
        command,
        click.option(
            "--margin", type=float, help="Between islands, in units of the square. [default: 0.002]"
        ),
        click.option(
            "--no-pack", "pack", flag_value=False, default=None, help="Leave each island where its map lies."
        ),
    )


areal_option = click.option(
    "--areal",
    type=writable,
    help="Write log2 of each vertex's areal distortion (.shape.gii, curv, npy, csv).",
)


def decorated(command: Command, *decorators: Callable[[Command], Command]) -> Command:
    """A command with decorators, the first of them outermost."""
    for decorator in reversed(decorators):
        command = decorator(command)
    return command
