# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.unwrap: UVs with equal areas for every selected island."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .. import bridge, packing
from ..job import Cancelled
from ..jobs import targets, unwrap
from . import poll


def _layer_names(_operator, context, _text):
    obj = context.object
    return [layer.name for layer in obj.data.uv_layers] if obj and obj.type == "MESH" else []


class AUTHALIC_OT_unwrap(bpy.types.Operator):
    """Unwrap so that every face gets the share of the texture that its area is of the surface"""

    bl_idname = "authalic.unwrap"
    bl_label = "Authalic Unwrap"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)

    domain: EnumProperty(
        name="Domain",
        description="The shape that islands are mapped onto",
        items=(
            ("AUTO", "Automatic", "The shape that suits an island, which has to have a boundary: a disk"),
            ("DISK", "Disk", "Map every island onto a disk"),
        ),
        default="AUTO",
    )
    fill_holes: BoolProperty(
        name="Fill Holes",
        description="Virtually fill holes in the mesh before unwrapping, all but the longest boundary",
        default=True,
    )
    iterations: IntProperty(
        name="Iterations",
        description="Most iterations of the solver. More share the areas out more evenly, fewer are faster",
        min=1,
        soft_max=1000,
        default=100,
    )
    uv_layer: StringProperty(
        name="UV Map",
        description="The UV map to write, added if there is none of this name. Empty for the active one",
        default="",
        search=_layer_names,
        search_options={"SUGGESTION"},
    )
    margin_method: EnumProperty(
        name="Margin Method",
        description="What the margin is measured in",
        items=(
            ("SCALED", "Scaled", "Use scale of existing UVs to multiply margin"),
            ("ADD", "Add", "Just add the margin, ignoring any UV scale"),
            ("FRACTION", "Fraction", "Specify a precise fraction of final UV output"),
        ),
        default="SCALED",
    )
    margin: FloatProperty(
        name="Margin", description="Space between islands", min=0.0, max=1.0, precision=3, default=0.001
    )

    @classmethod
    def poll(cls, context):
        return poll.has_meshes(cls, context)

    def execute(self, context):
        try:
            report = unwrap.job(context, self._settings()).execute()
        except targets.NothingToDo as problem:
            self.report({"WARNING"}, str(problem))
            return {"CANCELLED"}
        except (unwrap.CannotUnwrap, Cancelled) as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        self.report({"WARNING"} if report.refusals or report.notes else {"INFO"}, f"Unwrapped {report}")
        return {"FINISHED"}

    def draw(self, _context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_options(self.layout, self)

    def _settings(self):
        return unwrap.Settings(
            uv_layer=self.uv_layer,
            mapping=bridge.UnwrapSettings(self.fill_holes, self.iterations),
            packing=packing.PackSettings(self.margin_method, self.margin),
        )


def draw_options(layout, properties):
    """The options, in the redo panel and in the sidebar."""
    column = layout.column()
    for name in ("domain", "fill_holes", "iterations"):
        column.prop(properties, name)
    column.prop(properties, "uv_layer", placeholder="Active")
    column = layout.column()
    for name in _PACKING:
        column.prop(properties, name)


_PACKING = ("margin_method", "margin")


def register():
    bpy.utils.register_class(AUTHALIC_OT_unwrap)


def unregister():
    bpy.utils.unregister_class(AUTHALIC_OT_unwrap)
