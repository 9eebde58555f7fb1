# SPDX-License-Identifier: GPL-3.0-or-later
"""The offsets of shape keys, carried from the target's mesh to the source's. Plain numpy, no bpy."""

from collections.abc import Callable

import numpy as np

from ..surfaces.arrays import Floats
from .sides import Side

Turn = Callable[[Floats], Floats]
"""Makes offsets (u, 3) of the source's mesh of those of the target's mesh at the source's points."""


def along_surface(matrices: Floats) -> Turn:
    """Offsets turn and grow with the surface around each point, by matrices (u, 3, 3)."""
    return lambda offsets: np.einsum("nij,nj->ni", matrices, offsets)


def everywhere(matrix: Floats) -> Turn:
    """All offsets turn and grow alike, by a matrix (3, 3)."""
    return lambda offsets: offsets @ matrix.T


def into_side(side: Side, to_world: Floats) -> Floats:
    """The linear map (3, 3) from a mesh to its side, by its matrix (4, 4) into the world."""
    return np.linalg.inv(side.matrix[:3, :3]) @ to_world[:3, :3]
