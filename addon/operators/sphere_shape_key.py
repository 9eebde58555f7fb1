# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.sphere_shape_key: a slider that morphs a closed mesh into its map onto the sphere."""

from typing import Any

import bpy

from ..jobs import sphere_shape_key
from ..jobs.job import Job
from . import poll, solving
from .modal import Modal
from .solving import Solving


class AUTHALIC_OT_sphere_shape_key(Modal, Solving, bpy.types.Operator):
    """Add the shape key "Authalic Sphere", whose slider morphs a closed mesh into a sphere of the same area.

    Each face's area on the sphere is proportional to its area on the mesh; no face folds over"""

    bl_idname = "authalic.sphere_shape_key"
    bl_label = "Authalic Sphere Shape Key"
    bl_options = {"REGISTER", "UNDO", "PRESET"}  # noqa: RUF012 (Blender reads a plain set)
    refused = (sphere_shape_key.CannotMap,)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.has_meshes_in_object_mode(cls, context)

    def job(self, context: bpy.types.Context) -> Job[Any, sphere_shape_key.Report]:
        return sphere_shape_key.job(context, sphere_shape_key.Settings(self.solver()))

    def line(self, report: sphere_shape_key.Report) -> str:
        return str(report)

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_options(self.layout, self)


def draw_options(layout: bpy.types.UILayout, properties: Any) -> None:
    """The options, in the redo panel and in the sidebar."""
    solving.draw_options(layout.column(), properties)


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_sphere_shape_key)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_OT_sphere_shape_key)
