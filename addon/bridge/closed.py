# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed islands: mapped onto the sphere, which is laid flat in the layout that suits them."""

from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

import authalic

from ..surfaces.arrays import Booleans, Floats
from . import known, remedies
from .island import figures_of, island_of
from .patches import SurfacePatch, checked
from .progress import Progress, share_of, to_the_end
from .results import Island, Note
from .settings import UnwrapSettings
from .shortfall import UNEVEN_SPHERE, shortfall
from .solver import Solver
from .spheres import sphere_map

CUT_OPEN = (
    "cut open by seams, which are not marked, because its sphere cannot be laid flat well; set Seams to "
    "Automatic to mark them"
)
# A slider position whose shapes a layout of the sphere does not fold.
_FIT_TO_LAY_FLAT = 0.9
# The directions of the pole, and of the seam at the angle 0.
_AXES = {
    "X": ((1, 0, 0), (0, 1, 0)),
    "Y": ((0, 1, 0), (0, 0, -1)),
    "Z": ((0, 0, 1), (0, 1, 0)),
}
_NAMES = {"LAMBERT": "Lambert Cylindrical", "OCTAHEDRAL": "Octahedral"}
# The part of the time that the sphere map takes; the layouts take the rest.
_SPHERE = 0.9
# The most vertices that a layout needs for its poles.
_POLES = 4
# Islands of more triangles are cut open only if no layout of theirs is without folds: seams take their time.
_SMALL = 5000
# Low-poly shapes have at most so many triangles: they are cut open unless a layout has these figures.
_LOW_POLY, _EVEN, _LITTLE_SHEARED = 200, 0.15, 3.0


@dataclass
class LaidFlat:
    """The islands that a closed one becomes in the layouts that were tried, in this order.

    A layout with folds has none; `problem` is the error of the first one.
    """

    piece: SurfacePatch
    islands: dict[str, Island] = field(default_factory=dict)
    figures: dict[str, tuple[float, float]] = field(default_factory=dict)
    problem: authalic.SolverError | None = None
    tried: list[str] = field(default_factory=list)

    @property
    def is_good(self) -> bool:
        """Whether one of the islands is good enough, or can be no better in reasonable time."""
        if len(self.piece.polygons) > _SMALL:
            return bool(self.islands)
        return any(_is_good(island) and self._is_as_by_seams(name) for name, island in self.islands.items())

    def _is_as_by_seams(self, layout: str) -> bool:
        """Whether seams would hardly do better, or the island is no low-poly shape."""
        if len(self.piece.polygons) > _LOW_POLY:
            return True
        deviation, angle = self.figures[layout]
        return deviation <= _EVEN and angle <= _LITTLE_SHEARED

    def island(self, notes: list[Note]) -> Island:
        """The best island, with a note if its layout is not the wanted one; without any, raises the error."""
        if not self.islands:
            assert self.problem is not None
            raise self.problem
        layout = min(self.islands, key=self._badness)
        if layout != self.tried[0]:
            first = self.islands.get(self.tried[0])
            fault = "fold" if first is None or first.shortfall is None else f"be {first.shortfall.faults}"
            said = f"laid out as {_NAMES[layout]}, because it would {fault} as {_NAMES[self.tried[0]]}"
            notes.append(Note(self.piece.name, self.piece.polygon, said))
        return self.islands[layout]

    def _badness(self, layout: str) -> tuple[bool, float]:
        short = self.islands[layout].shortfall
        return not _is_good(self.islands[layout]), short.deviation if short else 0.0


def laid_flat(piece: SurfacePatch, settings: UnwrapSettings, progress: Progress) -> LaidFlat:
    """The wanted layout of a closed island and, if that is bad or has folds, the other one."""
    result = LaidFlat(piece)
    try:
        _lay_flat(result, settings, settings.solver, progress)
    except authalic.SolverError as problem:
        if problem.kind == "cancelled":
            raise
        result.problem = problem
    return result


