# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel of the figures of UV maps and of the heat map, and the heat map in popovers and menus."""

from typing import Any

import bpy

from ..blender.types import PanelMixin
from ..operators import heat_map, measure, texel_density
from . import spaces, text


def _figures(context: bpy.types.Context) -> measure.Figures | None:
    """The figures of the last measurement, or else of the heat map; None where neither applies now."""
    return measure.current(context) or heat_map.current(context)


class _Panel(PanelMixin):
    bl_category = "Authalic"
    bl_region_type = "UI"


class _DistortionPanel(_Panel):
    bl_label = "Distortion"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        _draw_heat_map(layout, context)
        column = layout.column(align=True)
        column.operator("authalic.measure", text="Measure")
        column.operator("authalic.fix_flips")
        figures = _figures(context)
        if figures is not None:
            text.draw_problems(layout, [figures.sentence], context, icon="INFO")


class _NumbersPanel(_Panel):
    bl_label = "Advanced"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a plain set)

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        figures = _figures(context)
        if figures is None:
            column.label(text="Measure first, or show the heat map")
            return
        for figure in figures.numbers:  # one in a line: a sidebar is narrow
            column.label(text=figure[:1].upper() + figure[1:], translate=False)


class _TexelDensityPanel(_Panel):
    bl_label = "Texel Density"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a plain set)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        # The options that the button was last used with, and will use next.
        options = context.window_manager.operator_properties_last("authalic.set_texel_density")
        figures = _figures(context)
        if figures is not None:
            layout.label(text=f"Now {texel_density.now(context, figures, options):.4g} px/m", translate=False)
        layout.operator("authalic.set_texel_density")
        layout.use_property_split = True
        layout.use_property_decorate = False
        texel_density.draw_options(layout, options, context)


class _InUvEditor(PanelMixin):
    bl_space_type = "IMAGE_EDITOR"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return spaces.shows_uvs(context)


class AUTHALIC_PT_distortion_view3d(_DistortionPanel, bpy.types.Panel):
    bl_space_type = "VIEW_3D"


class AUTHALIC_PT_distortion_numbers_view3d(_NumbersPanel, bpy.types.Panel):
    bl_space_type = "VIEW_3D"
    bl_parent_id = "AUTHALIC_PT_distortion_view3d"


class AUTHALIC_PT_texel_density_view3d(_TexelDensityPanel, bpy.types.Panel):
    bl_space_type = "VIEW_3D"
    bl_parent_id = "AUTHALIC_PT_distortion_view3d"


class AUTHALIC_PT_distortion_image(_InUvEditor, _DistortionPanel, bpy.types.Panel):
    pass


class AUTHALIC_PT_distortion_numbers_image(_InUvEditor, _NumbersPanel, bpy.types.Panel):
    bl_parent_id = "AUTHALIC_PT_distortion_image"


class AUTHALIC_PT_texel_density_image(_InUvEditor, _TexelDensityPanel, bpy.types.Panel):
    bl_parent_id = "AUTHALIC_PT_distortion_image"


def _draw_heat_map(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The switch of the heat map, and its options while it is on."""
    manager: Any = context.window_manager
    settings = manager.authalic_heat_map
    icon: Any = "HIDE_OFF" if settings.show else "HIDE_ON"
    layout.prop(settings, "show", text="Show Heat Map", toggle=True, icon=icon)
    if settings.show:
        _draw_options(layout, settings)


def _draw_options(layout: bpy.types.UILayout, settings: Any) -> None:
    layout.row().prop(settings, "quantity", expand=True)
    column = layout.column()
    column.use_property_split = True
    column.use_property_decorate = False
    column.prop(settings, "area_end" if settings.quantity == "AREA" else "shear_end")
    column.prop(settings, "opacity")
    column.prop(settings, "density_source")
    column.prop(settings, "legend")


def _draw_popover(self: Any, context: bpy.types.Context) -> None:
    if context.area.type == "IMAGE_EDITOR" and not spaces.shows_uvs(context):
        return
    manager: Any = context.window_manager
    settings = manager.authalic_heat_map
    layout = self.layout.column()
    layout.prop(settings, "show", text="Authalic Heat Map")
    if settings.show:
        _draw_options(layout, settings)


def _draw_menu(self: Any, _context: Any) -> None:
    self.layout.operator("authalic.show_heat_map")
    self.layout.operator("authalic.measure")
    self.layout.operator("authalic.set_texel_density")


_TYPES: Any = bpy.types
_POPOVERS = ("VIEW3D_PT_overlay", "IMAGE_PT_overlay")
# The UV menus of the UV editor and of the 3D view.
_MENUS = ("IMAGE_MT_uvs", "VIEW3D_MT_uv_map")
_CLASSES = (
    AUTHALIC_PT_distortion_view3d,
    AUTHALIC_PT_texel_density_view3d,
    AUTHALIC_PT_distortion_numbers_view3d,
    AUTHALIC_PT_distortion_image,
    AUTHALIC_PT_texel_density_image,
    AUTHALIC_PT_distortion_numbers_image,
)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    for names, draw in ((_POPOVERS, _draw_popover), (_MENUS, _draw_menu)):
        for name in names:
            getattr(_TYPES, name).append(draw)


def unregister() -> None:
    for names, draw in ((_MENUS, _draw_menu), (_POPOVERS, _draw_popover)):
        for name in names:
            getattr(_TYPES, name).remove(draw)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
