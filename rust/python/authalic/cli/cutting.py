# SPDX-License-Identifier: MIT OR Apache-2.0
"""Seams and UVs: unwrap, seams."""

from pathlib import Path
from typing import Any

import click

from . import options
from .options import Frame


@click.command()
@click.argument("surface", type=options.existing_or_stream)
@click.argument("output", type=options.writable)
@options.search
@click.option("--margin", type=float, help="Between islands, in units of the square. [default: 0.002]")
@click.option("--no-pack", is_flag=True, help="Leave each island where its map lies.")
@options.common
def unwrap(
    surface: Path,
    output: Path,
    no_pack: bool,
    as_json: bool,
    quiet: bool,
    threads: int | None,
    input_format: str | None,
    output_format: str | None,
    **arguments: Any,
) -> None:
    """Unwrap any SURFACE: seams, islands of even areas, packed into the unit square.

    OUTPUT holds the surface with the UVs. Formats with one UV point for each vertex (PLY, GLB, glTF, VTK,
    VTU) split the vertices on seams.
    """
    from ..runs.unwrap import unwrap_run

    frame = Frame(as_json, quiet, threads)
    options.check_streams(surface, output, input_format, output_format)
    with options.files(surface, output) as (source, target), frame.progress("unwrap") as progress:
        record = unwrap_run(
            source,
            target,
            input_format=input_format,
            output_format=output_format,
            options=arguments | {"pack": False if no_pack else None},
            progress=progress,
        )
    frame.show(record, surface, output)


@click.command()
@click.argument("surface", type=options.existing)
@click.argument("output", type=options.writable_file)
@options.search
@options.common
def seams(
    surface: Path,
    output: Path,
    as_json: bool,
    quiet: bool,
    threads: int | None,
    input_format: str | None,
    output_format: str | None,
    **arguments: Any,
) -> None:
    """Find seams of a SURFACE.

    OUTPUT is a csv with the two vertices of each seam, counted from 0; an npz with the arrays edges and
    island_of; or an OBJ of the surface with the seams as lines.
    """
    from ..runs.unwrap import seams_run

    frame = Frame(as_json, quiet, threads)
    with frame.progress("seams") as progress:
        record = seams_run(
            surface,
            output,
            input_format=input_format,
            output_format=output_format,
            options=arguments,
            progress=progress,
        )
    frame.show(record, surface, output)


COMMANDS = (unwrap, seams)
