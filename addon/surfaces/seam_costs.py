# SPDX-License-Identifier: GPL-3.0-or-later
"""Where seams may run, how dear they are there, and how many there are. Plain numpy, no bpy."""

from collections.abc import Sequence

import numpy as np

from .arrays import Booleans, Floats, Integers, Reals
from .surface import Surface

# Scans are meshes whose median edge is below this part of the diagonal of the bounding box.
_FINE = 0.008
# A seam costs 1 + this · w / (1 - w) times as much where it is kept off with the weight w.
_KEPT_OFF = 9.0
# A seam costs 1 / (1 + this) as much where it is preferred with the weight 1.
_PREFERRED = 3.0
# Weights that are 1 but for rounding.
_WHOLE = 1 - 1e-6
# The factor of edges at which seams are forbidden, where there is no way around them.
_UNAVOIDABLE = 1e4


def vertex_factors(keep_off: Reals, prefer: Reals) -> Floats:
    """How dear a seam is at each vertex, (n,), by weights (n,) from 0 to 1; infinite where it is kept off."""
    off = np.clip(keep_off.astype(float), 0, 1)
    dear = np.full(len(off), np.inf)
    is_free = off < _WHOLE
    dear[is_free] = 1 + _KEPT_OFF * off[is_free] / (1 - off[is_free])
    factors: Floats = dear / (1 + _PREFERRED * np.clip(prefer.astype(float), 0, 1))
    return factors


def finite(factors: Floats) -> Floats:
    """Factors that allow seams where these forbid them, as the last way out."""
    return np.minimum(factors, _UNAVOIDABLE)


def is_scan(surface: Surface) -> bool:
    """Whether the edges of a surface are short beside its size, as those of scans are."""
    first, second = _polygon_edges(surface)
    points = surface.positions[np.unique(surface.triangles)]
    lengths = np.linalg.norm(surface.positions[first] - surface.positions[second], axis=1)
    return bool(np.median(lengths) < _FINE * np.linalg.norm(np.ptp(points, axis=0)))


def slit_count(seams: Integers, boundary_loops: Sequence[Integers]) -> int:
    """The number of ends of seams (k, 2) inside a surface with these boundaries."""
    ends, count = np.unique(seams, return_counts=True)
    return int(np.count_nonzero((count == 1) & ~np.isin(ends, np.concatenate([[], *boundary_loops]))))


def edge_keys(surface: Surface) -> Integers:
    """A number for each edge of the mesh at a polygon of the surface, ascending; diagonals have none."""
    first, second = _polygon_edges(surface)
    return np.unique(_keys(first, second, len(surface.positions)))


def are_edges(surface: Surface, keys: Integers, pairs: Integers) -> Booleans:
    """Which pairs of vertices (k, 2) of the surface, -1 at centers of polygons, are among its `edge_keys`."""
    return np.isin(_keys(pairs[:, 0], pairs[:, 1], len(surface.positions)), keys) & (pairs >= 0).all(axis=1)


def triangle_edges(faces: Integers) -> Integers:
    """The edges (e, 2) of triangles (m, 3), each once, the lower vertex first, ascending."""
    ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    count = int(faces.max(initial=0)) + 1
    keys = np.unique(_keys(ends[:, 0], ends[:, 1], count))
    return np.stack([keys // count, keys % count], axis=1)


def _polygon_edges(surface: Surface) -> tuple[Integers, Integers]:
    """The ends of the edges around the polygons of a surface."""
    polygons = np.unique(surface.polygons)
    size, start = surface.polygon_size[polygons], surface.polygon_start[polygons]
    owner = np.repeat(np.arange(len(polygons)), size)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(size) - size, size)
    corner, following = start[owner] + place, start[owner] + (place + 1) % size[owner]
    return surface.corner_vertex[corner], surface.corner_vertex[following]


def _keys(first: Integers, second: Integers, count: int) -> Integers:
    low, high = np.minimum(first, second).astype(np.int64), np.maximum(first, second)
    return low * count + high
