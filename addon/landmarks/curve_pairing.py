# SPDX-License-Identifier: GPL-3.0-or-later
"""To which pair of landmark curves selected paths belong, and which way they run."""

from collections.abc import Collection

from ..blender.types import MeshObject
from ..surfaces.arrays import Path
from . import curve_selection, paths
from .curves import Curve, pairs
from .objects import NONE, SIDES, side_object


def place_for(source: MeshObject, selected: dict[str, Path]) -> tuple[int, dict[str, Path]]:
    """The index of the pair to which selected paths {side: path} belong, -1 for a new pair; and these paths.

    A single path completes the active pair if that lacks its side, or else the first pair that does. Of two
    paths, one that the active pair already has is ignored.
    """
    listed, active = pairs(source), source.authalic_landmark_curve_index
    if len(selected) == 2 and active < len(listed):
        new = {side: path for side, path in selected.items() if not _has(listed[active], side, path)}
        missing = [side for side in new if getattr(listed[active], side).problem]
        if len(new) == 1 and missing:
            return active, new
    if len(selected) != 1:
        return NONE, selected
    (side,) = selected
    lacking = [index for index, pair in enumerate(listed) if getattr(pair, side).problem]
    return (active if active in lacking else lacking[0] if lacking else NONE), selected


def directed(
    source: MeshObject, index: int, selected: dict[str, Path], loose: Collection[str]
) -> dict[str, Path]:
    """Selected paths {side: path}; on the sides `loose` they are turned to run as their partners do."""
    partners: dict[str, Path] = dict.fromkeys(SIDES, ())
    if index != NONE:
        pair = pairs(source)[index]
        partners = {side: getattr(pair, side).vertices for side in SIDES}
    partners |= selected
    for side, partner in (SIDES, SIDES[::-1]):
        if side in loose and partners[partner]:
            objects = side_object(source, side), side_object(source, partner)
            partners[side] = curve_selection.like(objects[0], partners[side], objects[1], partners[partner])
    return {side: partners[side] for side in selected}


def _has(pair: Curve, side: str, path: Path) -> bool:
    """Whether a path is that of a pair, in either direction."""
    return set(paths.edges(path)) <= {way for edge in getattr(pair, side).edges for way in (edge, edge[::-1])}
