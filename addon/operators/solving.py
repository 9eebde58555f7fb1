# SPDX-License-Identifier: GPL-3.0-or-later
"""The solver's options, which several operators have."""

from bpy.props import EnumProperty, FloatProperty, IntProperty

from .. import bridge, solver

_PRESETS = (
    ("AUTHALIC", "Authalic", "Areas alone, as even as can be"),
    ("BALANCED", "Balanced", "Areas nearly as even, with less skew"),
    ("SOFT", "Soft", "Shapes matter more, areas differ a little"),
    ("CUSTOM", "Custom", "As the slider says"),
)


def _set_slider(properties, _context):
    # Custom is where the slider stands already.
    wanted = solver.PRESETS.get(properties.angle_preset, properties.angle_weight)
    if properties.angle_weight != wanted:
        properties.angle_weight = wanted


def _set_preset(properties, _context):
    fitting = solver.preset(properties.angle_weight)
    if properties.angle_preset != fitting:
        properties.angle_preset = fitting


class Solving:
    """Properties and their part of a panel."""

    method: EnumProperty(
        name="Method",
        description="How areas are made even",
        items=(
            ("GAUSS_NEWTON", "Gauss-Newton", "The most even, in few iterations; never folds a face"),
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
        description="Where to set Angle Weight",
        items=_PRESETS,
        update=_set_slider,
        default="AUTHALIC",
    )
    angle_weight: FloatProperty(
        name="Angle Weight",
        description="How much angles count against areas. 0 shares areas out as evenly as can be, higher "
        "values skew less and let areas differ. Above 0 the outline of an open island follows its shape, "
        "else it is a circle",
        min=0.0,
        max=1.0,
        precision=3,
        update=_set_preset,
        default=0.0,
    )
    iterations: IntProperty(
        name="Iterations",
        description="Most iterations of the solver, 0 for as many as it takes. Fewer are faster and less "
        "even",
        min=0,
        soft_max=200,
        default=0,
    )

    def solver(self):
        """The settings; where a script has named a preset only, the slider is set to it."""
        is_set = self.properties.is_property_set
        if is_set("angle_preset") and not is_set("angle_weight"):
            self.angle_weight = solver.PRESETS.get(self.angle_preset, 0.0)
        self.angle_preset = solver.preset(self.angle_weight)
        return bridge.Solver(self.method, self.iterations, self.angle_weight)


def draw_options(column, properties):
    """The options, in the redo panel and in the sidebar."""
    angles = column.column(align=True)
    angles.active = properties.method == "GAUSS_NEWTON"
    angles.prop(properties, "angle_preset")
    angles.prop(properties, "angle_weight", slider=True)
    column.prop(properties, "method")
    column.prop(properties, "iterations")
