# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps that are not as good as they should be. Plain data, no bpy."""

from dataclasses import dataclass

import numpy as np

from .solver import Solver

UNEVEN_DISK, UNEVEN_SPHERE = 0.1, 0.5
"""Standard deviations of area ratios that are bad if areas count; large polygons are less even on spheres."""
# A standard deviation that is bad with any weight of angles.
_UNEVEN = 1.0
# A mean angle distortion that is bad.
_SHEARED = 20.0
_GOES_ON = "raise Iterations to go on"
_ENDS = {"stalled": "stopped before it converged", "max_iterations": "stopped at the iteration limit"}


@dataclass
class Shortfall:
    """The figures of a map that has not converged, or that is bad for its settings.

    `status` is the solver's. `is_uneven` and `is_sheared` say which figures are bad, `remedy` what to do.
    """

    status: str
    deviation: float
    angle: float
    is_uneven: bool
    is_sheared: bool
    remedy: str

    @property
    def faults(self) -> str:
        """What is bad, in words; empty if the map has just not converged."""
        faults = {"uneven": self.is_uneven, "sheared": self.is_sheared}
        return ", ".join(fault for fault, applies in faults.items() if applies)

    def __str__(self) -> str:
        said = ", ".join(filter(None, [self.faults, _ENDS.get(self.status)]))
        figures = f"area ratio SD {self.deviation:.3g}, angle distortion {self.angle:.2f}"
        remedy = self.remedy if self.faults else _GOES_ON if self.status == "max_iterations" else ""
        return "; ".join([f"{said} ({figures})", *filter(None, [remedy])])


def shortfall(
    status: str, figures: tuple[float, float], solver: Solver, uneven: float, remedy: str
) -> Shortfall | None:
    """The `Shortfall` of a map; None if it has converged and is good enough for its weight.

    `figures` are the standard deviation of area ratios and the mean angle distortion. `uneven` is a deviation
    that is bad where areas count.
    """
    deviation, angle = figures
    limit = max(uneven, min(_UNEVEN, UNEVEN_DISK + solver.area_tolerance + np.sqrt(solver.weight) / 2))
    is_uneven, is_sheared = bool(deviation > limit), bool(angle > _SHEARED)
    if not is_uneven and not is_sheared and status in {"converged", "cancelled"}:
        return None
    return Shortfall(status, deviation, angle, is_uneven, is_sheared, remedy)
