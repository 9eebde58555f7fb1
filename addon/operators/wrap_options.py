# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of a registration and of its morph: properties of the operators, and kept on each source."""

from dataclasses import fields
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from ..blender import editability, signals
from ..blender.types import MeshObject
from ..landmarks.objects import active_source
from ..registration.settings import Settings


def _common_signals(_owner: Any, context: bpy.types.Context, _text: str) -> list[str]:
    """The names of signals that the active object and its target have."""
    source = active_source(context)
    target = source.authalic_target if source is not None else None
    if source is None or target is None:
        return []
    there = set(signals.names(target))
    return [name for name in signals.names(source) if name in there]


class Registering:
    """The properties of operators that register."""

    method: EnumProperty(
        name="Method",
        description="What is matched between the two meshes",
        items=(
            (
                "POINTS",
                "Landmark Points",
                "Landmark points, as closely as faces can follow",
            ),
            (
                "CURVES",
                "Landmark Curves",
                "Landmark curves and boundaries, exactly along their whole length",
            ),
        ),
        default="POINTS",
    )
    domain: EnumProperty(
        name="Domain",
        description="The shape that both surfaces are mapped to",
        items=(
            (
                "AUTO",
                "Automatic",
                "A disk for surfaces with a boundary, a sphere for closed ones and where one is closed",
            ),
            (
                "DISK",
                "Disk",
                "The longest boundaries are matched, all others are filled. Normals must be on the same side",
            ),
            ("SPHERE", "Sphere", "All boundaries are filled"),
        ),
        default="AUTO",
    )
    energy: EnumProperty(
        name="Energy",
        description="What the map from surface to surface keeps",
        items=(
            (
                "SURFACE",
                "Keep Shapes",
                "Areas and angles, measured between the two meshes: knees stay knees",
            ),
            (
                "AREA",
                "Keep Areas",
                "Areas alone, as in the papers. By curves: the paper's harmonic map, which keeps angles",
            ),
        ),
        default="SURFACE",
    )
    feature: StringProperty(
        name="Feature",
        description="A vertex group or attribute of both meshes that should agree: painted weights, "
        "curvature, a depth. Empty for none",
        default="",
        search=_common_signals,
    )
    feature_weight: FloatProperty(
        name="Feature Weight",
        description="How strongly the feature pulls what agrees together",
        min=0.0,
        soft_max=10.0,
        default=1.0,
    )
    position_weight: FloatProperty(
        name="Like Poses",
        description="For bodies in like poses: how strongly each vertex is pulled to its own position, after "
        "the two are aligned. 0 for other poses",
        min=0.0,
        soft_max=10.0,
        default=0.0,
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
        return Settings(**{each.name: getattr(self, each.name) for each in fields(Settings)})


class Wrapping(Registering):
    """The properties of the operator that morphs the source, too."""

    align: BoolProperty(
        name="Align",
        description="Move, rotate and scale the target onto the object, so that the shape does not travel "
        "while it morphs. If off, the morph ends where the target is",
        default=False,
    )
    followers: EnumProperty(
        name="Other Pieces",
        description="How pieces that are not matched, such as eyes, follow the surface around them",
        items=(
            ("AUTO", "Automatic", "Small pieces keep their shapes, large ones bend"),
            ("RIGID", "Keep Shapes", "Pieces are moved, rotated and scaled as a whole"),
            ("BEND", "Bend", "Pieces bend with the surface, as shoes and gloves should"),
        ),
        default="AUTO",
    )
    target_uv: BoolProperty(
        name="UV Map on Target",
        description="For open meshes: write the map under which both coincide as a UV map of the target too",
        default=False,
    )
    strain_attribute: BoolProperty(
        name="Strain Attribute",
        description="Store how far each face is stretched or shrunk, 1 for not at all, as the face attribute "
        "authalic_strain",
        default=False,
    )
    animate: BoolProperty(name="Animate", description="Key-frame the shape key from 0 to 1", default=False)
    frame_start: IntProperty(
        name="Start Frame", description="The frame at which the shape key is 0", default=1
    )
    frame_end: IntProperty(name="End Frame", description="The frame at which the shape key is 1", default=100)

    @property
    def frames(self) -> tuple[int, int] | None:
        """The first and the last frame of the key-framed morph, or None."""
        return (self.frame_start, self.frame_end) if self.animate else None


class AUTHALIC_PG_wrap(Wrapping, bpy.types.PropertyGroup):
    """The options that an object was wrapped with last, or that were chosen in the panel since."""


def start_with_kept(operator: Any, source: MeshObject | None) -> None:
    """Gives an operator the options that its source keeps, but for those that its caller has set."""
    if source is not None:
        for name in _names():
            if not operator.properties.is_property_set(name):
                setattr(operator, name, getattr(source.authalic_wrap, name))


def keep(options: Any, source: MeshObject) -> None:
    """Keeps options on the source, which start the next registration and are saved with the file."""
    if editability.is_writable(source):
        for name in _names():
            setattr(source.authalic_wrap, name, getattr(options, name))


def _names() -> list[str]:
    return [*Registering.__annotations__, *Wrapping.__annotations__]


def draw(layout: bpy.types.UILayout, properties: Any) -> None:
    """All options, in the redo panel."""
    draw_main(layout, properties)
    draw_more(layout, properties)


def draw_main(layout: bpy.types.UILayout, properties: Any) -> None:
    """The options that are wanted most."""
    column = layout.column()
    column.prop(properties, "method")
    column.prop(properties, "energy")
    if properties.energy == "SURFACE":
        column.prop(properties, "feature")
        if properties.feature:
            column.prop(properties, "feature_weight")
        column.prop(properties, "position_weight")
    elif properties.method == "POINTS":
        column.prop(properties, "angle_weight", slider=True)
    column.prop(properties, "align")


def draw_more(layout: bpy.types.UILayout, properties: Any) -> None:
    """The other options."""
    column = layout.column()
    if properties.method == "POINTS":
        column.prop(properties, "domain")
        if properties.energy == "AREA":
            column.prop(properties, "weight")
        column.prop(properties, "target_uv")
    column.prop(properties, "followers")
    column.prop(properties, "strain_attribute")
    column.prop(properties, "animate")
    frames = column.column(align=True)
    frames.active = properties.animate
    frames.prop(properties, "frame_start")
    frames.prop(properties, "frame_end", text="End")


_PROPERTIES: Any = bpy.types.Object


def register() -> None:
    bpy.utils.register_class(AUTHALIC_PG_wrap)
    _PROPERTIES.authalic_wrap = PointerProperty(type=AUTHALIC_PG_wrap, options={"HIDDEN"})


def unregister() -> None:
    del _PROPERTIES.authalic_wrap
    bpy.utils.unregister_class(AUTHALIC_PG_wrap)