def soften(result: LaidFlat, settings: UnwrapSettings, progress: Progress) -> None:
    """Adds a layout of a map with better shapes where faces are too thin to be laid flat."""
    solver = settings.solver
    if not result.islands and solver.method == "GAUSS_NEWTON" and solver.angle_weight < _FIT_TO_LAY_FLAT:
        with suppress(authalic.SolverError):
            solver = replace(solver, angle_weight=_FIT_TO_LAY_FLAT, area_tolerance=0.0)
            _lay_flat(result, settings, solver, progress)


def _lay_flat(result: LaidFlat, settings: UnwrapSettings, solver: Solver, progress: Progress) -> None:
    """Adds layouts of the map onto the sphere to the result, until one is good."""
    sphere = _Sphere.of(result.piece, solver, share_of(progress, 0.0, _SPHERE))
    for number, layout in enumerate(sorted(_NAMES, key=lambda name: name != settings.layout)):
        share = (1.0 - _SPHERE) / len(_NAMES)
        if layout not in result.tried:
            result.tried.append(layout)
        try:
            island, figures = sphere.island(
                layout, settings, share_of(progress, _SPHERE + number * share, share)
            )
        except authalic.SolverError as problem:
            if problem.kind != "layout_fold":
                raise
            result.problem = result.problem or problem
            continue
        result.islands[layout], result.figures[layout] = island, figures
        if result.is_good:
            return


def _is_good(island: Island) -> bool:
    short = island.shortfall
    return short is None or not (short.is_uneven or short.is_sheared)


@dataclass
class _Sphere:
    """The sphere map of a closed island; `over` (3, 3) lays it over the island, `turned` as for spheres."""

    piece: SurfacePatch
    solver: Solver
    map: authalic.SphereMap
    over: Floats
    turned: Booleans

    @classmethod
    def of(cls, piece: SurfacePatch, solver: Solver, progress: Progress) -> "_Sphere":
        return cls(
            piece,
            solver,
            *sphere_map(checked(piece.patch, piece.points), solver, progress, piece.target_areas),
        )

    def island(
        self, layout: str, settings: UnwrapSettings, progress: Progress
    ) -> tuple[Island, tuple[float, float]]:
        """The island in one layout, with the deviation of its area ratios and its mean angle distortion."""
        piece, faces = self.piece, np.asarray(self.piece.patch.faces)
        laid = self._layout(layout, settings, progress)
        # the map has turned some faces over: back to the order of the mesh
        order = (np.asarray(self.map.faces)[:, None, :] == faces[:, :, None]).argmax(axis=2)
        corner_point = np.take_along_axis(np.asarray(laid.faces), order, axis=1)
        points, uv = np.asarray(laid.vertex_of), np.asarray(laid.points, float)
        native = authalic.Surface(piece.points[points], corner_point)
        island = island_of(piece, native, uv, corner_point, self.turned, points)
        figures = figures_of(authalic.distortion(native, island.uv, density=piece.target_areas), piece)
        remedy = remedies.of_layout(settings, piece.polygons)
        island.shortfall = shortfall(self.map.status, figures, self.solver, UNEVEN_SPHERE, remedy)
        return island, figures

    def _layout(self, layout: str, settings: UnwrapSettings, progress: Progress) -> authalic.Layout:
        """A layout by the settings; the pole and the seam lie on the island's own axes."""
        pole, start = np.array(_AXES[settings.pole_axis], float)
        angle = settings.seam_direction
        seam = np.cos(angle) * start + np.sin(angle) * np.cross(pole, start)
        real = self.piece.vertices >= 0
        options = {
            "kind": "lambert" if layout == "LAMBERT" else "octahedral",
            "pole": self.over @ pole,
            "seam": self.over @ seam,
            "polygons": self.piece.polygons,
            "density": self.piece.target_areas,
            "candidates": real if np.count_nonzero(real) >= _POLES else None,
            "precision": "float32",
        }
        # a map that ended early has to be laid flat, too
        return known.result(authalic.SphereMap.layout, self.map, options, to_the_end(progress))
