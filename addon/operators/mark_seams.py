# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.mark_seams: seams along which meshes unwrap with even areas and little shear."""

from dataclasses import replace
from typing import Any

import bpy
from bpy.props import BoolProperty, IntProperty

from ..jobs import mark_seams, seam_groups
from ..jobs.job import Job
from . import poll, seaming
from .modal import Modal
from .seaming import Seaming


class AUTHALIC_OT_mark_seams(Modal, Seaming, bpy.types.Operator):
    """Mark seams along which the mesh unwraps with even areas and little shear.

    Seams that are marked stay and are added to. In edit mode only selected faces are cut, if there are any"""

    bl_idname = "authalic.mark_seams"
    bl_label = "Mark Seams Automatically"
    bl_options = {"REGISTER", "UNDO", "PRESET"}  # noqa: RUF012 (Blender reads a plain set)
    refused = (mark_seams.CannotMark, seam_groups.NoGroup)

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
    search = replace(
        seaming.search(properties),
        max_islands=properties.max_islands or None,
        overlap=properties.allow_overlap,
        is_draft=properties.draft,
    )
    return mark_seams.Settings(groups=seaming.groups(properties), clear=properties.clear, search=search)


def draw_options(layout: bpy.types.UILayout, properties: Any) -> None:
    """The options, in the redo panel and in the sidebar."""
    column = layout.column()
    seaming.draw_options(column, properties)
    for name in _OPTIONS:
        column.prop(properties, name)


_OPTIONS = ("max_islands", "allow_overlap", "clear", "draft")


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_mark_seams)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_OT_mark_seams)
