# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps from a surface onto the unit sphere, compared with the surface. Plain numpy, no bpy."""

import numpy as np

from . import triangulation
from .arrays import Booleans, Floats, Integers

# Blender keeps coordinates in single precision.
_ROUNDING = 8 * float(np.finfo(np.float32).eps)


def centroid(points: Floats, faces: Integers) -> Floats:
    """The center (3,) of the area of a surface."""
    weights = triangulation.areas(points[faces])
    return weights @ points[faces].mean(axis=1) / weights.sum()


def radius(points: Floats, faces: Integers) -> float:
    """The radius of the sphere that has the area of a surface."""
    return float(np.sqrt(triangulation.areas(points[faces]).sum() / (4 * np.pi)))


def volume(points: Floats, faces: Integers) -> float:
    """The signed volume inside a closed surface: negative where its faces look inward."""
    a, b, c = (points[faces[:, corner]] for corner in range(3))
    return float(np.einsum("ij,ij", a, np.cross(b, c))) / 6


def over_surface(points: Floats, faces: Integers, positions: Floats) -> Floats:
    """The matrix (3, 3) by which `positions @ matrix` lays a map over its surface.

    The map (n, 3) is oriented outward by a closed surface's `faces` (m, 3). On a surface whose faces look
    inward it is turned inside out: it is mirrored, so that faces look inward on the sphere as well.
    """
    points = points - centroid(points, faces)
    if volume(points, faces) >= 0:
        return np.eye(3)
    corner = np.repeat(triangulation.areas(points[faces]), 3)
    weights = np.bincount(faces.ravel(), corner, len(points))
    u, _, vt = np.linalg.svd((weights[:, None] * -positions).T @ points)
    u[:, -1] *= np.sign(np.linalg.det(u @ vt))
    return -(u @ vt)


def is_thin(positions: Floats, faces: Integers) -> bool:
    """Whether a face of a map (n, 3) lies so flat on a great circle that rounding might fold it over."""
    corners = positions[faces]
    sides = np.abs(corners - np.roll(corners, 1, axis=1)).max(axis=(1, 2))
    return bool((np.linalg.det(corners) < _ROUNDING * sides).any())


def turned(faces: Integers, oriented: Integers) -> Booleans:
    """A mask (m,) of the faces (m, 3) that `oriented` (m, 3), in which all are oriented alike, turns over."""
    if np.array_equal(faces, oriented):  # most islands, of which there may be thousands
        return np.zeros(len(faces), bool)
    turns = np.stack([np.roll(faces, k, axis=1) for k in range(3)], axis=1)
    is_kept: Booleans = (oriented[:, None, :] == turns).all(axis=2).any(axis=1)
    return ~is_kept
