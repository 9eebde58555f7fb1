# SPDX-License-Identifier: GPL-3.0-or-later
"""The domain of a registration by landmark points, and the holes that are filled for it. No bpy."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .. import messages
from ..surfaces import triangulation
from ..surfaces.arrays import Integers
from ..surfaces.suitability import Patch, Unsuitable
from .piece import check_joined, check_piece
from .sides import Side, boundaries

# The square of an outline's length is at least this part of that of a disk with the area of the surface; the
# neck of a head has .06, its mouth .005.
_OUTLINE = 0.02


@dataclass
class Domain:
    """The shape "DISK" or "SPHERE" that both sides are mapped to.

    `outlines` are the points that become the boundary of a disk, on either side, and `holes` the numbers of
    other boundaries, which are filled.
    """

    shape: str
    outlines: list[Integers]
    holes: list[int]


def filled_in_words(sides: tuple[Side, Side], holes: Sequence[int]) -> list[str]:
    """How many holes of either side are filled."""
    counts = [(count, side.name) for count, side in zip(holes, sides, strict=True) if count]
    return [
        f"{messages.count(count, 'hole')} of {name} {'was' if count == 1 else 'were'} filled for the map"
        for count, name in counts
    ]


def domain(sides: tuple[Side, Side], patches: Sequence[Sequence[Patch]], wanted: str) -> Domain:
    """The domain of both sides, "AUTO", "DISK" or "SPHERE" being wanted.

    `patches` has the pieces of either side. Surfaces that both have an outline, or both one hole, are disks;
    of all others every hole is filled. Raises `Unsuitable` where one of them has no map of the wanted kind.
    """
    loops = [_loops(side, pieces) for side, pieces in zip(sides, patches, strict=True)]
    if any(loops) and not all(loops):
        for side, pieces in zip(sides, patches, strict=True):
            check_joined(side, pieces)
    shape = _natural(sides, loops) if wanted == "AUTO" else wanted
    outer = 1 if shape == "DISK" else 0
    for side, holes in zip(sides, loops, strict=True):
        if len(holes) < outer:
            raise Unsuitable(
                f"{side.name}: is closed, a disk has a boundary; set Domain to Automatic or Sphere"
            )
    return Domain(
        shape=shape,
        outlines=[np.concatenate([np.empty(0, int), *holes[:outer]]) for holes in loops],
        holes=[len(holes) - outer for holes in loops],
    )


def _loops(side: Side, patches: Sequence[Patch]) -> list[Integers]:
    """The boundary loops of one side, which must be a single piece without handles, the longest first."""
    check_piece(side, patches)
    return sorted(boundaries(patches), key=lambda loop: -length(side, loop))


def _natural(sides: tuple[Side, Side], loops: Sequence[Sequence[Integers]]) -> str:
    """The shape that suits both sides with these boundary loops, the longest first."""
    if not all(loops):
        return "SPHERE"
    have_one = all(len(holes) == 1 for holes in loops)
    outlines = [is_outline(side, holes[0]) for side, holes in zip(sides, loops, strict=True)]
    return "DISK" if all(outlines) or (have_one and not any(outlines)) else "SPHERE"


def is_outline(side: Side, loop: Integers) -> bool:
    """Whether a boundary loop goes around a surface, as a neck does, and is no hole in it, as a mouth is."""
    area = triangulation.areas(side.points[side.faces]).sum()
    return bool(length(side, loop) ** 2 > _OUTLINE * 4 * np.pi * area)


def length(side: Side, loop: Integers) -> float:
    corners = side.points[loop]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).sum())
