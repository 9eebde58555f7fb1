# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.unwrap: UVs with equal areas for every selected island."""

import math
from dataclasses import replace
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty

from .. import bridge
from ..blender import images, uv_maps
from ..blender.types import is_mesh
from ..jobs import densities, seam_groups, texel_density, unwrap
from ..jobs.job import Job
from . import poll, seaming, solving
from .density import property_of_sources
from .modal import Modal
from .seaming import Seaming
from .solving import Outlining


def _layer_names(_operator: bpy.types.Operator, context: bpy.types.Context, _text: str) -> list[str]:
    obj = context.object
    return uv_maps.names(obj) if is_mesh(obj) else []


class AUTHALIC_OT_unwrap(Modal, Outlining, Seaming, bpy.types.Operator):
    """Make each face's UV area proportional to its surface area"""

    bl_idname = "authalic.unwrap"
    bl_label = "Authalic Unwrap"
    bl_options = {"REGISTER", "UNDO", "PRESET"}  # noqa: RUF012 (Blender reads a plain set)
    refused = (unwrap.CannotUnwrap, seam_groups.NoGroup, densities.NoDensity)

    seams: EnumProperty(
        name="Seams",
        description="The seams along which meshes are cut",
        items=(
            ("GIVEN", "Given", "The seams of the mesh"),
            ("ADD", "Add", "The seams of the mesh, and more where faces would be sheared too much"),
            (
                "AUTOMATIC",
                "Automatic",
                "New seams that leave little shear; those of the mesh do not count. Opens any closed mesh",
            ),
        ),
        default="GIVEN",
    )
    mark_seams: BoolProperty(
        name="Mark Seams",
        description="Mark the seams that are found on the mesh. Those that it has stay",
        default=True,
    )
    domain: EnumProperty(
        name="Domain",
        description="The shape that islands are mapped onto",
        items=(
            (
                "AUTO",
                "Automatic",
                "A disk for islands with a boundary, a sphere for closed ones without handles",
            ),
            ("DISK", "Disk", "Map every island onto a disk. It needs a boundary: seams, or an open mesh"),
            (
                "SPHERE",
                "Sphere",
                "Map every island onto a sphere. It must be closed, without seams or handles",
            ),
        ),
        default="AUTO",
    )
    fill_holes: BoolProperty(
        name="Fill Holes",
        description="Virtually fill holes in the mesh before unwrapping, all but the longest boundary",
        default=True,
    )
    sphere_layout: EnumProperty(
        name="Layout",
        description="The equal-area projection that lays the sphere of a closed island flat",
        items=(
            (
                "LAMBERT",
                "Lambert Cylindrical",
                "A rectangle as long as the equator. The poles are its upper and lower sides; faces at the "
                "seam extend beyond the right side",
            ),
            (
                "OCTAHEDRAL",
                "Octahedral",
                "A square with the upper pole in the middle and the lower pole in its corners. Faces at the "
                "seam extend a little beyond its sides",
            ),
        ),
        default="LAMBERT",
    )
    pole_axis: EnumProperty(
        name="Pole Axis",
        description="The local axis on which the poles of a closed island lie",
        items=(
            ("X", "X", "Poles at the left and the right, seam at the back"),
            ("Y", "Y", "Poles at the front and the back, seam below"),
            ("Z", "Z", "Poles at the top and the bottom, seam at the back"),
        ),
        default="Z",
    )
    seam_direction: FloatProperty(
        name="Seam Direction",
        description="The angle of the seam of a closed island about the pole axis. 0 is at the back (+Y), "
        "or below (-Z) with the poles on Y",
        subtype="ANGLE",
        soft_min=-math.pi,
        soft_max=math.pi,
        default=0.0,
    )
    uv_layer: StringProperty(
        name="UV Map",
        description="The UV map to write; it is added if it is missing. Empty for the active one",
        default="",
        search=_layer_names,
        search_options={"SUGGESTION"},
    )
    density_source: property_of_sources()
    use_subsurf_data: BoolProperty(
        name="Use Subdivision Surface",
        description="Make areas even on the surface of the Subdivision Surface modifier, if it is the first",
        default=False,
    )
    keep_position: BoolProperty(
        name="Keep Position and Scale",
        description="Leave islands where their UVs are, at their size. Islands without UVs are packed",
        default=False,
    )
    pack_objects: EnumProperty(
        name="Objects",
        description="Whether several objects share the texture",
        items=(
            ("TOGETHER", "Together", "All objects share one texture, at one texel density"),
            ("EACH", "Each by Itself", "Every object fills a texture of its own"),
        ),
        default="TOGETHER",
    )
    rotate_method: EnumProperty(
        name="Rotation",
        description="How packing may turn islands",
        items=(
            ("ANY", "Any", "Any angle. An island that is alone lies level"),
            ("AXIS_ALIGNED", "Axis-Aligned", "Islands lie level or upright in their minimal rectangle"),
            ("NONE", "None", "Islands are not turned to be packed"),
        ),
        default="ANY",
    )
    margin_method: EnumProperty(
        name="Margin Method",
        description="The unit of the margin",
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
    texel_density: FloatProperty(
        name="Texel Density",
        description="Pixels per meter on the active image, or on one of 1024 pixels. 0 fills the image",
        min=0.0,
        soft_max=4096.0,
        precision=1,
        default=0.0,
    )
    correct_aspect: BoolProperty(
        name="Correct Aspect",
        description="Keep shapes on the active image where it is not square",
        default=True,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.has_meshes(cls, context)

    def job(self, context: bpy.types.Context) -> Job[Any, unwrap.Report]:
        chosen = self.solver()
        return unwrap.job(context, _settings(context, self.properties, chosen, from_last=self.is_redo))

    def line(self, report: unwrap.Report) -> str:
        return f"Unwrapped {report}"

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_options(self.layout, self)


def last_settings(context: bpy.types.Context) -> unwrap.Settings:
    """The options that the button was last used with, for maps that go on from the last ones."""
    last: Any = context.window_manager.operator_properties_last("authalic.unwrap")
    chosen = bridge.Solver(
        last.method,
        last.iterations,
        last.angle_weight,
        area_tolerance=last.area_tolerance,
        outline=last.outline,
        overlap=last.allow_overlap,
    )
    return _settings(context, last, chosen, from_last=True)


def _settings(
    context: bpy.types.Context, properties: Any, chosen: bridge.Solver, *, from_last: bool
) -> unwrap.Settings:
    """The options by the properties of the operator, but for those of the solver."""
    image = images.active(context)
    return unwrap.Settings(
        uv_layer=properties.uv_layer,
        mark_seams=properties.mark_seams,
        groups=seaming.groups(properties),
        density_source=properties.density_source,
        subdivided=properties.use_subsurf_data,
        mapping=bridge.UnwrapSettings(
            fill_holes=properties.fill_holes,
            solver=chosen,
            domain=properties.domain,
            layout=properties.sphere_layout,
            pole_axis=properties.pole_axis,
            seam_direction=properties.seam_direction,
            seams=_search(properties),
            from_last=from_last,
        ),
        placement=bridge.PlacementSettings(
            keep=properties.keep_position,
            each_by_itself=properties.pack_objects == "EACH",
            rotation=properties.rotate_method,
            margin_method=properties.margin_method,
            margin=_plain(properties.margin),
            density=_density(context, properties, image),
            aspect=images.aspect(image) if properties.correct_aspect else 1.0,
            tile=images.tile(image),
        ),
    )


def _density(context: bpy.types.Context, properties: Any, image: bpy.types.Image | None) -> float:
    """The texel density in heights of the image per unit of length; 0 if the image is to be filled."""
    height = images.size(image)[1] if image is not None else texel_density.DEFAULT_SIZE
    meters = context.scene.unit_settings.scale_length if context.scene else 1.0
    return _plain(properties.texel_density) * meters / height


def _search(properties: Any) -> bridge.SeamSettings | None:
    """The search for seams, if there is to be one."""
    if properties.seams == "GIVEN":
        return None
    search = seaming.search(properties)
    return replace(search, keep_given=properties.seams == "ADD", overlap=properties.allow_overlap)


def _plain(value: float) -> float:
    """A number rounded, so that Blender's single precision makes no difference."""
    return float(f"{value:.6g}")


def draw_options(layout: bpy.types.UILayout, properties: Any) -> None:
    """All options, in the redo panel."""
    solving.draw_presets(layout.column(), properties)
    draw_main(layout, properties)
    if has_closed(properties):
        layout.label(text="Closed Meshes")
        draw_closed(layout, properties)
    layout.label(text="Packing")
    draw_packing(layout, properties)
    layout.label(text="Advanced")
    draw_advanced(layout, properties)


def draw_main(layout: bpy.types.UILayout, properties: Any) -> None:
    """The options that are wanted most, below the presets."""
    column = layout.column()
    column.prop(properties, "seams")
    if properties.seams != "GIVEN":
        box = column.box().column()
        seaming.draw_options(box, properties)
        box.prop(properties, "mark_seams")
    column.prop(properties, "density_source", icon="GROUP_VERTEX")
    column.prop(properties, "keep_position")


def has_closed(properties: Any) -> bool:
    """Whether closed meshes keep to their seams, and so may be mapped onto spheres."""
    return bool(properties.seams == "GIVEN")


def draw_closed(layout: bpy.types.UILayout, properties: Any) -> None:
    """How closed meshes without seams are laid out."""
    column = layout.column()
    column.active = properties.domain != "DISK" and has_closed(properties)
    for name in ("sphere_layout", "pole_axis", "seam_direction"):
        column.prop(properties, name)


def draw_packing(layout: bpy.types.UILayout, properties: Any) -> None:
    """Where islands go."""
    column = layout.column()
    for name in _PACKING:
        column.prop(properties, name)


def draw_advanced(layout: bpy.types.UILayout, properties: Any) -> None:
    """The solver, the shapes that it maps to, and what it reads and writes."""
    column = layout.column()
    if has_closed(properties):
        column.prop(properties, "domain")
        row = column.row()
        row.active = properties.domain != "SPHERE"
        row.prop(properties, "fill_holes")
    solving.draw_advanced(column, properties)
    column.prop(properties, "use_subsurf_data")
    column.prop(properties, "uv_layer", placeholder="Active")


_PACKING = (*("pack_objects", "rotate_method", "margin_method", "margin", "texel_density", "correct_aspect"),)


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_unwrap)


def unregister() -> None:
    bridge.forget()
    bpy.utils.unregister_class(AUTHALIC_OT_unwrap)
