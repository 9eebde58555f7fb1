# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the registration panel below the landmarks: the two buttons and their options."""

from typing import Any

import bpy

from ..blender.types import MeshObject
from ..operators import register, transfer
from . import curves


def draw_register(layout: bpy.types.UILayout, source: MeshObject, context: bpy.types.Context) -> None:
    """Below each button stand the options that it was last used with, and will use next."""
    last = context.window_manager.operator_properties_last
    buttons: Any = ("register", register, "SHAPEKEY_DATA"), ("transfer", transfer, "IMPORT")
    for operator, module, icon in buttons:
        column = layout.column()
        row = column.row()
        row.scale_y = 1.5 if operator == "register" else 1.0
        row.operator(f"authalic.{operator}", icon=icon)
        column.use_property_split = True
        column.use_property_decorate = False
        module.draw_options(column, last(f"authalic.{operator}"))
        if operator == "register" and last("authalic.register").method == "CURVES":
            curves.draw_hint(layout, source, context)
