# SPDX-License-Identifier: GPL-3.0-or-later
"""The shear that seams are to leave, which several operators have."""

from typing import Any

import bpy
from bpy.props import EnumProperty, FloatProperty

from ..blender.types import OperatorMixin
from ..bridge.settings import FEW_SEAMS, LOW_SHEAR

_STOPS = {"LOW_SHEAR": LOW_SHEAR, "FEW_SEAMS": FEW_SEAMS}
# The name of a preset that leaves the shear to the extension, and of none.
_AUTOMATIC, _CUSTOM = "AUTO", "CUSTOM"
# Numbered, because key maps keep numbers.
_PRESETS = (
    (
        _AUTOMATIC,
        "Automatic",
        "Low Shear, but Few Seams for scans: meshes whose edges are below 0.8 % of their size",
        "NONE",
        0,
    ),
    ("LOW_SHEAR", "Low Shear", f"Shear {LOW_SHEAR}: shapes come before seams", "NONE", 1),
    ("FEW_SEAMS", "Few Seams", f"Shear {FEW_SEAMS}: seams are about a fifth shorter", "NONE", 2),
    (_CUSTOM, "Custom", "The value of Shear", "NONE", 3),
)
_SHOWN = _PRESETS[:3]


def _set_shear(properties: Any, _context: bpy.types.Context) -> None:
    stop = _STOPS.get(properties.shear_preset)
    if stop is not None and not _is_at(properties.shear, stop):
        name = properties.shear_preset
        properties.shear = stop
        properties.shear_preset = name


def _set_preset(properties: Any, _context: bpy.types.Context) -> None:
    name = next((name for name, stop in _STOPS.items() if _is_at(properties.shear, stop)), _CUSTOM)
    if properties.shear_preset != name:
        properties.shear_preset = name


def _is_at(value: float, stop: float) -> bool:
    return abs(value - stop) < 5e-4


class Seaming(OperatorMixin):
    """The properties of operators that find seams."""

    shear_preset: EnumProperty(
        name="Shear Preset",
        description="Trade-off between shear and the length of seams",
        items=_PRESETS,
        update=_set_shear,
        default=_AUTOMATIC,
    )
    shear: FloatProperty(
        name="Shear",
        description="Mean shear that the seams leave: the long over the short axis of what a UV map makes of "
        "a circle. 1 is none; less shear needs more seams",
        min=1.01,
        soft_min=1.1,
        soft_max=2.0,
        max=100.0,
        step=1,
        precision=2,
        update=_set_preset,
        default=LOW_SHEAR,
    )


def shear(properties: Any) -> float | None:
    """The shear by the properties of an operator; None for the one that suits each mesh.

    If a script sets the shear, its value counts, unless it names a preset too.
    """
    preset = properties.shear_preset
    if properties.is_property_set("shear") and not properties.is_property_set("shear_preset"):
        preset = _CUSTOM
    if preset == _AUTOMATIC:
        return None
    # Rounded, so that Blender's single precision makes no difference.
    return _STOPS.get(preset) or float(f"{properties.shear:.6g}")


def draw_shear(column: bpy.types.UILayout, properties: Any) -> None:
    """A row of presets over the value; none is pressed if the value belongs to no preset."""
    row = column.row(align=True)
    row.use_property_split = False
    for name, text, *_ in _SHOWN:
        row.prop_enum(properties, "shear_preset", name, text=text)
    row = column.row()
    row.active = properties.shear_preset != _AUTOMATIC
    row.prop(properties, "shear", slider=True)
