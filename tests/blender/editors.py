# SPDX-License-Identifier: GPL-3.0-or-later
"""Editors of the window that Blender has without a screen."""

from collections.abc import Iterator
from contextlib import contextmanager

import bpy


@contextmanager
def uv_editor() -> Iterator[None]:
    """The UV editor in the place of an area of the window."""
    window = bpy.context.window_manager.windows[0]
    place = window.screen.areas[0]
    former, place.ui_type = place.ui_type, "UV"
    try:
        region = next(region for region in place.regions if region.type == "WINDOW")
        with bpy.context.temp_override(window=window, area=place, region=region):
            yield
    finally:
        place.ui_type = former
