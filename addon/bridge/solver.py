# SPDX-License-Identifier: GPL-3.0-or-later
"""The solver's options, in Blender's words and in the library's. Plain logic, no bpy."""

from dataclasses import dataclass
from typing import Any

# The names for disks and for spheres, for each of which the papers have their own descent.
_METHODS = {
    "GAUSS_NEWTON": ("gauss_newton", "gauss_newton"),
    "GRADIENT_DESCENT": ("conjugate_gradient", "gradient_descent"),
    "FIXED_POINT": ("fixed_point", "fixed_point"),
}
_BOUNDARIES = {"FREE": "free", "CIRCLE": "sliding", "RECTANGLE": "rectangle"}
# The weight at a slider of almost 0, as a power of ten.
_LEAST = -5.0
# The powers of ten that the slider spans.
_DECADES = 5.5
# Up to this weight a map puts areas first.
_AREAS_FIRST = 0.01

PRESETS = {"EVEN": 2 / 5.5, "BALANCED": 0.632, "SOFT": 0.814, "CIRCLE": 0.0}
"""The slider of each preset: weights of .001, .03, .3 and 0."""
FORMER_NAMES = {"AUTHALIC": "CIRCLE"}
"""The names of presets in scripts and key maps of earlier versions."""


@dataclass
class Solver:
    """The method, the iteration limit (0: the default), and the trade-off between areas and angles.

    `angle_weight` is the slider from areas, 0, to angles, 1. `area_tolerance` above 0 replaces it: the least
    shear with area errors within it. The `outline` of open islands is "FREE", "CIRCLE" or "RECTANGLE"; a free
    one may overlap itself with `overlap`. The papers' methods know areas and the circle only.
    """

    method: str = "GAUSS_NEWTON"
    iterations: int = 0
    angle_weight: float = PRESETS["EVEN"]
    outline: str = "FREE"
    overlap: bool = False
    area_tolerance: float = 0.0

    @property
    def is_free(self) -> bool:
        """Whether open islands get an outline of their own."""
        return self._is_ours and self.outline == "FREE"

    @property
    def is_even(self) -> bool:
        """Whether these are the options with which the library maps the islands along seams that it finds."""
        is_even = fits("EVEN", self.angle_weight, self.outline, self.area_tolerance)
        return self._is_ours and is_even and self.iterations == 0

    @property
    def weight(self) -> float:
        """The library's weight of angles, 0 where it does not apply."""
        return weight(self.angle_weight) if self._is_ours and not self.area_tolerance else 0.0

    @property
    def puts_areas_first(self) -> bool:
        return self.weight <= _AREAS_FIRST

    def disk_options(self) -> dict[str, Any]:
        """Arguments of `authalic.disk_map`."""
        options = self._options(0)
        if self._is_ours:
            options["boundary"] = _BOUNDARIES[self.outline]
        if self.is_free and self.overlap:
            options["overlap"] = True
        return options

    def sphere_options(self) -> dict[str, Any]:
        """Arguments of `authalic.sphere_map`."""
        return self._options(1)

    @property
    def _is_ours(self) -> bool:
        return self.method == "GAUSS_NEWTON"

    def _options(self, shape: int) -> dict[str, Any]:
        options = {"method": _METHODS[self.method][shape], "max_iterations": self.iterations or None}
        if self._is_ours and self.area_tolerance:
            return {**options, "area_tolerance": self.area_tolerance}
        return {**options, "angle_weight": self.weight}


def weight(slider: float) -> float:
    """The library's weight of angles at a slider from 0 to 1.

    It is rounded, so that Blender's single precision makes no difference.
    """
    return float(f"{10 ** (_LEAST + _DECADES * slider):.6g}") if slider > 0 else 0.0


def outline(name: str) -> str:
    """The outline of a preset."""
    return "CIRCLE" if FORMER_NAMES.get(name, name) == "CIRCLE" else "FREE"


def slider(name: str) -> float:
    """The slider of a preset."""
    return PRESETS[FORMER_NAMES.get(name, name)]


def is_preset(name: str) -> bool:
    """Whether a preset has this name, today or formerly."""
    return FORMER_NAMES.get(name, name) in PRESETS


def fits(name: str, angle_weight: float, its_outline: str | None = None, area_tolerance: float = 0.0) -> bool:
    """Whether the preset of this name has these values; without an outline, for the sphere."""
    return (
        is_preset(name)
        and abs(angle_weight - slider(name)) < 5e-4
        and its_outline in (None, outline(name))
        and area_tolerance == 0
    )


def preset(angle_weight: float, its_outline: str | None = None, area_tolerance: float = 0.0) -> str:
    """The name of the preset with these values, or "CUSTOM"."""
    values = angle_weight, its_outline, area_tolerance
    return next((name for name in PRESETS if fits(name, *values)), "CUSTOM")
