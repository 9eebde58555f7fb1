# SPDX-License-Identifier: GPL-3.0-or-later
"""Scales UV islands of a context's objects to a texel density: the one path of operator and scripts."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from .. import bridge, messages
from ..blender import images, meshes, uv_maps
from ..blender.images import Size
from ..blender.types import MeshObject
from ..surfaces import texel_density
from ..surfaces.arrays import Booleans, Floats
from ..surfaces.surface import Surface
from ..surfaces.texel_density import Islands
from . import targets

DEFAULT_SIZE = 1024


@dataclass
class Settings:
    """The wanted density in pixels per meter, and the size of the image.

    Islands get it `each` for itself, or together by one factor. They are scaled about their centers, with
    `keep_position` False about the origin of the UV space.
    """

    density: float
    size: Size
    each: bool = True
    keep_position: bool = True


@dataclass
class Report:
    """How many islands were scaled, the density that they had together, and what was left as it was."""

    islands: int
    before: float
    settings: Settings
    without_area: int
    refusals: list[bridge.Refusal]

    def __str__(self) -> str:
        width, height = self.settings.size
        said = [
            f"{messages.count(self.islands, 'island')} at {self.settings.density:.4g} px/m "
            f"(before {self.before:.4g}) of an image of {width} × {height} pixels"
        ]
        if self.without_area:
            said.append(f"{messages.count(self.without_area, 'island')} without area left out")
        if self.refusals:
            said.append(f"left as it was: {messages.listed(self.refusals)}")
        return "; ".join(said)


@dataclass
class _Chosen:
    """An object, its UV map, its whole surface, its islands, and which of these (k,) are chosen."""

    obj: MeshObject
    layer: str
    surface: Surface
    islands: Islands
    mask: Booleans


def size_of_image(context: bpy.types.Context) -> tuple[str, Size] | None:
    """The name and the size of the image that the active object is being textured with, if there is one."""
    image = images.active(context)
    return (image.name, images.size(image)) if image is not None else None


def in_pixels(context: bpy.types.Context, density: float, size: Size) -> float:
    """Pixels per meter of an image, by a density as `texel_density` has them."""
    return density * _pixels_per_density(context, size)


def set_density(context: bpy.types.Context, settings: Settings) -> Report:
    """Scales the islands of the selected faces, in object mode all islands of the selected objects.

    Raises `targets.NothingToDo` before anything is written.
    """
    objects, refusals = targets.editable(context)
    chosen = [entry for obj in objects if (entry := _chosen(obj, context.mode == "EDIT_MESH")) is not None]
    if not chosen:
        raise targets.NothingToDo("No selected face has a UV map")
    before = texel_density.density([entry.islands for entry in chosen], [entry.mask for entry in chosen])
    if not before > 0:
        raise targets.NothingToDo("The selected faces have no area, or their UVs lie in one point")
    scales = _scales(chosen, settings.density / _pixels_per_density(context, settings.size), before, settings)
    middle = _middle(chosen) if settings.keep_position and not settings.each else None
    for entry, scale in zip(chosen, scales, strict=True):
        pivots = _pivots(entry, settings, middle)
        change = texel_density.scaled(entry.surface, entry.islands, scale, pivots)
        uv_maps.write(entry.obj.data, entry.layer, change.corners, change.uv)
    islands = sum(int(np.isfinite(scale).sum()) for scale in scales)
    total = sum(int(entry.mask.sum()) for entry in chosen)
    before_in_pixels = in_pixels(context, before, settings.size)
    return Report(islands, before_in_pixels, settings, total - islands, refusals)


def _scales(chosen: Sequence[_Chosen], wanted: float, before: float, settings: Settings) -> list[Floats]:
    """The factors (k,) of the islands of each object; NaN for those that stay."""
    scales = []
    for entry in chosen:
        scale = texel_density.factors(entry.islands, wanted)
        if not settings.each:
            scale = np.full(len(scale), wanted / before)
        scale[~entry.mask] = np.nan
        scales.append(scale)
    return scales


def _chosen(obj: MeshObject, selected_only: bool) -> _Chosen | None:
    """An object with its islands; None if it has no UV map, or none of its faces is chosen."""
    layer = uv_maps.active(obj)
    if layer is None:
        return None
    surface = meshes.read(obj, uv_layer=layer, world=True)
    if not len(surface.triangles):
        return None
    islands = texel_density.islands(surface)
    mask = np.ones(len(islands.areas), bool)
    if selected_only:
        is_selected = np.zeros(surface.polygon_count, bool)
        is_selected[meshes.read(obj, selected_only=True).polygons] = True
        mask = np.bincount(islands.of_triangle, is_selected[surface.polygons]) > 0
    return _Chosen(obj, layer, surface, islands, mask) if mask.any() else None


def _pivots(entry: _Chosen, settings: Settings, shared: Floats | None) -> Floats:
    """The points (k, 2) about which the islands of an object are scaled."""
    if not settings.keep_position:
        return np.zeros((len(entry.islands.areas), 2))
    if shared is not None:
        return np.tile(shared, (len(entry.islands.areas), 1))
    return texel_density.centers(entry.surface, entry.islands)


def _middle(chosen: Sequence[_Chosen]) -> Floats:
    """The center (2,) of the bounding box of all chosen islands."""
    corners = [texel_density.boxes(entry.surface, entry.islands) for entry in chosen]
    low = np.min(
        [low[entry.mask].min(axis=0) for entry, (low, _) in zip(chosen, corners, strict=True)], axis=0
    )
    high = np.max(
        [top[entry.mask].max(axis=0) for entry, (_, top) in zip(chosen, corners, strict=True)], axis=0
    )
    middle: Floats = (low + high) / 2
    return middle


def _pixels_per_density(context: bpy.types.Context, size: Size) -> float:
    """Pixels per meter for the density 1: a unit of length in Blender may be another length in meters."""
    meters = context.scene.unit_settings.scale_length if context.scene else 1.0
    return float(np.sqrt(size[0] * size[1]) / meters)
