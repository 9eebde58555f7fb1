# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.set_texel_density: UV islands scaled to a number of pixels per meter."""

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntVectorProperty

from ..blender.types import Status
from ..jobs import targets, texel_density
from . import poll
from .measure import Figures


class AUTHALIC_OT_set_texel_density(bpy.types.Operator):
    """Scale UV islands so that a meter of their surface gets a given number of pixels.

    In Edit Mode the islands of the selected faces, in Object Mode all islands of the selected objects"""

    bl_idname = "authalic.set_texel_density"
    bl_label = "Set Texel Density"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)

    density: FloatProperty(
        name="Density",
        description="Pixels per meter",
        min=1e-6,
        soft_min=1.0,
        soft_max=16384.0,
        default=1024.0,
    )
    use_image: BoolProperty(
        name="Size of Image",
        description="Take the size of the image of the UV editor, or of the active texture of the active "
        "material, if there is one",
        default=True,
    )
    size: IntVectorProperty(
        name="Size",
        description="Width and height of the texture in pixels, where there is no image",
        size=2,
        min=1,
        soft_max=16384,
        default=(texel_density.DEFAULT_SIZE,) * 2,
    )
    scale: EnumProperty(
        name="Scale",
        description="What gets the density",
        items=(
            ("EACH", "Each Island", "Every island gets the density"),
            ("TOGETHER", "Together", "All islands get it together, and keep their sizes beside each other"),
        ),
        default="EACH",
    )
    keep_position: BoolProperty(
        name="Keep Position",
        description="Scale about the center of each island, or of all together; else about the origin of the "
        "UV space",
        default=True,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.has_uv_maps(cls, context)

    def execute(self, context: bpy.types.Context) -> Status:
        settings = texel_density.Settings(
            density=self.density,
            size=image_size(context, self)[1],
            each=self.scale == "EACH",
            keep_position=self.keep_position,
        )
        try:
            report = texel_density.set_density(context, settings)
        except targets.NothingToDo as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        self.report({"WARNING"} if report.refusals else {"INFO"}, str(report))
        return {"FINISHED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        draw_options(layout, self, context)


def image_size(context: bpy.types.Context, properties: Any) -> tuple[str, tuple[int, int]]:
    """The name of the image whose size counts, empty if there is none, and the size."""
    found = texel_density.size_of_image(context) if properties.use_image else None
    return found or ("", tuple(properties.size))


def now(context: bpy.types.Context, figures: Figures, properties: Any) -> float:
    """The pixels per meter of what was measured."""
    return texel_density.in_pixels(context, figures.texel_density, image_size(context, properties)[1])


def draw_options(layout: bpy.types.UILayout, properties: Any, context: bpy.types.Context) -> None:
    """The options, in the redo panel and in the sidebar."""
    name, (width, height) = image_size(context, properties)
    layout.prop(properties, "density", text="Pixels per Meter")
    layout.prop(properties, "use_image")
    if name:
        layout.label(text=f"{name}: {width} × {height}", icon="IMAGE_DATA", translate=False)
    else:
        layout.prop(properties, "size")
    layout.prop(properties, "scale")
    layout.prop(properties, "keep_position")


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_set_texel_density)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_OT_set_texel_density)
