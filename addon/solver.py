# SPDX-License-Identifier: GPL-3.0-or-later
"""The solver's options in Blender's words, and what the library calls them. Plain logic, no bpy."""

from dataclasses import dataclass

# For disks and for spheres. The papers have a descent of their own for either.
_METHODS = {
    "GAUSS_NEWTON": ("gauss_newton", "gauss_newton"),
    "GRADIENT_DESCENT": ("conjugate_gradient", "gradient_descent"),
    "FIXED_POINT": ("fixed_point", "fixed_point"),
}
# The weight at a slider of almost 0, and what the whole slider multiplies it by, as powers of ten.
_LEAST, _DECADES = -5.0, 5.5

PRESETS = {"AUTHALIC": 0.0, "BALANCED": 0.632, "SOFT": 0.814}
"""Where the slider stands; at .03 and .3 for the weights of the last two."""


@dataclass
class Solver:
    """The method, the most iterations (0: as many as it takes) and the slider from areas, 0, to angles, 1."""

    method: str = "GAUSS_NEWTON"
    iterations: int = 0
    angle_weight: float = 0.0

    @property
    def weighs_angles(self):
        return self.method == "GAUSS_NEWTON" and self.angle_weight > 0

    def disk_options(self):
        """Arguments of `authalic.disk_map`; with angles an outline that suits these."""
        options = self._options(0)
        return {**options, "boundary": "free"} if self.weighs_angles else options

    def sphere_options(self):
        """Arguments of `authalic.sphere_map`."""
        return self._options(1)

    def _options(self, shape):
        return {
            "method": _METHODS[self.method][shape],
            "max_iterations": self.iterations or None,
            "angle_weight": weight(self.angle_weight) if self.weighs_angles else 0.0,
        }


def weight(slider):
    """The library's weight of angles against areas at a slider from 0 to 1."""
    return 10 ** (_LEAST + _DECADES * slider) if slider > 0 else 0.0


def preset(slider):
    """The name of the preset where the slider stands, or "CUSTOM"."""
    return next((name for name, value in PRESETS.items() if abs(slider - value) < 5e-4), "CUSTOM")
