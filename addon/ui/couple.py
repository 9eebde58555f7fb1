# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel Wrap and Morph of the 3D view with the two objects; its other parts are panels within it."""

import bpy

from ..blender import places
from ..blender.types import MeshObject, PanelMixin, is_mesh
from ..jobs import unjoined
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
        _draw_mask(column, source)
        column.prop(source, "authalic_target")
        if source.authalic_target is not None:
            _draw_mask(column, source.authalic_target)
        _draw_merge(self.layout, source)
        row = self.layout.row(align=True)
        row.operator("authalic.swap_target", text="Swap", icon="ARROW_LEFTRIGHT")
        target = source.authalic_target
        is_beside = target is not None and places.is_beside(target)
        row.operator("authalic.side_by_side", icon="SNAP_EDGE", depress=is_beside)


def _draw_mask(layout: bpy.types.UILayout, obj: MeshObject) -> None:
    """The vertex group of an object that is left out, where it has any."""
    if obj.vertex_groups or obj.authalic_mask:
        layout.prop_search(obj, "authalic_mask", obj, "vertex_groups")


def _draw_merge(layout: bpy.types.UILayout, source: MeshObject) -> None:
    """A button for each object whose vertices were found to lie on each other."""
    for side, obj in (("SOURCE", source), ("TARGET", source.authalic_target)):
        if obj is not None and unjoined.is_unjoined(obj):
            row = layout.row()
            row.label(text=obj.name, icon="ERROR", translate=False)
            row.operator("authalic.merge_by_distance").side = side


def register() -> None:
    bpy.utils.register_class(AUTHALIC_PT_registration_view3d)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_PT_registration_view3d)
