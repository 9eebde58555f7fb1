# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands as shapes in the plane: texel density and bounding boxes. Plain numpy, no bpy."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from . import triangulation
from .arrays import Floats, Integers

# Angles tried at a time, and directions in which the outermost points stand for an outline.
_TURNS, _DIRECTIONS = 60, 120
# Below this correlation of two sets of points no angle fits better than others.
_NO_TURN = 1e-6


@dataclass
class PlanarIsland:
    """A map `uv` (n, 2) of the triangles `faces` (m, 3) between `points` (n, 3).

    `density` (m,), if there is one, says how much more area in the map each triangle is to get than its area
    asks for.
    """

    points: Floats
    faces: Integers
    uv: Floats
    density: Floats | None

    def wanted_areas(self, areas: Floats) -> Floats:
        """The shares (m,) of the map that triangles with some areas (m,) are to get."""
        return areas if self.density is None else areas * self.density


def scale_to_one_density(islands: Sequence[PlanarIsland]) -> None:
    """Scales islands so that the UV area of each is its share of the whole surface's area, by density."""
    areas = np.array([_area(island) for island in islands])
    total = areas.sum()
    for island, area in zip(islands, areas, strict=True):
        uv_area = np.abs(triangulation.signed_areas(island.uv[island.faces])).sum()
        island.uv = island.uv * np.sqrt(area / total / uv_area)


def _area(island: PlanarIsland) -> float:
    return float(island.wanted_areas(triangulation.areas(island.points[island.faces])).sum())


def density(islands: Sequence[PlanarIsland]) -> float:
    """Lengths in the maps of islands over those on their surfaces, where the density is 1."""
    area = sum(np.abs(triangulation.signed_areas(island.uv[island.faces])).sum() for island in islands)
    return float(np.sqrt(area / sum(map(_area, islands))))


def laid_over(triangles: Floats, others: Floats) -> Callable[[Floats], Floats] | None:
    """The similarity that lays triangles (t, 3, 2) over others (t, 3, 2), as a function of points (n, 2).

    It keeps the area and the mean of the others, and mirrors nothing. None if either have no area, or are not
    finite.
    """
    area, wanted_area = (np.abs(triangulation.signed_areas(each)).sum() for each in (triangles, others))
    if not (np.isfinite(wanted_area) and area > 0 and wanted_area > 0):
        return None
    center, other_center = triangles.mean(axis=(0, 1)), others.mean(axis=(0, 1))
    own, wanted = (
        (each - middle).reshape(-1, 2) for each, middle in ((triangles, center), (others, other_center))
    )
    # points as complex numbers: the turn that makes the sum of products real
    products = np.sum((own[:, 0] - 1j * own[:, 1]) * (wanted[:, 0] + 1j * wanted[:, 1]))
    is_turned = abs(products) > _NO_TURN * np.linalg.norm(own) * np.linalg.norm(wanted)
    angle, scale = float(np.angle(products)) if is_turned else 0.0, np.sqrt(wanted_area / area)
    return lambda points: scale * _turned(points - center, angle) + other_center


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
