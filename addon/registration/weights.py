# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights and other values that were carried smoothly: within their bounds, and with their sums. No bpy."""

from collections.abc import Sequence

import numpy as np

from ..surfaces.arrays import Floats, Reals


def within(values: Floats, of: Reals) -> Floats:
    """Values (n, d) within the range of each column (k, d) of the data that they were carried from."""
    return np.clip(values, of.min(axis=0), of.max(axis=0))


def with_sums(weights: Sequence[Floats], sums: Floats) -> list[Floats]:
    """Weights (n, 1) of several groups, scaled at each vertex so that they add up to given sums (n, 1)."""
    total = np.sum(weights, axis=0)
    scale = np.divide(sums, total, out=np.ones_like(total), where=total > 0)
    return [scale * weight for weight in weights]
