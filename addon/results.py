# SPDX-License-Identifier: GPL-3.0-or-later
"""What goes into the bridge and what comes out of it. Plain data, no bpy."""

from dataclasses import dataclass, field

import numpy as np


@dataclass
class UnwrapSettings:
    """How islands are mapped; the solver stops earlier where it has converged.

    `domain` is "AUTO", "DISK" or "SPHERE". The others after `iterations` are of spheres: the layout "LAMBERT"
    or "OCTAHEDRAL", the axis "X", "Y" or "Z" of the poles, and the angle of the seam about it.
    """

    fill_holes: bool = True
    iterations: int = 100
    domain: str = "AUTO"
    layout: str = "LAMBERT"
    pole_axis: str = "Z"
    seam_direction: float = 0.0


@dataclass
class Island:
    """A map `uv` (n, 2) of the triangles `faces` (m, 3) between `points` (n, 3) of surface `surface`.

    A point of the surface is there once for each of its UVs. Those of the mesh corners `corners` (k,) are the
    UVs of the points `corner_point` (k,). `turned` are the polygons whose normals point against those of the
    rest; they are mirrored in the map. `uneven` is the standard deviation of the area ratios where the solver
    could not go on to make them even, else None.
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
    """What `unwrap` found."""

    islands: list[Island] = field(default_factory=list)
    refusals: list[Refusal] = field(default_factory=list)


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

    `uneven` is as for islands.
    """

    positions: np.ndarray
    radius: float
    deviation: float
    flips: int
    uneven: float | None
