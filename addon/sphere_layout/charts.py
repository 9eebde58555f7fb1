# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh of the sphere in a layout, with the corners of every face where they belong together.

Each edge is a great arc; the cuts of the layout that it leads across tell the image of its end next to that
of its start. So both faces at an edge agree on it, wherever they are put in the end. Plain numpy, no bpy.
"""

from dataclasses import dataclass

import numpy as np

from .layouts import Movements


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

    def image(self, face, corner):
        """The images (k, 2) of corners `corner` (k,) of faces `face` (k,), but at poles."""
        return self.moves[face, corner].of(self.places[self.faces[face, corner]])

    def follow(self, uv):
        """Puts the corners at the poles in the middle again."""
        face, corner, group = self.polar
        if len(face) == 0:
            return
        others = uv[face, :, 0]
        others[np.arange(len(face)), corner] = np.nan
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
    places = layout.places(points)
    local, closed = _triangle_moves(layout, points, faces, singular)
    chart = Chart(layout, faces, places, local, _polar(layout, faces, polygons, singular), closed)
    _join(chart, polygons, singular)
    number, first = np.unique(polygons, return_inverse=True)
    low, centre = _extents(chart.moves.of(chart.places[faces]), singular[faces], first, len(number))
    homes = layout.home(low, centre)[first]
    chart.moves = homes[:, None].after(chart.moves)
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
    ends = np.count_nonzero(singular[faces], axis=1)
    around = moves[rows, second].after(layout.crossings(at[1], at[2]))
    closed = around.agree(moves[rows, third])
    if layout.cones:
        inverse = moves[rows, third].after(layout.crossings(at[2], at[1]))
        for corner, other in ((third, around), (second, inverse)):
            vertex = faces[rows, corner]
            place = layout.places(points[vertex])
            same = np.abs(other.of(place) - moves[rows, corner].of(place)).max(axis=1) < 1e-6
            closed = np.where(singular[vertex], same, closed)
        return moves, closed & (ends <= 2)
    return moves, (closed | (ends > 0)) & (ends <= 1)


def _join(chart, polygons, singular):
    """Puts the triangles of a polygon together along its diagonals; those that do not fit are not closed."""
    done = np.zeros(len(polygons), bool)
    done[np.unique(polygons, return_index=True)[1]] = True
    here, there = _diagonals(chart.faces, polygons, singular)
    while True:
        known, new = done[here[0]], done[there[0]]
        onward, back = known & ~new, new & ~known
        if not (onward | back).any():
            break
        source = np.concatenate([here[:, onward], there[:, back]], axis=1)
        target = np.concatenate([there[:, onward], here[:, back]], axis=1)
        whole = _fitted(chart, singular, source, target)
        chart.moves[target[0]] = whole[:, None].after(chart.moves[target[0]])
        done[target[0]] = True
    for end in (1, 2):
        vertex = chart.faces[here[0], here[end]]
        apart = np.abs(chart.image(here[0], here[end]) - chart.image(there[0], there[end])).max(axis=1) > 1e-6
        apart &= chart.layout.cones | ~singular[vertex]
        chart.closed &= ~np.isin(polygons, polygons[here[0, apart]])


def _fitted(chart, singular, source, target):
    """Movements that put triangles, by their target ends of diagonals, to others by the source ends."""
    (face, first, second), (other, its_first, its_second) = source, target
    whole = chart.moves[face, first].after(chart.moves[other, its_first].inverse())
    # About a singular point it may be half a turn more.
    place = chart.places[chart.faces[other, its_second]]
    moved = whole.after(chart.moves[other, its_second]).of(place)
    off = np.abs(moved - chart.image(face, second)).max(axis=1) > 1e-6
    off &= singular[chart.faces[face, first]]
    half_turn = Movements(np.where(off, -1.0, 1.0), 2 * off[:, None] * chart.image(face, first))
    return half_turn.after(whole)


def _diagonals(faces, polygons, singular):
    """Face, corner at one end and corner at the other end, (3, k), of the two triangles at diagonals.

    The first end is not singular if one of them is not.
    """
    first, second = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    key = np.column_stack([np.repeat(polygons, 3), np.minimum(first, second), np.maximum(first, second)])
    order = np.lexsort(key.T)
    same = np.flatnonzero((key[order[1:]] == key[order[:-1]]).all(axis=1))
    edge = order[same]
    turned = singular[first[edge]]
    ends = np.where(turned, second[edge], first[edge]), np.where(turned, first[edge], second[edge])
    return tuple(
        np.stack([face, *((faces[face] == end[:, None]).argmax(axis=1) for end in ends)])
        for face in (edge // 3, order[same + 1] // 3)
    )


def _polar(layout, faces, polygons, singular):
    """Face, corner and polygon, counted through, of the corners at the poles of a cylinder."""
    if layout.cones:
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
