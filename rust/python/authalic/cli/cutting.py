# SPDX-License-Identifier: MIT OR Apache-2.0
"""Seams and UVs: unwrap, seams."""

from pathlib import Path
from typing import Any

import click

from . import options
from .frame import Frame


@click.command()
@click.argument("surface", type=options.existing_or_stream)
@click.argument("output", type=options.writable_or_stream)
@options.search
@options.packing
@options.common
def unwrap(frame: Frame, surface: Path, output: Path, **arguments: Any) -> None:
    """Unwrap any SURFACE: seams, islands of even areas, packed into the unit square.

    OUTPUT holds the surface with the UVs. Formats with one UV point for each vertex (PLY, GLB, glTF, VTK,
    VTU) split the vertices on seams.
    """
    from ..runs.unwrap import unwrap_run

    frame.run(unwrap_run, surface, output, options=arguments)


@click.command()
@click.argument("surface", type=options.existing_or_stream)
@click.argument("output", type=options.writable_or_stream)
@options.search
@options.common
def seams(frame: Frame, surface: Path, output: Path, **arguments: Any) -> None:
    """Find seams of a SURFACE.

    OUTPUT is a csv with the two vertices of each seam, counted from 0; an npz with the arrays edges and
    island_of; or an OBJ of the surface with the seams as lines.
    """
    from ..runs.unwrap import seams_run

    frame.run(seams_run, surface, output, options=arguments)


COMMANDS = (unwrap, seams)
