# SPDX-License-Identifier: GPL-3.0-or-later
"""Source and target change places: the target keeps the pairs then, and the source is its target."""

from .. import messages
from ..blender.types import MeshObject
from . import curves as landmark_curves
from . import points as landmark_points
from .curves import Curve
from .objects import CannotPair, check_lists, check_target
from .points import Pair


def swap(source: MeshObject) -> MeshObject:
    """Makes the target of an object the source, with all pairs the other way around; returns it.

    Raises `CannotPair` and then changes nothing.
    """
    check_target(source)
    target = source.authalic_target
    check_lists(target)
    _check_free(source, target)
    points, curves = landmark_points.pairs(source), landmark_curves.pairs(source)
    _check_sound([*points, *curves])
    weights = [(landmark.is_soft, landmark.weight) for landmark in source.authalic_landmarks]
    landmark_points.clear(source)
    landmark_curves.clear(source)
    source.authalic_target = None
    target.authalic_target = source
    landmark_points.replace(target, [(pair.name, pair.target_vertex, pair.source_vertex) for pair in points])
    for landmark, given in zip(target.authalic_landmarks, weights, strict=True):
        landmark.is_soft, landmark.weight = given
    reversed_curves = [(curve.name, curve.target.vertices, curve.source.vertices) for curve in curves]
    landmark_curves.replace(target, reversed_curves)
    return target


def _check_free(source: MeshObject, target: MeshObject) -> None:
    """Raises `CannotPair` if the target has pairs of its own, which the swap would replace."""
    own = [*target.authalic_landmarks, *target.authalic_landmark_curves]
    if own or target.authalic_target not in (None, source):
        what = messages.count(len(own), "landmark") + " of its own" if own else "a target of its own"
        raise CannotPair(
            f"{target.name} has {what}; clear that first, or make {target.name} the active object"
        )


def _check_sound(pairs: list[Pair | Curve]) -> None:
    bad = [f"{pair.name}: {pair.problem}" for pair in pairs if pair.problem is not None]
    if bad:
        raise CannotPair(f"{messages.listed(bad)}; mend or remove what cannot be used first")
