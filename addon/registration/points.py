# SPDX-License-Identifier: GPL-3.0-or-later
"""The requirements of a registration by landmark points. Plain numpy, no bpy."""

from collections.abc import Sequence

import numpy as np

from .. import messages
from ..surfaces.arrays import Booleans, Integers
from ..surfaces.suitability import Unsuitable
from .domain import Domain
from .sides import PointPair, Side

_FEWEST = {"DISK": 1, "SPHERE": 2}


def check_landmarks(sides: tuple[Side, Side], pairs: Sequence[PointPair], domain: Domain) -> Integers:
    """The landmarks of source and target as points (2, k) of the sides.

    `pairs` are (name, source vertex, target vertex). Raises `Unsuitable` with the names of the pairs that
    cannot be.
    """
    if len(pairs) < _FEWEST[domain.shape]:
        few = "at least two landmark pairs, better four or more"
        few = "a landmark pair" if domain.shape == "DISK" else few
        raise Unsuitable(f"{sides[0].name} needs {few}; add vertices that belong together")
    landmarks = []
    for number, (side, outline) in enumerate(zip(sides, domain.outlines, strict=True), 1):
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
        problem = f"is on the boundary of {side.name}, which becomes a circle; pick a vertex inside"
        _refuse(pairs, np.isin(points, outline), problem)
        landmarks.append(points)
    return np.array(landmarks)


def _refuse(pairs: Sequence[PointPair], bad: Booleans, problem: str) -> None:
    names = [f'"{pairs[index][0]}"' for index in np.flatnonzero(bad).tolist()]
    if names:
        raise Unsuitable(f"Landmark {messages.listed(names)} {problem}")
