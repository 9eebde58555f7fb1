# SPDX-License-Identifier: GPL-3.0-or-later
"""Which triangles hang together. Plain numpy, no bpy."""

import numpy as np

from .arrays import Booleans, Floats, Integers


def joined_by_edges(faces: Integers) -> Integers:
    """The component (m,), from 0, of each triangle (m, 3); those with a common edge are in the same one.

    Every triangle takes the lowest number among its neighbors, and that of the triangle of this number, until
    none changes.
    """
    edge, count = _edges(faces)
    label = np.arange(len(faces))
    while True:
        lowest = np.full(count, len(faces))
        np.minimum.at(lowest, edge.ravel(), np.repeat(label, 3))
        new = np.minimum(label, lowest[edge].min(axis=1, initial=len(faces)))
        # The old label's triangle comes along, which joins large parts in few rounds.
        np.minimum.at(new, label, new.copy())
        new = new[new]
        if (new == label).all():
            return np.unique(label, return_inverse=True)[1].reshape(-1)
        label = new


def mirrored(component: Integers, signed_areas: Floats) -> Booleans:
    """Which components (k,) are mirrored: the signed areas (m,) of their triangles sum up to less than 0."""
    return np.bincount(component, signed_areas) < 0


def _edges(faces: Integers) -> tuple[Integers, int]:
    """The number (m, 3) of the edge after each corner, and how many edges there are."""
    ends = np.stack([faces, np.roll(faces, -1, axis=1)])
    low, high = ends.min(axis=0).astype(np.int64), ends.max(axis=0)
    distinct, edge = np.unique(low * (int(faces.max(initial=0)) + 1) + high, return_inverse=True)
    return edge.reshape(-1, 3), len(distinct)
