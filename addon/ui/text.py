# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures and problems of landmarks in panels."""

import textwrap
from collections.abc import Sequence
from typing import Any

import bpy

_LETTER = 7.5  # pixels that a letter takes on average
_EXACT = 5e-4  # percent
# Green, yellow and red dots, and the errors in percent up to which they stand.
_DOTS = ((0.1, "COLORSET_03_VEC"), (1.0, "COLORSET_09_VEC"), (float("inf"), "COLORSET_01_VEC"))


def draw_aside(row: bpy.types.UILayout, text: str) -> None:
    """A figure at the right end of a row of a list, grayed out."""
    column = row.row()
    column.alignment = "RIGHT"
    column.active = False
    column.label(text=text, translate=False)


def icon_of_error(error: float, problem: str | None) -> Any:
    """The icon for the last error of a pair, in percent of the target's size, negative if there was none."""
    if problem is not None:
        return "ERROR"
    if error < 0:
        return "DOT"
    return next(icon for most, icon in _DOTS if error <= most)


def draw_error(layout: bpy.types.UILayout, pairs: Any, index: int) -> None:
    """The error of the active pair in the last registration, if there was one."""
    error = pairs[index].error if index < len(pairs) else -1.0
    if error >= 0:
        row = layout.row()
        row.active = False
        said = "Meets its partner" if error < _EXACT else f"Missed by {error:.2g} % of the target's size"
        row.label(text=said, translate=False)


def draw_problems(
    layout: bpy.types.UILayout, lines: Sequence[str], context: bpy.types.Context, icon: Any = "ERROR"
) -> None:
    """Some sentences in a box, as wide as the panel."""
    if not lines:
        return
    box = layout.box().column(align=True)
    width = int(context.region.width / (_LETTER * context.preferences.system.ui_scale)) - 8
    for number, line in enumerate(textwrap.wrap("; ".join(lines), max(width, 16))):
        box.label(text=line, icon="BLANK1" if number else icon, translate=False)
