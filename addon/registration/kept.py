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

_KEPT = 8


def fingerprint(source: Side, target: Side, pairs: Sequence[PointPair] | Sequence[CurvePair]) -> bytes:
    """A hash of everything but the settings that a registration depends on: both sides and the landmarks.

    Pairs are (name, vertex, vertex), or (name, vertices, vertices) of curves.
    """
    digest = hashlib.blake2b(digest_size=16)
    for side in (source, target):
        digest.update(side.name.encode())
        arrays: tuple[NDArray[Any], ...] = side.points, side.faces, side.vertices, side.corners
        for array in arrays:
            digest.update(np.array(array.shape, np.int64).tobytes() + np.ascontiguousarray(array).tobytes())
    listed = [(name, np.array(first).tolist(), np.array(second).tolist()) for name, first, second in pairs]
    digest.update(repr(listed).encode())
    return digest.digest()


class Kept:
    """The last few registrations of the session."""

    def __init__(self) -> None:
        self._found: OrderedDict[tuple[bytes, tuple[Any, ...], bytes], Registered] = OrderedDict()

    def get(self, key_: bytes, settings: Settings, pulls: bytes) -> Registered | None:
        """The registration of these meshes with these settings, if it ran to its end, or None.

        The hash `pulls` is that of what pulled it beside the landmarks.
        """
        registered = self._found.get((key_, astuple(settings), pulls))
        return registered if registered is not None and not registered.ended_early else None

    def latest(self, keys: Sequence[tuple[bytes, str]]) -> Registered | None:
        """The latest registration with one of these keys and methods, or None."""
        for (key_, used, _), registered in reversed(self._found.items()):
            if (key_, Settings(*used).method) in keys:
                return registered
        return None

    def put(self, key_: bytes, settings: Settings, pulls: bytes, registered: Registered) -> None:
        self._found.pop((key_, astuple(settings), pulls), None)
        self._found[key_, astuple(settings), pulls] = registered
        while len(self._found) > _KEPT:
            self._found.popitem(last=False)

    def touch(self, key_: bytes, settings: Settings, pulls: bytes) -> None:
        """Makes a registration the latest."""
        self._found.move_to_end((key_, astuple(settings), pulls))
