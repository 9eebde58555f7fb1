# SPDX-License-Identifier: GPL-3.0-or-later
"""The requirements of a registration by landmark points. Plain numpy, no bpy."""

from collections.abc import Sequence

import numpy as np

from .. import messages
from ..surfaces.arrays import Booleans, Integers
from ..surfaces.suitability import Unsuitable
from .domain import Domain
from .settings import Settings
from .sides import PointPair, Side

_FEWEST = {"DISK": 1, "SPHERE": 2}


def check_landmarks(
    sides: tuple[Side, Side], pairs: Sequence[PointPair], domain: Domain, settings: Settings
) -> Integers:
    """The landmarks of source and target as points (2, k) of the sides.

    `pairs` are (name, source vertex, target vertex). Raises `Unsuitable` with the names of the pairs that
    cannot be.
    """
    _check_number(sides[0].name, len(pairs), domain, settings)
    landmarks = []
    for number, (side, outline) in enumerate(zip(sides, domain.outlines, strict=True), 1):
        vertices = np.array([pair[number] for pair in pairs], int)
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


def _check_number(name: str, count: int, domain: Domain, settings: Settings) -> None:
    """Spheres may be laid over each other by a feature alone."""
    if count >= _FEWEST[domain.shape] or (domain.shape == "SPHERE" and settings.that_count.feature):
        return
    few = "a landmark pair"
    remedy = "add vertices that belong together"
    if domain.shape == "SPHERE":
        few = "at least two landmark pairs, better four or more"
        remedy += ", or choose a feature"
    raise Unsuitable(f"{name} needs {few}; {remedy}")


def _refuse(pairs: Sequence[PointPair], bad: Booleans, problem: str) -> None:
    names = [f'"{pairs[index][0]}"' for index in np.flatnonzero(bad).tolist()]
    if names:
        raise Unsuitable(f"Landmark {messages.listed(names)} {problem}")
