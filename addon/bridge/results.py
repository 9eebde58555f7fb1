# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of the bridge. Plain data, no bpy."""

from dataclasses import dataclass, field

import numpy as np

import authalic

from ..surfaces.arrays import Floats, Integers, Singles
from ..surfaces.islands import PlanarIsland
from ..surfaces.polygons import Polygons
from .shortfall import Shortfall

# A polygon has its share if its area ratio differs from 1 by this at most.
_FAIR = 0.1


@dataclass
class Island(PlanarIsland):
    """A map of an island of the surface of number `surface` into the plane.

    A point of the surface occurs once for each of its UVs. The mesh corners `corners` (k,) have the UVs of
    the points `corner_point` (k,). `turned` are the polygons whose normals point against those of the rest;
    they are mirrored in the map. `native` holds points and faces in the native library. `figures` are those
    of the UVs in single precision, None until asked for. `shortfall` is None if the map is as good as it
    should be. `may_turn` says that the outline has no upper side. `has_divided_polygons` says that triangles
    differ from Blender's, as around the centers of divided polygons.
    """

    name: str
    surface: int
    polygon: int
    corners: Integers
    corner_point: Integers
    turned: Integers
    native: authalic.Surface
    has_divided_polygons: bool = False
    figures: authalic.Distortion | None = None
    shortfall: Shortfall | None = None
    may_turn: bool = False


@dataclass
class Refusal:
    """An island, or with `polygon` None a whole object, that was left as it was.

    `polygons` (p,) are all of the island, where they are known.
    """

    name: str
    polygon: int | None
    reason: str
    polygons: Integers = field(default_factory=lambda: np.empty(0, int), compare=False, repr=False)

    def __str__(self) -> str:
        where = "" if self.polygon is None else f" at face {self.polygon}"
        return f"{self.name}{where}: {self.reason}"


@dataclass(frozen=True)
class Note:
    """What is remarkable about an island, or with `polygon` None about a whole object."""

    name: str
    polygon: int | None
    text: str

    def __str__(self) -> str:
        where = "" if self.polygon is None else f" at face {self.polygon}"
        return f"{self.name}{where}: {self.text}"


@dataclass
class FoundSeams:
    """The result of `find_seams`: `edges` (k, 2) are the vertices of the new seams of each surface.

    The surfaces are divided into `islands`. The `length` of the new seams, over the root of the area, and the
    predicted `shear` are of all surfaces together. Where the wanted shear was left to the search, `presets`
    has that of each surface that was cut, the highest of its islands. `notes` name what is sheared more than
    it should be, and what was mended. `at_a_point` and `left_out` as for a mapping. `ended_early` says that
    it was asked to end before it was done: the last island has quick seams then.
    """

    edges: list[Integers]
    islands: int = 0
    length: float = 0.0
    shear: float = 1.0
    presets: dict[str, float] = field(default_factory=dict)
    notes: list[Note] = field(default_factory=list)
    at_a_point: list[tuple[int, Integers]] = field(default_factory=list)
    left_out: dict[int, Integers] = field(default_factory=dict)
    refusals: list[Refusal] = field(default_factory=list)
    ended_early: bool = False


@dataclass
class Mapping:
    """The result of `unwrap`; `ended_early` says that it was asked to end before it was done.

    `seams` are those that were found for it, None where those of the surfaces count. `at_a_point` are the
    mesh corners (k,) of some surfaces, by number, that belong to islands without area. `left_out` are the
    polygons (p,) of some surfaces that no island has: those without area, and duplicates; the corners of the
    islands include theirs. `notes` name what was mended or done in another way than asked for.
    """

    islands: list[Island] = field(default_factory=list)
    at_a_point: list[tuple[int, Integers]] = field(default_factory=list)
    left_out: dict[int, Integers] = field(default_factory=dict)
    notes: list[Note] = field(default_factory=list)
    refusals: list[Refusal] = field(default_factory=list)
    ended_early: bool = False
    seams: FoundSeams | None = None


@dataclass
class Figures:
    """Area ratios, angles and flips of UVs, over the triangles of all surfaces.

    `angle` is the mean of σ₁/σ₂ over the triangles, `shear` that over the area.
    """

    triangles: int
    mean: float
    deviation: float
    log2_min: float
    log2_max: float
    flips: int
    angle: float
    shear: float
    without_area: int


@dataclass
class Measurement(Figures):
    """Figures of UV maps whoever made them, with those of the polygons of each surface.

    `mirrored` islands are mirrored as a whole, which is no flip. `texel_density` is the root of UV area over
    area in space.
    """

    mirrored: int
    texel_density: float
    polygons: list[Polygons]

    @property
    def log2(self) -> list[Floats]:
        """log2 of the area ratio of each polygon, (polygons,) for each surface."""
        return [figures.log2 for figures in self.polygons]

    @property
    def flipped(self) -> int:
        """The number of polygons with a folded triangle."""
        return sum(int(figures.folded.sum()) for figures in self.polygons)

    @property
    def fair(self) -> float:
        """The part of the polygons with an area whose area ratio is 1 up to a tenth."""
        counted = sum(int(figures.counted.sum()) for figures in self.polygons)
        return np.count_nonzero(np.abs(self._ratios - 1) <= _FAIR) / counted

    @property
    def shares(self) -> tuple[float, float]:
        """The least and the greatest area ratio of a polygon that is not flipped, 0 where all are."""
        ratios = self._ratios
        return (float(ratios.min()), float(ratios.max())) if len(ratios) else (0.0, 0.0)

    @property
    def _ratios(self) -> Floats:
        """The area ratios (k,) of the polygons that have an area and are not flipped."""
        chosen = [figures.ratios[figures.counted & ~figures.folded] for figures in self.polygons]
        return np.concatenate(chosen)


@dataclass
class SphereShape:
    """A closed mesh's vertices (n, 3) on the sphere of its area, in single precision, with figures.

    `angle` is the mean angle distortion, `shortfall` as for islands, `ended_early` as for a mapping.
    """

    positions: Singles
    radius: float
    deviation: float
    flips: int
    angle: float
    shortfall: Shortfall | None
    ended_early: bool


@dataclass
class Unflipped:
    """The result of `fix_flips`: `writes` are (surface, mesh corners (k,), UVs (k, 2) in single precision).

    `faces` polygons were flipped, in `islands` islands; `moved` UV vertices have moved. Islands whose flips
    stay are refused. `ended_early` as for a mapping.
    """

    writes: list[tuple[int, Integers, Singles]] = field(default_factory=list)
    faces: int = 0
    islands: int = 0
    moved: int = 0
    refusals: list[Refusal] = field(default_factory=list)
    ended_early: bool = False
