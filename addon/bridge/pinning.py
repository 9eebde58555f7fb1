# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands with pinned UVs: the pins stay where they are, and the rest of the map follows."""

from collections.abc import Sequence
from contextlib import suppress

import numpy as np

import authalic

from ..surfaces import pinned, triangulation
from ..surfaces.arrays import Floats, Integers
from ..surfaces.surface import Surface
from .progress import Progress, to_the_end
from .results import Island
from .shortfall import UNEVEN_DISK, Shortfall

FOLDS = "its faces would fold over between its pinned UVs; unpin some, or move them"
"""Why an island with pinned UVs is left as it was."""
_MOVE_PINS = "unpin some UVs, or move them"


def is_pinned(island: Island, surface: Surface) -> bool:
    """Whether an island of a surface has pinned UVs."""
    return surface.pinned is not None and bool(surface.pinned[island.corners].any())


def not_pinned(
    islands: Sequence[Island], surface: Surface, stretch: Floats, progress: Progress
) -> list[Island]:
    """Moves and bends islands of a surface so that their pinned UVs stay; returns those without pins.

    `stretch` (2,) takes the square of the UV map to the texture. Faces may fold over.
    """
    for island in islands:
        if is_pinned(island, surface):
            _put(island, surface, stretch, progress)
    return [island for island in islands if not is_pinned(island, surface)]


def _put(island: Island, surface: Surface, stretch: Floats, progress: Progress) -> None:
    assert surface.pinned is not None
    corners = np.flatnonzero(surface.pinned[island.corners])
    pins, first = np.unique(island.corner_point[corners], return_index=True)
    places = surface.uvs[island.corners[corners[first]]].astype(float)
    uv = pinned.bent(island.uv, pins, places * stretch, _scale(island, surface, stretch)) / stretch
    if len(authalic.distortion(island.native, uv).folded):
        uv = _unfolded(island, uv, pins, progress)
    uv[pins] = places
    island.uv = uv
    island.shortfall = _shortfall(island)


def _shortfall(island: Island) -> Shortfall | None:
    """What is bad about an island between its pins; None if nothing is."""
    with suppress(authalic.MeshError):
        found = authalic.distortion(island.native, island.uv)
        deviation, angle = float(found.area_ratio_std), float(found.angle_distortion_mean)
        if deviation > UNEVEN_DISK:
            return Shortfall("converged", deviation, angle, True, False, (_MOVE_PINS, _MOVE_PINS))
    return island.shortfall


def _scale(island: Island, surface: Surface, stretch: Floats) -> float:
    """The scale at which an island has the area of its former UVs; 1 if they have none."""
    former = np.full(surface.uvs.shape, np.nan)
    former[island.corners] = surface.uvs[island.corners]
    area = float(np.nansum(np.abs(triangulation.signed_areas(former[surface.corners] * stretch))))
    own = float(np.abs(triangulation.signed_areas(island.uv[island.faces])).sum())
    return float(np.sqrt(area / own)) if area > 0 and np.isfinite(area) else 1.0


def _unfolded(island: Island, uv: Floats, pins: Integers, progress: Progress) -> Floats:
    """A map without folds near one with folds, if there is one."""
    with suppress(authalic.MeshError, authalic.SolverError):
        untangled = authalic.untangle(island.native, uv, fixed=pins, progress=to_the_end(progress))
        return np.array(untangled.image)
    return uv
