# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.transfer: UV maps, vertex groups, colors and shape keys from the target to the active object."""

from dataclasses import fields
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty

from ..blender import editability
from ..blender.types import MeshObject, Status
from ..jobs import transfer
from ..jobs.couple import CannotRegister
from ..jobs.job import Job
from ..landmarks.objects import sources, target_problem
from ..registration.settings import Settings
from .modal import Modal
from .wrap_options import Registering

_OF_REGISTRATION = tuple(each.name for each in fields(Settings))
_KINDS = ("uv_maps", "active_uv_only", "vertex_groups", "colour_attributes", "shape_keys")
_WAYS = ("offsets", "smooth")


class AUTHALIC_OT_transfer(Modal, Registering, bpy.types.Operator):
    """Copy UV maps, vertex groups, colors and shape keys from the target to the active object.

    Selected objects with the same target get them too. The registration of both meshes says where they go.
    Layers of the same names are replaced"""

    bl_idname = "authalic.transfer"
    bl_label = "Transfer from Target"
    bl_options = {"REGISTER", "UNDO", "PRESET"}  # noqa: RUF012 (Blender reads a plain set)
    refused = (CannotRegister,)

    uv_maps: BoolProperty(name="UV Maps", description="By face corner; seams stay seams", default=True)
    active_uv_only: BoolProperty(
        name="Active UV Map Only", description="Copy only the active UV map of the target", default=False
    )
    vertex_groups: BoolProperty(name="Vertex Groups", description="With their weights", default=True)
    colour_attributes: BoolProperty(
        name="Color Attributes", description="Of vertices and of face corners", default=True
    )
    shape_keys: BoolProperty(
        name="Shape Keys",
        description="As offsets from the keys they are relative to, with their masks, values and drivers. "
        "Morphs between both are left out",
        default=True,
    )
    offsets: EnumProperty(
        name="Offsets",
        description="How the offsets of shape keys are turned and scaled",
        items=(
            ("SURFACE", "With the Surface", "As the surface around each vertex is turned and scaled"),
            ("ALIGN", "Aligned", "All alike, as the target must be to lie over the object"),
            ("WORLD", "World", "They keep their directions and lengths in the world"),
        ),
        default="SURFACE",
    )
    # What `offsets` was in version 0.1.0, for presets and scripts of that time.
    align: BoolProperty(name="Align", default=False, options={"HIDDEN", "SKIP_SAVE"})
    smooth: EnumProperty(
        name="Smooth",
        description="Interpolate weights, colors and shape keys without the facets of the target",
        items=(
            ("AUTO", "Automatic", "Where the target has at most half as many faces"),
            ("ON", "On", "Smooth between the vertices of the target"),
            ("OFF", "Off", "Linear on each face of the target"),
        ),
        default="AUTO",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _can_transfer(cls, context)

    def job(self, context: bpy.types.Context) -> Job[Any, transfer.Reports]:
        # If none of these is set, the last registration is used.
        is_set = any(self.properties.is_property_set(name) for name in _OF_REGISTRATION)
        return transfer.job(
            context,
            transfer.Settings(
                **{name: getattr(self, name) for name in _KINDS},
                offsets=self._offsets(),
                smooth=self.smooth,
                registration=self.registration() if is_set else None,
            ),
        )

    def _offsets(self) -> str:
        is_set = self.properties.is_property_set
        if is_set("align") and not is_set("offsets"):
            return "ALIGN" if self.align else "WORLD"
        return str(self.offsets)

    def line(self, report: transfer.Report) -> str:
        return f"Transferred {report}"

    def _say(self, report: transfer.Reports) -> Status:
        for each in report.reports:
            super()._say(each)
        for failure in report.failures:
            self.report({"WARNING"}, f"{self.bl_label}: {failure}")
        return {"FINISHED"}

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_options(self.layout, self)


def _can_transfer(operator: "type[bpy.types.Operator]", context: bpy.types.Context) -> bool:
    """Object mode, and a mesh with a target; else tells the user why not."""
    if context.mode != "OBJECT":
        operator.poll_message_set("Only in Object Mode")
        return False
    problems = [_problem(source) for source in sources(context)]
    if not problems:
        operator.poll_message_set("Make the mesh that is to change the active object")
    elif all(problems):
        operator.poll_message_set(problems[0] or "")
    return not all(problems)


def _problem(source: MeshObject) -> str | None:
    """Why an object can have no layers of its target, or None."""
    reason = target_problem(source) or editability.why_not_mesh(source)
    return f"{source.name}: {reason}" if reason else None


def draw_options(layout: bpy.types.UILayout, properties: Any) -> None:
    """The options, in the redo panel and in the sidebar."""
    column = layout.column()
    for name in (*_KINDS, *_WAYS):
        row = column.row()
        row.active = _DEPENDS.get(name) is None or getattr(properties, _DEPENDS[name])
        row.prop(properties, name)


_DEPENDS = {"active_uv_only": "uv_maps", "offsets": "shape_keys"}


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_transfer)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_OT_transfer)
