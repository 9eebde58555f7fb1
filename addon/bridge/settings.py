# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of an unwrap, of its islands' places, and of a search for seams. Plain data, no bpy."""

from dataclasses import dataclass, field

from .solver import Solver

LOW_SHEAR, FEW_SEAMS = 1.25, 1.4
"""The shear that seams are to leave, unless a caller has a wish: of models, and of scans."""


@dataclass
class SeamSettings:
    """The settings of a search for seams.

    `shear` is the mean σ₁/σ₂ that the maps of the islands may have; None for the one that suits each
    island: `LOW_SHEAR`, but `FEW_SEAMS` for scans. With `keep_given` the seams of the surface stay and are
    added to, else they are ignored. `front` is a direction in which seams are seen. A draft takes a fraction
    of a second.
    """

    shear: float | None = None
    keep_given: bool = True
    is_symmetric: bool = True
    front: tuple[int, int, int] | None = None
    max_islands: int | None = None
    overlap: bool = False
    is_draft: bool = False


@dataclass
class PlacementSettings:
    """Where the islands of an unwrap go.

    With `keep` an island lies where its UVs were before, at their size. The others are packed into the `tile`
    (column, row) of the UV map; those of each surface apart if `each_by_itself`. The `rotation` is "ANY",
    "AXIS_ALIGNED", or "NONE"; `margin` is the least distance between islands by Blender's `margin_method`.
    `aspect` is the width of the texture over its height. `density` above 0 is that of packed islands, in
    heights of the tile per unit of length; 0 fills the tile.
    """

    keep: bool = False
    each_by_itself: bool = False
    rotation: str = "ANY"
    margin_method: str = "SCALED"
    margin: float = 0.001
    density: float = 0.0
    aspect: float = 1.0
    tile: tuple[int, int] = (0, 0)


@dataclass
class UnwrapSettings:
    """The settings of an unwrap.

    `domain` is "AUTO", "DISK" or "SPHERE". Closed islands have a layout, "LAMBERT" or "OCTAHEDRAL", the axis
    "X", "Y" or "Z" of the poles, and the angle of the seam about it. With `seams` every island is cut into
    disks first, and neither domain nor layout counts. `from_last` begins maps with those that were made last.
    """

    fill_holes: bool = True
    solver: Solver = field(default_factory=Solver)
    domain: str = "AUTO"
    layout: str = "LAMBERT"
    pole_axis: str = "Z"
    seam_direction: float = 0.0
    seams: SeamSettings | None = None
    from_last: bool = False
