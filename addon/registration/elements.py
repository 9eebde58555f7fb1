# SPDX-License-Identifier: GPL-3.0-or-later
"""Data of a mesh's vertices and corners as data of its side's triangles, and back. Plain numpy, no bpy."""

import numpy as np

from ..surfaces.arrays import Floats, Integers, Reals
from .sides import Side

_ROUNDING = 1e-5  # of colors in single precision


def by_points(side: Side, values: Reals) -> Floats:
    """Values (n, d) of a mesh's vertices as those of a side's points (u, d).

    The center of a divided polygon has the mean of its corners.
    """
    real = side.vertices >= 0
    result = np.empty((len(side.points), values.shape[1]))
    result[real] = values[side.vertices[real]]
    if not real.all():
        result[~real] = _means(side, result[side.faces])[~real]
    return result


def by_corners(side: Side, values: Reals) -> Floats:
    """Values (c, d) of a mesh's corners as those of a side's triangles (m, 3, d); centers as for points."""
    result = np.zeros((*side.corners.shape, values.shape[1]))
    real = side.corners >= 0
    result[real] = values[side.corners[real]]
    if not real.all():
        result[~real] = _means(side, result)[side.faces[~real]]
    return result


def joined(side: Side, values: Floats) -> Floats | None:
    """Values (m, 3, d) of a side's corners as those of its points (u, d); None if some differ at a point."""
    corners, points = values.reshape(-1, values.shape[-1]), side.faces.ravel()
    result = np.empty((len(side.points), values.shape[-1]))
    result[points] = corners
    return result if np.abs(result[points] - corners).max(initial=0.0) <= _ROUNDING else None


def from_points(side: Side, values: Floats) -> tuple[Integers, Floats]:
    """The vertices (k,) of the mesh that are points of a side, and their values (k, d)."""
    real = side.vertices >= 0
    return side.vertices[real], values[real]


def from_corners(side: Side, values: Floats) -> tuple[Integers, Floats]:
    """The corners (k,) of the mesh that a side's triangles have, and their values (k, d).

    Where several triangles of a polygon share a corner, the value is that of the first triangle.
    """
    corners, first = np.unique(side.corners, return_index=True)
    real = corners >= 0
    return corners[real], values.reshape(-1, values.shape[-1])[first[real]]


def by_polygons(side: Side, values: Floats) -> Floats:
    """The means by area (p,) of values of a side's triangles (m,) on each polygon; 0 on others."""
    a, b, c = np.moveaxis(side.points[side.faces], 1, 0)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    sums = np.bincount(side.polygons, areas * values)
    totals = np.bincount(side.polygons, areas)
    return np.divide(sums, totals, out=np.zeros_like(sums), where=totals > 0)


def turn_and_scale(points: Floats, images: Floats) -> Floats:
    """The linear part (3, 3) of the similarity that takes points (n, 3) to their images (n, 3)."""
    points, images = points - points.mean(axis=0), images - images.mean(axis=0)
    u, _, vt = np.linalg.svd(images.T @ points)
    u[:, -1] *= np.sign(np.linalg.det(u @ vt))
    return np.linalg.norm(images) / np.linalg.norm(points) * (u @ vt)


def _means(side: Side, values: Floats) -> Floats:
    """At the centers of divided polygons the means (u, d) of values (m, 3, d) around them."""
    is_center = side.corners < 0
    fan = is_center.any(axis=1)
    points = side.faces[fan][is_center[fan]]
    around = values[fan][~is_center[fan]].reshape(len(points), 2, -1).mean(axis=1)
    result = np.zeros((len(side.points), values.shape[2]))
    np.add.at(result, points, around)
    return result / np.maximum(np.bincount(points, minlength=len(side.points)), 1)[:, None]
