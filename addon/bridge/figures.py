# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of UV maps: area ratios, angles and flips."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import authalic

from ..surfaces import polygons, triangulation
from ..surfaces.arrays import Booleans, Integers
from ..surfaces.islands import PlanarIsland
from ..surfaces.surface import Surface
from .results import Measurement


def folds(island: PlanarIsland) -> bool:
    """Whether a face of an island is folded over, exactly, in UVs of single precision as Blender has them."""
    try:
        figures = authalic.distortion(island.points, island.faces, island.uv.astype(np.float32).astype(float))
    except authalic.MeshError:  # the whole island has shrunk to a line or a point
        return True
    return len(figures.folded) > 0


def measure(surfaces: Sequence[Surface]) -> Measurement | None:
    """Figures of the UVs of `surfaces`, all on one scale; None where no triangle has an area."""
    points = np.concatenate([surface.positions[surface.triangles] for surface in surfaces])
    image = np.concatenate([surface.uvs[surface.corners] for surface in surfaces])
    good = triangulation.has_area(points) & np.isfinite(image).all(axis=(1, 2))
    points, image = points[good], image[good]
    if not triangulation.signed_areas(image.astype(float)).any():
        return None
    # With the UV islands in one piece the library turns faces of inconsistent normals by itself.
    first, faces = triangulation.welded(_vertices(surfaces)[good], image)
    corner_points, corner_image = points.reshape(-1, 3)[first], image.reshape(-1, 2)[first]
    figures = authalic.distortion(corner_points, faces, corner_image.astype(float))
    log2 = np.clip(figures.log2_area_ratio, -polygons.LOG2_LIMIT, polygons.LOG2_LIMIT)
    log2[figures.folded] = -polygons.LOG2_LIMIT
    unfolded = np.ones(len(log2), bool)
    unfolded[figures.folded] = False
    angles = figures.angle_distortion[unfolded]
    spread = [_spread(good, values) for values in (log2, triangulation.areas(points), ~unfolded)]
    return Measurement(
        triangles=len(log2),
        mean=float(figures.area_ratio_mean),
        deviation=float(figures.area_ratio_std),
        log2_min=float(log2.min()),
        log2_max=float(log2.max()),
        flips=len(figures.folded),
        angle=float(angles.mean()) if len(angles) else float("inf"),
        without_area=int(np.count_nonzero(~good)),
        log2=polygons.log2_area_ratios(surfaces, *spread),
    )


def _vertices(surfaces: Sequence[Surface]) -> Integers:
    """The vertices of the triangles of all surfaces, (t, 3), numbered on from one surface to the next."""
    starts = np.cumsum([0, *(len(surface.positions) for surface in surfaces)])
    return np.concatenate([s.triangles + start for s, start in zip(surfaces, starts[:-1], strict=True)])


def _spread(good: Booleans, values: NDArray[Any]) -> NDArray[Any]:
    """Values of some triangles as values of all, 0 for the others."""
    result = np.zeros(len(good), values.dtype)
    result[good] = values
    return result
