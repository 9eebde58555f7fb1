# SPDX-License-Identifier: GPL-3.0-or-later
"""UVs that were pulled to triangles, for polygons of which some triangles lie beyond a seam of the UVs.

Each triangle has the UVs of that side of the seam on which its middle lies. A quad with a triangle on either
side would reach from one island to another, all over the texture: its largest triangle decides for all its
corners. Plain numpy, no bpy.
"""

import numpy as np

from ..surfaces.arrays import Booleans, Floats, Integers
from .sides import Side

# Triangles of a polygon are on different sides where they differ at a corner by this part of their size.
_APART = 0.25


def on_one_side(side: Side, places: Floats, uv: Floats) -> Floats:
    """UVs (m, 3, 2) of a side's triangles, with polygons on different sides of seams laid on one.

    `places` (u, 3) are the side's points in the domain of the registration.
    """
    torn = _torn(side, uv)[side.polygons]
    if not torn.any():
        return uv
    polygons, faces = side.polygons[torn], side.faces[torn]
    leading = _largest(polygons, np.abs(np.linalg.det(places[faces])))
    weights = np.einsum("fkc,fcd->fkd", places[faces], np.linalg.pinv(places[faces][leading]))
    weights /= weights.sum(axis=2, keepdims=True)
    result = uv.copy()
    result[torn] = np.einsum("fkd,fde->fke", weights, uv[torn][leading])
    return result


def _torn(side: Side, uv: Floats) -> Booleans:
    """Which polygons have triangles that differ by much at a corner they share, (p,)."""
    real = side.corners >= 0
    corners, count = side.corners[real], side.corners.max() + 1
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(low, corners, uv[real])
    np.maximum.at(high, corners, uv[real])
    jump = np.zeros(side.corners.shape)
    jump[real] = np.abs(high - low)[corners].max(axis=1)
    size = np.ptp(uv, axis=1).max(axis=1)
    torn = np.zeros(side.polygons.max() + 1, bool)
    torn[side.polygons[jump.max(axis=1) > _APART * size]] = True
    return torn


def _largest(polygons: Integers, areas: Floats) -> Integers:
    """For each triangle (f,) the number of the one with the largest area in its polygon."""
    order = np.lexsort([areas, polygons])
    ends = np.flatnonzero(np.append(polygons[order][1:] != polygons[order][:-1], True))
    return order[ends][np.searchsorted(polygons[order][ends], polygons)]
