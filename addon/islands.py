# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands as shapes in the plane: texel density, outlines, and moving them. Plain numpy, no bpy."""

import numpy as np

_DIRECTIONS = 32


def scale_to_one_density(islands):
    """Scales islands so that the UV area of each is its share of the whole surface's area."""
    total = sum(island.area for island in islands)
    for island in islands:
        island.uv *= np.sqrt(island.area / total / island.uv_area)
        island.uv_area = island.area / total


def outline(uv):
    """A convex polygon (k, 2), counter-clockwise, around points (n, 2): what the packer has to keep apart.

    It is bounded by the supporting lines in 32 directions, so that around a disk it is .5 % too wide.
    """
    angles = np.arange(_DIRECTIONS) * (2 * np.pi / _DIRECTIONS)
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    reach = np.array([(uv @ normal).max() for normal in normals])
    # Where the lines of two neighbouring directions meet.
    along = (np.roll(reach, -1) - reach * np.cos(angles[1])) / np.sin(angles[1])
    tangents = np.stack([-normals[:, 1], normals[:, 0]], axis=1)
    return _without_repeats(reach[:, None] * normals + along[:, None] * tangents)


def upright(outline):
    """The turn, a complex number of modulus 1, that gives an outline (k, 2) its smallest bounding box."""
    z = outline @ [1, 1j]
    sides = np.roll(z, -1) - z
    turns = np.concatenate([[1], np.abs(sides) / sides])
    turned = turns[:, None] * z
    boxes = np.ptp(turned.real, axis=1) * np.ptp(turned.imag, axis=1)
    # Only for a real gain: a round island stays as it is.
    best = boxes.argmin()
    return turns[best] if boxes[best] < 0.97 * boxes[0] else 1


def similarity(before, after):
    """The factor and the offset, as complex numbers, that carry points (k, 2) closest to others (k, 2)."""
    z, w = before @ [1, 1j], after @ [1, 1j]
    centre, target = z.mean(), w.mean()
    factor = np.vdot(z - centre, w - target) / np.vdot(z - centre, z - centre)
    return factor, target - factor * centre


def moved(uv, factor, offset):
    """Points (n, 2), turned, scaled and shifted by a similarity."""
    w = factor * (uv @ [1, 1j]) + offset
    return np.stack([w.real, w.imag], axis=1)


def _without_repeats(polygon):
    gaps = np.linalg.norm(polygon - np.roll(polygon, 1, axis=0), axis=1)
    return polygon[gaps > 1e-6 * np.ptp(polygon, axis=0).max()]
