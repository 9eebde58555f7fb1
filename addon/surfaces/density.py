# SPDX-License-Identifier: GPL-3.0-or-later
"""Densities that painted weights ask for. Plain numpy, no bpy."""

import numpy as np

from .arrays import Floats, Reals
from .surface import Surface

# A polygon of the weight 1 gets this much more UV area than one of the weight 0.
_GAIN = 7.0
# The luminance of linear red, green and blue (ITU-R BT.709).
_LUMINANCE = (0.2126, 0.7152, 0.0722)


def luminance(colors: Reals) -> Floats:
    """The luminance (n,) of linear colors (n, 3) or (n, 4)."""
    values: Floats = colors[:, :3].astype(float) @ np.array(_LUMINANCE)
    return values


def of_polygons(surface: Surface, weights: Reals) -> Floats:
    """The density (p,) of each polygon: 1 + 7 w, w the mean of the weights (c,) of its corners."""
    owner = np.repeat(np.arange(surface.polygon_count), surface.polygon_size)
    clipped = np.clip(np.nan_to_num(weights.astype(float)), 0, 1)
    means = np.bincount(owner, clipped, surface.polygon_count) / surface.polygon_size
    densities: Floats = 1 + _GAIN * means
    return densities
