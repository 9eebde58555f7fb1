# SPDX-License-Identifier: GPL-3.0-or-later
"""The angle distortion of UVs, by the singular values of the linear map of each triangle."""

import meshes
import numpy as np
from meshes import Array, MeshObject


def of(obj: MeshObject) -> Array:
    """σ₁/σ₂ of each triangle (t,) of the active UV map, in the world."""
    corners, _, points = meshes.triangles(obj)
    image = meshes.uv(obj)[corners].astype(float)
    along, other = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    length = np.linalg.norm(along, axis=1)
    across = np.einsum("ij,ij->i", along, other) / length
    height = np.linalg.norm(np.cross(along, other), axis=1) / length
    # the triangle in its own plane: (0, 0), (length, 0), (across, height)
    first = (image[:, 1] - image[:, 0]) / length[:, None]
    second = (image[:, 2] - image[:, 0] - across[:, None] * first) / height[:, None]
    values = np.linalg.svd(np.stack([first, second], axis=2), compute_uv=False)
    ratio: Array = values[:, 0] / values[:, 1]
    return ratio
