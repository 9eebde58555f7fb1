# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar panel that marks seams, and the entry in the Edge menu."""

from typing import Any

import bpy

from ..operators import mark_seams
from . import text


class AUTHALIC_PT_seams_view3d(bpy.types.Panel):
    bl_label = "Seams"
    bl_category = "Authalic"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"

    def draw(self, context: bpy.types.Context) -> None:
        layout, manager = self.layout, context.window_manager
        row = layout.row()
        row.scale_y = 1.5
        row.operator("authalic.mark_seams", text="Mark Seams", icon="EDGESEL")
        _draw_preview(layout, context)
        layout.use_property_split = True
        layout.use_property_decorate = False
        # The options that the button was last used with, and will use next.
        mark_seams.draw_options(layout, manager.operator_properties_last("authalic.mark_seams"))


def _draw_preview(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    manager: Any = context.window_manager
    is_on = manager.authalic_seam_preview
    layout.prop(manager, "authalic_seam_preview", toggle=True, icon="HIDE_OFF" if is_on else "HIDE_ON")
    if is_on and manager.authalic_seam_figures:
        text.draw_problems(layout, [manager.authalic_seam_figures], context, icon="INFO")


def _draw_menu(self: Any, _context: Any) -> None:
    self.layout.separator()
    self.layout.operator("authalic.mark_seams")


_MENUS: Any = bpy.types


def register() -> None:
    bpy.utils.register_class(AUTHALIC_PT_seams_view3d)
    _MENUS.VIEW3D_MT_edit_mesh_edges.append(_draw_menu)


def unregister() -> None:
    _MENUS.VIEW3D_MT_edit_mesh_edges.remove(_draw_menu)
    bpy.utils.unregister_class(AUTHALIC_PT_seams_view3d)
