# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a registration. Plain data, no bpy."""

import math
from dataclasses import dataclass, replace

_METHODS, _DOMAINS, _ENERGIES = ("POINTS", "CURVES"), ("AUTO", "DISK", "SPHERE"), ("SURFACE", "AREA")


@dataclass
class Settings:
    """`method` is "POINTS" or "CURVES", `energy` is "SURFACE", which keeps shapes, or "AREA", the papers'.

    `domain` is "AUTO", "DISK" or "SPHERE", `weight` that of the landmarks at first, `angle_weight` the slider
    from areas, 0, to angles, 1, for "AREA": these three are of points alone. For "SURFACE" the signal named
    `feature` and the positions pull, each by its weight.
    """

    domain: str = "AUTO"
    weight: float = 1.0
    angle_weight: float = 0.0
    method: str = "POINTS"
    energy: str = "SURFACE"
    feature: str = ""
    feature_weight: float = 1.0
    position_weight: float = 0.0

    @property
    def is_pulled(self) -> bool:
        """Whether soft landmarks, features and positions count."""
        return self.energy == "SURFACE"

    @property
    def are_possible(self) -> bool:
        """Whether the operators could have these settings."""
        weights = (self.weight, self.angle_weight, self.feature_weight, self.position_weight)
        named = self.method in _METHODS and self.domain in _DOMAINS and self.energy in _ENERGIES
        return named and self.angle_weight <= 1 and all(0 <= weight < math.inf for weight in weights)

    @property
    def that_count(self) -> "Settings":
        """These settings without the options that make no difference."""
        default = Settings()
        settings = self
        if self.method == "CURVES":
            settings = replace(settings, domain=default.domain, weight=default.weight)
        if self.method == "CURVES" or self.is_pulled:
            settings = replace(settings, angle_weight=default.angle_weight)
        if not self.is_pulled:
            settings = replace(settings, feature="", position_weight=0.0)
        return settings if settings.feature else replace(settings, feature_weight=default.feature_weight)
