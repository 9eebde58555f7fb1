# SPDX-License-Identifier: MIT OR Apache-2.0
"""The figures of UVs, by formulas independent of the package; every triangle counts the same.

This runs inside Blender too, which has numpy only.
"""

from dataclasses import dataclass

import numpy as np

from bench.jacobians import jacobians

SLIVER = 1e-14
"""Triangles with a smaller share of the area have no figures."""


@dataclass(frozen=True)
class Figures:
    """The quality of some islands."""

    deviation: float
    """The standard deviation of the area ratio, all islands together at one scale."""
    shear: float
    """The mean of σ₁/σ₂ over the triangles that are not flipped."""
    flips: int


def measured(triangles, corners, island_of):
    """The figures of triangles (m, 3, 3) with UVs (m, 3, 2) in islands (m,), all islands at the same scale.

    A triangle is flipped where it lies the other way round than most of its island.
    """
    jacobian, areas = jacobians(triangles, corners)
    sound = areas > SLIVER * areas.sum()
    jacobian, areas, island_of = jacobian[sound], areas[sound], island_of[sound]
    determinant = np.linalg.det(jacobian)
    side = np.sign(np.bincount(island_of, determinant * areas))
    determinant = determinant * side[island_of]
    ratio = determinant / ((np.abs(determinant) * areas).sum() / areas.sum())
    squares, good = (jacobian**2).sum(axis=(1, 2)), determinant > 0
    largest = (squares + np.sqrt(np.maximum(squares**2 - 4 * determinant**2, 0))) / 2  # σ₁²
    shear = (largest[good] / determinant[good]).mean() if good.any() else np.inf
    return Figures(float(ratio.std()), float(shear), int(np.count_nonzero(~good)))
