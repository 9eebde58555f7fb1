# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the islands of an unwrap lie in the UV map: packed into a tile, or where their UVs were."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from .. import messages
from ..surfaces import islands as shapes
from ..surfaces.arrays import Floats, Integers, Singles
from ..surfaces.suitability import Unsuitable
from ..surfaces.surface import Surface
from . import known, pinning
from .figures import folding, measure, measure_islands
from .progress import Progress, to_the_end
from .results import Figures, Island, Mapping, Refusal
from .settings import PlacementSettings

_FOLDS = "its faces would fold over in UV precision; cut its long or thin parts open by seams"
_NO_ROOM = "The margin leaves no room for the islands; make it smaller. Nothing was changed"
_NO_AREA = "No face has an area in the packed UVs; nothing was changed"


# The library's names.
_ROTATIONS: dict[str, bool | Literal["cardinal"]] = {"ANY": True, "AXIS_ALIGNED": "cardinal", "NONE": False}
# So many islands are laid level by the packer, if it may turn them.
_MANY = 400
# A scaled margin of Blender's, over the sum of the islands' sizes.
_SCALED = 0.1


@dataclass
class Placed:
    """The UVs to write: for each surface the corners (k,) of its islands and their UVs (k, 2)."""

    parts: list[tuple[Integers, Singles]]
    figures: Figures


def place(
    mapping: Mapping, surfaces: Sequence[Surface], settings: PlacementSettings, progress: Progress
) -> Placed:
    """Places the islands of a mapping; those that would fold over where they come to lie are refused.

    Raises `Unsuitable` if nothing is left to write.
    """
    # 1. One density; islands without an upper side lie level, or all.
    if mapping.islands:
        shapes.scale_to_one_density(mapping.islands)
    free = [island for island in mapping.islands if island.may_turn or settings.rotation == "AXIS_ALIGNED"]
    are_turned_anyway = settings.rotation == "ANY" and len(free) >= _MANY
    if free and not are_turned_anyway:
        for island, uv in zip(free, shapes.all_upright([island.uv for island in free]), strict=True):
            island.uv = uv
    # 2. A place for each; once more without the islands that fold over there.
    maps = [island.uv for island in mapping.islands]
    while mapping.islands:
        _put(mapping.islands, surfaces, settings, progress)
        is_sound = [not is_folding for is_folding in folding(mapping.islands)]
        if all(is_sound):
            break
        mapping.refusals += [
            Refusal(
                *(island.name, island.polygon, _why(island, surfaces)),
                surfaces[island.surface].polygons_of(island.corners),
            )
            for island, sound in zip(mapping.islands, is_sound, strict=True)
            if not sound
        ]
        maps = [uv for uv, sound in zip(maps, is_sound, strict=True) if sound]
        mapping.islands = [island for island, sound in zip(mapping.islands, is_sound, strict=True) if sound]
        for island, uv in zip(mapping.islands, maps, strict=True):
            island.uv = uv
    if not mapping.islands:
        raise Unsuitable(f"No island could be unwrapped: {messages.listed(mapping.refusals)}")
    # 3. What Blender will have
    groups = _by_surface(mapping.islands, surfaces)
    parts = [
        _gathered(group, corners)
        for group, corners in zip(groups, _at_a_point(mapping, surfaces), strict=True)
    ]
    figures = _figures(_counted(surfaces, mapping), parts, mapping.islands)
    if figures is None:
        raise Unsuitable(_NO_AREA)
    return Placed(parts, figures)


def _by_surface(islands: Sequence[Island], surfaces: Sequence[Surface]) -> list[list[Island]]:
    """The islands of each surface."""
    groups: list[list[Island]] = [[] for _ in surfaces]
    for island in islands:
        groups[island.surface].append(island)
    return groups


def _why(island: Island, surfaces: Sequence[Surface]) -> str:
    """Why an island folds over in its place."""
    return pinning.FOLDS if pinning.is_pinned(island, surfaces[island.surface]) else _FOLDS


def _put(
    islands: Sequence[Island], surfaces: Sequence[Surface], settings: PlacementSettings, progress: Progress
) -> None:
    """Moves and scales the UVs of islands to where they are wanted."""
    stretch = np.array([settings.aspect, 1.0])  # from the square to the texture
    groups = _by_surface(islands, surfaces)
    for number, surface in enumerate(surfaces):
        if surface.pinned is not None:
            groups[number] = pinning.not_pinned(groups[number], surface, stretch, progress)
        if settings.keep:
            groups[number] = _not_put_back(groups[number], surface, stretch)
    packed = {id(island) for group in groups for island in group}
    stays = [island for island in islands if id(island) not in packed]
    # what is packed beside islands that stay is to be no finer than these
    most = shapes.density(stays) * np.sqrt(settings.aspect) if stays else np.inf
    if not settings.each_by_itself:
        groups = [[island for group in groups for island in group]]
    for group in filter(None, groups):
        try:
            _pack(group, settings, most, progress)
        except ValueError as problem:  # of the library, which refuses margins only
            raise Unsuitable(_NO_ROOM) from problem


