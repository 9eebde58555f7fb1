# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmark curves that looked reversed in the last registration of an object, and are as they were."""

from collections.abc import Sequence

from ..blender.types import MeshObject
from ..landmarks import curves as landmark_curves
from ..landmarks import paths
from ..landmarks.objects import CannotPair
from ..registration.sides import CurvePair
from ..surfaces.arrays import Path

# The paths on source and target, by the name of the source.
_reversed: dict[str, set[tuple[Path, Path]]] = {}


def remember(name: str, curves: Sequence[CurvePair]) -> None:
    """Remembers the open ones of the curves that look reversed, if any, for the source of a name."""
    _reversed[name] = {
        (source_path, target_path)
        for _, source_path, target_path in curves
        if not paths.is_closed(source_path)
    }


def of(source: MeshObject) -> list[int]:
    """The curves of a source, by their numbers in the list, that looked reversed and are as they were."""
    looked = _reversed.get(source.name)
    if not looked:
        return []
    pairs = landmark_curves.pairs(source, drawing=True)
    return [
        number for number, pair in enumerate(pairs) if (pair.source.vertices, pair.target.vertices) in looked
    ]


def reverse(source: MeshObject) -> list[int]:
    """Reverses the target's path of these curves, all or none, and returns their numbers.

    Raises `CannotPair` and then changes nothing.
    """
    done: list[int] = []
    numbers = of(source)
    try:
        for number in numbers:
            landmark_curves.reverse(source, number, "target")
            done.append(number)
    except CannotPair:
        for number in done:
            landmark_curves.reverse(source, number, "target")
        raise
    return numbers
