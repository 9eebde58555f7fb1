# SPDX-License-Identifier: GPL-3.0-or-later
"""A map of a patch as an island, and its figures."""

import numpy as np

import authalic

from ..surfaces.arrays import Booleans, Floats, Integers
from .patches import SurfacePatch
from .results import Island


def figures_of(distortion: authalic.Distortion, piece: SurfacePatch) -> tuple[float, float]:
    """The standard deviation of area ratios, and the mean angle distortion, of faces that have an area."""
    if not piece.slivers.any():
        return float(distortion.area_ratio_std), float(distortion.angle_distortion_mean)
    counted = ~piece.slivers
    ratios = np.exp2(np.asarray(distortion.log2_area_ratio)[counted])
    return float(ratios.std()), float(np.asarray(distortion.angle_distortion)[counted].mean())


def island_of(
    piece: SurfacePatch,
    native: authalic.Surface,
    uv: Floats,
    faces: Integers,
    turned: Booleans,
    points: Integers,
) -> Island:
    """An `Island` of the patch's points (n,) with UVs (n, 2) and triangles `faces`."""
    corners, corner_point = piece.corners, faces.ravel()
    real = corners >= 0
    is_whole = bool(real.all())
    if not is_whole or len(piece.carried):
        corners = np.concatenate([corners[real], piece.carried])
        corner_point = np.concatenate([corner_point[real], corner_point[piece.hosts]])
    return Island(
        name=piece.name,
        surface=piece.index,
        polygon=piece.polygon,
        points=piece.points[points],
        faces=faces,
        corners=corners,
        corner_point=corner_point,
        uv=uv,
        density=piece.density,
        turned=np.unique(piece.polygons[turned]) if turned.any() else piece.polygons[:0],
        native=native,
        has_divided_polygons=bool(piece.slivers.any()) or not is_whole,
    )
