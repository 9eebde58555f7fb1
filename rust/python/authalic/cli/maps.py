# SPDX-License-Identifier: MIT OR Apache-2.0
"""Maps: disk, sphere, layout."""

from pathlib import Path
from typing import Any

import click

from ..io import mesh_format
from . import options
from .frame import STREAM, Frame


@click.command()
@click.argument("surface", type=options.existing_or_stream)
@click.argument("output", type=options.writable_or_stream)
@options.boundary
@options.descent
@options.areal_option
@options.common
def disk(frame: Frame, surface: Path, output: Path, areal: Path | None, **arguments: Any) -> None:
    """Map a SURFACE with a boundary to the disk.

    OUTPUT holds the surface with the map as UVs; in a format without UVs (STL, OFF, GIFTI, FreeSurfer) the
    flat map.
    """
    from ..runs.disk import disk_run

    frame.run(disk_run, surface, output, areal=areal, options=arguments)


@click.command()
@click.argument("surface", type=options.existing_or_stream)
@click.argument("output", type=options.writable_or_stream, required=False)
@click.option("--radius", type=float, help="Of the sphere. [default: 100 for FreeSurfer and GIFTI, else 1]")
@options.closed
@options.descent
@options.areal_option
@options.common
def sphere(
    frame: Frame,
    surface: Path,
    output: Path | None,
    radius: float | None,
    areal: Path | None,
    **arguments: Any,
) -> None:
    """Map a closed SURFACE to the sphere.

    OUTPUT has the vertices and faces in the surface's order. By default it lies beside the surface:
    lh.authalic.sphere for lh.white, ball.sphere.obj for ball.obj.
    """
    from ..runs.names import map_output
    from ..runs.sphere import sphere_run

    if radius is not None and not 0 < radius < float("inf"):
        raise click.BadParameter("it must be positive", param_hint="--radius")
    if output is None and surface != STREAM:
        name = mesh_format(surface, frame.output_format or frame.input_format).name
        frame, output = frame._replace(output_format=name), map_output(surface, "sphere", name)
    frame.run(sphere_run, surface, output or STREAM, areal=areal, radius=radius, options=arguments)


@click.command()
@click.argument("surface", type=options.existing_or_stream)
@click.argument("output", type=options.writable_or_stream)
@click.option("--kind", type=click.Choice(["lambert", "octahedral"]), help="[default: lambert]")
@click.option("--pole", type=click.Choice(["x", "y", "z"]), help="The axis through the poles. [default: z]")
@click.option("--seam", type=float, help="Longitude of the seam, in radians. [default: 0]")
@options.descent
@options.common
def layout(
    frame: Frame,
    surface: Path,
    output: Path,
    kind: str | None,
    pole: str | None,
    seam: float | None,
    **arguments: Any,
) -> None:
    """Map a closed SURFACE to the sphere, and lay that out flat.

    OUTPUT holds the surface with the layout as UVs, or the layout itself in a format without UVs.
    """
    from ..runs.layout import layout_run

    chosen = {"kind": kind, "pole": pole, "seam": seam}
    frame.run(layout_run, surface, output, options=arguments, layout=chosen)


COMMANDS = (disk, sphere, layout)
