# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands as shapes in the plane: texel density and bounding boxes. Plain numpy, no bpy."""

import numpy as np

from . import triangulation


def scale_to_one_density(islands):
    """Scales islands so that the UV area of each is its share of the whole surface's area."""
    areas = [triangulation.areas(island.points[island.faces]).sum() for island in islands]
    for island, area in zip(islands, areas, strict=True):
        uv_area = np.abs(triangulation.signed_areas(island.uv[island.faces])).sum()
        island.uv *= np.sqrt(area / sum(areas) / uv_area)


def box(uv):
    """The corners (4, 2), counter-clockwise, of the bounding box of points (n, 2)."""
    (left, low), (right, high) = uv.min(axis=0), uv.max(axis=0)
    return np.array([[left, low], [right, low], [right, high], [left, high]])
