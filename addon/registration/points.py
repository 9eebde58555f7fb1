# SPDX-License-Identifier: GPL-3.0-or-later
"""The requirements of a registration by landmark points. Plain numpy, no bpy."""

from collections.abc import Sequence

import numpy as np

from .. import messages
from ..surfaces.arrays import Booleans, Integers
from ..surfaces.suitability import Patch, Unsuitable
from .piece import check_joined, check_piece
from .sides import PointPair, Side

_FEWEST = {"DISK": 1, "SPHERE": 2}


def domain(sides: tuple[Side, Side], patches: Sequence[Sequence[Patch]], wanted: str) -> str:
    """ "DISK" or "SPHERE", which both sides (source, target) are; `patches` has the pieces of either.

    Raises `Unsuitable` where one of them is neither, where they differ, or where they are not what is wanted.
    """
    shapes = [_shape(side, pieces) for side, pieces in zip(sides, patches, strict=True)]
    for side, shape in zip(sides, shapes, strict=True):
        if wanted not in ("AUTO", shape):
            raise Unsuitable(f"{side.name}: {_NOT_WANTED[wanted]}")
    if shapes[0] != shapes[1]:
        for side, pieces in zip(sides, patches, strict=True):
            check_joined(side, pieces)
        opened, closed = (sides[shapes.index(shape)].name for shape in ("DISK", "SPHERE"))
        raise Unsuitable(
            f"{opened} is open and {closed} is closed; both must be open or both closed: fill the hole of "
            f"{opened} or delete faces of {closed}"
        )
    return shapes[0]


_NOT_WANTED = {
    "DISK": "is closed, a disk has a boundary; set Domain to Automatic or Sphere",
    "SPHERE": "has a boundary, but a sphere has none; fill it or set Domain to Automatic or Disk",
}


def _shape(side: Side, patches: Sequence[Patch]) -> str:
    """The shape of one side, which must be a single piece without handles and with at most one boundary."""
    patch = check_piece(side, patches)
    loops = [side.vertices[patch.vertex_of[loop]] for loop in patch.boundary_loops]
    if len(loops) > 1:
        holes = _holes(loops[1:])
        raise Unsuitable(f"{side.name}: has {len(loops)} boundaries where one is allowed; fill {holes}")
    return "DISK" if loops else "SPHERE"


def _holes(loops: Sequence[Integers]) -> str:
    """All boundaries but the longest, each by its length and a vertex."""
    named = messages.listed([f"the one of {len(loop)} edges at vertex {max(loop)}" for loop in loops])
    return f"{named} (select a boundary edge, Select Boundary Loop, F)"


def check_landmarks(
    sides: tuple[Side, Side], pairs: Sequence[PointPair], shape: str, borders: Sequence[Integers]
) -> Integers:
    """The landmarks of source and target as points (2, k) of the sides.

    `pairs` are (name, source vertex, target vertex), `borders` the points of either boundary. Raises
    `Unsuitable` with the names of the pairs that cannot be.
    """
    if len(pairs) < _FEWEST[shape]:
        few = "a landmark pair" if shape == "DISK" else "at least two landmark pairs, better four or more"
        raise Unsuitable(f"{sides[0].name} needs {few}; add vertices that belong together")
    landmarks = []
    for number, (side, border) in enumerate(zip(sides, borders, strict=True), 1):
        vertices = np.array([pair[number] for pair in pairs])
        outside = (vertices < 0) | (vertices >= side.count)
        _refuse(pairs, outside, f"is on no vertex of {side.name}; pick it again")
        points = side.points_of(vertices)
        is_other = np.isin(vertices, side.rest.vertices)
        _refuse(pairs, is_other, side.rest.why_not(side.name))
        _refuse(pairs, points < 0, f"is on a loose vertex of {side.name}; pick one that has faces")
        first = np.unique(points, return_index=True)[1]
        again = ~np.isin(np.arange(len(points)), first)
        _refuse(
            pairs, again, f"is on a vertex of {side.name} that has a landmark already; remove one of them"
        )
        if shape == "DISK":
            problem = f"is on the boundary of {side.name}, which becomes a circle; pick a vertex inside"
            _refuse(pairs, np.isin(points, border), problem)
        landmarks.append(points)
    return np.array(landmarks)


def _refuse(pairs: Sequence[PointPair], bad: Booleans, problem: str) -> None:
    names = [f'"{pairs[index][0]}"' for index in np.flatnonzero(bad).tolist()]
    if names:
        raise Unsuitable(f"Landmark {messages.listed(names)} {problem}")
