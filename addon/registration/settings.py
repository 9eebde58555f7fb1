# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a registration. Plain data, no bpy."""

from dataclasses import dataclass


@dataclass
class Settings:
    """`method` is "POINTS" or "CURVES", and the others are of points alone.

    `domain` is "AUTO", "DISK" or "SPHERE", `weight` that of the landmarks at first, `angle_weight` the slider
    from areas, 0, to angles, 1.
    """

    domain: str = "AUTO"
    weight: float = 1.0
    angle_weight: float = 0.0
    method: str = "POINTS"

    @property
    def that_count(self) -> "Settings":
        """These settings without the options that make no difference."""
        return self if self.method == "POINTS" else Settings(method=self.method)
