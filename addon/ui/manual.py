# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual, a page within the extension: Online Manual in the context menus of buttons opens it."""

from pathlib import Path

import bpy

_PAGE = Path(__file__).parents[1] / "manual.html"
# Operators and classes by the beginnings of their names, and the headings that tell of them.
_PLACES = (
    ("unwrap", "unwrap"),
    ("mark_seams", "mark-seams"),
    ("measure", "distortion"),
    ("show_heat_map", "distortion"),
    ("heat_map", "distortion"),
    ("fix_flips", "fix-flips"),
    ("select_reported", "unwrap"),
    ("texel_density", "distortion"),
    ("set_texel_density", "distortion"),
    ("sphere_shape_key", "sphere-shape-key"),
    ("landmark_curve", "landmark-curves"),
    ("", "registration-morphs-and-transfers"),
)


def address(heading: str = "") -> str:
    """The address of a heading of the manual, or of its beginning."""
    return _PAGE.as_uri() + (f"#{heading}" if heading else "")


def _map() -> tuple[str, tuple[tuple[str, str], ...]]:
    """For Blender: the common beginning of all addresses, and patterns with the rest."""
    of_operators = [(f"bpy.ops.authalic.{start}*", f"#{heading}") for start, heading in _PLACES]
    of_classes = [(f"bpy.types.authalic_??_{start}*", f"#{heading}") for start, heading in _PLACES]
    return address(), (*of_operators, *of_classes)


def register() -> None:
    bpy.utils.register_manual_map(_map)


def unregister() -> None:
    bpy.utils.unregister_manual_map(_map)
