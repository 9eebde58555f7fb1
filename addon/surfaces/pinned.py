# SPDX-License-Identifier: GPL-3.0-or-later
"""A map moved and bent so that some of its points come to lie where they are pinned. Plain numpy, no bpy.

A similarity takes the map as near to the pins as it can; a thin-plate spline, the smoothest of all functions
that take these values, moves it the rest of the way (Duchon 1977).
"""

import numpy as np

from .arrays import Floats, Integers

# The spline of more pins is that of a sample: its matrix is dense.
MOST = 2000
_SAME = 1e-12


def bent(points: Floats, pins: Integers, places: Floats, scale: float) -> Floats:
    """Points (n, 2) of a map, `pins` (k,) of them in `places` (k, 2); a single pin keeps the `scale`."""
    moved = _similar(points, pins, places, scale)
    moved += _spline(moved, moved[pins], places - moved[pins])
    moved[pins] = places
    return moved


def _similar(points: Floats, pins: Integers, places: Floats, scale: float) -> Floats:
    """The similarity of a map that brings pins nearest to their places, by least squares."""
    own = points[pins] - points[pins].mean(axis=0)
    wanted = places - places.mean(axis=0)
    spread = float((own**2).sum())
    factor = complex(scale)
    if len(pins) > 1 and spread > 0 and (wanted**2).sum() > 0:
        # the best complex factor
        dot = np.sum((own[:, 0] - 1j * own[:, 1]) * (wanted[:, 0] + 1j * wanted[:, 1]))
        factor = complex(dot / spread) if abs(dot) > _SAME * spread else factor
    offsets = points - points[pins].mean(axis=0)
    turned = factor * (offsets[:, 0] + 1j * offsets[:, 1])
    return np.stack([turned.real, turned.imag], axis=1) + places.mean(axis=0)


def _spline(points: Floats, centers: Floats, values: Floats) -> Floats:
    """Values (n, 2) at points (n, 2) of the thin-plate spline with values (k, 2) at centers (k, 2)."""
    _, first = np.unique(centers, axis=0, return_index=True)
    first = first[:: -(-len(first) // MOST)]
    centers, values = centers[first], values[first]
    if len(centers) < 3 or np.linalg.matrix_rank(centers - centers[0]) < 2:
        # on a line a spline of the plane is not determined
        return _along_a_line(points, centers, values)
    size = np.ptp(centers, axis=0).max()
    affine = np.c_[np.ones(len(centers)), centers / size]
    system = np.block([[_kernel(centers, centers, size), affine], [affine.T, np.zeros((3, 3))]])
    weights = np.linalg.lstsq(system, np.concatenate([values, np.zeros((3, 2))]), rcond=None)[0]
    result: Floats = np.c_[np.ones(len(points)), points / size] @ weights[-3:]
    for start in range(0, len(points), MOST):
        part = points[start : start + MOST]
        result[start : start + MOST] += _kernel(part, centers, size) @ weights[:-3]
    return result


def _kernel(points: Floats, centers: Floats, size: float) -> Floats:
    """r² log r of distances over the size, (n, k)."""
    squared = ((points[:, None] - centers[None]) ** 2).sum(axis=2) / size**2
    return squared * np.log(np.maximum(squared, _SAME**2)) / 2


def _along_a_line(points: Floats, centers: Floats, values: Floats) -> Floats:
    """Values at points by those at centers on a line, linear between them, and constant beyond and across."""
    along = centers[-1] - centers[0]
    if not along.any():
        return np.tile(values.mean(axis=0), (len(points), 1))
    place, order = centers @ along, np.argsort(centers @ along)
    return np.stack([np.interp(points @ along, place[order], values[order, axis]) for axis in (0, 1)], axis=1)
