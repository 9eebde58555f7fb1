# SPDX-License-Identifier: MIT OR Apache-2.0
"""One surface onto another: register."""

from pathlib import Path
from typing import Any

import click

from . import options
from .frame import Frame


@click.command()
@click.argument("source", type=options.existing)
@click.argument("target", type=options.existing)
@click.argument("output", type=options.writable_or_stream)
@click.option(
    "--landmarks",
    type=options.existing,
    help="Text: a vertex of SOURCE and one of TARGET in each row, counted from 0; a third column has the "
    "weights of soft pairs, inf for exact ones.",
)
@click.option(
    "--curves",
    type=options.existing,
    help='JSON: {"source": [[vertices], ...], "target": [[vertices], ...]}; a registration by curves.',
)
@click.option(
    "--features",
    type=(options.existing, options.existing),
    default=None,
    help="Values at the vertices of SOURCE and of TARGET to be laid over each other.",
)
@click.option(
    "--pull",
    type=(options.existing, options.writable),
    default=None,
    help="Values at the vertices of TARGET, and the file for them at those of SOURCE.",
)
@click.option(
    "--energy",
    type=click.Choice(["surface", "area", "harmonic"]),
    help="What is kept: shapes between the surfaces, or the papers' energy.  [default: surface]",
)
@click.option("--fill-holes", is_flag=True, default=None, help="Fill holes for the time being.")
@click.option(
    "--repair",
    is_flag=True,
    default=None,
    help="Repair both first. OUTPUT has the repaired faces; landmarks and values are those of the files.",
)
@click.option("--feature-weight", type=float, help="How strongly values pull.  [default: 1]")
@click.option("--position-weight", type=float, help="How strongly each vertex is pulled to its own position.")
@click.option("--area-weight", type=float, help="[default: 1]")
@click.option("--angle-weight", type=float, help="[default: 1]")
@options.common
def register(
    frame: Frame,
    source: Path,
    target: Path,
    output: Path,
    landmarks: Path | None,
    curves: Path | None,
    features: tuple[Path, Path] | None,
    pull: tuple[Path, Path] | None,
    **arguments: Any,
) -> None:
    """Register a SOURCE surface to a TARGET surface.

    OUTPUT has the faces of SOURCE and its vertices at their places on TARGET; as npz also the arrays
    triangles and barycentric, which name the place of each vertex.
    """
    from ..runs.register import register_run

    if landmarks is not None and curves is not None:
        raise click.UsageError("give --landmarks or --curves, not both")
    chosen = {"landmarks": landmarks, "curves": curves, "features": features, "pull": pull}
    frame.run(register_run, source, output, target=target, options=arguments, **chosen)


COMMANDS = (register,)
