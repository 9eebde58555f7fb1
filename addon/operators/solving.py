# SPDX-License-Identifier: GPL-3.0-or-later
"""The solver's options, which several operators have."""

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from .. import bridge
from ..blender.types import OperatorMixin
from ..bridge import solver

# Numbered, because key maps keep numbers. AUTHALIC is the former name of CIRCLE.
_PRESETS = (
    ("EVEN", "Even", "Areas even to about a percent, shapes as good as that allows", "NONE", 4),
    ("BALANCED", "Balanced", "Better shapes, areas nearly as even", "NONE", 1),
    ("SOFT", "Soft", "Shapes matter more than areas", "NONE", 2),
    (
        "CIRCLE",
        "Circle",
        "Areas as even as possible, whatever the shapes; open islands fill a circle",
        "NONE",
        5,
    ),
    ("CUSTOM", "Custom", "The values below", "NONE", 3),
    ("AUTHALIC", "Authalic", "The former name of Circle", "NONE", 0),
)
SHOWN = _PRESETS[:4]
"""The presets that are shown, as the items of an enumeration."""
# A name of its own: within a class that has a method `solver`, Python 3.14 takes `solver` for that.
_DEFAULT_WEIGHT = solver.PRESETS["EVEN"]


def _values(properties: Any) -> tuple[float, str | None, float]:
    """The values that a preset sets; only islands have an outline."""
    return properties.angle_weight, getattr(properties, "outline", None), properties.area_tolerance


def _set_values(properties: Any, _context: bpy.types.Context) -> None:
    name = properties.angle_preset
    if not solver.is_preset(name) or solver.fits(name, *_values(properties)):
        return
    _assign(properties, "area_tolerance", 0.0)
    _assign(properties, "angle_weight", solver.slider(name))
    if hasattr(properties, "outline"):
        _assign(properties, "outline", solver.outline(name))
    properties.angle_preset = name


def _set_preset(properties: Any, _context: bpy.types.Context) -> None:
    values = _values(properties)
    if not solver.fits(properties.angle_preset, *values):
        _assign(properties, "angle_preset", solver.preset(*values))


def _assign(properties: Any, name: str, value: object) -> None:
    # Assigning calls the update function again.
    if getattr(properties, name) != value:
        setattr(properties, name, value)


class Solving(OperatorMixin):
    """The properties of operators that map surfaces."""

    method: EnumProperty(
        name="Method",
        description="The algorithm that makes areas even",
        items=(
            ("GAUSS_NEWTON", "Gauss-Newton", "The most even areas, in few iterations; never folds a face"),
            (
                "GRADIENT_DESCENT",
                "Gradient Descent",
                "As in the papers: conjugate gradients on disks, gradient descent on spheres. Less even",
            ),
            ("FIXED_POINT", "Fixed Point", "As in the papers. The least even"),
        ),
        default="GAUSS_NEWTON",
    )
    angle_preset: EnumProperty(
        name="Preset",
        description="Trade-off between areas and shapes",
        items=_PRESETS,
        update=_set_values,
        default="EVEN",
    )
    angle_weight: FloatProperty(
        name="Angle Weight",
        description="Trade-off: 0 preserves areas, 1 preserves angles",
        min=0.0,
        max=1.0,
        precision=3,
        update=_set_preset,
        default=_DEFAULT_WEIGHT,
    )
    area_tolerance: FloatProperty(
        name="Area Tolerance",
        description="Allowed deviation of the areas: shapes become as good as possible within it, and Angle "
        "Weight is not used. 0 turns it off",
        min=0.0,
        max=1.0,
        soft_max=0.2,
        step=1,
        precision=3,
        update=_set_preset,
        default=0.0,
    )
    iterations: IntProperty(
        name="Iterations",
        description="Iteration limit of the solver. 0 for as many as usually suffice",
        min=0,
        soft_max=200,
        default=0,
    )

    def solver(self) -> bridge.Solver:
        """The settings. If a script names a preset, its values count unless the script sets them."""
        is_set = self.properties.is_property_set
        if is_set("angle_preset") and solver.is_preset(self.angle_preset):
            name = self.angle_preset
            wanted = {"angle_weight": solver.slider(name), "outline": solver.outline(name)}
            for key, value in wanted.items():
                if hasattr(self, key) and not is_set(key):
                    setattr(self, key, value)
        self.angle_preset = solver.preset(*_values(self))
        return bridge.Solver(
            self.method,
            self.iterations,
            self.angle_weight,
            area_tolerance=self.area_tolerance,
            **self.outline_options(),
        )

    def outline_options(self) -> dict[str, Any]:
        """Arguments of `bridge.Solver` for open islands."""
        return {}


class Outlining(Solving):
    """The properties of operators that map open islands."""

    outline: EnumProperty(
        name="Outline",
        description="The shape that open islands take in the UV map",
        items=(
            ("FREE", "Free", "Every island gets the outline that suits its shape"),
            ("CIRCLE", "Circle", "Every island fills a circle"),
            ("RECTANGLE", "Rectangle", "Every island fills a rectangle, with corners chosen automatically"),
        ),
        update=_set_preset,
        default="FREE",
    )
    allow_overlap: BoolProperty(
        name="Allow Overlap",
        description="Let the outline of an island overlap itself where that gives better shapes. No face is "
        "flipped, but parts of an island may lie over each other",
        default=False,
    )

    def outline_options(self) -> dict[str, Any]:
        return {"outline": self.outline, "overlap": self.allow_overlap}


def draw_options(column: bpy.types.UILayout, properties: Any) -> None:
    """All options, in the redo panel and in the sidebar."""
    draw_presets(column, properties)
    draw_advanced(column, properties)


def draw_presets(column: bpy.types.UILayout, properties: Any) -> None:
    """A row of buttons from areas to shapes; none is pressed if the values belong to no preset."""
    trade = column.column(align=True)
    trade.active = properties.method == "GAUSS_NEWTON"
    trade.use_property_split = False
    trade.label(text="Area ↔ Shape")
    row = trade.row(align=True)
    if not hasattr(properties, "outline"):
        row.prop_enum(properties, "angle_preset", "CIRCLE", text="Areas Only")
    for name in ("EVEN", "BALANCED", "SOFT"):
        row.prop_enum(properties, "angle_preset", name)


def draw_advanced(column: bpy.types.UILayout, properties: Any) -> None:
    """The values behind the presets, the outline of open islands, and the method."""
    trade = column.column()
    trade.active = properties.method == "GAUSS_NEWTON"
    row = trade.row()
    row.active = properties.area_tolerance == 0
    row.prop(properties, "angle_weight", slider=True)
    trade.prop(properties, "area_tolerance")
    if hasattr(properties, "outline"):
        trade.prop(properties, "outline")
        row = trade.row()
        row.active = properties.outline == "FREE"
        row.prop(properties, "allow_overlap")
    column.prop(properties, "method")
    column.prop(properties, "iterations")
