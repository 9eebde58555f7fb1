# SPDX-License-Identifier: GPL-3.0-or-later
"""A registration of two surfaces and its figures. Plain numpy, no bpy."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..surfaces.arrays import Floats, Integers
from .sides import Side

_WORST, _NEXT_WORST = 3, 0.5  # so many pairs are named, of those with so much of the largest error
_SEEN = 5e-6  # errors above this are not 0.000 %
# With right landmarks, the energy between the surfaces stretches 0.02 to 0.05 of the area of like bodies over
# 2×, and 0.15 of the animals that differ most. With one pair that is wrong or two that are swapped it is 0.14
# to 0.53.
_HIGH = 0.12


@dataclass
class Strain:
    """How far a registration stretches and shrinks the source.

    `median` is that of the symmetric Dirichlet energy over 4, by area: 1 for an isometry. `stretched` is the
    share of the area that is stretched or shrunk over 2×, most near the pair named `worst`, "" for none.
    """

    median: float
    stretched: float
    worst: str

    @property
    def is_high(self) -> bool:
        return self.stretched > _HIGH


@dataclass
class Registered:
    """The library's registration of `source` onto `target` and figures of it.

    `places` (u, 3) and `target_places` are the points of either in the common domain, the unit sphere or the
    unit disk at height 1. `errors` (k,) are the distances of the landmarks, as parts of the target's size,
    `missed` the names of pairs that do not meet. `energy` is the larger of the two maps into the domain, not
    a number where other things than areas count, `folds` counts those of both. By curves the `domain` is
    "CURVES", the common domain a sphere, and `remarks` say what should be looked at. `filled` says which
    holes were filled, `backward` which curves, by number, fit better in reverse.
    """

    native: Any
    source: Side
    target: Side
    domain: str
    places: Floats
    target_places: Floats
    names: list[str]
    errors: Floats
    missed: list[str]
    energy: float
    folds: int
    status: str
    seconds: float
    strain: Strain = field(default_factory=lambda: Strain(1.0, 0.0, ""))
    remarks: list[str] = field(default_factory=list)
    filled: list[str] = field(default_factory=list)
    backward: list[int] = field(default_factory=list)

    @property
    def keeps_shapes(self) -> bool:
        """Whether areas were not what counted."""
        return self.by_curves or not np.isfinite(self.energy)

    @property
    def by_curves(self) -> bool:
        return self.domain == "CURVES"

    @property
    def method(self) -> str:
        return "CURVES" if self.by_curves else "POINTS"

    @property
    def ended_early(self) -> bool:
        return self.status == "cancelled"

    @property
    def worst(self) -> list[tuple[str, float]]:
        """The few pairs (name, error) with the largest errors, the largest first; none if all meet."""
        order = np.argsort(-self.errors, kind="stable")[:_WORST]
        least = max(_SEEN, _NEXT_WORST * self.errors.max(initial=0))
        return [(self.names[pair], float(self.errors[pair])) for pair in order if self.errors[pair] >= least]


def registered_by_points(
    native: Any, sides: tuple[Side, Side], shape: str, landmarks: Integers, names: list[str]
) -> Registered:
    """The figures of a registration (`authalic.Registration`) of two sides by landmarks (2, k)."""
    source, target = sides
    ends = np.asarray(native.positions)[landmarks[0]]
    apart = np.linalg.norm(ends - target.points[landmarks[1]], axis=1)
    both = native.distortion, getattr(native, "target_distortion", None)
    figures: list[Any] = [figures for figures in both if figures is not None]
    return Registered(
        native=native,
        source=source,
        target=target,
        domain=shape,
        places=_in_space(np.asarray(native.registered)),
        target_places=_in_space(np.asarray(native.target_registered)),
        names=names,
        errors=apart / max(target.size, np.finfo(float).tiny),
        missed=[names[pair] for pair in native.missed],
        energy=max(float(figure.authalic_energy) for figure in figures),
        folds=sum(len(figure.folded) for figure in figures),
        status=native.status,
        seconds=float(native.seconds),
        strain=strain(native, names),
    )


def strain(native: Any, names: list[str]) -> Strain:
    """The strain of a registration (`authalic.Registration`) by pairs of these names."""
    figures = native.strain
    worst = figures.worst_landmark
    return Strain(float(figures.median), float(figures.stretched), "" if worst is None else names[worst])


def _in_space(points: Floats) -> Floats:
    """Points (n, 2) of the disk at height 1; points (n, 3) as they are."""
    return points if points.shape[1] == 3 else np.column_stack([points, np.ones(len(points))])
