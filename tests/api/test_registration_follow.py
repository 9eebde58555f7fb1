# SPDX-License-Identifier: MIT OR Apache-2.0
"""Points beside a registered surface that follow it: eyes, teeth and clothes."""

import numpy as np
import pytest

import authalic

from . import meshes, pairs

EYES = np.array([[0.45, -0.8, 0.4], [-0.45, -0.8, 0.4]]) / np.linalg.norm([0.45, -0.8, 0.4])
"""Directions of the sockets."""


def head(level=4, turned=None):
    """A ball with two sockets."""
    directions, faces = meshes.icosphere(level, turned)
    depth = sum(0.3 * np.exp(-(np.linalg.norm(directions - eye, axis=1) ** 4) / 0.3**4) for eye in EYES)
    return meshes.Mesh(directions * (1 - depth)[:, None], faces)


def eyes(radius=0.12):
    """Two balls in the sockets, (k, 3), and the number of the piece of each point."""
    ball = meshes.icosphere(2)[0]
    return np.concatenate([0.88 * eye + radius * ball for eye in EYES]), np.repeat([0, 1], len(ball))


def bent(points):
    """Taller, turned, enlarged and leaning over."""
    x, y, z = np.asarray(points).T
    lean = 0.3 * (z + 1)
    x, z = np.cos(lean) * x + np.sin(lean) * (z + 1), np.cos(lean) * (z + 1) - np.sin(lean) * x
    return 2.5 * np.stack([x, y, 1.2 * z], axis=1) @ meshes.rotation(3).T + [7, -3, 11]


def best_ball(points):
    """Center and radius of the ball nearest to points, and the largest distance from it over the radius."""
    system = np.column_stack([2 * points, np.ones(len(points))])
    center, rest = np.split(np.linalg.lstsq(system, (points**2).sum(axis=1), rcond=None)[0], [3])
    radius = np.sqrt(rest[0] + center @ center)
    return center, radius, np.abs(np.linalg.norm(points - center, axis=1) - radius).max() / radius


def windings(points, mesh):
    """How often a closed surface winds around points, by solid angles (Van Oosterom and Strackee 1983)."""
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces] - points[:, None, None], 2, 0)
    na, nb, nc = (np.linalg.norm(corner, axis=-1) for corner in (a, b, c))
    over = (a * np.cross(b, c)).sum(axis=-1)
    under = na * nb * nc + (a * b).sum(-1) * nc + (b * c).sum(-1) * na + (c * a).sum(-1) * nb
    return np.arctan2(over, under).sum(axis=1) / (2 * np.pi)


def similar(points):
    return 1.7 * points @ meshes.rotation(1).T + [3, -20, 5]


@pytest.fixture(scope="module")
def onto_similar():
    """A head onto a similar one, and the source."""
    source = head(3)
    marks = pairs.spread(source, 8)
    return pairs.register(
        pairs.Pair(source, source._replace(vertices=similar(source.vertices)), marks, marks)
    )


@pytest.fixture(scope="module")
def onto_bent():
    """A head onto a bent one of other triangles, with landmarks around the sockets, and the target."""
    source, target = head(), head(turned=7)
    rims = [eye + 0.4 * np.cross(eye, side) for eye in EYES for side in np.eye(3)]
    places = [*EYES * 0.7, *rims, *meshes.octahedron().vertices]
    marks = [pairs.nearest(mesh, places) for mesh in (source, target)]
    target = target._replace(vertices=bent(target.vertices))
    return pairs.register(pairs.Pair(source, target, *marks)), target


@pytest.mark.parametrize("rigid_size", [0.0, 0.25, np.inf])
def test_all_points_move_by_the_similarity_of_a_similar_target(onto_similar, rigid_size):
    points, pieces = eyes()
    moved = onto_similar.follow(points, pieces=pieces, rigid_size=rigid_size)
    assert moved.dtype == np.float64
    assert moved.flags.c_contiguous
    # as exactly as the registration finds the similarity
    found = np.abs(onto_similar.positions - similar(head(3).vertices)).max()
    assert np.abs(moved - similar(points)).max() < 1e-9 + 10 * found


