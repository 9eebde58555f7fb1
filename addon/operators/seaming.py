# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of a search for seams, which several operators have."""

from typing import Any

import bpy
from bpy.props import EnumProperty, FloatProperty, StringProperty

from .. import bridge
from ..blender import vertex_groups
from ..blender.types import OperatorMixin, is_mesh
from ..bridge.settings import FEW_SEAMS, LOW_SHEAR
from ..jobs.seam_groups import SeamGroups

_STOPS = {"LOW_SHEAR": LOW_SHEAR, "FEW_SEAMS": FEW_SEAMS}
# The name of a preset that leaves the shear to the extension, and of none.
_AUTOMATIC, _CUSTOM = "AUTO", "CUSTOM"
# Numbered, because key maps keep numbers.
_PRESETS = (
    (
        _AUTOMATIC,
        "Automatic",
        "Low Shear, but Few Seams for scans: meshes whose edges are below 0.8 % of their size, or that would "
        "need more than 20 slits",
        "NONE",
        0,
    ),
    ("LOW_SHEAR", "Low Shear", f"Shear {LOW_SHEAR}: shapes come before seams", "NONE", 1),
    ("FEW_SEAMS", "Few Seams", f"Shear {FEW_SEAMS}: seams are about a fifth shorter", "NONE", 2),
    (_CUSTOM, "Custom", "The value of Shear", "NONE", 3),
)
_SHOWN = _PRESETS[:3]
_FRONTS = {
    "NEGATIVE_Y": (0, -1, 0),
    "POSITIVE_Y": (0, 1, 0),
    "NEGATIVE_X": (-1, 0, 0),
    "POSITIVE_X": (1, 0, 0),
    "NEGATIVE_Z": (0, 0, -1),
    "POSITIVE_Z": (0, 0, 1),
}


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


def _group_names(_operator: bpy.types.Operator, context: bpy.types.Context, _text: str) -> list[str]:
    obj = context.object
    return vertex_groups.names(obj) if is_mesh(obj) else []


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
    keep_off: StringProperty(
        name="Keep Off",
        description="A vertex group to keep seams off, such as a face: with the weight 0.5 a seam costs ten "
        "times as much there, with the weight 1 there is none unless there is no other way",
        default="",
        search=_group_names,
    )
    prefer: StringProperty(
        name="Prefer",
        description="A vertex group where seams are preferred, such as the inside of a sleeve: with the "
        "weight 1 a seam costs a quarter there",
        default="",
        search=_group_names,
    )
    symmetry: EnumProperty(
        name="Symmetry",
        description="Whether seams mirror each other",
        items=(
            ("AUTO", "Automatic", "Symmetric seams where the mesh is symmetric, if they are about as short"),
            ("OFF", "Off", "The shortest seams"),
        ),
        default="AUTO",
    )
    front: EnumProperty(
        name="Front",
        description="The local axis that the front of the mesh faces: seams cost up to three times as much "
        "there",
        items=(
            ("NONE", "None", "Seams may run anywhere"),
            ("NEGATIVE_Y", "-Y", "As in Blender's front view"),
            ("POSITIVE_Y", "Y", "As in Blender's back view"),
            ("NEGATIVE_X", "-X", "As in Blender's left view"),
            ("POSITIVE_X", "X", "As in Blender's right view"),
            ("NEGATIVE_Z", "-Z", "As in Blender's bottom view"),
            ("POSITIVE_Z", "Z", "As in Blender's top view"),
        ),
        default="NONE",
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


def groups(properties: Any) -> SeamGroups:
    """The vertex groups by the properties of an operator."""
    return SeamGroups(properties.keep_off, properties.prefer)


def search(properties: Any) -> bridge.SeamSettings:
    """The search for seams by the properties that all operators have."""
    return bridge.SeamSettings(
        shear=shear(properties),
        is_symmetric=properties.symmetry == "AUTO",
        front=_FRONTS.get(properties.front),
    )


def draw_options(column: bpy.types.UILayout, properties: Any) -> None:
    """The options that all operators have, in the redo panel and in the sidebar."""
    _draw_shear(column, properties)
    for name in _GROUPS:
        column.prop(properties, name, icon="GROUP_VERTEX")
    for name in _OPTIONS:
        column.prop(properties, name)


_GROUPS = ("keep_off", "prefer")
_OPTIONS = ("front", "symmetry")


def _draw_shear(column: bpy.types.UILayout, properties: Any) -> None:
    """A row of presets over the value; none is pressed if the value belongs to no preset."""
    row = column.row(align=True)
    row.use_property_split = False
    for name, text, *_ in _SHOWN:
        row.prop_enum(properties, "shear_preset", name, text=text)
    row = column.row()
    row.active = properties.shear_preset != _AUTOMATIC
    row.prop(properties, "shear", slider=True)
