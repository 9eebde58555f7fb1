# SPDX-License-Identifier: GPL-3.0-or-later
"""What goes into the bridge and what comes out of it. Plain data, no bpy."""

from dataclasses import dataclass, field

import numpy as np

from .solver import Solver


@dataclass
class UnwrapSettings:
    """How islands are mapped.

    `domain` is "AUTO", "DISK" or "SPHERE". The others after it are of spheres: the layout "LAMBERT" or
    "OCTAHEDRAL", the axis "X", "Y" or "Z" of the poles, and the angle of the seam about it.
    """

    fill_holes: bool = True
    solver: Solver = field(default_factory=Solver)
    domain: str = "AUTO"
    layout: str = "LAMBERT"
    pole_axis: str = "Z"
    seam_direction: float = 0.0


@dataclass
class Island:
    """A map `uv` (n, 2) of the triangles `faces` (m, 3) between `points` (n, 3) of surface `surface`.

    A point of the surface is there once for each of its UVs. Those of the mesh corners `corners` (k,) are the
    UVs of the points `corner_point` (k,). `turned` are the polygons whose normals point against those of the
    rest; they are mirrored in the map. `uneven` is the standard deviation of the area ratios where these
    should have been even and are not, else None. `may_turn` says that the outline has no upper side.
    """

    name: str
    surface: int
    polygon: int
    points: np.ndarray
    faces: np.ndarray
    corners: np.ndarray
    corner_point: np.ndarray
    uv: np.ndarray
    turned: np.ndarray
    uneven: float | None = None
    may_turn: bool = False


@dataclass
class Refusal:
    """An island, or with `polygon` None a whole object, that was left as it was."""

    name: str
    polygon: int | None
    reason: str

    def __str__(self):
        where = "" if self.polygon is None else f" at face {self.polygon}"
        return f"{self.name}{where}: {self.reason}"


@dataclass
class Mapping:
    """What `unwrap` found; `ended_early` where it was asked to make do with what it had."""

    islands: list[Island] = field(default_factory=list)
    refusals: list[Refusal] = field(default_factory=list)
    ended_early: bool = False


@dataclass
class Measurement:
    """Area ratio figures over the triangles of all surfaces; `log2` has an array (polygons,) for each."""

    triangles: int
    mean: float
    deviation: float
    log2_min: float
    log2_max: float
    flips: int
    angle: float
    without_area: int
    log2: list[np.ndarray]


@dataclass
class SphereShape:
    """A closed mesh's vertices (n, 3) on the sphere with its area, in single precision, and figures of that.

    `angle` is the mean angle distortion, `uneven` as for islands, `ended_early` as for a mapping.
    """

    positions: np.ndarray
    radius: float
    deviation: float
    flips: int
    angle: float
    uneven: float | None
    ended_early: bool
