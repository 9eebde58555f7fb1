# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams along which islands become disks whose maps are hardly sheared."""

from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import numpy as np

import authalic

from ..surfaces import seam_costs, suitability, triangulation
from ..surfaces.arrays import Booleans, Floats, Integers
from ..surfaces.suitability import Unsuitable
from ..surfaces.surface import Surface
from .patches import SurfacePatch, checked, surface_patches
from .progress import Progress, keep_going, one_by_one, to_the_end
from .results import FoundSeams
from .settings import FEW_SEAMS, LOW_SHEAR, SeamSettings

_NO_CUT = "has no seams along its edges that cut it open; triangulate or remesh it"
_CROSSES = "seams cross what they are to be kept off, because nothing else cuts it open"


class _NoWay(Unsuitable):
    """Weights forbid all seams that would cut a patch into disks."""


def find_seams(
    surfaces: Sequence[Surface], settings: SeamSettings, progress: Progress = keep_going
) -> FoundSeams:
    """Finds seams for every island of every surface (`Surface`), along edges of the mesh only.

    When `progress` returns False, the current island gets quick seams, and later ones are refused. Islands
    without seams that help are refused, not raised.
    """
    return disks(surfaces, settings, progress)[0]


def disks(
    surfaces: Sequence[Surface], settings: SeamSettings, progress: Progress
) -> tuple[FoundSeams, list[SurfacePatch]]:
    """What `find_seams` returns, and the disks that the surfaces become."""
    found = FoundSeams([np.empty((0, 2), int) for _ in surfaces])
    search = _Search(surfaces, settings, found)
    patches = surface_patches(surfaces, found, with_seams=settings.keep_given)
    search.expect(patches)
    one_by_one(patches, search.cut, found, progress)
    search.finish()
    return found, search.disks


class _Search:
    """A search on the patches of some surfaces, and what has been found so far."""

    def __init__(self, surfaces: Sequence[Surface], settings: SeamSettings, found: FoundSeams) -> None:
        self.disks: list[SurfacePatch] = []
        self._surfaces, self._settings, self._found = surfaces, settings, found
        self._edges = [seam_costs.edge_keys(surface) for surface in surfaces]
        self._shear = [_shear(surface, settings) for surface in surfaces]
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
        if piece.is_pinned:
            raise Unsuitable(suitability.PINNED)
        suitability.check_sides(piece.patch)
        seams = self._seams(piece, progress)
        edges = np.asarray(seams.edges)
        self.disks += piece.parts(edges)
        index, found = piece.index, self._found
        found.edges[index] = np.concatenate([found.edges[index], piece.vertices[edges]])
        found.islands += seams.islands
        self._islands[index] += seams.islands - 1
        area = triangulation.areas(piece.points[np.asarray(piece.patch.faces)]).sum()
        self._sums += [area, seams.length * np.sqrt(area), seams.predicted * area]
        if seams.status == "stalled":
            found.notes.append(
                f"{piece.name} at face {piece.polygon}: no seams bring the shear down to "
                f"{self._shear[index]:.4g} (predicted {seams.predicted:.2f})"
            )

    def finish(self) -> None:
        area, length, shear = self._sums
        if area > 0:
            self._found.length, self._found.shear = float(length / np.sqrt(area)), float(shear / area)

    def _seams(self, piece: SurfacePatch, progress: Progress) -> authalic.Seams:
        """The seams of a patch; they run where they are forbidden only if there is no other way."""
        edges = seam_costs.triangle_edges(np.asarray(piece.patch.faces))
        is_edge, factors = self._are_edges(piece, edges), self._factors(piece, edges)
        diagonals = edges[~is_edge]
        with suppress(_NoWay):
            return self._sought(piece, np.where(is_edge, factors, np.inf), diagonals, progress)
        finite = np.where(is_edge, seam_costs.finite(factors), np.inf)
        seams = self._sought(piece, finite, diagonals, progress)
        self._found.notes.append(f"{piece.name} at face {piece.polygon}: {_CROSSES}")
        return seams

    def _are_edges(self, piece: SurfacePatch, pairs: Integers) -> Booleans:
        """Which pairs (k, 2) of vertices of a patch are edges of the mesh, and no diagonals of polygons."""
        surface, keys = self._surfaces[piece.index], self._edges[piece.index]
        return seam_costs.are_edges(surface, keys, piece.vertices[pairs])

    def _factors(self, piece: SurfacePatch, edges: Integers) -> Floats:
        """How dear a seam is at edges (e, 2) of a patch, (e,)."""
        factors = self._surfaces[piece.index].seam_factors
        if factors is None:
            return np.ones(len(edges))
        # The center of a divided polygon has no factor, and no seam.
        return factors[piece.vertices[edges]].mean(axis=1)

    def _sought(
        self, piece: SurfacePatch, weights: Floats, diagonals: Integers, progress: Progress
    ) -> authalic.Seams:
        """The seams of a patch, with weights (e,) of its edges; raises `_NoWay` if these forbid all cuts."""
        try:
            return self._exact_or_quick(piece, {"weights": weights, "diagonals": diagonals}, progress)
        except authalic.MeshError as problem:
            if problem.kind == "invalid_array":
                raise _NoWay(_NO_CUT) from problem
            raise

    def _exact_or_quick(
        self, piece: SurfacePatch, options: dict[str, Any], progress: Progress
    ) -> authalic.Seams:
        """The seams of a patch; quick ones for a draft, or if the search was asked to end."""
        settings, native = self._settings, checked(piece.patch, piece.points)
        options = {
            **options,
            "target": self._shear[piece.index],
            "symmetry": "auto" if settings.is_symmetric else "off",
            "front": settings.front,
            "max_islands": self._most_islands(piece),
            "overlap": settings.overlap,
        }
        if not settings.is_draft:
            try:
                return authalic.seams(native, progress=progress, **options)
            except authalic.SolverError as problem:
                if problem.kind != "cancelled":
                    raise
        return authalic.seams(native, method="cones", progress=to_the_end(progress), **options)

    def _most_islands(self, piece: SurfacePatch) -> int | None:
        """The most islands that a patch may become, so that its surface has no more than wanted."""
        if self._settings.max_islands is None:
            return None
        return max(1, self._settings.max_islands - int(self._islands[piece.index]) + 1)


def _shear(surface: Surface, settings: SeamSettings) -> float:
    """The shear that the seams of a surface are to leave."""
    if settings.shear is not None:
        return settings.shear
    return FEW_SEAMS if seam_costs.is_scan(surface) else LOW_SHEAR
