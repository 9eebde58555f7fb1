# SPDX-License-Identifier: GPL-3.0-or-later
"""To which pair of landmark curves selected paths belong, and which way they run."""

from collections.abc import Collection

from ..blender.types import MeshObject
from ..surfaces.arrays import Path
from . import curve_selection, paths
from .curves import Curve, pairs
from .objects import NONE, SIDES, side_object


def place_for(source: MeshObject, selected: dict[str, Path]) -> tuple[int, dict[str, Path]]:
    """The index of the pair to which selected paths {side: path} belong, -1 for a new one; and these paths.

    Alone, a path completes the active pair if that lacks its side, or else the first one that does. Of two,
    one that the active pair has already is not meant.
    """
    listed, active = pairs(source), source.authalic_landmark_curve_index
    if len(selected) == 2 and active < len(listed):
        others = {side: path for side, path in selected.items() if not _has(listed[active], side, path)}
        missing = [side for side in others if getattr(listed[active], side).problem]
        if len(others) == 1 and missing:
            return active, others
    if len(selected) != 1:
        return NONE, selected
    (side,) = selected
    lacking = [index for index, pair in enumerate(listed) if getattr(pair, side).problem]
    return (active if active in lacking else lacking[0] if lacking else NONE), selected


def directed(
    source: MeshObject, index: int, selected: dict[str, Path], loose: Collection[str]
) -> dict[str, Path]:
    """Selected paths {side: path}, those of the sides `loose` turned to run as their partners do."""
    partners: dict[str, Path] = dict.fromkeys(SIDES, ())
    if index != NONE:
        pair = pairs(source)[index]
        partners = {side: getattr(pair, side).vertices for side in SIDES}
    partners |= selected
    for side, other in (SIDES, SIDES[::-1]):
        if side in loose and partners[other]:
            objects = side_object(source, side), side_object(source, other)
            partners[side] = curve_selection.like(objects[0], partners[side], objects[1], partners[other])
    return {side: partners[side] for side in selected}


def _has(pair: Curve, side: str, path: Path) -> bool:
    """Whether a path is that of a pair, in either direction."""
    return set(paths.edges(path)) <= {way for edge in getattr(pair, side).edges for way in (edge, edge[::-1])}
