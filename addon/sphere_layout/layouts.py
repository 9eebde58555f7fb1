# SPDX-License-Identifier: GPL-3.0-or-later
"""Equal-area layouts of the unit sphere in the plane. Plain numpy, no bpy.

Both layouts are flat but for a few singular points: the images of a point of the sphere differ by movements
of the plane, translations by a turn for Lambert's cylinder, translations and half turns for the octahedral
square.
"""

from dataclasses import dataclass

import numpy as np

_TURN = 2 * np.pi
# A corner this little (radians) left of the seam still counts as on it.
_ON_SEAM = 1e-5
_ON_POLE = 1e-9


@dataclass
class Movements:
    """Movements x -> signs * x + shifts of the plane: `signs` (...) of 1 or -1, `shifts` (..., 2)."""

    signs: np.ndarray
    shifts: np.ndarray

    def __getitem__(self, index):
        return Movements(self.signs[index], self.shifts[index])

    def __setitem__(self, index, other):
        self.signs[index], self.shifts[index] = other.signs, other.shifts

    def after(self, first):
        """These movements after `first`."""
        return Movements(self.signs * first.signs, self.signs[..., None] * first.shifts + self.shifts)

    def inverse(self):
        return Movements(self.signs, -self.signs[..., None] * self.shifts)

    def of(self, places):
        return self.signs[..., None] * places + self.shifts

    def agree(self, other):
        near = np.abs(self.shifts - other.shifts).max(axis=-1) < 1e-6
        return near & (self.signs == other.signs)

    @staticmethod
    def none(shape):
        return Movements(np.ones(shape), np.zeros((*shape, 2)))


class Lambert:
    """Lambert's cylindrical projection: longitude in [0, 2 pi) and height, seam at longitude 0."""

    singular = np.array([[0.0, 0, 1], [0, 0, -1]])
    scale = 1.0  # areas in the plane as parts of those on the sphere
    cones = False

    @staticmethod
    def places(points):
        longitude = np.arctan2(points[:, 1], points[:, 0]) % _TURN
        longitude[longitude >= _TURN] = 0  # what -1e-17 comes to
        return np.column_stack([longitude, points[:, 2]])

    @staticmethod
    def crossings(start, end):
        """Where great arcs from points (k, 3) lead to: the end's image next to the start's."""
        turns = np.round((Lambert.places(end) - Lambert.places(start))[:, 0] / _TURN)
        return Movements(np.ones(len(turns)), np.column_stack([-_TURN * turns, 0 * turns]))

    @staticmethod
    def home(low, _centre):
        """What brings faces with lower left corners (k, 2) to the seam's right."""
        turns = np.floor((low[:, 0] + _ON_SEAM) / _TURN)
        return Movements(np.ones(len(turns)), np.column_stack([-_TURN * turns, 0 * turns]))

    @staticmethod
    def within(places):
        """Which places (k, 2) lie between the poles."""
        return np.abs(places[:, 1]) < 1

    @staticmethod
    def finish(uv):
        return uv


class Octahedral:
    """The equal-area octahedral map of Clarberg (2008): a square, north in the middle, south in its corners.

    Each side of the square is glued to itself by a half turn about its middle, a point of the equator. A cut
    runs from each of these four points along its meridian to the south pole.
    """

    singular = np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
    scale = 1 / np.pi
    cones = True  # singular points are the tips of cones, no poles

    @staticmethod
    def places(points):
        x, y, z = Octahedral._off_the_pole(points).T
        radius = np.hypot(x, y) / np.sqrt(1 + np.abs(z))
        along = np.arctan2(np.abs(y), np.abs(x)) * (2 / np.pi)
        u, v = radius * (1 - along), radius * along
        south = z < 0
        u, v = np.where(south, 1 - v, u), np.where(south, 1 - u, v)
        return np.column_stack([np.where(x < 0, -u, u), np.where(y < 0, -v, v)])

    @staticmethod
    def crossings(start, end):
        """Where great arcs from points (k, 3) lead to: the end's image next to the start's."""
        start, end = Octahedral._off_the_pole(start), Octahedral._off_the_pole(end)
        result, when = Movements.none((len(start),)), np.full(len(start), -1.0)
        for middle in Octahedral.singular:
            crossed, share = _meridian_crossings(start, end, middle)
            half_turn = Movements(np.where(crossed, -1.0, 1.0), 2 * crossed[:, None] * middle[:2])
            # An arc that crosses two cuts meets them in the order of their places along it.
            later = share > when
            result[later], result[~later] = (
                result[later].after(half_turn[later]),
                half_turn[~later].after(result[~later]),
            )
            when = np.where(crossed, np.maximum(when, share), when)
        return result

    @staticmethod
    def home(_low, centre):
        """What brings faces with centres (k, 2) into the square."""
        cell = np.round(centre / 2)
        signs = np.where(cell.sum(axis=1) % 2 == 0, 1.0, -1.0)
        return Movements(signs, -2 * signs[:, None] * cell)

    @staticmethod
    def within(places):
        return np.ones(len(places), bool)

    @staticmethod
    def finish(uv):
        """The square with the area of the sphere, the seam direction at its upper side."""
        return np.sqrt(np.pi) * np.stack([-uv[..., 1], uv[..., 0]], axis=-1)

    @staticmethod
    def _off_the_pole(points):
        """Points, those on the south pole a hair off: the four cuts meet there."""
        on = (np.hypot(points[:, 0], points[:, 1]) < _ON_POLE) & (points[:, 2] < 0)
        if not on.any():
            return points
        points = points.copy()
        points[on] = _ON_POLE * np.cos(0.3), _ON_POLE * np.sin(0.3), -1
        return points


LAYOUTS = {"LAMBERT": Lambert, "OCTAHEDRAL": Octahedral}


def _meridian_crossings(start, end, middle):
    """Which arcs cross the southern half of a point of the equator's meridian, and how far along (k,)."""
    x, y, _ = middle
    side, other = (points[:, 1] * x - points[:, 0] * y for points in (start, end))
    between = (side >= 0) != (other >= 0)
    meeting = start * np.abs(other)[:, None] + end * np.abs(side)[:, None]
    crossed = between & (meeting @ middle > 0) & (meeting[:, 2] < 0)
    total = np.abs(side) + np.abs(other)
    return crossed, np.where(crossed, np.abs(side) / np.where(total > 0, total, 1), -1.0)
