# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands as shapes in the plane: texel density and bounding boxes. Plain numpy, no bpy."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from . import triangulation
from .arrays import Floats, Integers

# Angles tried at a time, and directions in which the outermost points stand for an outline.
_TURNS, _DIRECTIONS = 60, 120


@dataclass
class PlanarIsland:
    """A map `uv` (n, 2) of the triangles `faces` (m, 3) between `points` (n, 3)."""

    points: Floats
    faces: Integers
    uv: Floats


def scale_to_one_density(islands: Sequence[PlanarIsland]) -> None:
    """Scales islands so that the UV area of each is its share of the whole surface's area."""
    areas = [triangulation.areas(island.points[island.faces]).sum() for island in islands]
    for island, area in zip(islands, areas, strict=True):
        uv_area = np.abs(triangulation.signed_areas(island.uv[island.faces])).sum()
        island.uv *= np.sqrt(area / sum(areas) / uv_area)


def box(uv: Floats) -> Floats:
    """The corners (4, 2), counter-clockwise, of the bounding box of points (n, 2)."""
    (left, low), (right, high) = uv.min(axis=0), uv.max(axis=0)
    return np.array([[left, low], [right, low], [right, high], [left, high]])


def upright(uv: Floats) -> Floats:
    """Points (n, 2) turned so that their bounding box is as small as possible, its long side horizontal."""
    outline, angles = _outline(uv), np.linspace(0, np.pi / 2, _TURNS, endpoint=False)
    angle = _tightest(outline, angles)
    angle = _tightest(outline, angle + np.linspace(-angles[1], angles[1], _TURNS))
    width, height = np.ptp(_turned(outline, angle), axis=0)
    return _turned(uv, angle + np.pi / 2 if height > width else angle)


def _tightest(points: Floats, angles: Floats) -> float:
    """The angle, of (k,), by which points must be turned for the smallest bounding box."""
    sizes = [np.ptp(_turned(points, angle), axis=0).prod() for angle in angles]
    return float(angles[np.argmin(sizes)])


def _turned(points: Floats, angle: float) -> Floats:
    cosine, sine = np.cos(angle), np.sin(angle)
    turn: Floats = np.array([[cosine, sine], [-sine, cosine]])
    return points @ turn


def _outline(uv: Floats) -> Floats:
    """The outermost points, of (n, 2), in `_DIRECTIONS` directions."""
    u, v = np.ascontiguousarray(uv.T)
    angles = np.linspace(0, 2 * np.pi, _DIRECTIONS, endpoint=False)
    outermost: Integers = np.unique([np.argmax(np.cos(angle) * u + np.sin(angle) * v) for angle in angles])
    return uv[outermost]
