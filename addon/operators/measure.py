# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.measure: how far the active UV map is from equal areas."""

import bpy
from bpy.props import StringProperty

from ..jobs import measure, targets
from . import poll


class AUTHALIC_OT_measure(bpy.types.Operator):
    """Measure how evenly the active UV map shares the texture out, as figures and as a face attribute.

    The attribute has 0 for a fair share, 1 for double, -1 for half, -20 for a face that is folded over"""

    bl_idname = "authalic.measure"
    bl_label = "Measure Area Distortion"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)

    @classmethod
    def poll(cls, context):
        return poll.has_meshes(cls, context)

    def execute(self, context):
        try:
            figures = measure.job(context).execute()
        except targets.NothingToDo as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        line = measure.line(figures)
        context.window_manager.authalic_figures = line
        self.report({"INFO"}, f"Measured {figures.triangles} triangles: {line}")
        return {"FINISHED"}


def register():
    bpy.utils.register_class(AUTHALIC_OT_measure)
    bpy.types.WindowManager.authalic_figures = StringProperty(
        name="Figures", description="What was measured last", options={"SKIP_SAVE"}
    )


def unregister():
    del bpy.types.WindowManager.authalic_figures
    bpy.utils.unregister_class(AUTHALIC_OT_measure)
