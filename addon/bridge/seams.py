# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams along which islands become disks whose maps are hardly sheared."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

import authalic

from ..surfaces import seam_costs, suitability, triangulation
from ..surfaces.arrays import Booleans, Floats, Integers
from ..surfaces.suitability import Unsuitable
from ..surfaces.surface import Surface
from . import known
from .patches import SurfacePatch, checked, opened, surface_patches
from .progress import READING, Progress, keep_going, one_by_one, share_of, to_the_end
from .results import FoundSeams, Note
from .settings import FEW_SEAMS, LOW_SHEAR, SeamSettings

_NO_CUT = "has no seams along its edges that cut it open; triangulate or remesh it"
# A patch in which the seams for little shear have more slits has the relief of a scan.
_MOST_SLITS = 20
# That of quick seams, which have a third more slits.
_MOST_QUICK_SLITS = 27
# The part of the time of a search that is repeated for more shear.
_FIRST = 0.6
_CROSSES = "seams cross what they are to be kept off, because nothing else cuts it open"


_Seams = authalic.Seams | authalic.Unwrap


class _NoWay(Unsuitable):
    """Weights forbid all seams that would cut a patch into disks."""


@dataclass
class Disk:
    """A disk that a surface has become, and the UVs (n, 2) of its points, in the unit of the surface.

    They are None if the search made no map.
    """

    piece: SurfacePatch
    uv: Floats | None


def find_seams(
    surfaces: Sequence[Surface], settings: SeamSettings, progress: Progress = keep_going
) -> FoundSeams:
    """Finds seams for every island of every surface (`Surface`), along edges of the mesh only.

    When `progress` returns False, the current island gets quick seams, and later ones are refused. Islands
    without seams that help are refused, not raised.
    """
    return disks(surfaces, settings, False, progress)[0]


def disks(
    surfaces: Sequence[Surface], settings: SeamSettings, with_maps: bool, progress: Progress
) -> tuple[FoundSeams, list[Disk]]:
    """What `find_seams` returns, and the disks that the surfaces become; if wanted, with maps.

    The maps are those by which the search checks the shear. A search that ends early has none.
    """
    found = FoundSeams([np.empty((0, 2), int) for _ in surfaces])
    search = _Search(surfaces, settings, with_maps, found)
    patches = surface_patches(surfaces, found, with_seams=settings.keep_given)
    search.expect(patches)
    one_by_one(patches, search.cut, found, share_of(progress, READING, 1.0 - READING))
    search.finish()
    return found, search.disks


class Cutter:
    """Cuts patches of some surfaces into disks, one by one; what they share is computed at the first one."""

    def __init__(self, surfaces: Sequence[Surface], settings: SeamSettings, with_maps: bool) -> None:
        self._surfaces, self._settings, self._with_maps = surfaces, settings, with_maps
        self._search: _Search | None = None

    def disks(self, piece: SurfacePatch, progress: Progress) -> list[Disk]:
        """The disks that a patch becomes, if wanted with maps; a search that ends early has none."""
        if self._search is None:
            found = FoundSeams([np.empty((0, 2), int) for _ in self._surfaces])
            self._search = _Search(self._surfaces, self._settings, self._with_maps, found)
        before = len(self._search.disks)
        self._search.cut(piece, progress)
        return self._search.disks[before:]


