# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights that are painted on meshes: vertex groups and color attributes, in object mode and in edit mode."""

from typing import Any

import bpy
import numpy as np

from ..surfaces import density
from ..surfaces.arrays import Integers, Reals
from . import meshes, vertex_groups
from .types import MeshObject


def names(obj: MeshObject) -> list[str]:
    """The names of an object's vertex groups and color attributes."""
    colors = [color.name for color in obj.data.color_attributes if color.domain in ("POINT", "CORNER")]
    return [*vertex_groups.names(obj), *colors]


def of_corners(
    obj: MeshObject, name: str, corner_vertex: Integers, shown: bpy.types.Mesh | None = None
) -> Reals | None:
    """The weights (c,) in a vertex group, or the luminances of a color, at corners with vertices (c,).

    Those of the object's mesh, or of the mesh `shown` as its modifiers have made it. A group comes first
    where both have the name; None where the object has neither.
    """
    if name in vertex_groups.names(obj):
        return vertex_groups.weights(obj, name, shown)[corner_vertex]
    with meshes.readable(shown or obj.data) as mesh:
        color: Any = mesh.color_attributes.get(name)
        if color is None or color.domain not in ("POINT", "CORNER"):
            return None
        values = density.luminance(_colors(color))
        return values if color.domain == "CORNER" else values[corner_vertex]


def _colors(attribute: bpy.types.Attribute) -> Reals:
    """Linear colors (n, 4)."""
    data: Any = attribute
    values = np.empty(4 * len(data.data), np.float32)
    data.data.foreach_get("color", values)
    return values.reshape(-1, 4)
