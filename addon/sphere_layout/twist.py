# SPDX-License-Identifier: GPL-3.0-or-later
"""Movements of the sphere onto itself that keep every area. Plain numpy, no bpy."""

import numpy as np

# How far about the moved point's circle the sphere turns rigidly, as a part of the way to where it rests.
_RIGID = 0.15
_WIDEST = np.radians(120)
_DISTANCES = np.radians([5, 10, 15, 20, 30, 40, 55, 70, 85])


def twist(points, start, goal, fixed):
    """Points (n, 3) of the unit sphere after a twist that takes `start` to `goal`; None if there is no room.

    Each circle about a centre turns rigidly, so that areas are kept: by one angle as far out as `start` and
    `goal` lie, by less farther out, by nothing where the points `fixed` (k, 3) are.
    """
    if np.allclose(start, goal, rtol=0, atol=1e-15):
        return points.copy()
    found = [_twist_about(centre, start, goal, fixed) for centre in _centres(start, goal)]
    found = [twist for twist in found if twist is not None]
    if not found:
        return None
    _, centre, angle, near, far = min(found, key=lambda twist: twist[0])
    distance = _angle(points, centre)
    share = (_log_tan(np.maximum(distance, 1e-9)) - _log_tan(near)) / (_log_tan(far) - _log_tan(near))
    share = np.clip(share, 0, 1)
    return _rotated(points, centre, angle * (1 - share * share * (3 - 2 * share)))


def rotation(start, goal):
    """The rotation (3, 3) by the smallest angle that takes one point of the unit sphere to another."""
    axis, cosine = np.cross(start, goal), start @ goal
    if cosine < -1 + 1e-12:  # any half turn about a perpendicular axis
        axis = np.cross(start, np.eye(3)[np.abs(start).argmin()])
        axis /= np.linalg.norm(axis)
        return 2 * np.outer(axis, axis) - np.eye(3)
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + cross + cross @ cross / (1 + cosine)


def _centres(start, goal):
    """Centres (3,) equally far from both points, on either side of them."""
    middle, across = start + goal, np.cross(start, goal)
    if np.linalg.norm(middle) < 1e-9 or np.linalg.norm(across) == 0:
        return
    middle, across = middle / np.linalg.norm(middle), across / np.linalg.norm(across)
    for distance in _DISTANCES:
        for side in (-1, 1):
            yield np.cos(distance) * middle + side * np.sin(distance) * across


def _twist_about(centre, start, goal, fixed):
    """(largest shear, centre, angle, where it begins to slow down, where it has ended), or None."""
    radius = _angle(start[None], centre)[0]
    far = min(_angle(fixed, centre).min(initial=np.inf) * 0.999, _WIDEST)
    near = radius + _RIGID * (far - radius)
    if far <= 1.1 * radius:
        return None
    a, b = (point - (point @ centre) * centre for point in (start, goal))
    angle = np.arctan2(np.cross(a, b) @ centre, a @ b)
    shear = 1.5 * abs(angle) / (_log_tan(far) - _log_tan(near))
    return shear, centre, angle, near, far


def _log_tan(distance):
    """The coordinate in which a uniform slowing down shears uniformly."""
    return np.log(np.tan(distance / 2))


def _angle(points, centre):
    return np.arctan2(np.linalg.norm(np.cross(points, centre), axis=1), points @ centre)


def _rotated(points, axis, angles):
    """Points (n, 3), each turned about one axis by its own angle (n,)."""
    cosine, sine = np.cos(angles)[:, None], np.sin(angles)[:, None]
    along = (points @ axis)[:, None] * axis
    turned = along + cosine * (points - along) + sine * np.cross(axis, points)
    return turned / np.linalg.norm(turned, axis=1, keepdims=True)
