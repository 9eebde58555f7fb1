# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of a mesh of quads and n-gons, fit for the native library. Plain numpy, no bpy."""

from dataclasses import dataclass

import numpy as np

from .arrays import Booleans, Floats, Integers, Reals
from .surface import Surface

# Blender keeps coordinates in single precision: a height below this part of the largest coordinate may be
# nothing but rounding.
_ROUNDING = 2 * float(np.finfo(np.float32).eps)
# The height of a triangle on a straight line, over its longest side. Far from the origin, where coordinates
# are coarse, triangles of better shapes are as low as rounding, but their areas are not.
_FLAT = 2.0**-10

# The triangles of a polygon whose corners are few beside its area.
_LARGE = 4


@dataclass
class Triangles:
    """Triangles with the mesh corner of each of their corners, -1 at the center of a divided polygon."""

    positions: Floats
    triangles: Integers
    corners: Integers
    polygons: Integers


def areas(triangles: Floats) -> Floats:
    """Areas (t,) of triangles (t, 3, 3) in space."""
    a, b = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    return np.linalg.norm(np.cross(a, b), axis=1) / 2


def signed_areas(triangles: Floats) -> Floats:
    """Signed areas (t,) of triangles (t, 3, 2) in the plane."""
    a, b = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2


def welded(vertices: Integers, uv: Reals) -> tuple[Integers, Integers]:
    """Triangles of vertices (t, 3) with float32 UVs (t, 3, 2), joined where both agree.

    Returns which corners, counted through, come first at each point (n,), and triangles (t, 3) of points.
    """
    # Adding 0 makes one of the two zeros.
    places = (np.ascontiguousarray(uv, np.float32) + np.float32(0)).view(np.uint64).ravel()
    distinct, place = np.unique(places, return_inverse=True)
    key = vertices.ravel().astype(np.int64) * max(len(distinct), 1) + place.ravel()
    _, first, points = np.unique(key, return_index=True, return_inverse=True)
    return first, points.reshape(-1, 3)


def has_area(triangles: Floats) -> Booleans:
    """Which triangles (t, 3, 3) are no lines that have an area by the rounding of their coordinates, (t,)."""
    first, second = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    sides = np.stack([_squares(first), _squares(second), _squares(second - first)]).max(axis=0)
    good: Booleans = _squares(np.cross(first, second)) > (_FLAT * sides) ** 2
    # few are left to be looked at closely
    rest = np.flatnonzero(~good)
    good[rest] = 2 * areas(triangles[rest]) > np.sqrt(sides[rest]) * rounding(triangles[rest])
    return good


def _squares(vectors: Floats) -> Floats:
    """The squared lengths (k,) of vectors (k, 3)."""
    squares: Floats = np.einsum("ij,ij->i", vectors, vectors)
    return squares


def rounding(triangles: Floats) -> Floats:
    """The height (t,) up to which triangles (t, 3, 3) are lines, by the rounding of their coordinates."""
    sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1, initial=0)
    by_place = _ROUNDING * np.abs(triangles).max(axis=(1, 2), initial=0)
    height: Floats = np.minimum(by_place, _FLAT * sides)
    return height


def flat(positions: Floats, triangles: Integers) -> Booleans:
    """Which triangles (t, 3) between positions (n, 3) that are finite have no area, (t,)."""
    points = positions[triangles]
    with np.errstate(invalid="ignore"):
        is_flat: Booleans = ~has_area(points) & np.isfinite(points).all(axis=(1, 2))
    return is_flat


def has_large_polygon(polygons: Integers) -> bool:
    """Whether a polygon has so many triangles, of (t,), that no map can be even in it."""
    return bool(np.bincount(polygons).max(initial=0) > _LARGE)


def edge_keys(faces: Integers, count: int) -> Integers:
    """A number for each edge of triangles (m, 3) between `count` vertices, (m, 3), the same for all at it."""
    following = np.roll(faces, -1, axis=1)
    low, high = np.minimum(faces, following), np.maximum(faces, following)
    keys: Integers = low.astype(np.int64) * count + high
    return keys


