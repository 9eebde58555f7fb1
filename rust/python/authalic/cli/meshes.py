# SPDX-License-Identifier: MIT OR Apache-2.0
"""Meshes: info, measure, repair."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from . import options
from .frame import Frame, read_file
from .report import show_info


@click.command()
@click.argument("surface", type=options.existing_or_stream)
@options.input_format
@options.as_json
def info(surface: Path, input_format: str | None, as_json: bool) -> None:
    """Print what a SURFACE is like, and which maps suit it.

    A surface that no map takes is reported with what is wrong with it; that is no error of this command. Of a
    result that was saved in Python: its function, options, versions, and the SHA-256 of its input.
    """
    from ..runs.measure import info_run

    with read_file(surface, input_format) as source:
        record = info_run(source, input_format=input_format)
    show_info(record | {"input": str(surface)}, as_json, sys.stdout)


@click.command()
@click.argument("surface", type=options.existing)
@click.argument("map", type=options.existing, required=False)
@options.input_format
@click.option("--map-format", type=options.format_names, help="Where the name does not say it.")
@options.areal_option
@options.as_json
def measure(
    surface: Path,
    map: Path | None,
    input_format: str | None,
    map_format: str | None,
    areal: Path | None,
    as_json: bool,
) -> None:
    """Measure a map of a SURFACE, from any tool.

    MAP is a mesh with the same faces: a sphere, a flat mesh at z = 0, or one whose UVs are the map. Without
    it the UVs of SURFACE are measured.
    """
    from ..runs.measure import measure_run

    record = measure_run(surface, map, areal=areal, input_format=input_format, image_format=map_format)
    Frame(as_json).show(record, surface)


def _choice(*words: str) -> Callable[[click.Context, click.Parameter, str | None], Any]:
    """Reads words, and numbers otherwise; all and none stand for True and False."""

    def read(context: click.Context, option: click.Parameter, value: str | None) -> Any:
        if value is None:
            return None
        if value in words:
            return {"all": True, "none": False}.get(value, value)
        try:
            number = float(value) if "." in value or "e" in value else int(value)
        except ValueError as error:
            known = ", ".join(words)
            raise click.BadParameter(f"it is a number or {known}, but is {value}", context, option) from error
        if isinstance(number, int) and abs(number) > options.MOST:
            raise click.BadParameter(f"whole numbers end with {options.MOST}", context, option)
        return number

    return read


@click.command()
@click.argument("surface", type=options.existing_or_stream)
@click.argument("output", type=options.writable_or_stream)
@click.option(
    "--merge",
    callback=_choice("none"),
    help="Merge points of open edges no farther apart than this; none: no points. [default: 0]",
)
@click.option(
    "--close-holes",
    callback=_choice("all", "none", "pinholes"),
    help="all, none, pinholes, or those of at most so many edges. [default: pinholes]",
)
@click.option("--keep-outline", is_flag=True, default=None, help="Leave the longest loop of each piece open.")
@click.option(
    "--close-handles",
    callback=_choice("all", "none", "noise"),
    help="all, none, noise, or those that a loop of at most this length opens. [default: none]",
)
@click.option("--keep", type=click.Choice(["all", "largest"]), help="The pieces to keep. [default: all]")
@options.common
def repair(frame: Frame, surface: Path, output: Path, merge: Any, **arguments: Any) -> None:
    """Make a surface that can be mapped out of any triangles.

    Equal points are merged, bad faces removed, edges of many faces split, faces oriented, pinholes closed.
    UVs are not kept.
    """
    from ..runs.record import given
    from ..runs.repair import repair_run

    chosen = given(arguments)
    if merge is not None:
        chosen["merge"] = None if merge is False else merge
    frame.run(repair_run, surface, output, options=chosen)


COMMANDS = (info, measure, repair)
