# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel with the list of landmarks and its buttons, within Wrap and Morph."""

from typing import Any

import bpy

from ..blender.types import Landmark, MeshObject
from ..landmarks import points as landmark_points
from ..landmarks.objects import active_source, target_problem
from . import couple, text

_shown: list[landmark_points.Pair] = []  # the pairs of the list that is being drawn


class AUTHALIC_UL_landmarks(bpy.types.UIList):
    """Number, name and a dot in the color of the error of each pair, or a warning if a vertex was lost."""

    def draw_item(  # type: ignore[override]
        self,
        _context: bpy.types.Context,
        layout: bpy.types.UILayout,
        _data: Any,
        item: Landmark,
        _icon: int | None,
        _active_data: Any,
        _active_name: str,
        index: int = 0,
    ) -> None:
        pair = _shown[index] if index < len(_shown) else None
        row = layout.row(align=True)
        number = row.row()
        number.ui_units_x = 1.1
        number.label(text=str(index + 1), translate=False)
        row.prop(item, "name", text="", emboss=False)
        if pair is not None:
            # Its tooltip has the numbers of the vertices.
            icon = text.icon_of_error(item.error, pair.problem)
            dot = row.operator("authalic.landmark_jump", text="", icon=icon, emboss=False)
            dot.index, dot.side = index, "SOURCE"


class AUTHALIC_PT_landmarks(couple.Part, bpy.types.Panel):
    bl_label = "Landmarks"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene, "authalic_show_landmarks", text="", icon="HIDE_OFF", emboss=False)

    def draw(self, context: bpy.types.Context) -> None:
        _draw_landmarks(self.layout, active_source(context), context)


class AUTHALIC_MT_landmarks(bpy.types.Menu):
    bl_label = "Landmarks"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator("authalic.landmark_import", icon="IMPORT")
        layout.operator("authalic.landmark_export", icon="EXPORT")
        layout.separator()
        layout.operator("authalic.landmark_clear", icon="X")


def _draw_landmarks(layout: bpy.types.UILayout, source: MeshObject, context: bpy.types.Context) -> None:
    _shown[:] = landmark_points.pairs(source, drawing=True)
    row = layout.row()
    row.template_list(
        "AUTHALIC_UL_landmarks",
        "",
        source,
        "authalic_landmarks",
        source,
        "authalic_landmark_index",
        rows=4 if _shown else 3,
    )
    column = row.column(align=True)
    column.operator("authalic.landmark_add", text="", icon="ADD")
    column.operator("authalic.landmark_remove", text="", icon="REMOVE")
    column.separator()
    column.menu("AUTHALIC_MT_landmarks", text="", icon="DOWNARROW_HLT")
    row = layout.row(align=True)
    row.operator("authalic.landmark_pick", icon="EYEDROPPER")
    row.operator("authalic.landmark_mirror", text="Mirror over X", icon="MOD_MIRROR")
    row = layout.row(align=True)
    row.operator("authalic.landmark_jump", text="To Source", icon="VIEWZOOM").side = "SOURCE"
    row.operator("authalic.landmark_jump", text="To Target", icon="VIEWZOOM").side = "TARGET"
    _draw_weight(layout, source)
    text.draw_error(layout, source.authalic_landmarks, source.authalic_landmark_index)
    text.draw_problems(layout, _lines(source), context)


def _draw_weight(layout: bpy.types.UILayout, source: MeshObject) -> None:
    """Whether the active pair meets exactly or only pulls; only where shapes are kept it may pull."""
    wrap, index = source.authalic_wrap, source.authalic_landmark_index
    if index < len(source.authalic_landmarks) and (wrap.method, wrap.energy) == ("POINTS", "SURFACE"):
        landmark = source.authalic_landmarks[index]
        row = layout.row()
        row.prop(landmark, "is_soft")
        weight = row.row()
        weight.active = landmark.is_soft
        weight.prop(landmark, "weight")


def _lines(source: MeshObject) -> list[str]:
    """The problems of the target, or of the pairs."""
    if target := target_problem(source):
        return [target] if source.authalic_target is not None or _shown else []
    return _problems(source.authalic_landmark_index)


def _problems(active: int) -> list[str]:
    bad = [number for number, pair in enumerate(_shown) if pair.problem is not None]
    if active in bad:
        return [f"{_shown[active].name}: {_shown[active].problem}; remove the pair and pick it again"]
    return [f"{len(bad)} of the pairs cannot be used"] if bad else []


_CLASSES = (AUTHALIC_UL_landmarks, AUTHALIC_MT_landmarks, AUTHALIC_PT_landmarks)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
