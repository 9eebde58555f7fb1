# SPDX-License-Identifier: GPL-3.0-or-later
"""From figures of triangles to figures of polygons. Plain numpy, no bpy."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import Booleans, Floats
from .surface import Surface

# The limit of face attributes, and its negative the value of folded faces: shading cannot show infinities.
LOG2_LIMIT = 20.0


@dataclass
class Triangles:
    """Figures of triangles (t,) on one scale: area ratios, σ₁/σ₂, and whether they are folded.

    Their `areas` in space, and `targets`, the areas that they should have, are 0 where they do not count.
    """

    areas: Floats
    targets: Floats
    ratios: Floats
    shears: Floats
    folded: Booleans

    def split(self, surfaces: Sequence[Surface]) -> "list[Triangles]":
        """The figures of each surface's triangles, from those of all."""
        ends = np.cumsum([len(surface.triangles) for surface in surfaces])[:-1]
        parts = [np.split(values, ends) for values in vars(self).values()]
        return [Triangles(*values) for values in zip(*parts, strict=True)]


@dataclass
class Polygons:
    """Figures of the polygons (p,) of a surface, means over their triangles; those without area have 1.

    A polygon is `folded` if one of its triangles is, and `counted` if it has an area.
    """

    ratios: Floats
    shears: Floats
    folded: Booleans
    counted: Booleans

    @property
    def log2(self) -> Floats:
        """log2 of the area ratios, within the limits; that of folded polygons is the lower limit."""
        values = np.log2(np.maximum(self.ratios, np.exp2(-LOG2_LIMIT)))
        values[self.folded] = -LOG2_LIMIT
        return np.minimum(values, LOG2_LIMIT)


def of_triangles(surface: Surface, triangles: Triangles) -> Polygons:
    """The figures of a surface's polygons by those of its triangles, weighted by target and by area."""

    def mean(values: Floats, weights: Floats) -> Floats:
        area = total(weights)
        return np.divide(total(values * weights), area, out=np.ones(len(area)), where=area > 0)

    def total(values: Floats) -> Floats:
        return np.bincount(surface.polygons, values, surface.polygon_count)

    folded = np.zeros(surface.polygon_count, bool)
    folded[surface.polygons[triangles.folded]] = True
    shears = np.where(triangles.folded, 1.0, triangles.shears)
    return Polygons(
        ratios=mean(triangles.ratios, triangles.targets),
        shears=mean(shears, triangles.areas),
        folded=folded,
        counted=total(triangles.targets) > 0,
    )
