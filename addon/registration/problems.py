# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors and warnings of a registration in words, with the names of objects and landmarks. No bpy."""

from collections.abc import Sequence

from ..landmarks import paths
from ..messages import problems
from ..messages.problems import FLIP, Problem
from .sides import CurvePair, PointPair, Side, is_open

OUTLINE = "the outline"
"""The name of the curve after all others, where the outlines of both sides are one."""
_SIDES = ("source", "target")


def in_words(
    error: Problem, sides: tuple[Side, Side], pairs: Sequence[PointPair] | Sequence[CurvePair]
) -> str:
    """The sentence for an error of a registration of two sides by pairs (name, source, target)."""
    names = [*(name for name, _, _ in pairs), OUTLINE]
    if error.kind == "mirrored" and _any_open(sides):
        return (
            f"the curves fit far better when one surface is mirrored: {FLIP}, or mirror one "
            "(Object > Mirror), or check the order of the curves"
        )
    if error.side is None:
        return problems.in_words(error, names=names)
    side = sides[_SIDES.index(error.side)]
    return f"{side.name}: {problems.in_words(error, side.polygons, side.vertices, names)}"


def remarks(warnings: Sequence[Problem], sides: tuple[Side, Side], curves: Sequence[CurvePair]) -> list[str]:
    """The sentences for the warnings of a registration by curves, the cause of most of them first."""
    names = [name for name, _, _ in curves]
    sentences = [problems.in_words(warning, names=names) for warning in warnings]
    kinds = [warning.kind for warning in warnings]
    backward = kinds.count("backward_curve")
    opened = sum(not paths.is_closed(source) for _, source, _ in curves)
    are_most = backward > 1 and 2 * backward > opened
    if are_most and "opposite_normals" not in kinds and _any_open(sides):
        most = f"most curves run backwards; if the normals of the two face opposite ways, {FLIP}"
        return [most, *sentences]
    return sentences


def _any_open(sides: tuple[Side, Side]) -> bool:
    return any(is_open(side) for side in sides)
