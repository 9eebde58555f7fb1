# SPDX-License-Identifier: MIT OR Apache-2.0
"""Meshes as they are: info, measure."""

import sys
from pathlib import Path

import click

from . import options
from .options import Frame
from .report import show_info

_JSON = click.option("--json", "as_json", is_flag=True, help="Print figures and errors as JSON.")
_FORMAT = click.option("--input-format", type=options.format_names, help="Where the name does not say it.")


@click.command()
@click.argument("surface", type=options.existing_or_stream)
@_FORMAT
@_JSON
def info(surface: Path, input_format: str | None, as_json: bool) -> None:
    """Print what a SURFACE is like, and which maps suit it.

    A surface that no map takes is reported with what is wrong with it; that is no error of this command.
    """
    from ..runs.measure import info_run

    options.check_streams(surface, surface, input_format, "")
    with options.files(surface, Path()) as (source, _):
        record = info_run(source, input_format=input_format)
    show_info(record | ({"input": "-"} if surface == options.STREAM else {}), as_json, sys.stdout)


@click.command()
@click.argument("surface", type=options.existing)
@click.argument("map", type=options.existing, required=False)
@_FORMAT
@click.option("--map-format", type=options.format_names, help="Where the name does not say it.")
@options.areal_option
@_JSON
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
    Frame(as_json, quiet=False, threads=None).show(record, surface)


COMMANDS = (info, measure)
