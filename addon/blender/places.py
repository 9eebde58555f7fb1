# SPDX-License-Identifier: GPL-3.0-or-later
"""Where objects stand in the world, and where those stood that were put beside another to be seen."""

from typing import Any

import bpy
import numpy as np
from bpy.props import FloatVectorProperty
from mathutils import Matrix, Vector

from ..surfaces.arrays import Floats
from .types import MeshObject

_GAP = 0.1  # over the larger of the two widths
_SAME = 1e-5  # locations have single precision


def put_beside(obj: MeshObject, other: MeshObject) -> None:
    """Moves an object to the right of another, along X, on the same ground and with the same middle in Y.

    It remembers where it stood; nothing of it but its location changes.
    """
    (low, high), (of_other, high_of_other) = _box(obj), _box(other)
    gap = _GAP * max(high[0] - low[0], high_of_other[0] - of_other[0])
    away = Vector(
        (
            high_of_other[0] + gap - low[0],
            ((of_other + high_of_other) - (low + high))[1] / 2,
            of_other[2] - low[2],
        )
    )
    obj.authalic_home = obj.location
    obj.location += _from_location(obj).inverted_safe() @ away
    obj.authalic_beside = obj.location


def put_back(obj: MeshObject) -> None:
    """Moves an object that was put beside another back to where it stood."""
    obj.location = obj.authalic_home
    obj.property_unset("authalic_home")
    obj.property_unset("authalic_beside")


def is_beside(obj: MeshObject) -> bool:
    """Whether an object was put beside another and has not been moved since."""
    place = Vector(obj.authalic_beside)
    return obj.is_property_set("authalic_beside") and (place - obj.location).length <= _SAME * place.length


def home(obj: MeshObject) -> Matrix:
    """The matrix into the world of an object, as it was before the object was put beside another."""
    matrix = obj.matrix_world.copy()
    if is_beside(obj):
        back: Any = _from_location(obj) @ (Vector(obj.authalic_home) - Vector(obj.authalic_beside))
        matrix = Matrix.Translation(back) @ matrix
    return matrix


def box_of(objects: list[MeshObject]) -> tuple[Floats, Floats]:
    """The lowest and the highest coordinates (3,) of several objects in the world."""
    boxes = [_box(obj) for obj in objects]
    lows, highs = np.array([low for low, _ in boxes]), np.array([high for _, high in boxes])
    return lows.min(axis=0), highs.max(axis=0)


def _from_location(obj: MeshObject) -> Matrix:
    """The linear part of the way from an object's location into the world: that of its parents."""
    return (obj.matrix_world @ obj.matrix_basis.inverted_safe()).to_3x3()


def _box(obj: MeshObject) -> tuple[Floats, Floats]:
    """The lowest and the highest coordinates (3,) of an object's bounding box in the world."""
    corners = np.array([obj.matrix_world @ Vector(tuple(corner)) for corner in obj.bound_box])
    return corners.min(axis=0), corners.max(axis=0)


_PROPERTIES: Any = bpy.types.Object


def register() -> None:
    # The locations before and after the object was put beside another.
    for name in ("authalic_home", "authalic_beside"):
        setattr(_PROPERTIES, name, FloatVectorProperty(size=3, options={"HIDDEN"}))


def unregister() -> None:
    del _PROPERTIES.authalic_beside
    del _PROPERTIES.authalic_home
