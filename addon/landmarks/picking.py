# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertex under the cursor, by the geometry of a view. Needs no window.

On a surface it is the nearest vertex of the face under the cursor, beside the surface the nearest vertex
within some pixels; never a vertex behind a surface.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from mathutils import Matrix, Vector
from numpy.typing import ArrayLike

from ..blender.vertex_positions import Cast
from ..surfaces.arrays import Booleans, Floats, Integers

# A hit this much nearer than a vertex, as a part of its distance, hides it.
_HIDING = 1e-4


@dataclass
class View:
    """A view of `width` by `height` pixels through the matrix (4, 4) from the world to clip space."""

    matrix: Floats
    width: int
    height: int

    def project(self, points: Floats) -> Floats:
        """Pixels (k, 2) of points (k, 3) in the world; not a number for those behind the eye."""
        clip = points @ self.matrix[:, :3].T + self.matrix[:, 3]
        with np.errstate(divide="ignore", invalid="ignore"):
            flat = clip[:, :2] / clip[:, 3:]
        flat[clip[:, 3] <= 0] = np.nan
        return (flat + 1) / 2 * (self.width, self.height)

    def ray(self, pixel: ArrayLike) -> tuple[Floats, Floats]:
        """The origin, on the near clipping plane, and the direction of the ray through a pixel."""
        x, y = 2 * np.asarray(pixel, float) / (self.width, self.height) - 1
        ends = np.array([[x, y, -1, 1], [x, y, 1, 1]]) @ np.linalg.inv(self.matrix).T
        near, far = ends[:, :3] / ends[:, 3:]
        return near, (far - near) / np.linalg.norm(far - near)


class Pickable:
    """A surface with vertices to pick: those `used` (n,) of points (n, 3), with a matrix into the world.

    `cast` casts a ray in the coordinates of the points.
    """

    def __init__(self, points: Floats, used: Booleans, cast: Cast, matrix: Matrix) -> None:
        self.points, self._used, self._cast = np.asarray(points, float), np.asarray(used, bool), cast
        corners = self.points if len(self.points) else np.zeros((1, 3))
        sides = np.stack([corners.min(axis=0), corners.max(axis=0)], axis=1)
        self._box = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 3)
        self.place(matrix)

    def place(self, matrix: Matrix) -> None:
        """Moves the surface."""
        self.matrix = matrix.copy()
        self._inverse = self.matrix.inverted_safe()

    def world(self, vertices: Any = slice(None)) -> Floats:
        """The points of some vertices, (k, 3), in the world."""
        return self._moved(self.points[vertices])

    def candidates(self, view: View, pixel: Floats, radius: float) -> tuple[Integers, Floats]:
        """The vertices within a radius in pixels, nearest first, and their distances."""
        if self._is_far(view, pixel, radius):
            return np.empty(0, int), np.empty(0)
        away = np.linalg.norm(view.project(self.world()) - pixel, axis=1)
        near = np.flatnonzero((away <= radius) & self._used)
        near = near[np.argsort(away[near], kind="stable")]
        return near, away[near]

    def hit(self, origin: Floats, direction: Floats) -> tuple[float, Integers | None]:
        """The distance and the vertices of the face that a ray hits first, or infinity and None."""
        start = self._inverse @ Vector(origin.tolist())
        cast = self._cast(start, self._inverse.to_3x3() @ Vector(direction.tolist()))
        if cast is None:
            return np.inf, None
        point, face = cast
        return (self.matrix @ point - Vector(origin.tolist())).length, np.array(face)

    def _is_far(self, view: View, pixel: Floats, radius: float) -> bool:
        """Whether the box about the surface is in front of the eye and away from the pixel."""
        corners = view.project(self._moved(self._box))
        outside = (corners.min(axis=0) > pixel + radius) | (corners.max(axis=0) < pixel - radius)
        return bool(np.isfinite(corners).all() and outside.any())

    def _moved(self, points: Floats) -> Floats:
        matrix: Floats = np.array(self.matrix)
        return points @ matrix[:3, :3].T + matrix[:3, 3]


def pick(
    surfaces: Sequence[Pickable],
    view: View,
    pixel: ArrayLike,
    *,
    radius: float = 20.0,
    blocked: float = np.inf,
) -> tuple[int, int] | None:
    """(number of a surface, vertex) at a pixel, or None; `blocked` is the distance of what hides them."""
    pixel = np.asarray(pixel, float)
    origin, direction = view.ray(pixel)
    hits = [surface.hit(origin, direction) for surface in surfaces]
    which = int(np.argmin([distance for distance, _ in hits])) if hits else 0
    distance, face = hits[which] if hits else (np.inf, None)
    if min(distance, blocked) < np.inf:
        return _corner(surfaces, which, face, view, pixel) if distance <= blocked else None
    return _beside(surfaces, view, pixel, radius)


def grabbed(
    surfaces: Sequence[Pickable],
    marked: Sequence[tuple[int, int]],
    view: View,
    pixel: ArrayLike,
    *,
    radius: float,
) -> int | None:
    """The number of the marked vertex (number of a surface, vertex) that a marker shows at a pixel, or None.

    It is the nearest visible one within the radius.
    """
    places = [surfaces[which].world([vertex])[0] for which, vertex in marked]
    if not places:
        return None
    away = np.linalg.norm(view.project(np.array(places)) - np.asarray(pixel, float), axis=1)
    near = [int(number) for number in np.argsort(away) if away[number] <= radius]
    return next((number for number in near if _is_visible(surfaces, *marked[number], view)), None)


def _corner(
    surfaces: Sequence[Pickable], which: int, face: Integers, view: View, pixel: Floats
) -> tuple[int, int] | None:
    """The nearest visible corner of the face under the cursor."""
    away = np.linalg.norm(view.project(surfaces[which].world(face)) - pixel, axis=1)
    for vertex in face[np.argsort(away)]:
        if _is_visible(surfaces, which, vertex, view):
            return which, int(vertex)
    return None


def _beside(surfaces: Sequence[Pickable], view: View, pixel: Floats, radius: float) -> tuple[int, int] | None:
    """The nearest visible vertex, where no surface is under the cursor."""
    candidates: list[tuple[float, int, int]] = []
    for which, surface in enumerate(surfaces):
        vertices, away = surface.candidates(view, pixel, radius)
        candidates.extend((d, which, int(vertex)) for d, vertex in zip(away, vertices, strict=True))
    for _, which, vertex in sorted(candidates):
        if _is_visible(surfaces, which, vertex, view):
            return which, vertex
    return None


def _is_visible(surfaces: Sequence[Pickable], which: int, vertex: int, view: View) -> bool:
    point = surfaces[which].world([vertex])
    pixel = view.project(point)[0]
    if not np.isfinite(pixel).all():
        return False
    origin, _ = view.ray(pixel)
    distance = np.linalg.norm(point[0] - origin)
    direction = (point[0] - origin) / max(distance, 1e-30)
    for number, surface in enumerate(surfaces):
        reached, face = surface.hit(origin, direction)
        is_at_vertex = number == which and face is not None and vertex in face
        if reached < distance * (1 - _HIDING) and not is_at_vertex:
            return False
    return True
