# SPDX-License-Identifier: MIT OR Apache-2.0
"""The linear maps of triangles in space to the plane. This runs inside Blender too, which has numpy only."""

import numpy as np


def jacobians(triangles, corners):
    """The Jacobians (m, 2, 2) of the maps from triangles in space to the plane, and the triangles' areas."""
    a, b = (triangles[:, k] - triangles[:, 0] for k in (1, 2))
    u, v = (corners[:, k] - corners[:, 0] for k in (1, 2))
    side = positive(np.linalg.norm(a, axis=1))
    along = np.einsum("ij,ij->i", a, b) / side
    doubled = np.linalg.norm(np.cross(a, b), axis=1)
    first = u / side[:, None]
    second = (v - along[:, None] * first) / positive(doubled / side)[:, None]
    return np.stack([first, second], axis=2), doubled / 2


def positive(values):
    """Values that can be divided by."""
    return np.maximum(values, 1e-300)
