# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks of one half of both objects for the other half, which lies mirrored over X."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import bpy
import numpy as np

from ..blender import vertex_positions
from ..blender.types import MeshObject
from . import points as landmark_points
from .objects import CannotPair, check_target

_OVER_X = np.array([-1.0, 1.0, 1.0])
_ON_PLANE = 0.1  # times the tolerance


@dataclass
class Mirrored:
    """Names of pairs: those added, and those not mirrored, because they lie on the mirror plane, have a
    mirrored pair already, or find no free vertex near the mirrored place.
    """

    added: list[str] = field(default_factory=list)
    on_plane: list[str] = field(default_factory=list)
    there: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)


class _Half:
    """One of the two objects, which is symmetric in its own space, with the vertices of landmarks on it."""

    def __init__(self, obj: MeshObject, vertices: Sequence[int], tolerance: float) -> None:
        self._points, used = vertex_positions.undeformed_surface(obj)
        self._candidates = np.flatnonzero(used) if used.any() else np.arange(len(self._points))
        size = np.linalg.norm(np.ptp(self._points[self._candidates], axis=0))
        self.vertices, self._reach = list(vertices), tolerance * float(size)
        self.partners = [self._partner(vertex) for vertex in vertices]

    def is_on_plane(self, number: int) -> bool:
        """Whether a landmark lies on the mirror plane."""
        vertex = self.vertices[number]
        is_near = abs(self._points[vertex, 0]) <= _ON_PLANE * self._reach
        return bool(is_near or self.partners[number] == vertex)

    def counterpart(self, number: int) -> int | None:
        """The landmark that lies mirrored to one, or None; each is then nearest to the other's place."""
        places = self._points[self.vertices]
        away = np.linalg.norm(places[:, None] - _OVER_X * places, axis=2)  # of each from all mirrored places
        nearest = int(away[:, number].argmin())
        is_mutual = away[:, nearest].argmin() == number and nearest != number
        return nearest if is_mutual and away[nearest, number] <= self._reach else None

    def _partner(self, vertex: int) -> int | None:
        """The vertex nearest to the mirrored place of another, or None if that is too far."""
        away = np.linalg.norm(self._points[self._candidates] - _OVER_X * self._points[vertex], axis=1)
        nearest = int(away.argmin())
        return int(self._candidates[nearest]) if away[nearest] <= self._reach else None


def mirror(source: MeshObject, tolerance: float) -> Mirrored:
    """Adds the mirrored pair of each pair off the mirror plane, with left and right swapped in its name.

    The tolerance is a part of the size of each object. Raises `CannotPair` and then changes nothing.
    """
    check_target(source)
    listed = zip(source.authalic_landmarks, landmark_points.pairs(source), strict=True)
    sound = [((landmark.is_soft, landmark.weight), pair) for landmark, pair in listed if pair.problem is None]
    weights, pairs = [weight for weight, _ in sound], [pair for _, pair in sound]
    halves = (
        _Half(source, [pair.source_vertex for pair in pairs], tolerance),
        _Half(source.authalic_target, [pair.target_vertex for pair in pairs], tolerance),
    )
    names = {pair.name for pair in pairs}
    result = Mirrored()
    for number, pair in enumerate(pairs):
        flipped = bpy.utils.flip_name(pair.name)
        is_sided = flipped != pair.name
        if any(half.is_on_plane(number) for half in halves):
            result.on_plane.append(pair.name)
        elif (is_sided and flipped in names) or any(half.counterpart(number) is not None for half in halves):
            result.there.append(pair.name)
        else:
            partners = [half.partners[number] for half in halves]
            added = _add(source, partners, flipped if is_sided else "", weights[number])
            (result.added if added else result.missing).append(added or pair.name)
    return result


def _add(
    source: MeshObject, vertices: Sequence[int | None], name: str, weight: tuple[bool, float]
) -> str | None:
    """Adds a pair, soft or not and with a weight, and returns its name.

    None where a vertex is missing or has a landmark already.
    """
    source_vertex, target_vertex = vertices
    if source_vertex is None or target_vertex is None:
        return None
    try:
        added = landmark_points.add(source, source_vertex, target_vertex, name)
    except CannotPair:  # one of the two vertices is in a pair
        return None
    added.is_soft, added.weight = weight
    return added.name