class _Search:
    """A search on the patches of some surfaces, and what has been found so far."""

    def __init__(
        self, surfaces: Sequence[Surface], settings: SeamSettings, with_maps: bool, found: FoundSeams
    ) -> None:
        self.disks: list[Disk] = []
        self._surfaces, self._settings, self._with_maps = surfaces, settings, with_maps
        self._found = found
        self._edges = [seam_costs.edge_keys(surface) for surface in surfaces]
        self._is_scan = [seam_costs.is_scan(surface) for surface in surfaces]
        # the islands of each surface: those that are cut, and one at least for each patch that is left
        self._islands = np.zeros(len(surfaces), int)
        # the sums of area, length · root of area, and shear · area
        self._sums = np.zeros(3)

    def expect(self, pieces: Sequence[SurfacePatch]) -> None:
        """Says which patches there are to be cut."""
        for piece in pieces:
            self._islands[piece.index] += 1

    def cut(self, piece: SurfacePatch, progress: Progress) -> None:
        """Cuts a patch into disks."""
        parts, across = opened(piece, self._found.notes)
        edges = self._found.edges
        for part in parts:
            suitability.check_sides(part.patch)
            wanted, seams = self._suitable(part, progress)
            self.disks += _disks(part, seams)
            self._record(part, wanted, seams)
        edges[piece.index] = np.concatenate([edges[piece.index], across])

    def finish(self) -> None:
        area, length, shear = self._sums
        if area > 0:
            self._found.length, self._found.shear = float(length / np.sqrt(area)), float(shear / area)

    def _record(self, piece: SurfacePatch, wanted: float, seams: _Seams) -> None:
        index, found, shear = piece.index, self._found, _shear(seams)
        if self._settings.shear is None:
            found.presets[piece.name] = max(wanted, found.presets.get(piece.name, 0.0))
        found.edges[index] = np.concatenate([found.edges[index], piece.mesh_edges(np.asarray(seams.edges))])
        found.islands += seams.islands
        self._islands[index] += seams.islands - 1
        area = triangulation.areas(piece.points[np.asarray(piece.patch.faces)]).sum()
        self._sums += [area, seams.length * np.sqrt(area), shear * area]
        if seams.status == "stalled":
            how = "reached" if isinstance(seams, authalic.Unwrap) else "predicted"
            missed = f"no seams bring the shear down to {wanted:.4g} ({how} {shear:.2f})"
            self._note(piece, missed)

    def _note(self, piece: SurfacePatch, remark: str) -> None:
        note = Note(piece.name, piece.polygon, remark)
        if note not in self._found.notes:
            self._found.notes.append(note)

    def _suitable(self, piece: SurfacePatch, progress: Progress) -> tuple[float, _Seams]:
        """The shear that suits a patch if none is wanted, and its seams."""
        if self._settings.shear is not None:
            return self._settings.shear, self._seams(piece, self._settings.shear, progress)
        if self._is_scan[piece.index]:
            return FEW_SEAMS, self._seams(piece, FEW_SEAMS, progress)
        seams = self._seams(piece, LOW_SHEAR, share_of(progress, 0.0, _FIRST))
        slits = seam_costs.slit_count(np.asarray(seams.edges), piece.patch.boundary_loops)
        most = _MOST_QUICK_SLITS if self._settings.is_draft else _MOST_SLITS
        if self._found.ended_early or slits <= most:
            return LOW_SHEAR, seams
        fewer = self._seams(piece, FEW_SEAMS, share_of(progress, _FIRST, 1 - _FIRST))
        return (LOW_SHEAR, seams) if self._found.ended_early else (FEW_SEAMS, fewer)

    def _seams(self, piece: SurfacePatch, shear: float, progress: Progress) -> _Seams:
        """The seams of a patch; they run where they are forbidden only if there is no other way."""
        edges = seam_costs.triangle_edges(np.asarray(piece.patch.faces))
        is_edge, factors = self._are_edges(piece, edges), self._factors(piece, edges)
        diagonals = edges[~is_edge]
        with suppress(_NoWay):
            weights = np.where(is_edge, factors, np.inf)
            return self._sought(piece, shear, weights, diagonals, progress)
        finite = np.where(is_edge, seam_costs.finite(factors), np.inf)
        seams = self._sought(piece, shear, finite, diagonals, progress)
        self._note(piece, _CROSSES)
        return seams

    def _are_edges(self, piece: SurfacePatch, pairs: Integers) -> Booleans:
        """Which pairs (k, 2) of vertices of a patch are edges of the mesh, and no diagonals of polygons."""
        surface, keys = self._surfaces[piece.index], self._edges[piece.index]
        return seam_costs.are_edges(surface, keys, piece.mesh_edges(pairs))

    def _factors(self, piece: SurfacePatch, edges: Integers) -> Floats:
        """How dear a seam is at edges (e, 2) of a patch, (e,)."""
        factors = self._surfaces[piece.index].seam_factors
        if factors is None:
            return np.ones(len(edges))
        # The center of a divided polygon has no factor, and no seam.
        return factors[piece.vertices[edges]].mean(axis=1)

    def _sought(
        self, piece: SurfacePatch, shear: float, weights: Floats, diagonals: Integers, progress: Progress
    ) -> _Seams:
        """The seams of a patch, with weights (e,) of its edges; raises `_NoWay` if these forbid all cuts."""
        try:
            options = {"target": shear, "weights": weights, "diagonals": diagonals}
            return self._exact_or_quick(piece, options, progress)
        except authalic.MeshError as problem:
            if problem.kind == "invalid_array":
                raise _NoWay(_NO_CUT) from problem
            raise

    def _exact_or_quick(self, piece: SurfacePatch, options: dict[str, Any], progress: Progress) -> _Seams:
        """The seams of a patch; quick ones for a draft, or if the search was asked to end."""
        settings, native = self._settings, checked(piece.patch, piece.points)
        options = {
            **options,
            "symmetry": "auto" if settings.is_symmetric else "off",
            "front": settings.front,
            "max_islands": self._most_islands(piece),
            "overlap": settings.overlap,
        }
        if not settings.is_draft:
            try:
                if self._with_maps:
                    return known.result(authalic.unwrap, native, {"pack": False, **options}, progress)
                return known.result(authalic.seams, native, options, progress)
            except authalic.SolverError as problem:
                if problem.kind != "cancelled":
                    raise
        return authalic.seams(native, method="cones", progress=to_the_end(progress), **options)

    def _most_islands(self, piece: SurfacePatch) -> int | None:
        """The most islands that a patch may become, so that its surface has no more than wanted."""
        if self._settings.max_islands is None:
            return None
        return max(1, self._settings.max_islands - int(self._islands[piece.index]) + 1)


def _shear(seams: _Seams) -> float:
    """The mean σ₁/σ₂ of the maps along seams, or what is predicted where there are none."""
    return seams.shear if isinstance(seams, authalic.Unwrap) else seams.predicted


def _disks(piece: SurfacePatch, seams: _Seams) -> list[Disk]:
    """What becomes of a patch when it is cut along seams."""
    parts = piece.parts(np.asarray(seams.edges))
    if not isinstance(seams, authalic.Unwrap):
        return [Disk(part, None) for part in parts]
    at_corner = np.asarray(seams.uv)[np.asarray(seams.faces)].reshape(-1, 2)
    return [Disk(part, _uv(part.patch, at_corner)) for part in parts]


def _uv(patch: authalic.Patch, at_corner: Floats) -> Floats:
    """The UVs (n, 2) of a patch's points, by those of the corners of the surface that it was cut from."""
    uv = np.empty((len(patch.vertex_of), 2))
    uv[np.asarray(patch.faces).ravel()] = at_corner[np.asarray(patch.corner_of).ravel()]
    return uv
