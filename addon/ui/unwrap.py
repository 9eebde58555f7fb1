# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar panels of the 3D view and the UV editor."""

from collections.abc import Callable
from typing import Any

import bpy

from ..blender.types import PanelMixin
from ..jobs import reported
from ..operators import mark_seams, solving, sphere_shape_key, unwrap
from . import spaces, text


class _Panel(PanelMixin):
    bl_category = "Authalic"
    bl_region_type = "UI"


def _options(context: bpy.types.Context) -> Any:
    """The options that the button was last used with, and will use next."""
    return context.window_manager.operator_properties_last("authalic.unwrap")


class _UnwrapPanel(_Panel):
    bl_label = "Authalic Unwrap"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        row = layout.row()
        row.scale_y = 1.5
        row.operator("authalic.unwrap", icon="UV")
        if reported.last():
            _draw_reported(layout)
        layout.use_property_split = True
        layout.use_property_decorate = False
        solving.draw_presets(layout.column(), _options(context))
        _draw_live(layout, context)
        unwrap.draw_main(layout, _options(context))


def _draw_live(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The slider from areas to shapes, which the UVs can follow."""
    manager: Any = context.window_manager
    row = layout.row(align=True)
    row.use_property_split = False
    slider = row.row(align=True)
    slider.active = _options(context).method == "GAUSS_NEWTON" and _options(context).area_tolerance == 0
    slider.prop(_options(context), "angle_weight", text="Shape", slider=True)
    row.prop(manager, "authalic_live", toggle=True, icon="PAUSE" if manager.authalic_live else "PLAY")
    if manager.authalic_live and manager.authalic_live_figures:
        layout.label(text=manager.authalic_live_figures, translate=False)


def _draw_reported(layout: bpy.types.UILayout) -> None:
    """Buttons that select what the last report named."""
    row = layout.row(align=True)
    row.operator("authalic.select_reported", text="Select Worst", icon="ERROR").which = "WORST"
    row.operator("authalic.select_reported", text="Select Reported").which = "ALL"


class _Section(_Panel):
    """A mixin for the closed panels within the panel of the unwrap."""

    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a plain set)
    draw_section: Callable[[bpy.types.UILayout, Any], None]

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        self.draw_section(layout, _options(context))


class _ClosedMeshes(_Section):
    bl_label = "Closed Meshes"
    draw_section = staticmethod(unwrap.draw_closed)


class _Packing(_Section):
    bl_label = "Packing"
    draw_section = staticmethod(unwrap.draw_packing)


class _Advanced(_Section):
    bl_label = "Advanced"
    draw_section = staticmethod(unwrap.draw_advanced)


class _InView3D(PanelMixin):
    bl_space_type = "VIEW_3D"


class _InUvEditor(PanelMixin):
    bl_space_type = "IMAGE_EDITOR"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return spaces.shows_uvs(context)


class AUTHALIC_PT_unwrap_view3d(_InView3D, _UnwrapPanel, bpy.types.Panel):
    pass


class AUTHALIC_PT_unwrap_closed_view3d(_InView3D, _ClosedMeshes, bpy.types.Panel):
    bl_parent_id = "AUTHALIC_PT_unwrap_view3d"


class AUTHALIC_PT_unwrap_packing_view3d(_InView3D, _Packing, bpy.types.Panel):
    bl_parent_id = "AUTHALIC_PT_unwrap_view3d"


class AUTHALIC_PT_unwrap_advanced_view3d(_InView3D, _Advanced, bpy.types.Panel):
    bl_parent_id = "AUTHALIC_PT_unwrap_view3d"


class AUTHALIC_PT_unwrap_image(_InUvEditor, _UnwrapPanel, bpy.types.Panel):
    pass


class AUTHALIC_PT_unwrap_closed_image(_InUvEditor, _ClosedMeshes, bpy.types.Panel):
    bl_parent_id = "AUTHALIC_PT_unwrap_image"


class AUTHALIC_PT_unwrap_packing_image(_InUvEditor, _Packing, bpy.types.Panel):
    bl_parent_id = "AUTHALIC_PT_unwrap_image"


class AUTHALIC_PT_unwrap_advanced_image(_InUvEditor, _Advanced, bpy.types.Panel):
    bl_parent_id = "AUTHALIC_PT_unwrap_image"


class AUTHALIC_PT_seams_view3d(_Panel, bpy.types.Panel):
    bl_label = "Seams"
    bl_space_type = "VIEW_3D"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        row = layout.row()
        row.scale_y = 1.5
        row.operator("authalic.mark_seams", text="Mark Seams", icon="EDGESEL")
        _draw_preview(layout, context)
        layout.use_property_split = True
        layout.use_property_decorate = False
        # The options that the button was last used with, and will use next.
        mark_seams.draw_options(
            layout, context.window_manager.operator_properties_last("authalic.mark_seams")
        )


def _draw_preview(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    manager: Any = context.window_manager
    is_on = manager.authalic_seam_preview
    layout.prop(manager, "authalic_seam_preview", toggle=True, icon="HIDE_OFF" if is_on else "HIDE_ON")
    if is_on and manager.authalic_seam_figures:
        text.draw_problems(layout, [manager.authalic_seam_figures], context, icon="INFO")


class AUTHALIC_PT_sphere_shape_key_view3d(_Panel, bpy.types.Panel):
    bl_label = "Sphere Shape Key"
    bl_space_type = "VIEW_3D"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a plain set)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator("authalic.sphere_shape_key", icon="SHAPEKEY_DATA")
        layout.use_property_split = True
        layout.use_property_decorate = False
        options = context.window_manager.operator_properties_last("authalic.sphere_shape_key")
        sphere_shape_key.draw_options(layout, options)


_CLASSES = (
    AUTHALIC_PT_unwrap_view3d,
    AUTHALIC_PT_unwrap_closed_view3d,
    AUTHALIC_PT_unwrap_packing_view3d,
    AUTHALIC_PT_unwrap_advanced_view3d,
    AUTHALIC_PT_seams_view3d,
    AUTHALIC_PT_sphere_shape_key_view3d,
    AUTHALIC_PT_unwrap_image,
    AUTHALIC_PT_unwrap_closed_image,
    AUTHALIC_PT_unwrap_packing_image,
    AUTHALIC_PT_unwrap_advanced_image,
)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
