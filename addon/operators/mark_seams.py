# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.mark_seams: seams along which meshes unwrap with even areas and little shear."""

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from .. import bridge
from ..blender import vertex_groups
from ..blender.types import is_mesh
from ..jobs import mark_seams
from ..jobs.job import Job
from . import poll, seaming
from .modal import Modal
from .seaming import Seaming

_FRONTS = {
    "NEGATIVE_Y": (0, -1, 0),
    "POSITIVE_Y": (0, 1, 0),
    "NEGATIVE_X": (-1, 0, 0),
    "POSITIVE_X": (1, 0, 0),
    "NEGATIVE_Z": (0, 0, -1),
    "POSITIVE_Z": (0, 0, 1),
}


def _group_names(_operator: bpy.types.Operator, context: bpy.types.Context, _text: str) -> list[str]:
    obj = context.object
    return vertex_groups.names(obj) if is_mesh(obj) else []


class AUTHALIC_OT_mark_seams(Modal, Seaming, bpy.types.Operator):
    """Mark seams along which the mesh unwraps with even areas and little shear.

    Seams that are marked stay and are added to. In edit mode only selected faces are cut, if there are any"""

    bl_idname = "authalic.mark_seams"
    bl_label = "Mark Seams Automatically"
    bl_options = {"REGISTER", "UNDO", "PRESET"}  # noqa: RUF012 (Blender reads a plain set)
    refused = (mark_seams.CannotMark,)

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
    max_islands: IntProperty(
        name="Max Islands",
        description="The most islands of a mesh, unless the seams that are marked make more. 0 for no limit",
        min=0,
        soft_max=50,
        default=0,
    )
    allow_overlap: BoolProperty(
        name="Allow Overlap",
        description="Fewer seams, with which islands may overlap themselves when they are unwrapped",
        default=False,
    )
    clear: BoolProperty(
        name="Clear Existing",
        description="Clear the seams that are marked, and find all of them anew",
        default=False,
    )
    draft: BoolProperty(
        name="Draft",
        description="Quick seams, a little longer, for tuning the options; the shear is only predicted",
        default=False,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.has_meshes(cls, context)

    def job(self, context: bpy.types.Context) -> Job[Any, mark_seams.Report]:
        return mark_seams.job(context, settings(self.properties))

    def line(self, report: mark_seams.Report) -> str:
        return str(report)

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_options(self.layout, self)


def settings(properties: Any) -> mark_seams.Settings:
    """The settings by the properties of the operator."""
    return mark_seams.Settings(
        keep_off=properties.keep_off,
        prefer=properties.prefer,
        clear=properties.clear,
        search=bridge.SeamSettings(
            shear=seaming.shear(properties),
            is_symmetric=properties.symmetry == "AUTO",
            front=_FRONTS.get(properties.front),
            max_islands=properties.max_islands or None,
            overlap=properties.allow_overlap,
            is_draft=properties.draft,
        ),
    )


def draw_options(layout: bpy.types.UILayout, properties: Any) -> None:
    """The options, in the redo panel and in the sidebar."""
    column = layout.column()
    seaming.draw_shear(column, properties)
    for name in _GROUPS:
        column.prop(properties, name, icon="GROUP_VERTEX")
    for name in _OPTIONS:
        column.prop(properties, name)


_GROUPS = ("keep_off", "prefer")
_OPTIONS = ("front", "symmetry", "max_islands", "allow_overlap", "clear", "draft")


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_mark_seams)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_OT_mark_seams)
