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
    areas = _wanted_areas(islands)
    scales = np.sqrt(areas / areas.sum() / _uv_areas(islands))
    for island, scale in zip(islands, scales.tolist(), strict=True):
        island.uv = island.uv * scale


def density(islands: Sequence[PlanarIsland]) -> float:
    """Lengths in the maps of islands over those on their surfaces, where the density is 1."""
    return float(np.sqrt(_uv_areas(islands).sum() / _wanted_areas(islands).sum()))


def box_sizes(islands: Sequence[PlanarIsland]) -> Floats:
    """Width and height (k, 2) of the bounding boxes of islands in the map."""
    points, starts = _joined([island.uv for island in islands])
    return np.maximum.reduceat(points, starts) - np.minimum.reduceat(points, starts)


def _wanted_areas(islands: Sequence[PlanarIsland]) -> Floats:
    """The shares (k,) of the map that islands are to get."""
    triangles, starts = _joined([island.points[island.faces] for island in islands])
    areas = triangulation.areas(triangles)
    for island, start in zip(islands, starts.tolist(), strict=True):
        if island.density is not None:
            areas[start : start + len(island.faces)] *= island.density
    return np.add.reduceat(areas, starts)


def _uv_areas(islands: Sequence[PlanarIsland]) -> Floats:
    """The areas (k,) of islands in the map."""
    triangles, starts = _joined([island.uv[island.faces] for island in islands])
    return np.add.reduceat(np.abs(triangulation.signed_areas(triangles)), starts)


def _joined(arrays: Sequence[Floats]) -> tuple[Floats, Integers]:
    """Arrays one after the other, and where each begins: thousands of islands in few calls."""
    return np.concatenate(arrays), np.cumsum([0, *map(len, arrays[:-1])])


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


def upright(uv: Floats) -> Floats:
    """Points (n, 2) turned so that their bounding box is as small as possible, its long side horizontal."""
    return all_upright([uv])[0]


def all_upright(maps: Sequence[Floats]) -> list[Floats]:
    """Maps (n, 2) of islands, each turned as `upright` does."""
    points, starts = _joined([_outline(uv) if len(uv) > _DIRECTIONS else uv for uv in maps])
    turns = np.linspace(0, np.pi / 2, _TURNS, endpoint=False)
    angles = _tightest(points, starts, np.zeros(len(maps)), turns)
    angles = _tightest(points, starts, angles, np.linspace(-turns[1], turns[1], _TURNS))
    width, height = _turned_sizes(points, starts, angles)
    angles += np.where(height > width, np.pi / 2, 0.0)
    return [_turned(uv, angle) for uv, angle in zip(maps, angles.tolist(), strict=True)]


def _tightest(points: Floats, starts: Integers, angles: Floats, turns: Floats) -> Floats:
    """The angles (k,), with one of `turns` added to each, at which islands have the smallest bounding boxes.

    The islands have the points (n, 2) from `starts` (k,) on.
    """
    best, least = angles, np.full(len(angles), np.inf)
    for turn in turns:
        size = np.prod(_turned_sizes(points, starts, angles + turn), axis=0)
        best, least = np.where(size < least, angles + turn, best), np.minimum(size, least)
    return best


def _turned_sizes(points: Floats, starts: Integers, angles: Floats) -> tuple[Floats, Floats]:
    """Width and height (k,) of the bounding boxes of islands turned by angles (k,)."""
    counts = np.diff([*starts, len(points)])
    cosine, sine = np.repeat(np.cos(angles), counts), np.repeat(np.sin(angles), counts)
    u, v = points.T
    x, y = cosine * u - sine * v, sine * u + cosine * v
    width, height = (np.maximum.reduceat(c, starts) - np.minimum.reduceat(c, starts) for c in (x, y))
    return width, height


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
