# SPDX-License-Identifier: GPL-3.0-or-later
"""How many texels a length on a surface gets, and UV islands scaled to a wanted number. Plain numpy, no bpy.

A density here is the root of UV area over area in space; with an image of w × h pixels a length gets √(w h)
times as many pixels.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from . import components, triangulation
from .arrays import Booleans, Floats, Integers, Singles
from .surface import Surface


@dataclass
class Islands:
    """The UV islands of a surface: that of each triangle (t,), from 0, and areas (k,) of all of them."""

    of_triangle: Integers
    areas: Floats
    uv_areas: Floats


@dataclass
class Change:
    """New UVs (k, 2) for mesh corners (k,)."""

    corners: Integers
    uv: Singles


def islands(surface: Surface) -> Islands:
    """The islands of a surface's UV map: triangles that share an edge in the mesh and in the plane."""
    image = surface.uvs[surface.corners]
    _, faces = triangulation.welded(surface.triangles, image)
    island = components.joined_by_edges(faces)
    areas = triangulation.areas(surface.positions[surface.triangles])
    uv_areas = np.abs(triangulation.signed_areas(image.astype(float)))
    return Islands(island, np.bincount(island, areas), np.bincount(island, uv_areas))


def density(found: Sequence[Islands], chosen: Sequence[Booleans]) -> float:
    """The density of some islands (k,) of each surface together; 0 where they have no area."""
    area = sum(float(part.areas[mask].sum()) for part, mask in zip(found, chosen, strict=True))
    uv_area = sum(float(part.uv_areas[mask].sum()) for part, mask in zip(found, chosen, strict=True))
    return float(np.sqrt(uv_area / area)) if area > 0 and np.isfinite(uv_area / area) else 0.0


def factors(found: Islands, wanted: float) -> Floats:
    """The factors (k,) that give islands a density; NaN where there is none, for lack of area."""
    with np.errstate(divide="ignore", invalid="ignore"):
        values: Floats = wanted / np.sqrt(found.uv_areas / found.areas)
    values[~np.isfinite(values) | (values <= 0)] = np.nan
    return values


def centers(surface: Surface, found: Islands) -> Floats:
    """The centers (k, 2) of the bounding boxes of islands."""
    low, high = boxes(surface, found)
    middles: Floats = (low + high) / 2
    return middles


def boxes(surface: Surface, found: Islands) -> tuple[Floats, Floats]:
    """The lower left and the upper right corners (k, 2) of the bounding boxes of islands."""
    uv = surface.uvs[surface.corners].astype(float)
    shape = (len(found.areas), 2)
    low, high = np.full(shape, np.inf), np.full(shape, -np.inf)
    np.minimum.at(low, found.of_triangle, uv.min(axis=1))
    np.maximum.at(high, found.of_triangle, uv.max(axis=1))
    return low, high


def scaled(surface: Surface, found: Islands, scale: Floats, pivots: Floats) -> Change:
    """Islands scaled by factors (k,) about points (k, 2); those whose factor is NaN stay as they are."""
    island = np.repeat(found.of_triangle, 3)
    corners, first = np.unique(surface.corners.ravel(), return_index=True)
    island = island[first]
    moves = np.isfinite(scale)[island]
    corners, island = corners[moves], island[moves]
    pivot = pivots[island]
    uv = pivot + (surface.uvs[corners] - pivot) * scale[island][:, None]
    return Change(corners, uv.astype(np.float32))
