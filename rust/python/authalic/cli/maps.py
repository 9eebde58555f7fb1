# SPDX-License-Identifier: MIT OR Apache-2.0
"""Maps: disk, sphere, layout."""

from pathlib import Path
from typing import Any

import click

from ..io import mesh_format
from . import options
from .options import Frame


@click.command()
@click.argument("surface", type=options.existing_or_stream)
@click.argument("output", type=options.writable)
@options.boundary
@options.descent
@options.areal_option
@options.common
def disk(
    surface: Path,
    output: Path,
    areal: Path | None,
    as_json: bool,
    quiet: bool,
    threads: int | None,
    input_format: str | None,
    output_format: str | None,
    **arguments: Any,
) -> None:
    """Map a SURFACE with a boundary to the disk.

    OUTPUT holds the surface with the map as UVs; in a format without UVs (STL, OFF, GIFTI, FreeSurfer) the
    flat map.
    """
    from ..runs.disk import disk_run

    frame = Frame(as_json, quiet, threads)
    options.check_streams(surface, output, input_format, output_format)
    with options.files(surface, output) as (source, target), frame.progress("disk") as progress:
        record = disk_run(
            source,
            target,
            areal=areal,
            input_format=input_format,
            output_format=output_format,
            options=arguments,
            progress=progress,
        )
    frame.show(record, surface, output)


@click.command()
@click.argument("surface", type=options.existing_or_stream)
@click.argument("output", type=options.writable, required=False)
@click.option("--radius", type=float, help="Of the sphere. [default: 100 for FreeSurfer and GIFTI, else 1]")
@click.option(
    "--method",
    type=click.Choice(["gauss_newton", "gradient_descent", "fixed_point"]),
    help="The optimizer. [default: gauss_newton]",
)
@options.fill_holes
@options.descent
@options.areal_option
@options.common
def sphere(
    surface: Path,
    output: Path | None,
    radius: float | None,
    areal: Path | None,
    as_json: bool,
    quiet: bool,
    threads: int | None,
    input_format: str | None,
    output_format: str | None,
    **arguments: Any,
) -> None:
    """Map a closed SURFACE to the sphere.

    OUTPUT has the vertices and faces in the surface's order. By default it lies beside the surface:
    lh.authalic.sphere for lh.white, ball.sphere.obj for ball.obj.
    """
    from ..runs.names import map_output
    from ..runs.sphere import sphere_run

    frame = Frame(as_json, quiet, threads)
    if radius is not None and not 0 < radius < float("inf"):
        raise click.BadParameter("it must be positive", param_hint="--radius")
    if output is None and surface != options.STREAM:
        output_format = mesh_format(surface, output_format or input_format).name
        output = map_output(surface, "sphere", output_format)
    output = output or options.STREAM
    options.check_streams(surface, output, input_format, output_format)
    with options.files(surface, output) as (source, target), frame.progress("sphere") as progress:
        record = sphere_run(
            source,
            target,
            areal=areal,
            radius=radius,
            input_format=input_format,
            output_format=output_format,
            options=arguments,
            progress=progress,
        )
    frame.show(record, surface, output)


@click.command()
@click.argument("surface", type=options.existing_or_stream)
@click.argument("output", type=options.writable)
@click.option("--kind", type=click.Choice(["lambert", "octahedral"]), help="[default: lambert]")
@click.option("--pole", type=click.Choice(["x", "y", "z"]), help="The axis through the poles. [default: z]")
@click.option("--seam", type=float, help="Longitude of the seam, in radians. [default: 0]")
@options.descent
@options.common
def layout(
    surface: Path,
    output: Path,
    kind: str | None,
    pole: str | None,
    seam: float | None,
    as_json: bool,
    quiet: bool,
    threads: int | None,
    input_format: str | None,
    output_format: str | None,
    **arguments: Any,
) -> None:
    """Map a closed SURFACE to the sphere, and lay that out flat.

    OUTPUT holds the surface with the layout as UVs, or the layout itself in a format without UVs.
    """
    from ..runs.layout import layout_run

    frame = Frame(as_json, quiet, threads)
    options.check_streams(surface, output, input_format, output_format)
    with options.files(surface, output) as (source, target), frame.progress("layout") as progress:
        record = layout_run(
            source,
            target,
            input_format=input_format,
            output_format=output_format,
            options=arguments,
            layout={"kind": kind, "pole": pole, "seam": seam},
            progress=progress,
        )
    frame.show(record, surface, output)


COMMANDS = (disk, sphere, layout)
