# SPDX-License-Identifier: GPL-3.0-or-later
"""Unfolds the few faces that straight edges have folded over in a layout. Plain numpy, no bpy.

Local optimisation as by Freitag and Plassmann (2000): one vertex after the other moves to where the worst of
its faces is best. As this worst is concave in the place of the vertex, a pattern search finds the best.
"""

import numpy as np

from ..surfaces import triangulation

_GOOD = 0.25
# Sweeps without success after which to take in one more ring of faces, and to give up.
_GROWING = 3
_PATIENCE = 12
_DIRECTIONS = np.stack([np.cos(np.arange(12) * np.pi / 6), np.sin(np.arange(12) * np.pi / 6)], axis=1)
_HALVINGS = 14
# Blender keeps UVs in single precision; some more for islands that share the square with others.
_ROUNDING = 4 * float(np.finfo(np.float32).eps)


def folded(uv):
    """Faces of images (m, 3, 2) that are folded over, or so thin that rounding might fold them over."""
    a, b, c = uv[:, 0], uv[:, 1], uv[:, 2]
    sides = np.maximum(np.abs(b - a), np.abs(c - a)).sum(axis=1)
    size = max(np.ptp(uv[..., axis]) for axis in (0, 1))
    return np.flatnonzero(~(triangulation.signed_areas(uv) > _ROUNDING * size * sides))


def folded_when_rounded(uv):
    """Faces of images (m, 3, 2) that are folded over in single precision where they alone fill the square."""
    low = uv.min(axis=(0, 1))
    rounded = ((uv - low) / (uv.max(axis=(0, 1)) - low).max()).astype(np.float32).astype(float)
    return np.flatnonzero(~(triangulation.signed_areas(rounded) > 0))


def untangle(chart, areas, movable):
    """Moves places of a `charts.Chart` until no face is folded over, or nothing helps any more.

    The faces' areas should be `areas` (m,). Vertices that are not in the mask `movable` (n,) stay.
    """
    uv, corners = chart.uv(), _Corners(chart.faces)
    fewest, since = len(chart.faces), 0
    while len(bad := folded(uv)):
        fewest, since = (len(bad), 0) if len(bad) < fewest else (fewest, since + 1)
        if since > _PATIENCE:
            return
        for _ in range(since // _GROWING):
            bad = corners.faces_about(np.unique(chart.faces[bad]))
        for vertex in np.unique(chart.faces[bad]):
            if movable[vertex]:
                _improve(chart, uv, areas, vertex, corners.of(vertex))


class _Corners:
    """The corners at each vertex of faces (m, 3)."""

    def __init__(self, faces):
        self._order = np.argsort(faces.ravel(), kind="stable")
        self._starts = np.searchsorted(faces.ravel()[self._order], np.arange(faces.max() + 2))

    def of(self, vertex):
        return self._order[self._starts[vertex] : self._starts[vertex + 1]]

    def faces_about(self, vertices):
        return np.unique(np.concatenate([self.of(vertex) for vertex in vertices]) // 3)


def _improve(chart, uv, areas, vertex, corners):
    """Moves one vertex to where its worst face is best."""
    face, corner = np.divmod(corners, 3)
    moves, wanted = chart.moves[face, corner], areas[face]
    second, third = uv[face, (corner + 1) % 3], uv[face, (corner + 2) % 3]

    def worst(places):
        own = moves.signs[:, None] * places[:, None] + moves.shifts
        a, b = second - own, third - own
        least = ((a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]) / (2 * wanted)).min(axis=1)
        return np.where(chart.layout.within(places), least, -np.inf)

    place = chart.places[vertex]
    value = worst(place[None])[0]
    if value >= _GOOD:
        return
    step = np.linalg.norm(second - third, axis=1).max()
    for _ in range(_HALVINGS):
        trial = place + step * _DIRECTIONS
        values = worst(trial)
        best = values.argmax()
        if values[best] > value:
            place, value = trial[best], values[best]
        else:
            step /= 2
    chart.places[vertex] = place
    uv[face, corner] = moves.of(place)
    chart.follow(uv)
