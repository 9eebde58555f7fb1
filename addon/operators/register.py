# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.register: a slider that morphs the active object into its target, landmarks onto landmarks."""

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from ..blender import editability
from ..blender.types import OperatorMixin, is_mesh
from ..jobs import register as registration
from ..jobs.couple import CannotRegister
from ..jobs.job import Job
from ..jobs.register_report import Report
from ..landmarks.objects import active_source, target_problem
from ..registration.settings import Settings
from .modal import Modal


class Registering(OperatorMixin):
    """The properties of operators that register."""

    method: EnumProperty(
        name="Method",
        description="What is matched between the two meshes",
        items=(
            (
                "POINTS",
                "Landmark Points",
                "Landmark points, as closely as faces can follow. Areas are preserved",
            ),
            (
                "CURVES",
                "Landmark Curves",
                "Landmark curves and boundaries, exactly along their whole length. Shapes of faces are "
                "preserved as well as possible",
            ),
        ),
        default="POINTS",
    )
    domain: EnumProperty(
        name="Domain",
        description="The shape that both surfaces are mapped to",
        items=(
            ("AUTO", "Automatic", "A disk for surfaces with a boundary, a sphere for closed ones"),
            ("DISK", "Disk", "Both surfaces must have one boundary, and normals on the same side"),
            ("SPHERE", "Sphere", "Both surfaces must be closed"),
        ),
        default="AUTO",
    )
    angle_weight: FloatProperty(
        name="Angle Weight",
        description="Trade-off: 0 preserves areas, higher values shear less",
        min=0.0,
        max=1.0,
        precision=3,
        default=0.0,
    )
    weight: FloatProperty(
        name="Landmark Weight",
        description="Initial pull on the landmarks; it grows until they meet",
        min=1e-6,
        soft_max=100.0,
        default=1.0,
    )

    def registration(self) -> Settings:
        return Settings(self.domain, self.weight, self.angle_weight, self.method)


class AUTHALIC_OT_register(Modal, Registering, bpy.types.Operator):
    """Add a shape key whose slider morphs the active object into its target, landmarks onto landmarks.

    Points preserve areas, curves preserve the shapes of faces; no face folds over. The normals of both meshes
    must face the same way (with curves only if the meshes are open), or the map is mirrored: recalculate or
    flip the normals of one mesh"""

    bl_idname = "authalic.register"
    bl_label = "Wrap onto Target"
    bl_options = {"REGISTER", "UNDO", "PRESET"}  # noqa: RUF012 (Blender reads a plain set)
    refused = (CannotRegister,)

    align: BoolProperty(
        name="Align",
        description="Move, rotate and scale the target onto the object, so that the shape does not travel "
        "while it morphs. If off, the morph ends where the target is",
        default=False,
    )
    target_uv: BoolProperty(
        name="UV Map on Target",
        description="For open meshes: write the map under which both coincide as a UV map of the target too",
        default=False,
    )
    animate: BoolProperty(name="Animate", description="Key-frame the shape key from 0 to 1", default=False)
    frame_start: IntProperty(
        name="Start Frame", description="The frame at which the shape key is 0", default=1
    )
    frame_end: IntProperty(name="End Frame", description="The frame at which the shape key is 1", default=100)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return has_target(cls, context)

    def job(self, context: bpy.types.Context) -> Job[Any, Report]:
        frames = (self.frame_start, self.frame_end) if self.animate else None
        settings = registration.Settings(self.registration(), self.align, self.target_uv, frames)
        return registration.job(context, settings)

    def line(self, report: Report) -> str:
        return str(report)

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_options(self.layout, self)


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


def draw_options(layout: bpy.types.UILayout, properties: Any) -> None:
    """The options, in the redo panel and in the sidebar."""
    column = layout.column()
    column.prop(properties, "method")
    of_points = ("domain", "angle_weight", "weight")
    for name in (*(of_points if properties.method == "POINTS" else ()), "align"):
        column.prop(properties, name, slider=name == "angle_weight")
    for name in (*(("target_uv",) if properties.method == "POINTS" else ()), "animate"):
        column.prop(properties, name)
    frames = column.column(align=True)
    frames.active = properties.animate
    frames.prop(properties, "frame_start")
    frames.prop(properties, "frame_end", text="End")


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_register)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_OT_register)
