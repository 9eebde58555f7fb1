# SPDX-License-Identifier: GPL-3.0-or-later
"""The mask of an object: the vertex group that a registration leaves out, saved with the object."""

from typing import Any

import bpy
from bpy.props import StringProperty

_PROPERTIES: Any = bpy.types.Object


def register() -> None:
    _PROPERTIES.authalic_mask = StringProperty(
        name="Mask",
        description="A vertex group whose vertices, from a weight of 0.5 on, are not matched. On the object "
        "that is wrapped they follow their surroundings",
    )


def unregister() -> None:
    del _PROPERTIES.authalic_mask
