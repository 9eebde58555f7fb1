# SPDX-License-Identifier: GPL-3.0-or-later
"""Where objects stand in the world."""

import numpy as np
from mathutils import Matrix, Vector

from ..surfaces.arrays import Floats
from .types import MeshObject

_GAP = 0.1  # over the larger of the two widths


def put_beside(obj: MeshObject, other: MeshObject) -> None:
    """Moves an object to the right of another, along X, on the same ground and with the same middle in Y."""
    (low, high), (of_other, high_of_other) = _box(obj), _box(other)
    gap = _GAP * max(high[0] - low[0], high_of_other[0] - of_other[0])
    away = (
        high_of_other[0] + gap - low[0],
        ((of_other + high_of_other) - (low + high))[1] / 2,
        of_other[2] - low[2],
    )
    obj.matrix_world = Matrix.Translation(away) @ obj.matrix_world


def _box(obj: MeshObject) -> tuple[Floats, Floats]:
    """The lowest and the highest coordinates (3,) of an object's bounding box in the world."""
    corners = np.array([obj.matrix_world @ Vector(tuple(corner)) for corner in obj.bound_box])
    return corners.min(axis=0), corners.max(axis=0)
