# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.sphere_shape_key: a slider that morphs a closed mesh into its map onto the sphere."""

import bpy
from bpy.props import IntProperty

from ..job import Cancelled
from ..jobs import sphere_shape_key, targets
from . import poll


class AUTHALIC_OT_sphere_shape_key(bpy.types.Operator):
    """Add the shape key "Authalic Sphere", whose slider morphs a closed mesh into a sphere of the same area.

    Every face gets the share of the sphere that its area is of the mesh; none is folded over"""

    bl_idname = "authalic.sphere_shape_key"
    bl_label = "Authalic Sphere Shape Key"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)

    iterations: IntProperty(
        name="Iterations",
        description="Most iterations of the solver. More share the areas out more evenly, fewer are faster",
        min=1,
        soft_max=1000,
        default=100,
    )

    @classmethod
    def poll(cls, context):
        return poll.has_meshes_in_object_mode(cls, context)

    def execute(self, context):
        try:
            report = sphere_shape_key.job(context, self._settings()).execute()
        except targets.NothingToDo as problem:
            self.report({"WARNING"}, str(problem))
            return {"CANCELLED"}
        except (sphere_shape_key.CannotMap, Cancelled) as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        self.report({"WARNING"} if report.refusals or report.notes else {"INFO"}, str(report))
        return {"FINISHED"}

    def draw(self, _context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_options(self.layout, self)

    def _settings(self):
        return sphere_shape_key.Settings(iterations=self.iterations)


def draw_options(layout, properties):
    """The options, in the redo panel and in the sidebar."""
    layout.column().prop(properties, "iterations")


def register():
    bpy.utils.register_class(AUTHALIC_OT_sphere_shape_key)


def unregister():
    bpy.utils.unregister_class(AUTHALIC_OT_sphere_shape_key)
