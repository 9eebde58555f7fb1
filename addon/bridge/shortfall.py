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

    `status` is the solver's. `is_uneven` and `is_sheared` say which figures are bad, `remedies` what to do
    about the one and the other.
    """

    status: str
    deviation: float
    angle: float
    is_uneven: bool
    is_sheared: bool
    remedies: tuple[str, str]

    @property
    def faults(self) -> str:
        """What is bad, in words; empty if the map has just not converged."""
        faults = {"uneven": self.is_uneven, "sheared": self.is_sheared}
        return ", ".join(fault for fault, applies in faults.items() if applies)

    @property
    def severity(self) -> float:
        """How bad the figures are, over those that are just bad."""
        return max(self.deviation / UNEVEN_DISK, self.angle / _SHEARED)

    def __str__(self) -> str:
        said = ", ".join(filter(None, [self.faults, _ENDS.get(self.status)]))
        figures = f"area ratio SD {self.deviation:.3g}, angle distortion {self.angle:.2f}"
        chosen = [self.remedies[0]] * self.is_uneven + [self.remedies[1]] * self.is_sheared
        if not chosen and self.status == "max_iterations":
            chosen = [_GOES_ON]
        remedy = " and ".join(dict.fromkeys(chosen))
        return "; ".join([f"{said} ({figures})", *filter(None, [remedy])])


def shortfall(
    status: str, figures: tuple[float, float], solver: Solver, uneven: float, remedies: tuple[str, str]
) -> Shortfall | None:
    """The `Shortfall` of a map; None if it has converged and is good enough for its weight.

    `figures` are the standard deviation of area ratios and the mean angle distortion. `uneven` is a deviation
    that is bad where areas count. `remedies` help what is uneven, and what is sheared.
    """
    deviation, angle = figures
    limit = max(uneven, min(_UNEVEN, UNEVEN_DISK + solver.area_tolerance + np.sqrt(solver.weight) / 2))
    is_uneven, is_sheared = bool(deviation > limit), bool(angle > _SHEARED)
    if not is_uneven and not is_sheared and status in {"converged", "cancelled"}:
        return None
    return Shortfall(status, deviation, angle, is_uneven, is_sheared, remedies)
