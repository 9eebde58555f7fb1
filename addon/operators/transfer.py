# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.transfer: UV maps, vertex groups, colors and shape keys from the target to the active object."""

from typing import Any

import bpy
from bpy.props import BoolProperty

from ..jobs import transfer
from ..jobs.couple import CannotRegister
from ..jobs.job import Job
from .modal import Modal
from .register import has_target
from .wrap_options import Registering

_OF_REGISTRATION = ("method", "domain", "angle_weight", "weight")
_KINDS = ("uv_maps", "active_uv_only", "vertex_groups", "colour_attributes", "shape_keys", "align")


class AUTHALIC_OT_transfer(Modal, Registering, bpy.types.Operator):
    """Copy UV maps, vertex groups, colors and shape keys from the target to the active object.

    The registration of both meshes says where they go. Layers of the same names are replaced"""

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
        description="As displacements from the keys they are relative to. Morphs between both are left out",
        default=True,
    )
    align: BoolProperty(
        name="Align Shape Keys",
        description="Rotate and scale displacements as the target must be to lie over the object. If off, "
        "they keep their directions and lengths in the world",
        default=False,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return has_target(cls, context)

    def job(self, context: bpy.types.Context) -> Job[Any, transfer.Report]:
        # If none of these is set, the last registration is used.
        is_set = any(self.properties.is_property_set(name) for name in _OF_REGISTRATION)
        return transfer.job(
            context,
            transfer.Settings(
                **{name: getattr(self, name) for name in _KINDS},
                registration=self.registration() if is_set else None,
            ),
        )

    def line(self, report: transfer.Report) -> str:
        return f"Transferred {report}"

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_options(self.layout, self)


def draw_options(layout: bpy.types.UILayout, properties: Any) -> None:
    """The options, in the redo panel and in the sidebar."""
    column = layout.column()
    for name in _KINDS:
        row = column.row()
        row.active = _DEPENDS.get(name) is None or getattr(properties, _DEPENDS[name])
        row.prop(properties, name)


_DEPENDS = {"active_uv_only": "uv_maps", "align": "shape_keys"}


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_transfer)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_OT_transfer)
