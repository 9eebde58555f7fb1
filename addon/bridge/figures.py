# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of UV maps: area ratios, angles and flips."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import authalic

from ..surfaces import components, degenerate, polygons, triangulation
from ..surfaces.arrays import Booleans, Floats, Integers, Singles
from ..surfaces.surface import Surface
from .results import Figures, Island, Measurement


def folds(island: Island) -> bool:
    """Whether a face of an island is folded in single precision, as Blender has UVs; the answer is exact."""
    try:
        island.figures = None
        return len(_in_uvs(island).folded) > 0
    except authalic.MeshError:  # the whole island has shrunk to a line or a point
        return True


def folding(islands: Sequence[Island]) -> list[bool]:
    """Whether each island folds, as `folds` says, in one call of the library."""
    found = authalic.distortions(
        [island.native for island in islands], [island.uv.astype(np.float32) for island in islands]
    )
    for island, each in zip(islands, found, strict=True):
        island.figures = each if isinstance(each, authalic.Distortion) else None
    return [island.figures is None or len(island.figures.folded) > 0 for island in islands]


def _in_uvs(island: Island) -> authalic.Distortion:
    """The figures of an island in single precision, by the library; kept until `folds` is asked again."""
    if island.figures is None:
        island.figures = authalic.distortion(island.native, island.uv.astype(np.float32))
    return island.figures


def measure_islands(islands: Sequence[Island]) -> Figures | None:
    """Figures of islands without folds, in UVs of single precision, all on one scale.

    None if no triangle has an area.
    """
    points = np.concatenate([island.points[island.faces] for island in islands])
    image = np.concatenate([island.uv.astype(np.float32)[island.faces] for island in islands])
    angles = np.concatenate([np.asarray(_in_uvs(island).angle_distortion) for island in islands])
    good = triangulation.has_area(points)
    if not good.any():
        return None
    areas, image_areas = _areas(points[good], image[good])
    densities = np.concatenate([island.wanted_areas(np.ones(len(island.faces))) for island in islands])
    ratios, is_folded = _ratios(areas * densities[good], image_areas), np.zeros(len(areas), bool)
    return _figures(areas, ratios, is_folded, angles[good], int(np.count_nonzero(~good)))


def measure(surfaces: Sequence[Surface]) -> Measurement | None:
    """Figures of the UVs of `surfaces`, all on one scale; None if no triangle has an area.

    Areas count by the density of the surfaces.
    """
    points = np.concatenate([surface.positions[surface.triangles] for surface in surfaces])
    image = np.concatenate([surface.uvs[surface.corners] for surface in surfaces])
    good = triangulation.has_area(points) & np.isfinite(image).all(axis=(1, 2))
    points, image = points[good], image[good]
    areas, image_areas = _areas(points, image)
    if not image_areas.any():
        return None
    native, mirrored = _unmirrored(points, _vertices(surfaces)[good], image)
    folded = np.zeros(len(areas), bool)
    folded[native.folded] = True
    targets = areas * np.concatenate([surface.densities for surface in surfaces])[good]
    ratios = _ratios(targets, np.where(folded, -image_areas, image_areas))
    angles = np.asarray(native.angle_distortion)
    figures = _figures(areas, ratios, folded, angles, int(np.count_nonzero(~good)))
    spread = [_spread(good, values) for values in (areas, targets, ratios, angles, folded)]
    of_all = polygons.Triangles(*spread).split(surfaces)
    of_polygons = [polygons.of_triangles(*pair) for pair in zip(surfaces, of_all, strict=True)]
    texels = float(np.sqrt(image_areas.sum() / areas.sum()))
    return Measurement(**vars(figures), mirrored=mirrored, texel_density=texels, polygons=of_polygons)


def _unmirrored(points: Floats, vertices: Integers, image: Singles) -> tuple[authalic.Distortion, int]:
    """The figures by the library of triangles (t, 3, 3), with vertices (t, 3) and images (t, 3, 2).

    Islands that are mirrored are turned back first; also returns their number.
    """
    native, faces = _welded(points, vertices, image)
    if not len(native.folded):
        return native, 0
    signed = np.abs(triangulation.signed_areas(image.astype(float)))
    signed[native.folded] *= -1
    component = components.joined_by_edges(faces)
    mirrored = components.mirrored(component, signed)
    if mirrored.any():
        turned = image.copy()
        turned[mirrored[component], :, 0] *= -1
        native, _ = _welded(points, vertices, turned)
    return native, int(np.count_nonzero(mirrored))


def _welded(points: Floats, vertices: Integers, image: Singles) -> tuple[authalic.Distortion, Integers]:
    """The figures of triangles as above, and the triangles (t, 3) that they become.

    Corners are joined, so that the library itself can turn faces with inconsistent normals.
    """
    first, faces = triangulation.welded(vertices, image)
    native = authalic.distortion(points.reshape(-1, 3)[first], faces, image.reshape(-1, 2)[first])
    return native, faces


def _areas(points: Floats, image: Singles) -> tuple[Floats, Floats]:
    """The areas (t,) of triangles (t, 3, 3), and of their images (t, 3, 2)."""
    return triangulation.areas(points), np.abs(triangulation.signed_areas(image.astype(float)))


def _ratios(areas: Floats, image_areas: Floats) -> Floats:
    """Signed image areas (t,) over areas (t,), scaled so that all areas together have the ratio 1."""
    return image_areas / areas * float(areas.sum() / np.abs(image_areas).sum())


def _log2(ratios: Floats, folded: Booleans) -> Floats:
    """log2 of area ratios (t,), clipped to the limits."""
    log2 = np.full(len(ratios), -polygons.LOG2_LIMIT)
    log2[~folded] = np.clip(np.log2(ratios[~folded]), -polygons.LOG2_LIMIT, polygons.LOG2_LIMIT)
    return log2


def _figures(areas: Floats, ratios: Floats, folded: Booleans, angles: Floats, without_area: int) -> Figures:
    """Figures of triangles with areas (t,), area ratios (t,) and angle distortions (t,)."""
    log2, unfolded, weights = _log2(ratios, folded), angles[~folded], areas[~folded]
    return Figures(
        triangles=len(ratios),
        mean=float(ratios.mean()),
        deviation=float(ratios.std()),
        log2_min=float(log2.min()),
        log2_max=float(log2.max()),
        flips=int(folded.sum()),
        angle=float(unfolded.mean()) if len(unfolded) else float("inf"),
        shear=float(np.average(unfolded, weights=weights)) if len(unfolded) else float("inf"),
        without_area=without_area,
    )


def _vertices(surfaces: Sequence[Surface]) -> Integers:
    """The vertices of the triangles of all surfaces, (t, 3), numbered on from one surface to the next.

    Duplicate faces have vertices of their own: they are no part of the island that they lie on.
    """
    starts = np.cumsum([0, *(len(surface.positions) for surface in surfaces)])
    numbered = []
    for surface, start in zip(surfaces, starts[:-1], strict=True):
        copy = np.zeros(surface.polygon_count, np.int64)
        duplicates = degenerate.duplicates_of(surface)
        copy[duplicates] = 1 + np.arange(len(duplicates))
        numbered.append(surface.triangles + start + copy[surface.polygons, None] * starts[-1])
    return np.concatenate(numbered)


def _spread(good: Booleans, values: NDArray[Any]) -> NDArray[Any]:
    """Values of some triangles as values of all, 0 for the others."""
    result = np.zeros(len(good), values.dtype)
    result[good] = values
    return result
