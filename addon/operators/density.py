# SPDX-License-Identifier: GPL-3.0-or-later
"""The property that names a density, which several operators have."""

from typing import Any

import bpy
from bpy.props import StringProperty

from ..blender import weights
from ..blender.types import is_mesh


def _names(_owner: Any, context: bpy.types.Context, _text: str) -> list[str]:
    obj = context.object
    return weights.names(obj) if is_mesh(obj) else []


def property_of_sources() -> Any:
    """A property for the name of a vertex group or color attribute of the active object."""
    return StringProperty(
        name="Density",
        description="A vertex group or color attribute that says where more texture is wanted: faces of the "
        "weight or brightness 1 should get eight times as much as those of 0. Empty for the same everywhere",
        default="",
        search=_names,
    )
