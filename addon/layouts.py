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
    creased = False
    most_ends = 1  # singular corners of one face: the length of an edge from pole to pole is not defined

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
    creased = True  # where the signs of coordinates change
    most_ends = 2

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


@dataclass
class Chart:
    """A mesh in a layout: the image of a corner is `moves` (m, 3) of the place (n, 2) of its vertex.

    At a pole of Lambert's projection, for corners `polar[1]` of faces `polar[0]`, it is in the middle of the
    other corners of its polygon, which `polar[2]` counts. `closed` (m,) is False where a face winds about a
    singular point.
    """

    layout: type
    faces: np.ndarray
    places: np.ndarray
    moves: Movements
    polar: tuple
    closed: np.ndarray

    def uv(self):
        """The images (m, 3, 2) of all corners."""
        uv = self.moves.of(self.places[self.faces])
        self.follow(uv)
        return uv

    def follow(self, uv):
        """Puts the corners at the poles in the middle again."""
        face, corner, group = self.polar
        if len(face) == 0:
            return
        others = uv[face, :, 0]
        others[np.arange(len(face)), corner] = np.nan
        others[np.abs(uv[face, :, 1]) >= 1] = np.nan
        low, high = np.full((2, group.max() + 1), np.nan)
        np.fmin.at(low, group, np.fmin.reduce(others, axis=1))
        np.fmax.at(high, group, np.fmax.reduce(others, axis=1))
        uv[face, corner, 0] = ((low + high) / 2)[group]


def develop(layout, points, faces, polygons):
    """The `Chart` of faces (m, 3), counter-clockwise between points (n, 3) of the unit sphere.

    Faces with one number in `polygons` (m,) keep together. Points on a singular point of the layout have to
    be exactly there.
    """
    singular = (points[:, None] == layout.singular).all(axis=2).any(axis=1)
    local, closed = _triangle_moves(layout, points, faces, singular)
    here, there, ambiguous = _diagonals(faces, polygons, singular)
    closed &= ~np.isin(polygons, polygons[ambiguous])
    moves = _joined(local, polygons, here, there)
    chart = Chart(
        layout, faces, layout.places(points), moves, _polar(layout, faces, polygons, singular), closed
    )
    number, first = np.unique(polygons, return_inverse=True)
    low, centre = _extents(chart.moves.of(chart.places[faces]), singular[faces], first, len(number))
    homes = layout.home(low, centre)[first]
    chart.moves = homes[:, None].after(moves)
    return chart


def _triangle_moves(layout, points, faces, singular):
    """Movements (m, 3) that put the corners of each face together, and whether they close up."""
    rows = np.arange(len(faces))
    moves = Movements.none(faces.shape)
    # Arcs to singular points touch a cut; but all that they leave open is a movement about that point.
    base = np.argmin(singular[faces], axis=1)
    second, third = (base + 1) % 3, (base + 2) % 3
    at = [points[faces[rows, corner]] for corner in (base, second, third)]
    moves[rows, second] = layout.crossings(at[0], at[1])
    moves[rows, third] = layout.crossings(at[0], at[2])
    back = moves[rows, second].after(layout.crossings(at[1], at[2]))
    ends = np.count_nonzero(singular[faces], axis=1)
    return moves, (back.agree(moves[rows, third]) | (ends > 0)) & (ends <= layout.most_ends)


def _joined(local, polygons, here, there):
    """The movements (m, 3) with the triangles of a polygon put together along its diagonals."""
    result, done = Movements(local.signs.copy(), local.shifts.copy()), np.zeros(len(polygons), bool)
    done[np.unique(polygons, return_index=True)[1]] = True
    while not done.all() and len(here):
        known, new = done[here[0]], done[there[0]]
        near = (
            (here[:, known & ~new], there[:, known & ~new]),
            (there[:, new & ~known], here[:, new & ~known]),
        )
        source, target = (np.concatenate(parts, axis=1) for parts in zip(*near, strict=True))
        if source.shape[1] == 0:
            break
        whole = result[tuple(source)].after(local[tuple(target)].inverse())
        result[target[0]] = whole[:, None].after(local[target[0]])
        done[target[0]] = True
        open_ = ~(known & new)
        here, there = here[:, open_], there[:, open_]
    return result


def _diagonals(faces, polygons, singular):
    """Corners (face, number), (2, k), on either side of diagonals, at an end that is not singular.

    And the faces at diagonals between two singular points, where that is no longer one movement.
    """
    first, second = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    key = np.column_stack([np.repeat(polygons, 3), np.minimum(first, second), np.maximum(first, second)])
    order = np.lexsort(key.T)
    same = np.flatnonzero((key[order[1:]] == key[order[:-1]]).all(axis=1))
    one, two = order[same], order[same + 1]
    vertex = np.where(singular[first[one]], second[one], first[one])
    faces_one, faces_two = one // 3, two // 3
    corner_one = (faces[faces_one] == vertex[:, None]).argmax(axis=1)
    corner_two = (faces[faces_two] == vertex[:, None]).argmax(axis=1)
    return np.stack([faces_one, corner_one]), np.stack([faces_two, corner_two]), faces_one[singular[vertex]]


def _polar(layout, faces, polygons, singular):
    """Face, corner and polygon, counted through, of the corners at the poles of a cylinder."""
    if layout is not Lambert:
        return (np.empty(0, int),) * 3
    face, corner = np.nonzero(singular[faces])
    key = np.column_stack([polygons[face], faces[face, corner]])
    return face, corner, np.unique(key, axis=0, return_inverse=True)[1].ravel()


def _extents(uv, singular, group, count):
    """The lower left corner and the centre (count, 2) of each polygon, singular corners left out."""
    weights = np.where(singular.all(axis=1, keepdims=True), 1.0, ~singular)
    low = np.full((count, 2), np.inf)
    np.minimum.at(low, group, np.where(weights[..., None] > 0, uv, np.inf).min(axis=1))
    total = np.bincount(group, weights.sum(axis=1), count)
    sums = [np.bincount(group, (weights * uv[..., axis]).sum(axis=1), count) for axis in (0, 1)]
    return low, np.stack(sums, axis=1) / total[:, None]
