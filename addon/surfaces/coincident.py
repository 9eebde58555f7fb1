# SPDX-License-Identifier: GPL-3.0-or-later
"""Points that lie on each other. Plain numpy, no bpy."""

from itertools import product

import numpy as np

from .arrays import Floats, Integers

# Points lie on each other within this part of the size of the mesh.
_TOUCHING = 1e-5


def distance(points: Floats) -> float:
    """The distance within which points (n, 3) of a mesh lie on each other."""
    size = float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0
    return _TOUCHING * size if np.isfinite(size) and size > 0 else 1.0


def stands_for(points: Floats, within: float) -> Integers:
    """For each point (n,) the first of those that it lies on, by way of others too; its own number if none.

    Points that are nearer than `within` along each axis share a cell of one of eight grids. Their cells have
    twice this size, and they are shifted by half a cell along some axes.
    """
    first = np.arange(len(points))
    cells = [
        _numbered(np.floor(points / (2 * within) + np.array(shift))) for shift in product((0, 0.5), repeat=3)
    ]
    while True:
        before = first
        for cell in cells:
            lowest = np.full(int(cell.max(initial=-1)) + 1, len(points))
            np.minimum.at(lowest, cell, first)
            first = lowest[cell]
        first = first[first]
        if (first == before).all():
            return first


def _numbered(cells: Floats) -> Integers:
    """A number for each cell (n, 3), the same for the same cell."""
    return np.unique(cells, axis=0, return_inverse=True)[1].reshape(-1)


def count(points: Floats) -> int:
    """How many of some points (n, 3) lie on others."""
    first = stands_for(points, distance(points))
    return int((np.bincount(first, minlength=1)[first] > 1).sum())
