# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmark curves of two surfaces that are to be registered, and the figures. Plain numpy, no bpy."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import messages
from ..surfaces.arrays import Integers
from ..surfaces.suitability import Unsuitable
from .problems import remarks
from .registered import Registered, strain
from .sides import CurvePair, Side


def check_curves(
    sides: tuple[Side, Side], curves: Sequence[CurvePair], boundaries: Sequence[Sequence[Integers]]
) -> list[list[Integers]]:
    """The curves of source and target as lists of paths of points of the sides.

    `curves` are (name, source vertices, target vertices), `boundaries` the boundary loops of either side.
    Raises `Unsuitable` with the names of the curves that cannot be.
    """
    if not curves and not any(boundaries):
        raise Unsuitable(
            f"{sides[0].name} needs a landmark curve; select edges that belong together on both and add them"
        )
    lines, left = [], []
    for number, (side, loops) in enumerate(zip(sides, boundaries, strict=True), 1):
        side_lines = [_points(side, curve[0], curve[number]) for curve in curves]
        _check_edges(side, curves, side_lines)
        left.append(_without_curves(side, curves, side_lines, loops))
        lines.append(side_lines)
    if left[0] != left[1]:
        counts = [messages.count(number, "open boundary") for number in left]
        raise Unsuitable(
            f"{sides[0].name} has {counts[0]} and {sides[1].name} {counts[1]}, without those that are "
            "curves; both must have as many: fill holes, or delete faces"
        )
    return lines


def registered_by_curves(native: Any, sides: tuple[Side, Side], curves: Sequence[CurvePair]) -> Registered:
    """The figures of a registration by curves (`authalic.Registration`) of two sides."""
    names = [name for name, _, _ in curves]
    return Registered(
        native=native,
        source=sides[0],
        target=sides[1],
        domain="CURVES",
        places=np.asarray(native.registered),
        target_places=np.asarray(native.target_registered),
        names=names,
        errors=np.asarray(native.landmark_error, float),
        missed=[names[curve] for curve in native.missed],
        energy=float("nan"),
        folds=len(native.certificates.folded),
        status=native.status,
        seconds=float(native.seconds),
        strain=strain(native, names),
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


def _without_curves(
    side: Side, curves: Sequence[CurvePair], lines: Sequence[Integers], loops: Sequence[Integers]
) -> int:
    """The number of boundary loops that are no curves. Raises `Unsuitable` if a curve has a part of one."""
    left = len(loops)
    for (name, *_), path in zip(curves, lines, strict=True):
        for loop in loops:
            shared = np.intersect1d(path, loop)
            if path[0] == path[-1] and len(shared) == len(loop) == len(path) - 1:
                left -= 1
            elif len(shared):
                noun = "vertex" if len(shared) == 1 else "vertices"
                raise Unsuitable(
                    f'Curve "{name}" meets the boundary of {side.name} at {noun} '
                    f"{messages.numbers(side.vertices[shared])}; end it inside, or make it a closed curve "
                    "along the whole boundary"
                )
    return left
