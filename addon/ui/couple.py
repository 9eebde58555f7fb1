# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel Wrap and Morph of the 3D view with the two objects; its other parts are panels within it."""

import bpy

from ..blender.types import PanelMixin, is_mesh
from ..landmarks.objects import active_source

PARENT = "AUTHALIC_PT_registration_view3d"


def has_source(context: bpy.types.Context) -> bool:
    """Whether there is an object to wrap."""
    return is_mesh(context.object)


class Part(PanelMixin):
    """A mixin for the panels within Wrap and Morph."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Authalic"
    bl_parent_id = PARENT

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return has_source(context)


class AUTHALIC_PT_registration_view3d(bpy.types.Panel):
    bl_label = "Wrap and Morph"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Authalic"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a plain set)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return has_source(context)

    def draw(self, context: bpy.types.Context) -> None:
        source = active_source(context)
        column = self.layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        split = column.split(factor=0.4)
        title = split.row()
        title.alignment = "RIGHT"
        title.label(text="Source")
        split.label(text=source.name, icon="OBJECT_DATA", translate=False)
        column.prop(source, "authalic_target")
        row = self.layout.row(align=True)
        row.operator("authalic.swap_target", text="Swap", icon="ARROW_LEFTRIGHT")
        row.operator("authalic.side_by_side", icon="SNAP_EDGE")


def register() -> None:
    bpy.utils.register_class(AUTHALIC_PT_registration_view3d)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_PT_registration_view3d)
