# SPDX-License-Identifier: GPL-3.0-or-later
"""The status bar while something is computed: the keys, what it is, and how far it is."""

from collections.abc import Callable
from typing import Any

import bpy

_BAR_WIDTH = 18.0
"""In units of the interface, each as wide as an icon. A bar without a width is cut off."""


def show(
    context: bpy.types.Context, title: str, fraction: float, message: str, *, can_end_early: bool = True
) -> None:
    """Draws the status bar with a title and a message, and the bar at a fraction."""
    if context.workspace is not None:
        context.workspace.status_text_set(_drawing(title, fraction, message, can_end_early))


def clear(context: bpy.types.Context) -> None:
    """Leaves the status bar to Blender again."""
    if context.workspace is not None:
        context.workspace.status_text_set(None)


def _drawing(
    title: str, fraction: float, message: str, can_end_early: bool
) -> Callable[[bpy.types.Header, Any], None]:
    """A function that draws the status bar: the keys, the operator's name, and a bar with the message."""
    text = f"{message} — {100 * fraction:.0f} %"

    def draw(header: bpy.types.Header, _context: bpy.types.Context) -> None:
        layout = header.layout
        layout.label(text="Cancel", icon="EVENT_ESC")
        if can_end_early:
            layout.label(text="Finish Early", icon="EVENT_RETURN")
        layout.label(text=title)
        row = layout.row()
        row.ui_units_x = _BAR_WIDTH
        row.progress(factor=fraction, text=text)

    return draw
