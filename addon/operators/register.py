# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.register: a slider that morphs the active object into its target, landmarks onto landmarks."""

from typing import Any

import bpy

from ..blender import editability
from ..blender.types import Status, is_mesh
from ..jobs import register as registration
from ..jobs.couple import CannotRegister
from ..jobs.job import Job
from ..jobs.register_report import Report
from ..landmarks.objects import active_source, target_problem
from ..overlay import preview as overlay_preview
from ..overlay.preview import Preview
from . import wrap_options
from .modal import Modal
from .wrap_options import Wrapping


class AUTHALIC_OT_register(Modal, Wrapping, bpy.types.Operator):
    """Add a shape key whose slider morphs the active object into its target, landmarks onto landmarks.

    Shapes or areas are kept. The normals of both meshes
    must face the same way (with curves only if the meshes are open), or the map is mirrored: recalculate or
    flip the normals of one mesh"""

    bl_idname = "authalic.register"
    bl_label = "Wrap onto Target"
    bl_options = {"REGISTER", "UNDO", "PRESET"}  # noqa: RUF012 (Blender reads a plain set)
    refused = (CannotRegister,)
    _source: Any = None

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return has_target(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> Status:
        wrap_options.start_with_kept(self, active_source(context))
        return super().invoke(context, event)

    def job(self, context: bpy.types.Context) -> Job[Any, Report]:
        self._source = active_source(context)
        settings = registration.Settings(
            registration=self.registration(),
            align=self.align,
            target_uv=self.target_uv,
            strain_attribute=self.strain_attribute,
            frames=self.frames,
            followers=self.followers,
        )
        return registration.job(context, settings)

    def show_preview(self, context: bpy.types.Context, preview: Preview | None) -> None:
        overlay_preview.show(context, preview)

    def applied(self, _report: Report) -> None:
        wrap_options.keep(self, self._source)

    def line(self, report: Report) -> str:
        return str(report)

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        wrap_options.draw(self.layout, self)


def has_target(operator: "type[bpy.types.Operator]", context: bpy.types.Context) -> bool:
    """Object mode, an active mesh and a target for it; else tells the user why not."""
    obj = active_source(context)
    if context.mode != "OBJECT":
        operator.poll_message_set("Only in Object Mode")
    elif not is_mesh(obj):
        operator.poll_message_set("Make the mesh that is to change the active object")
    elif target_problem(obj):
        operator.poll_message_set(f"{obj.name}: {target_problem(obj)}")
    elif reason := editability.why_not_mesh(obj):
        operator.poll_message_set(f"{obj.name}: {reason}")
    else:
        return True
    return False


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_register)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_OT_register)
