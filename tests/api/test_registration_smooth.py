# SPDX-License-Identifier: MIT OR Apache-2.0
"""Data and vectors carried from a coarse surface to a fine one."""

import numpy as np
import pytest

import authalic

from . import meshes, pairs


@pytest.fixture(scope="module")
def ball():
    """A fine ball onto a coarse one of the same size, turned so that they share no vertex."""
    source = meshes.Mesh(*meshes.icosphere(4))
    target = meshes.Mesh(meshes.icosphere(3).vertices @ meshes.rotation(5).T, meshes.icosphere(3).faces)
    marks = pairs.spread(source, 6)
    pair = pairs.Pair(source, target, marks, pairs.nearest(target, source.vertices[marks]))
    return pairs.register(pair), pair


def wave(points):
    x, y, z = np.asarray(points).T
    return np.sin(2 * x + y) + 0.5 * np.cos(3 * z - x)


def on_ball(points):
    return points / np.linalg.norm(points, axis=1)[:, None]


def test_a_smooth_function_has_no_facets(ball):
    result, pair = ball
    expected = wave(on_ball(result.positions))
    linear, smooth = (result.pull(wave(pair.target.vertices), smooth=smooth) for smooth in (False, True))
    assert 5 * np.abs(smooth - expected).max() < np.abs(linear - expected).max()


def test_positions_pulled_smoothly_lie_on_the_round_ball(ball):
    result, pair = ball
    linear, smooth = (result.pull(pair.target.vertices, smooth=smooth) for smooth in (False, True))
    gap = [np.abs(np.linalg.norm(points, axis=1) - 1).max() for points in (linear, smooth)]
    assert 5 * gap[1] < gap[0]


def test_constants_and_zero_faces_stay_as_they_are(ball):
    result, pair = ball
    assert (result.pull(np.full(len(pair.target.vertices), 0.3), smooth=True) == 0.3).all()
    half = (pair.target.vertices[:, 2] > 0.1).astype(float)
    linear, smooth = (result.pull(half, smooth=smooth) for smooth in (False, True))
    assert (smooth[linear == 0] == 0).all() and (smooth[linear == 1] == 1).all()
    assert smooth.min() > -0.2 and smooth.max() < 1.2


def test_linear_functions_on_a_flat_disk_are_reproduced():
    source, target = meshes.grid(30, 31), meshes.grid(9, 10)
    marks = pairs.spread(source, 3)
    pair = pairs.Pair(source, target, marks, pairs.nearest(target, source.vertices[marks]))
    result = pairs.register(pair)
    values = target.vertices @ [1.5, -2.0, 0.3] + 4
    smooth = result.pull(values, smooth=True)
    assert np.abs(smooth - (result.positions @ [1.5, -2.0, 0.3] + 4)).max() < 1e-9


def test_shapes_and_refusals(ball):
    result, pair = ball
    n = len(pair.target.vertices)
    values = np.random.default_rng(1).standard_normal((n, 2, 3))
    pulled = result.pull(values, smooth=True)
    assert pulled.shape == (len(pair.source.vertices), 2, 3)
    assert np.array_equal(pulled[:, 1, 2], result.pull(values[:, 1, 2], smooth=True))
    with pytest.raises(ValueError, match="it does not go with values per corner"):
        result.pull(np.zeros((len(pair.target.faces), 3)), smooth=True)
    with pytest.raises(ValueError, match="it does not go with nearest=True"):
        result.pull(np.zeros(n), smooth=True, nearest=True)


def test_vectors_turn_and_grow_with_a_turned_body():
    source = meshes.bumpy_ball()
    turn = meshes.rotation(3)
    target = meshes.Mesh(2.5 * source.vertices @ turn.T + 7, source.faces)
    marks = pairs.spread(source, 6)
    result = pairs.register(pairs.Pair(source, target, marks, marks))
    matrices = result.local_similarities()
    assert matrices.shape == (len(source.vertices), 3, 3)
    # up to what the map of the two differs from the identity
    assert np.abs(matrices - turn.T / 2.5).max() < 0.05
    scale = np.linalg.det(matrices) ** (1 / 3)
    products = matrices @ matrices.transpose(0, 2, 1)
    assert np.allclose(products, scale[:, None, None] ** 2 * np.identity(3), atol=1e-9)


def test_vectors_turn_with_the_part_of_the_body_that_is_bent():
    """A rod that is bent by a quarter turn in its middle: what points away from the axis goes on doing so."""
    straight = meshes.capsule(48, 16)
    x = straight.vertices - straight.vertices.mean(axis=0)
    axis = np.ptp(x, axis=0).argmax()
    x = np.roll(x, 2 - axis, axis=1)  # the axis is z now
    length = np.ptp(x[:, 2])
    angle = np.clip(x[:, 2] / length + 0.5, 0, 1) * np.pi / 2
    radius = length / (np.pi / 2)
    bent = np.column_stack(
        [radius - (radius - x[:, 0]) * np.cos(angle), x[:, 1], (radius - x[:, 0]) * np.sin(angle)]
    )
    faces = straight.faces
    marks = pairs.spread(meshes.Mesh(x, faces), 8)
    result = authalic.register_spheres(
        (x, faces), (bent, faces), source_landmarks=marks, target_landmarks=marks, angle_weight=100
    )
    # on the bent rod, toward the center of the bend; on the straight one, along +x
    toward = np.column_stack([np.cos(angle), 0 * angle, -np.sin(angle)])
    carried = np.einsum("nij,nj->ni", result.local_similarities(), result.pull(toward))
    carried /= np.linalg.norm(carried, axis=1)[:, None]
    middle = np.abs(x[:, 2]) < 0.4 * length
    assert np.median(carried[middle, 0]) > 0.97 and carried[middle, 0].min() > 0.8
    assert result.pull(toward)[middle, 0].min() < 0.6, "in the axes of the world they would not"
