# SPDX-License-Identifier: GPL-3.0-or-later
"""From figures of triangles to figures of polygons. Plain numpy, no bpy."""

from collections.abc import Sequence

import numpy as np

from .arrays import Booleans, Floats
from .surface import Surface

# The limit of face attributes, and its negative the value of folded faces: shading cannot show infinities.
LOG2_LIMIT = 20.0


def log2_area_ratios(
    surfaces: Sequence[Surface], log2: Floats, areas: Floats, folded: Booleans
) -> list[Floats]:
    """For each surface log2 of the area ratio of its polygons (p,), from `log2` of all triangles (t,).

    A polygon has the mean of its triangles, weighted by `areas`, which are 0 for triangles that do not count.
    """
    ends = np.cumsum([len(surface.triangles) for surface in surfaces])[:-1]
    parts = zip(surfaces, *(np.split(values, ends) for values in (np.exp2(log2), areas, folded)), strict=True)
    return [_of_surface(*values) for values in parts]


def _of_surface(surface: Surface, ratios: Floats, weights: Floats, folded: Booleans) -> Floats:
    def total(values: Floats) -> Floats:
        return np.bincount(surface.polygons, values, surface.polygon_count)

    area = total(weights)
    mean = np.divide(total(ratios * weights), area, out=np.ones(surface.polygon_count), where=area > 0)
    log2 = np.clip(np.log2(mean), -LOG2_LIMIT, LOG2_LIMIT)
    log2[surface.polygons[folded]] = -LOG2_LIMIT
    return log2
