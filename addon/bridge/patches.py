# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes handed to the native library and cut into patches.

The arrays of a mesh cross here, once for an unwrap, a fix of flips or a sphere: its patches are surfaces of
the library, so that maps and figures of them send images and options only. Other arrays cross elsewhere:

- `islands`: the laid-out mesh of a closed island, which has the points on its seam twice;
- `registrations`: the two surfaces of a registration, and the values of a morph or a transfer;
- `figures.measure`: the triangles to measure, joined where they share UVs.
"""

import numpy as np

import authalic

from ..surfaces.arrays import Floats, Integers


def cut(points: Floats, faces: Integers, seams: Integers | None = None) -> list[authalic.Patch]:
    """The patches of triangles `faces` (m, 3) between `points` (n, 3).

    Coordinates that are not finite count as 0 here; `checked` refuses their patches later.
    """
    return authalic.cut(np.nan_to_num(points, posinf=0, neginf=0), faces, seams=seams)


def checked(patch: authalic.Patch, points: Floats) -> authalic.Surface:
    """The surface of a patch whose vertices are `points` (n, 3); raises MeshError unless all are finite."""
    if np.isfinite(points).all():
        return patch.surface
    return authalic.Surface(points, patch.faces)
