# SPDX-License-Identifier: GPL-3.0-or-later
"""The registrations of the session that later commands may use. Plain numpy, no bpy."""

import hashlib
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import astuple
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .registered import Registered
from .settings import Settings
from .sides import CurvePair, PointPair, Side

_KEPT = 4


def fingerprint(source: Side, target: Side, pairs: Sequence[PointPair] | Sequence[CurvePair]) -> bytes:
    """A hash of all that a registration depends on but its settings: both sides and the landmarks.

    Pairs are (name, vertex, vertex), or (name, vertices, vertices) of curves.
    """
    digest = hashlib.blake2b(digest_size=16)
    for one in (source, target):
        digest.update(one.name.encode())
        arrays: tuple[NDArray[Any], ...] = one.points, one.faces, one.vertices, one.corners
        for array in arrays:
            digest.update(np.array(array.shape, np.int64).tobytes() + np.ascontiguousarray(array).tobytes())
    listed = [(name, np.array(first).tolist(), np.array(second).tolist()) for name, first, second in pairs]
    digest.update(repr(listed).encode())
    return digest.digest()


class Kept:
    """The last few registrations, for what is done with them after."""

    def __init__(self) -> None:
        self._found: OrderedDict[tuple[bytes, tuple[Any, ...]], Registered] = OrderedDict()

    def get(self, key_: bytes, settings: Settings) -> Registered | None:
        """One of these meshes and settings that ran to its end, or None."""
        found = self._found.get((key_, astuple(settings)))
        return found if found is not None and not found.ended_early else None

    def latest(self, keys: Sequence[tuple[bytes, str]]) -> Registered | None:
        """The latest of some (key, method), or None."""
        listed = reversed(self._found.items())
        return next((found for (own, used), found in listed if (own, Settings(*used).method) in keys), None)

    def put(self, key_: bytes, settings: Settings, registered: Registered) -> None:
        self._found.pop((key_, astuple(settings)), None)
        self._found[key_, astuple(settings)] = registered
        while len(self._found) > _KEPT:
            self._found.popitem(last=False)

    def touch(self, key_: bytes, settings: Settings) -> None:
        """Makes one that was found the latest."""
        self._found.move_to_end((key_, astuple(settings)))