def _not_put_back(islands: Sequence[Island], surface: Surface, stretch: Floats) -> list[Island]:
    """Puts islands of a surface where their UVs were, at their size; returns those whose UVs had no area."""
    if surface.uv is None or not islands:
        return list(islands)
    new = np.empty_like(surface.uv, float)
    owner = np.full(len(new), -1)
    for number, island in enumerate(islands):
        new[island.corners], owner[island.corners] = island.uv[island.corner_point], number
    owner_of_triangle = owner[surface.corners].min(axis=1)
    order = np.argsort(owner_of_triangle, kind="stable")
    ends = np.searchsorted(owner_of_triangle[order], np.arange(len(islands) + 1))
    rest = []
    for number, island in enumerate(islands):
        corners = surface.corners[order[ends[number] : ends[number + 1]]]
        laid = shapes.laid_over(new[corners], surface.uv[corners] * stretch)
        if laid is None:
            rest.append(island)
        else:
            island.uv = laid(island.uv) / stretch
    return rest


def _pack(islands: Sequence[Island], settings: PlacementSettings, most: float, progress: Progress) -> None:
    """Packs islands outline by outline into the tile, or at a density of their own from its corner on.

    The density is at `most` the given one.
    """
    starts = np.cumsum([0, *(len(island.uv) for island in islands)])
    numbered = zip(islands, starts[:-1], strict=True)
    options = {
        # alone, an island would stand on its corner
        "rotate": _ROTATIONS["AXIS_ALIGNED" if len(islands) == 1 else settings.rotation],
        "aspect": settings.aspect,
        **_margin(islands, settings),
    }
    packing = known.packing(
        np.concatenate([island.uv for island in islands]),
        np.concatenate([island.faces + start for island, start in numbered]),
        np.repeat(np.arange(len(islands)), [len(island.faces) for island in islands]),
        options,
        to_the_end(progress),
    )
    density = packing.scale * shapes.density(islands)
    scale = settings.density / density if settings.density > 0 else min(1.0, most / density)
    for island, uv in zip(islands, np.split(np.asarray(packing.uv), starts[1:-1]), strict=True):
        island.uv = scale * uv + settings.tile


def _margin(islands: Sequence[Island], settings: PlacementSettings) -> dict[str, Any]:
    """The margin as the library's options: as Blender counts it, if scaled by the sizes of islands."""
    if settings.margin_method == "FRACTION":
        return {"margin": settings.margin}
    sizes = np.sqrt(shapes.box_sizes(islands).prod(axis=1))
    scale = _SCALED * sizes.sum() if settings.margin_method == "SCALED" else 1.0
    return {"margin": settings.margin * scale, "margin_unit": "islands"}


def _at_a_point(mapping: Mapping, surfaces: Sequence[Surface]) -> list[list[Integers]]:
    """The corners of each surface that belong to islands without area."""
    corners: list[list[Integers]] = [[] for _ in surfaces]
    for surface, some in mapping.at_a_point:
        corners[surface].append(some)
    return corners


def _counted(surfaces: Sequence[Surface], mapping: Mapping) -> list[Surface]:
    """The surfaces without polygons that are in no island."""
    counted = list(surfaces)
    for index, polygons in mapping.left_out.items():
        counted[index] = counted[index].without(polygons)
    return counted


def _gathered(islands: Sequence[Island], at_a_point: Sequence[Integers]) -> tuple[Integers, Singles]:
    """The corners (k,) to write of one surface, and their UVs (k, 2) as Blender will keep them.

    They are those of its islands, and those of islands without area, which lie in the lower left corner.
    """
    corners = np.concatenate([np.empty(0, int), *(island.corners for island in islands), *at_a_point])
    uv = np.concatenate([np.empty((0, 2)), *(island.uv[island.corner_point] for island in islands)])
    uv = np.pad(uv, ((0, len(corners) - len(uv)), (0, 0)))
    return corners, uv.astype(np.float32)


def _figures(
    surfaces: Sequence[Surface], parts: Sequence[tuple[Integers, Singles]], islands: Sequence[Island]
) -> Figures | None:
    """The figures of what was mapped, by Blender's triangles where these are not those of the islands."""
    if not any(island.has_divided_polygons for island in islands):
        return measure_islands(islands)
    return measure([_mapped(surface, *uvs) for surface, uvs in zip(surfaces, parts, strict=True)])


def _mapped(surface: Surface, corners: Integers, uv: Singles) -> Surface:
    """The part of a surface that was mapped, with its new UVs."""
    values: Singles = np.full((len(surface.corner_vertex), 2), np.nan, np.float32)
    values[corners] = uv
    return surface.restricted(np.isfinite(values[surface.corners]).all(axis=(1, 2)), values)
