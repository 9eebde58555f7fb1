# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.measure: the area distortion of the active UV map."""

from typing import Any

import bpy
from bpy.props import StringProperty

from ..blender.types import Status
from ..jobs import measure, targets
from . import poll


class AUTHALIC_OT_measure(bpy.types.Operator):
    """Measure the area distortion of the active UV map, as figures and as a face attribute.

    The attribute is 0 for a fair share, 1 for double, -1 for half, -20 for a flipped face"""

    bl_idname = "authalic.measure"
    bl_label = "Measure Area Distortion"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.has_meshes(cls, context)

    def execute(self, context: bpy.types.Context) -> Status:
        try:
            figures = measure.job(context).execute()
        except targets.NothingToDo as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        phrases = measure.phrases(figures)
        manager: Any = context.window_manager
        manager.authalic_figures = "\n".join(phrases)
        self.report({"INFO"}, f"Measured {figures.triangles} triangles: {', '.join(phrases)}")
        return {"FINISHED"}


_PROPERTIES: Any = bpy.types.WindowManager


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_measure)
    _PROPERTIES.authalic_figures = StringProperty(
        name="Figures", description="The last measurement, one figure per line", options={"SKIP_SAVE"}
    )


def unregister() -> None:
    del _PROPERTIES.authalic_figures
    bpy.utils.unregister_class(AUTHALIC_OT_measure)
