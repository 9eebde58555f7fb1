# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of an unwrap. Plain data, no bpy."""

from dataclasses import dataclass, field

from .solver import Solver


@dataclass
class UnwrapSettings:
    """The settings of an unwrap.

    `domain` is "AUTO", "DISK" or "SPHERE". Closed islands have a layout, "LAMBERT" or "OCTAHEDRAL", the axis
    "X", "Y" or "Z" of the poles, and the angle of the seam about it.
    """

    fill_holes: bool = True
    solver: Solver = field(default_factory=Solver)
    domain: str = "AUTO"
    layout: str = "LAMBERT"
    pole_axis: str = "Z"
    seam_direction: float = 0.0
