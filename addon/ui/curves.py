# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the registration panel with the list of landmark curves and its buttons."""

from typing import Any

import bpy

from ..blender.types import LandmarkCurve, MeshObject
from ..landmarks import curve_marks
from ..landmarks import curves as landmark_curves
from ..landmarks.objects import target_problem
from ..overlay.curves import icon
from . import text

_shown: list[landmark_curves.Curve] = []  # the pairs of the list that is being drawn


class AUTHALIC_UL_landmark_curves(bpy.types.UIList):
    """Number, color, name, last error and edge counts of each pair, and a warning if a path is missing."""

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
        number.ui_units_x = 1.1
        number.label(text=str(index + 1), translate=False)
        row.label(icon=icon(index))
        row.prop(item, "name", text="", emboss=False)
        if pair is None:
            return
        if pair.problem is not None:
            row.label(icon="ERROR")
        elif item.error >= 0:
            text.draw_aside(row, f"{item.error:.2f} %")
        text.draw_aside(row, f"{_edges(pair.source)} → {_edges(pair.target)}")


class AUTHALIC_MT_landmark_curves(bpy.types.Menu):
    bl_label = "Landmark Curves"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        for side in ("SOURCE", "TARGET"):
            operator = layout.operator(
                "authalic.landmark_curve_reverse",
                text=f"Reverse {side.capitalize()}",
                icon="ARROW_LEFTRIGHT",
            )
            operator.side = side
        layout.separator()
        layout.operator("authalic.landmark_import", icon="IMPORT")
        layout.operator("authalic.landmark_export", icon="EXPORT")
        layout.separator()
        layout.operator("authalic.landmark_curve_clear", icon="X")


def draw_curves(layout: bpy.types.UILayout, source: MeshObject, context: bpy.types.Context) -> None:
    """A panel within the panel, closed by default."""
    header, body = layout.panel("AUTHALIC_PT_landmark_curves", default_closed=True)
    count = len(source.authalic_landmark_curves)
    header.label(text=f"Landmark Curves ({count})" if count else "Landmark Curves")
    if body is None:
        return
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
    for side in ("SOURCE", "TARGET"):
        operator = row.operator(
            "authalic.landmark_curve_select", text=f"To {side.capitalize()}", icon="VIEWZOOM"
        )
        operator.side = side
    row = body.row()
    row.operator("authalic.landmark_curve_reverse", text="Reverse Target", icon="ARROW_LEFTRIGHT")
    text.draw_error(body, source.authalic_landmark_curves, source.authalic_landmark_curve_index)
    text.draw_problems(body, _problems(source), context)


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


def _edges(path: curve_marks.MarkedPath) -> str:
    if path.problem:
        return "?"
    return f"○{len(path.edges)}" if path.is_closed else str(len(path.edges))


_CLASSES = (AUTHALIC_UL_landmark_curves, AUTHALIC_MT_landmark_curves)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
