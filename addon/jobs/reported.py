# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces of the islands that the last report named: bad ones, worst first, and refusals."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from ..bridge import Island, Refusal
from ..surfaces.arrays import Integers
from ..surfaces.surface import Surface


@dataclass(frozen=True)
class Place:
    """Polygons (p,) of the object of a name, and what was said of them."""

    name: str
    polygons: Integers
    reason: str


_last: list[Place] = []


def of_islands(surfaces: Sequence[Surface], islands: Sequence[Island]) -> list[Place]:
    """The islands that are not as good as they should be, the worst first."""
    short = [(island, island.shortfall) for island in islands if island.shortfall is not None]
    short.sort(key=lambda pair: -pair[1].severity)
    return [
        Place(island.name, surfaces[island.surface].polygons_of(island.corners), str(shortfall))
        for island, shortfall in short
    ]


def remember(places: Sequence[Place], refusals: Sequence[object]) -> None:
    """Keeps what a report named, in the place of what the one before it did."""
    refused = [each for each in refusals if isinstance(each, Refusal) and len(each.polygons)]
    _last[:] = [*places, *(Place(each.name, each.polygons, each.reason) for each in refused)]


def last() -> list[Place]:
    """What the last report named and is still there."""
    return [place for place in _last if place.name in bpy.data.objects]


def forget() -> None:
    """Forgets all, as where another file is opened."""
    _last.clear()
