# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.unwrap: UVs with equal areas for every selected island."""

import math
from dataclasses import replace
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty

from .. import bridge
from ..blender import packing, uv_maps
from ..blender.types import is_mesh
from ..jobs import seam_groups, unwrap
from ..jobs.job import Job
from . import poll, seaming, solving
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
    refused = (unwrap.CannotUnwrap, seam_groups.NoGroup)

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

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.has_meshes(cls, context)

    def job(self, context: bpy.types.Context) -> Job[Any, unwrap.Report]:
        return unwrap.job(context, self._settings())

    def line(self, report: unwrap.Report) -> str:
        return f"Unwrapped {report}"

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_options(self.layout, self)

    def _settings(self) -> unwrap.Settings:
        return unwrap.Settings(
            uv_layer=self.uv_layer,
            mark_seams=self.mark_seams,
            groups=seaming.groups(self.properties),
            mapping=bridge.UnwrapSettings(
                fill_holes=self.fill_holes,
                solver=self.solver(),
                domain=self.domain,
                layout=self.sphere_layout,
                pole_axis=self.pole_axis,
                seam_direction=self.seam_direction,
                seams=self._search(),
            ),
            packing=packing.PackSettings(self.margin_method, self.margin),
        )

    def _search(self) -> bridge.SeamSettings | None:
        """The search for seams, if there is to be one."""
        if self.seams == "GIVEN":
            return None
        search = seaming.search(self.properties)
        return replace(search, keep_given=self.seams == "ADD", overlap=self.allow_overlap)


def draw_options(layout: bpy.types.UILayout, properties: Any) -> None:
    """The options, in the redo panel and in the sidebar."""
    column = layout.column()
    column.prop(properties, "seams")
    is_given = properties.seams == "GIVEN"
    if is_given:
        column.prop(properties, "domain")
        row = column.row()
        row.active = properties.domain != "SPHERE"
        row.prop(properties, "fill_holes")
    else:
        box = column.box().column()
        seaming.draw_options(box, properties)
        box.prop(properties, "mark_seams")
    solving.draw_options(column, properties)
    column.prop(properties, "uv_layer", placeholder="Active")
    if is_given:
        layout.label(text="Closed Islands")
        column = layout.column()
        column.active = properties.domain != "DISK"
        for name in _SPHERE:
            column.prop(properties, name)
    column = layout.column()
    for name in _PACKING:
        column.prop(properties, name)


_SPHERE = ("sphere_layout", "pole_axis", "seam_direction")
_PACKING = ("margin_method", "margin")


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_unwrap)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_OT_unwrap)
