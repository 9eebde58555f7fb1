# SPDX-License-Identifier: GPL-3.0-or-later
"""What pulls a registration beside exact landmarks. Plain numpy, no bpy."""

import hashlib
from dataclasses import dataclass, field

import numpy as np

from ..surfaces.arrays import Floats
from .settings import Settings


@dataclass
class Pulls:
    """The `weights` of the landmarks, infinite for exact ones, and named signals at the points of both sides.

    The two arrays of a signal are (u,) and (u_t,).
    """

    weights: list[float] = field(default_factory=list)
    features: dict[str, tuple[Floats, Floats]] = field(default_factory=dict)

    @property
    def is_soft(self) -> bool:
        """Whether there is a landmark that is not exact."""
        return not np.isinf(self.weights).all()

    def fingerprint(self, settings: Settings) -> bytes:
        """A hash of what counts with these settings."""
        if not settings.is_pulled:
            return b""
        digest = hashlib.blake2b(digest_size=16)
        if settings.method == "POINTS":
            digest.update(repr(self.weights if self.is_soft else []).encode())
        for signal in self.features[settings.feature] if settings.feature else ():
            digest.update(np.ascontiguousarray(signal, float).tobytes())
        return digest.digest()
