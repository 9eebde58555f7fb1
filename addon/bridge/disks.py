# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of many islands into the plane, all in one call of the native library."""

from collections.abc import Sequence

import authalic

from .patches import SurfacePatch, checked
from .progress import NOT_REACHED, Progress, Result, noting_the_end, refused
from .results import Refusal
from .settings import UnwrapSettings


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
    if not natives:
        return [None] * len(pieces)
    options = settings.solver.disk_options()
    listen = noting_the_end(progress, result)
    found = authalic.disk_maps(
        list(natives.values()), fill_holes=settings.fill_holes, progress=listen, **options
    )
    maps: list[authalic.DiskMap | None] = [None] * len(pieces)
    for number, each in zip(natives, found, strict=True):
        piece = pieces[number]
        with refused(piece, result):
            if each is None:
                result.refusals.append(Refusal(piece.name, piece.polygon, NOT_REACHED))
            elif isinstance(each, authalic.DiskMap):
                maps[number] = each
            else:
                raise each
    return maps
