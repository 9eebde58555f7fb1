# SPDX-License-Identifier: GPL-3.0-or-later
"""The entries in Blender's menus, by which F3 finds the operators in every mode."""

from collections.abc import Callable
from typing import Any

import bpy


class AUTHALIC_MT_object(bpy.types.Menu):
    bl_label = "Authalic"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator("authalic.unwrap", icon="UV")
        layout.operator("authalic.mark_seams")
        layout.operator("authalic.fix_flips")
        layout.operator("authalic.select_reported")
        layout.operator("authalic.measure")
        layout.operator("authalic.show_heat_map")
        layout.operator("authalic.set_texel_density")
        layout.separator()
        layout.operator("authalic.sphere_shape_key", icon="SHAPEKEY_DATA")
        layout.separator()
        layout.operator("authalic.landmark_pick", icon="EYEDROPPER")
        layout.operator("authalic.landmark_add", icon="ADD")
        layout.operator("authalic.landmark_mirror", icon="MOD_MIRROR")
        layout.operator("authalic.landmark_curve_add", icon="ADD")
        layout.operator("authalic.landmark_import", icon="IMPORT")
        layout.operator("authalic.landmark_export", icon="EXPORT")
        layout.operator("authalic.register", icon="SHAPEKEY_DATA")
        layout.operator("authalic.transfer", icon="IMPORT")
        layout.separator()
        layout.operator("authalic.swap_target", icon="ARROW_LEFTRIGHT")
        layout.operator("authalic.side_by_side", icon="SNAP_EDGE")


def _draw_object_menu(self: Any, _context: Any) -> None:
    self.layout.separator()
    self.layout.menu("AUTHALIC_MT_object")


def _draw_links_menu(self: Any, _context: Any) -> None:
    self.layout.separator()
    self.layout.operator("authalic.transfer", text="Transfer through Landmarks")


def _draw_unwrap_menu(self: Any, _context: Any) -> None:
    self.layout.separator()
    self.layout.operator("authalic.unwrap")


def _draw_uv_menu(self: Any, _context: Any) -> None:
    self.layout.separator()
    self.layout.operator("authalic.mark_seams")
    self.layout.operator("authalic.fix_flips")
    self.layout.operator("authalic.select_reported")


def _draw_edge_menu(self: Any, _context: Any) -> None:
    self.layout.separator()
    self.layout.operator("authalic.mark_seams")


def _draw_shape_key_menu(self: Any, _context: Any) -> None:
    self.layout.separator()
    self.layout.operator("authalic.sphere_shape_key", icon="SHAPEKEY_DATA")


ENTRIES: tuple[tuple[str, Callable[[Any, Any], None]], ...] = (
    ("VIEW3D_MT_object", _draw_object_menu),
    ("VIEW3D_MT_make_links", _draw_links_menu),
    # This menu serves the UV editor and the 3D view.
    ("IMAGE_MT_uvs_unwrap", _draw_unwrap_menu),
    ("IMAGE_MT_uvs", _draw_uv_menu),
    ("VIEW3D_MT_uv_map", _draw_uv_menu),
    ("VIEW3D_MT_edit_mesh_edges", _draw_edge_menu),
    ("MESH_MT_shape_key_context_menu", _draw_shape_key_menu),
)
_TYPES: Any = bpy.types


def register() -> None:
    bpy.utils.register_class(AUTHALIC_MT_object)
    for name, draw in ENTRIES:
        getattr(_TYPES, name).append(draw)


def unregister() -> None:
    for name, draw in reversed(ENTRIES):
        getattr(_TYPES, name).remove(draw)
    bpy.utils.unregister_class(AUTHALIC_MT_object)
