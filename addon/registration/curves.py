# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmark curves of two surfaces that are to be registered, and the figures. Plain numpy, no bpy."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import messages
from ..surfaces.arrays import Integers
from ..surfaces.suitability import Unsuitable
from .domain import is_outline, length
from .problems import OUTLINE, remarks
from .registered import Registered, strain
from .sides import CurvePair, Side

_NEEDS = "{} needs a landmark curve; select edges that belong together on both and add them"


@dataclass
class Paths:
    """The curves of `source` and `target` as points of the sides, and how many `holes` of each are filled.

    Where holes are filled, the outlines of both sides may be the last curve.
    """

    source: list[Integers]
    target: list[Integers]
    holes: list[int]


def check_curves(
    sides: tuple[Side, Side], curves: Sequence[CurvePair], boundaries: Sequence[Sequence[Integers]]
) -> Paths:
    """The curves of source and target as paths of points of the sides.

    `curves` are (name, source vertices, target vertices), `boundaries` the boundary loops of either side.
    Boundaries that are no curves pair up by themselves where both sides have as many. Else they are filled,
    but for the outlines of both. Raises `Unsuitable` with the names of the curves that cannot be.
    """
    lines: list[list[Integers]] = []
    for number, side in enumerate(sides, 1):
        lines.append([_points(side, curve[0], curve[number]) for curve in curves])
        _check_edges(side, curves, lines[-1])
    along = [
        [_loop_along(path, loops) for path in paths] for paths, loops in zip(lines, boundaries, strict=True)
    ]
    matched = [both for both in zip(*along, strict=True) if None not in both]
    left = [len(loops) - len(matched) for loops in boundaries]
    unmatched = [path for paths in along for path in paths if path is not None]
    if left[0] == left[1] and len(unmatched) == 2 * len(matched):
        if not curves and not any(boundaries):
            raise Unsuitable(_NEEDS.format(sides[0].name))
        for side, paths, loops, of_paths in zip(sides, lines, boundaries, along, strict=True):
            _refuse_meetings(side, curves, paths, loops, of_paths)
        return Paths(lines[0], lines[1], [0, 0])
    outlines = _outlines(sides, boundaries, matched)
    if outlines is not None:
        lines = [[*paths, outline] for paths, outline in zip(lines, outlines, strict=True)]
        left = [count - 1 for count in left]
    if not lines[0]:
        raise Unsuitable(_NEEDS.format(sides[0].name))
    return Paths(lines[0], lines[1], left)


def registered_by_curves(native: Any, sides: tuple[Side, Side], curves: Sequence[CurvePair]) -> Registered:
    """The figures of a registration by curves (`authalic.Registration`) of two sides."""
    names = [name for name, _, _ in curves]
    named = [*names, OUTLINE]
    return Registered(
        native=native,
        source=sides[0],
        target=sides[1],
        domain="CURVES",
        places=np.asarray(native.registered),
        target_places=np.asarray(native.target_registered),
        names=names,
        errors=np.asarray(native.landmark_error, float)[: len(names)],
        missed=[named[curve] for curve in native.missed],
        energy=float("nan"),
        folds=len(native.certificates.folded),
        status=native.status,
        seconds=float(native.seconds),
        strain=strain(native, named),
        remarks=remarks(native.warnings, sides, curves),
        backward=[each.curve for each in native.warnings if each.kind == "backward_curve"],
    )


def _points(side: Side, name: str, vertices: ArrayLike) -> Integers:
    """A path as points of a side."""
    vertices = np.asarray(vertices)
    if not len(vertices) or vertices.min() < 0 or vertices.max() >= side.count:
        raise Unsuitable(f'Curve "{name}" is not on vertices of {side.name}; add it again')
    points = side.points_of(vertices)
    if np.isin(vertices, side.rest.vertices).any():
        raise Unsuitable(f'Curve "{name}" {side.rest.why_not(side.name)}')
    if (points < 0).any():
        loose = messages.numbers(vertices[points < 0])
        raise Unsuitable(f'Curve "{name}" is on loose vertices of {side.name} ({loose}); add one with faces')
    return points


def _check_edges(side: Side, curves: Sequence[CurvePair], lines: Sequence[Integers]) -> None:
    """Raises `Unsuitable` where an edge of a curve has no face."""
    ends = np.sort(side.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1).astype(np.int64)
    existing = np.unique(ends[:, 0] * len(side.points) + ends[:, 1])
    for (name, *_), path in zip(curves, lines, strict=True):
        pairs = np.sort(np.column_stack([path[:-1], path[1:]]), axis=1).astype(np.int64)
        bad = np.flatnonzero(~np.isin(pairs[:, 0] * len(side.points) + pairs[:, 1], existing))
        if len(bad):
            first, second = side.vertices[path[bad[0] : bad[0] + 2]].tolist()
            raise Unsuitable(
                f'Curve "{name}" has the edge ({first}, {second}) of {side.name}, which has no face'
            )


def _loop_along(path: Integers, loops: Sequence[Integers]) -> int | None:
    """The number of the boundary loop that a closed path runs along."""
    if path[0] != path[-1]:
        return None
    is_along = (len(np.intersect1d(path, loop)) == len(loop) == len(path) - 1 for loop in loops)
    return next((number for number, it_is in enumerate(is_along) if it_is), None)


def _outlines(
    sides: tuple[Side, Side],
    boundaries: Sequence[Sequence[Integers]],
    matched: Sequence[tuple[int | None, ...]],
) -> list[Integers] | None:
    """The longest boundaries of both sides as closed paths, where they go around both and are no curves."""
    longest = []
    for number, (side, loops) in enumerate(zip(sides, boundaries, strict=True)):
        lengths = [length(side, loop) for loop in loops]
        first = int(np.argmax(lengths)) if lengths else None
        if first is None or not is_outline(side, loops[first]) or first in [both[number] for both in matched]:
            return None
        longest.append(np.append(loops[first], loops[first][0]))
    return longest


def _refuse_meetings(
    side: Side,
    curves: Sequence[CurvePair],
    paths: Sequence[Integers],
    loops: Sequence[Integers],
    along: Sequence[int | None],
) -> None:
    """Raises `Unsuitable` if a curve has a part of a boundary loop."""
    border = np.concatenate([np.empty(0, int), *loops])
    for (name, *_), path, loop in zip(curves, paths, along, strict=True):
        shared = np.intersect1d(path, border)
        if len(shared) and loop is None:
            noun = "vertex" if len(shared) == 1 else "vertices"
            raise Unsuitable(
                f'Curve "{name}" meets the boundary of {side.name} at {noun} '
                f"{messages.numbers(side.vertices[shared])}; end it inside, or make it a closed curve "
                "along the whole boundary"
            )
