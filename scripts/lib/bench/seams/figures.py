# SPDX-License-Identifier: MIT OR Apache-2.0
"""The figures of a layout, computed here from its UVs alone, by formulas independent of the package."""

from dataclasses import dataclass

import numpy as np

from bench.jacobians import jacobians, positive
from bench.seams import raster, topology

SAMPLES = 4_000_000
"""The points of the raster over the area of a layout."""
SLIVER = 1e-14
"""Faces with a smaller share of the area have no shape to compare with."""


@dataclass(frozen=True)
class Figures:
    """The quality of a layout at equal total area; means and percentiles are weighted by area."""

    length: float
    """The length of the seams, each counted once, over the square root of the area."""
    islands: int
    not_disks: int
    """Islands whose Euler characteristic is not 1."""
    deviation: float
    """The standard deviation of the area ratio."""
    shear: float
    """The mean of σ₁/σ₂; the percentile is of this too."""
    shear_p99: float
    dirichlet: float
    """The symmetric Dirichlet energy per area: 4 for an isometry."""
    flips: int
    overlap: float
    """The share of the covered area that an island covers more than once by itself."""
    packed: float
    """The share of the unit square."""


def measured(vertices, faces, corners):
    """The figures of a layout (m, 3, 2)."""
    islands = topology.islands(faces, corners)
    jacobian, areas = jacobians(vertices[faces], corners)
    lengths = np.linalg.norm(np.diff(vertices[islands.seams], axis=1), axis=-1)
    return Figures(
        lengths.sum() / np.sqrt(areas.sum()), islands.count, int((islands.euler != 1).sum()),
        *distortion(jacobian, areas), flips(jacobian, areas, islands),
        own_overlap(corners, islands.of_face), uv_areas(corners).sum(),
    )  # fmt: skip


def distortion(jacobian, areas):
    """The SD of the area ratio, the mean and the 99th percentile of σ₁/σ₂, and the Dirichlet energy."""
    sound = areas > SLIVER * areas.sum()
    weights, jacobian = areas[sound] / areas[sound].sum(), jacobian[sound]
    ratio = np.abs(np.linalg.det(jacobian))
    scale = (weights * ratio).sum()
    ratio, squares = ratio / scale, (jacobian**2).sum(axis=(1, 2)) / scale
    largest = (squares + np.sqrt(np.maximum(squares**2 - 4 * ratio**2, 0))) / 2  # σ₁²
    shear = largest / positive(ratio)
    energy = squares + squares / positive(ratio**2)
    deviation = np.sqrt((weights * (ratio - 1) ** 2).sum())
    return deviation, (weights * shear).sum(), percentile(shear, weights, 0.99), (weights * energy).sum()


def percentile(values, weights, share):
    """The least value such that the values up to it have this share of the weights."""
    order = np.argsort(values)
    upto = np.cumsum(weights[order])
    return values[order][np.searchsorted(upto, share * upto[-1])]


def flips(jacobian, areas, islands):
    """The faces that lie the other way round than most of their island; a mirrored island has none."""
    determinant = np.linalg.det(jacobian)
    side = np.sign(np.bincount(islands.of_face, determinant * areas, islands.count))
    sound = areas > SLIVER * areas.sum()
    return int((determinant * side[islands.of_face] <= 0)[sound].sum())


def own_overlap(corners, of_face):
    """The share of the points covered by an island that it covers twice or more often, over all islands."""
    pixel = np.sqrt(uv_areas(corners).sum() / SAMPLES)
    count = of_face.max() + 1
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(low, of_face, corners.min(axis=1))
    np.maximum.at(high, of_face, corners.max(axis=1))
    width, height = (np.ceil((high - low) / pixel).astype(int) + 2).T
    begin = np.cumsum(width * height) - width * height
    # seen in its island's own frame, a shared corner keeps the same bits in all of its faces
    spans = raster.spans((corners - low[of_face][:, None]) / pixel)
    island = of_face[spans.triangle]
    line = begin[island] + spans.row * width[island]
    changes = np.zeros((width * height).sum() + 1, np.int32)
    np.add.at(changes, line + spans.start, 1)
    np.add.at(changes, line + spans.stop, -1)
    layers = np.cumsum(changes)
    return (layers > 1).sum() / max((layers > 0).sum(), 1)


def uv_areas(corners):
    """The areas of the faces in the plane."""
    return np.abs(raster.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])) / 2