def test_eyes_stay_round_and_in_their_sockets(onto_bent):
    result, target = onto_bent
    points, pieces = eyes()
    moved = result.follow(points, pieces=pieces)
    for piece, eye in enumerate(EYES):
        center, radius, apart = best_ball(moved[pieces == piece])
        assert apart < 1e-9
        assert radius == pytest.approx(2.5 * 0.12 * 1.2 ** (1 / 3), rel=0.2)
        assert np.linalg.norm(center - bent(0.88 * eye[None])[0]) < 0.1 * 2.5
        away = np.linalg.norm(target.vertices - center, axis=1)
        assert away.min() > 0.75 * radius
    assert np.abs(windings(moved, target)).max() < 0.1


def test_eyes_that_bend_do_not_stay_round(onto_bent):
    result, _ = onto_bent
    points, pieces = eyes()
    moved = result.follow(points, pieces=pieces, rigid_size=0)
    assert best_ball(moved[pieces == 0])[2] > 0.01
    assert np.array_equal(moved, result.follow(points))
    assert np.array_equal(moved, result.follow(points, pieces=np.full(len(points), -1)))


def test_points_on_the_surface_go_where_it_goes(onto_bent):
    result, target = onto_bent
    moved = result.follow(head().vertices[::37])
    assert np.abs(moved - result.positions[::37]).max() < 1e-6 * pairs.size(target)


def test_clothes_keep_their_distance_and_do_not_tear(onto_bent):
    """A hood a little outside the head, away from its sockets."""
    result, _ = onto_bent
    ball = meshes.icosphere(4)[0]
    hood = 1.05 * ball[ball[:, 1] > 0]
    moved = result.follow(hood, pieces=np.zeros(len(hood), int))
    on_head = result.follow(hood / 1.05)
    gap = np.linalg.norm(moved - on_head, axis=1)
    assert gap.min() > 0.02 * 2.5
    assert gap.max() < 0.1 * 2.5
    assert best_ball(moved)[2] > 0.02
    nudged = result.follow(hood + np.array([1e-4, 0, 0]))
    assert np.abs(nudged - moved).max() < 1e-2


def test_results_are_the_same_on_any_number_of_threads(onto_bent):
    result, _ = onto_bent
    points, pieces = eyes()
    before = result.follow(points, pieces=pieces), result.follow(points)
    authalic.set_threads(1)
    try:
        after = result.follow(points, pieces=pieces), result.follow(points)
    finally:
        authalic.set_threads(0)
    assert all(np.array_equal(first, second) for first, second in zip(before, after, strict=True))


def test_pieces_do_not_depend_on_each_other(onto_bent):
    result, _ = onto_bent
    points, pieces = eyes()
    both = result.follow(points, pieces=pieces)
    assert np.array_equal(result.follow(points[pieces == 1], pieces=pieces[pieces == 1]), both[pieces == 1])
    assert np.array_equal(result.follow(points[::-1], pieces=pieces[::-1])[::-1], both)


def test_no_points(onto_similar):
    assert onto_similar.follow(np.empty((0, 3))).shape == (0, 3)
    assert onto_similar.follow([], pieces=[]).shape == (0, 3)


@pytest.mark.parametrize(
    ("points", "options", "message"),
    [
        ([[0, 0]], {}, r"points must be of shape \(n, 3\)"),
        ([[0, 0, np.nan]], {}, "points must be finite, but is NaN or infinite at point 0"),
        ([[0, 0, 0]], {"pieces": [0, 1]}, r"pieces must be of shape \(1,\), one number per point"),
        ([[0, 0, 0]], {"pieces": [[0]]}, r"pieces must be of shape \(k,\), one number per point"),
        ([[0, 0, 0]], {"rigid_size": -1}, "rigid_size must be a number ≥ 0, but is -1"),
        ([[0, 0, 0]], {"rigid_size": np.nan}, "rigid_size must be a number ≥ 0"),
    ],
)
def test_bad_arguments(onto_similar, points, options, message):
    with pytest.raises(ValueError, match=message):
        onto_similar.follow(points, **options)
