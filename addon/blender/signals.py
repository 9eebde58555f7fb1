# SPDX-License-Identifier: GPL-3.0-or-later
"""Signals at the vertices of meshes that are not in edit mode: vertex groups, attributes and colors."""

from typing import Any

import numpy as np

from ..surfaces import density
from ..surfaces.arrays import Floats
from . import vertex_groups
from .types import MeshObject

_NUMBERS = {"FLOAT", "INT", "INT8", "BOOLEAN"}
_COLORS = {"FLOAT_COLOR", "BYTE_COLOR"}


def names(obj: MeshObject) -> list[str]:
    """The names of vertex groups, and of attributes of vertices that are numbers or colors."""
    attributes = [
        each.name
        for each in obj.data.attributes
        if each.domain == "POINT" and each.data_type in _NUMBERS | _COLORS and _is_shown(each.name)
    ]
    return list(dict.fromkeys([*vertex_groups.names(obj), *attributes]))


def read(obj: MeshObject, name: str) -> Floats | None:
    """The values (n,) of a signal; None where the object has none of this name. Groups come first."""
    if name in vertex_groups.names(obj):
        return vertex_groups.weights(obj, name).astype(float)
    if name not in names(obj):
        return None
    attribute: Any = obj.data.attributes[name]
    count = len(obj.data.vertices)
    if attribute.data_type in _COLORS:
        colors = np.empty(4 * count, np.float32)
        attribute.data.foreach_get("color", colors)
        return np.asarray(density.luminance(colors.reshape(-1, 4)), float)
    values = np.empty(count, np.float32 if attribute.data_type == "FLOAT" else np.int32)
    if attribute.data_type == "BOOLEAN":
        values = np.empty(count, bool)
    attribute.data.foreach_get("value", values)
    return values.astype(float)


def _is_shown(name: str) -> bool:
    """Whether an attribute is neither Blender's own nor one with the marks of landmarks."""
    return not name.startswith((".", "authalic_"))
