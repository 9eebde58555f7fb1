# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a one-sided surface, like a Moebius strip, is cut to become two-sided. Plain numpy, no bpy.

Polygons are turned to face alike, ring by ring from the first one, those that face alike anyway first. The
edges where rings meet that face opposite ways are cut. The cost is that of all edges for each ring.
"""

from dataclasses import dataclass

import numpy as np

from .arrays import Booleans, Integers


def edges_across(faces: Integers, polygons: Integers) -> Integers:
    """The edges (k, 2), pairs of vertices, along which triangles (m, 3) of a connected manifold must be cut.

    Triangles of the same polygon, of (m,), are never parted.
    """
    pairs = _neighbors(faces, polygons)
    turned = _turned(pairs, int(polygons.max(initial=0)) + 1, int(polygons[0]))
    wrong: Booleans = (turned[pairs.first] != turned[pairs.second]) != pairs.is_against
    edges: Integers = pairs.edges[wrong]
    return edges


@dataclass
class _Pairs:
    """Polygons `first` and `second` (k,) at `edges` (k, 2); `is_against` (k,): they face opposite ways."""

    edges: Integers
    first: Integers
    second: Integers
    is_against: Booleans


def _neighbors(faces: Integers, polygons: Integers) -> _Pairs:
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    low, high = np.minimum(start, end).astype(np.int64), np.maximum(start, end)
    keys = low * (int(faces.max(initial=0)) + 1) + high
    order = np.argsort(keys, kind="stable")
    same = np.flatnonzero(keys[order[1:]] == keys[order[:-1]])
    a, b = order[same], order[same + 1]
    first, second = polygons[a // 3], polygons[b // 3]
    apart = first != second
    a, b = a[apart], b[apart]
    return _Pairs(np.stack([low[a], high[a]], axis=1), first[apart], second[apart], start[a] == start[b])


def _turned(pairs: _Pairs, count: int, start: int) -> Booleans:
    """Which of `count` polygons are turned over, so that neighbors face alike where that is possible."""
    turned, reached = np.zeros(count, bool), np.zeros(count, bool)
    reached[start] = True
    first = np.concatenate([pairs.first, pairs.second])
    second = np.concatenate([pairs.second, pairs.first])
    is_against = np.tile(pairs.is_against, 2)
    while True:
        border = reached[first] & ~reached[second]
        if not border.any():
            return turned
        alike = border & ~is_against
        border = alike if alike.any() else border
        turned[second[border]] = turned[first[border]] != is_against[border]
        reached[second[border]] = True
        open_ = ~reached[second]
        first, second, is_against = first[open_], second[open_], is_against[open_]
