# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels with the two buttons of a registration and their options, within Wrap and Morph."""

import bpy

from ..blender import shape_keys
from ..blender.types import MeshObject
from ..jobs.register import key_name
from ..landmarks.objects import active_source, sources
from ..operators import transfer, wrap_options
from . import couple, curves


class AUTHALIC_PT_wrap(couple.Part, bpy.types.Panel):
    bl_label = "Wrap"

    def draw(self, context: bpy.types.Context) -> None:
        layout, source = self.layout, active_source(context)
        options = source.authalic_wrap  # with which the button starts
        column = layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        wrap_options.draw_main(column, options)
        if options.method == "CURVES":
            curves.draw_hint(layout, source, context)
        row = layout.row()
        row.scale_y = 1.5
        row.operator("authalic.register", icon="SHAPEKEY_DATA")
        _draw_slider(layout, source)


def _draw_slider(layout: bpy.types.UILayout, source: MeshObject) -> None:
    """The slider of the shape key that morphs the source into its target, once there is one."""
    key = shape_keys.find(source, key_name(source.authalic_target)) if source.authalic_target else None
    if key is not None:
        row = layout.row()
        row.active = not key.mute
        row.prop(key, "value", text="Morph", slider=True)


class AUTHALIC_PT_wrap_advanced(couple.Part, bpy.types.Panel):
    bl_label = "Advanced"
    bl_parent_id = "AUTHALIC_PT_wrap"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a plain set)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        wrap_options.draw_more(layout, active_source(context).authalic_wrap)


class AUTHALIC_PT_transfer(couple.Part, bpy.types.Panel):
    bl_label = "Transfer"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a plain set)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator("authalic.transfer", icon="IMPORT")
        receivers = sources(context)
        if len(receivers) > 1:
            layout.label(text=f"To {len(receivers)} selected objects", translate=False)
        layout.use_property_split = True
        layout.use_property_decorate = False
        transfer.draw_options(layout, context.window_manager.operator_properties_last("authalic.transfer"))


_CLASSES = (AUTHALIC_PT_wrap, AUTHALIC_PT_wrap_advanced, AUTHALIC_PT_transfer)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
