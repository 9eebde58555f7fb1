# SPDX-License-Identifier: GPL-3.0-or-later
"""The edges of a mesh as lines between the points of its side. Plain numpy, no bpy."""

import numpy as np

from ..surfaces.arrays import Integers
from .sides import Side


def between_polygons(side: Side) -> Integers:
    """The edges (k, 2) of a side's triangles that are no diagonals of a polygon."""
    ends = np.sort(side.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    keys = np.column_stack([ends, np.repeat(side.polygons, 3)])
    within, count = np.unique(keys, axis=0, return_counts=True)
    edges: Integers = np.unique(within[count == 1, :2], axis=0)
    return edges
