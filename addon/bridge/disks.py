# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of many islands into the plane, in one call of the native library but for those that are known."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

import authalic

from ..surfaces.arrays import Floats
from .known import Request
from .patches import SurfacePatch, checked
from .progress import NOT_REACHED, Progress, Result, noting_the_end, refusal, refused, share_of
from .settings import UnwrapSettings

# Where areas count first, they may deviate by this.
_EVEN = 0.01
# How much lighter the weight of angles becomes where they deviate more, and the least one that is tried so.
_LIGHTER, _LIGHTEST = 4.0, 1e-5


def disk_maps(
    pieces: Sequence[SurfacePatch], settings: UnwrapSettings, result: Result, progress: Progress
) -> list[authalic.DiskMap | None]:
    """The map of each patch; None, and refused in the result, where there is none.

    When `progress` returns False, islands that have been begun keep their best maps so far.
    """
    natives: dict[int, authalic.Surface] = {}
    for number, piece in enumerate(pieces):
        with refused(piece, result):
            natives[number] = checked(piece.patch, piece.points)
    options = {"fill_holes": settings.fill_holes, **settings.solver.disk_options()}
    targets = [pieces[number].target_areas for number in natives]
    listen = noting_the_end(progress, result)
    most_uneven = _EVEN if settings.solver.is_even else np.inf
    found = _found(list(natives.values()), targets, options, (settings.from_last, most_uneven), listen)
    maps: list[authalic.DiskMap | None] = [None] * len(pieces)
    for number, each in zip(natives, found, strict=True):
        piece = pieces[number]
        with refused(piece, result):
            if each is None:
                result.refusals.append(refusal(piece, NOT_REACHED))
            elif isinstance(each, authalic.DiskMap):
                maps[number] = each
            else:
                raise each
    return maps


def _found(
    natives: Sequence[authalic.Surface],
    targets: Sequence[Floats | None],
    options: Mapping[str, Any],
    how: tuple[bool, float],
    progress: Progress,
) -> list[authalic.DiskMap | authalic.MeshError | authalic.SolverError | None]:
    """The map of each surface with the areas (m,) that its faces are to get, or what is wrong with it.

    `how` says whether to begin with the last maps, and which deviation of areas is too much.
    """
    from_last, most_uneven = how
    pairs = list(zip(natives, targets, strict=True))
    requests = [
        Request(authalic.disk_map, native, {"density": areas, **options}, from_last)
        for native, areas in pairs
    ]
    found: list[Any] = [request.known() for request in requests]
    initial = [request.initial() for request in requests]
    rest = [number for number, each in enumerate(found) if each is None]
    again = [number for number in rest if initial[number] is not None]
    new = [number for number in rest if initial[number] is None]
    share = len(again) / max(len(rest), 1)
    for place, number in enumerate(again):
        step = share_of(progress, share * place / len(again), share / len(again))
        found[number] = _map_from(natives[number], targets[number], initial[number], options, step)
    if new:
        maps = authalic.disk_maps(
            [natives[number] for number in new],
            densities=[targets[number] for number in new],
            progress=share_of(progress, share, 1.0 - share),
            **options,
        )
        for number, each in zip(new, maps, strict=True):
            found[number] = each
    for number in rest:
        if isinstance(found[number], authalic.DiskMap):
            found[number] = _evened(pairs[number], found[number], options, most_uneven, progress)
            requests[number].keep(found[number], began_with_last=initial[number] is not None)
    return found


def _evened(
    pair: tuple[authalic.Surface, Floats | None],
    disk_map: authalic.DiskMap,
    options: Mapping[str, Any],
    most_uneven: float,
    progress: Progress,
) -> authalic.DiskMap:
    """A map, or one with lighter weights of angles while areas deviate too much, as on long spikes."""
    native, areas = pair
    weight = options.get("angle_weight", 0.0)
    while disk_map.distortion.area_ratio_std > most_uneven and weight > _LIGHTEST:
        if disk_map.status == "cancelled":
            break
        weight /= _LIGHTER
        lighter = {**options, "angle_weight": weight}
        better = _map_from(native, areas, disk_map.uv, lighter, share_of(progress, 1.0, 0.0))
        if not isinstance(better, authalic.DiskMap):
            break
        disk_map = better
    return disk_map


def _map_from(
    native: authalic.Surface,
    areas: Floats | None,
    initial: Floats | None,
    options: Mapping[str, Any],
    progress: Progress,
) -> authalic.DiskMap | authalic.MeshError | authalic.SolverError:
    """The map of a surface that begins with another one, or what is wrong with the surface."""
    try:
        return authalic.disk_map(native, density=areas, initial=initial, progress=progress, **options)
    except (authalic.MeshError, authalic.SolverError) as problem:
        return problem
