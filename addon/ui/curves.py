# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel with the list of landmark curves and its buttons, within Wrap and Morph."""

from typing import Any

import bpy

from ..blender.types import LandmarkCurve, MeshObject
from ..jobs import reversed_curves
from ..landmarks import curves as landmark_curves
from ..landmarks.objects import active_source, target_problem
from ..overlay.curves import icon
from . import couple, text

_shown: list[landmark_curves.Curve] = []  # the pairs of the list that is being drawn


class AUTHALIC_UL_landmark_curves(bpy.types.UIList):
    """Number, color, name and a dot in the color of the last error of each pair, or a warning if a path is
    missing."""

    def draw_item(  # type: ignore[override]
        self,
        _context: bpy.types.Context,
        layout: bpy.types.UILayout,
        _data: Any,
        item: LandmarkCurve,
        _icon: int | None,
        _active_data: Any,
        _active_name: str,
        index: int = 0,
    ) -> None:
        pair = _shown[index] if index < len(_shown) else None
        row = layout.row(align=True)
        number = row.row()
        number.ui_units_x = 1.4
        number.label(text=f"C{index + 1}", translate=False)
        row.label(icon=icon(index))
        row.prop(item, "name", text="", emboss=False)
        if pair is not None:
            # Its tooltip has the numbers of edges.
            dot_icon = text.icon_of_error(item.error, pair.problem)
            dot = row.operator("authalic.landmark_curve_select", text="", icon=dot_icon, emboss=False)
            dot.index, dot.side = index, "SOURCE"


class AUTHALIC_MT_landmark_curves(bpy.types.Menu):
    bl_label = "Landmark Curves"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        reverse = "authalic.landmark_curve_reverse"
        layout.operator(reverse, text="Reverse Source", icon="ARROW_LEFTRIGHT").side = "SOURCE"
        layout.operator(reverse, text="Reverse Target", icon="ARROW_LEFTRIGHT").side = "TARGET"
        layout.separator()
        layout.operator("authalic.landmark_import", icon="IMPORT")
        layout.operator("authalic.landmark_export", icon="EXPORT")
        layout.separator()
        layout.operator("authalic.landmark_curve_clear", icon="X")


class AUTHALIC_PT_landmark_curves(couple.Part, bpy.types.Panel):
    bl_label = "Landmark Curves"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender reads a plain set)

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        count = len(active_source(context).authalic_landmark_curves)
        if count:
            text.draw_aside(self.layout, str(count))

    def draw(self, context: bpy.types.Context) -> None:
        _draw_curves(self.layout, active_source(context), context)


def _draw_curves(body: bpy.types.UILayout, source: MeshObject, context: bpy.types.Context) -> None:
    _shown[:] = landmark_curves.pairs(source, drawing=True)
    row = body.row()
    row.template_list(
        "AUTHALIC_UL_landmark_curves",
        "",
        source,
        "authalic_landmark_curves",
        source,
        "authalic_landmark_curve_index",
        rows=4 if _shown else 3,
    )
    column = row.column(align=True)
    column.operator("authalic.landmark_curve_add", text="", icon="ADD")
    column.operator("authalic.landmark_curve_remove", text="", icon="REMOVE")
    column.separator()
    column.menu("AUTHALIC_MT_landmark_curves", text="", icon="DOWNARROW_HLT")
    row = body.row(align=True)
    row.operator("authalic.landmark_curve_select", text="To Source", icon="VIEWZOOM").side = "SOURCE"
    row.operator("authalic.landmark_curve_select", text="To Target", icon="VIEWZOOM").side = "TARGET"
    reverse = body.row().operator(
        "authalic.landmark_curve_reverse", text="Reverse Target", icon="ARROW_LEFTRIGHT"
    )
    reverse.side = "TARGET"
    draw_reversed(body, source, context)
    text.draw_error(body, source.authalic_landmark_curves, source.authalic_landmark_curve_index)
    text.draw_problems(body, _problems(source), context)


def draw_reversed(layout: bpy.types.UILayout, source: MeshObject, context: bpy.types.Context) -> None:
    """The curves that looked reversed in the last registration, and a button that reverses them."""
    names = [f"C{number + 1}" for number in reversed_curves.of(source)]
    if names:
        verb = "fits" if len(names) == 1 else "fit"
        text.draw_problems(layout, [f"{', '.join(names)} {verb} far better in reverse"], context)
        layout.operator("authalic.landmark_curve_reverse_these", icon="ARROW_LEFTRIGHT")


def draw_hint(layout: bpy.types.UILayout, source: MeshObject, context: bpy.types.Context) -> None:
    """Warns that curves are missing or cannot be used."""
    pairs = landmark_curves.pairs(source, drawing=True)
    bad = sum(pair.problem is not None for pair in pairs)
    if not pairs:
        text.draw_problems(
            layout, ["No landmark curves yet; only boundaries are matched"], context, icon="INFO"
        )
    elif bad:
        text.draw_problems(layout, [f"{bad} of {len(pairs)} curves cannot be used"], context)
    else:
        draw_reversed(layout, source, context)


def _problems(source: MeshObject) -> list[str]:
    """The active pair's problem in words, or how many there are elsewhere in the list."""
    if not _shown:
        return ["Select edges in Edit Mode and add them"] if not target_problem(source) else []
    active = source.authalic_landmark_curve_index
    bad = [number for number, pair in enumerate(_shown) if pair.problem is not None]
    if active in bad:
        pair = _shown[active]
        lacking = pair.source.problem or pair.target.problem
        hint = "; select its edges there in Edit Mode and add them" if lacking else ""
        return [f"{pair.name}: {pair.problem}{hint}"]
    return [f"{len(bad)} of the curves cannot be used"] if bad else []


_CLASSES = (AUTHALIC_UL_landmark_curves, AUTHALIC_MT_landmark_curves, AUTHALIC_PT_landmark_curves)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
