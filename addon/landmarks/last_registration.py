# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the last registration of an object with its target, as they are saved with it."""

from typing import Any

import bpy
from bpy.props import FloatProperty, PointerProperty, StringProperty


class AUTHALIC_PG_registration(bpy.types.PropertyGroup):
    """The settings by the names that they have in the operator; no method if there was no registration."""

    method: StringProperty(options={"HIDDEN"})
    domain: StringProperty(options={"HIDDEN"})
    weight: FloatProperty(options={"HIDDEN"})
    angle_weight: FloatProperty(options={"HIDDEN"})
    # Files of earlier versions were registered by areas.
    energy: StringProperty(options={"HIDDEN"}, default="AREA")
    feature: StringProperty(options={"HIDDEN"})
    feature_weight: FloatProperty(options={"HIDDEN"}, default=1.0)
    position_weight: FloatProperty(options={"HIDDEN"})


_PROPERTIES: Any = bpy.types.Object


def register() -> None:
    bpy.utils.register_class(AUTHALIC_PG_registration)
    _PROPERTIES.authalic_registration = PointerProperty(type=AUTHALIC_PG_registration, options={"HIDDEN"})
    # All that version 0.1.0 kept: the method.
    _PROPERTIES.authalic_registered_by = StringProperty(options={"HIDDEN"})


def unregister() -> None:
    del _PROPERTIES.authalic_registered_by
    del _PROPERTIES.authalic_registration
    bpy.utils.unregister_class(AUTHALIC_PG_registration)