def branching_edges(faces: Integers, count: int) -> Integers:
    """The `edge_keys` of edges that more than two triangles, of (m, 3), have, ascending."""
    edges = np.sort(edge_keys(faces, count), axis=None)
    return np.unique(edges[2:][edges[2:] == edges[:-2]])


def sound(surface: Surface, also: Integers | None = None) -> Triangles:
    """The triangles of a surface, with bad polygons, and those of `also` (k,), divided from their center.

    A polygon is bad if one of its diagonals is also an edge or a diagonal of another polygon, where the
    surface would seem to branch, or if one of its triangles has no area, as corners in a line give. Polygons
    that have no area at all stay as they are.
    """
    is_flat = flat(surface.positions, surface.triangles)
    bad = _branching(surface)
    bad[surface.polygons[is_flat]] = True
    bad &= surface.polygon_size > 3
    if also is not None:
        bad[also] = True
    if not bad.any():
        return Triangles(surface.positions, surface.triangles, surface.corners, surface.polygons)
    has_any = np.zeros(surface.polygon_count, bool)
    has_any[surface.polygons[~is_flat]] = True
    bad &= has_any
    keep = ~bad[surface.polygons]
    kept = Triangles(
        surface.positions, surface.triangles[keep], surface.corners[keep], surface.polygons[keep]
    )
    return _divided(surface, np.flatnonzero(bad), kept)


def _branching(surface: Surface) -> Booleans:
    """Which polygons have a diagonal that is also an edge or a diagonal of another polygon, (p,)."""
    first, second = surface.corners.ravel(), np.roll(surface.corners, -1, axis=1).ravel()
    polygon = np.repeat(surface.polygons, 3)
    steps = (second - first) % surface.polygon_size[polygon]
    is_diagonal = (steps != 1) & (surface.polygon_size[polygon] > 3)
    bad = np.zeros(surface.polygon_count, bool)
    if not is_diagonal.any():
        return bad
    ends = np.sort(
        np.stack([surface.triangles.ravel(), np.roll(surface.triangles, -1, axis=1).ravel()]), axis=0
    )
    key = ends[0].astype(np.int64) * len(surface.positions) + ends[1]
    polygons = polygon[is_diagonal]
    diagonals, index = np.unique(key[is_diagonal], return_inverse=True)
    lowest = np.full(len(diagonals), surface.polygon_count)
    np.minimum.at(lowest, index, polygons)
    shared = np.zeros(len(diagonals), bool)
    shared[index[polygons != lowest[index]]] = True
    bad[polygons[shared[index] | np.isin(diagonals, key[~is_diagonal])[index]]] = True
    return bad


def _divided(surface: Surface, polygons: Integers, kept: Triangles) -> Triangles:
    """`kept` and, for each of `polygons`, a fan of triangles around the mean of its corners."""
    size, start = surface.polygon_size[polygons], surface.polygon_start[polygons]
    which = np.repeat(np.arange(len(polygons)), size)
    turn = np.arange(len(which)) - np.repeat(np.cumsum(size) - size, size)
    corner = start[which] + turn
    next_corner = start[which] + (turn + 1) % size[which]
    vertex = surface.corner_vertex[corner]
    centers = np.zeros((len(polygons), 3))
    np.add.at(centers, which, surface.positions[vertex] / size[which][:, None])
    fans = np.stack([vertex, surface.corner_vertex[next_corner], len(surface.positions) + which], axis=1)
    corners = np.stack([corner, next_corner, np.full(len(which), -1)], axis=1)
    return Triangles(
        np.concatenate([kept.positions, centers]),
        np.concatenate([kept.triangles, fans]),
        np.concatenate([kept.corners, corners]),
        np.concatenate([kept.polygons, polygons[which]]),
    )
