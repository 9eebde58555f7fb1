# SPDX-License-Identifier: MIT OR Apache-2.0
"""Features lay spheres over each other, with landmarks and without."""

import numpy as np
import pytest

import authalic

from . import meshes, pairs


def shape(x, y, z):
    return 1 + 0.3 * np.sin(3 * x + 1) * np.cos(2 * y + 0.5) + 0.2 * z


def signals(directions):
    """Two smooth signals (n, 2) without symmetry, by the directions of vertices."""
    x, y, z = directions.T
    return np.stack([np.sin(3 * x + 1) + np.cos(2 * y - 0.5) * z, x * y + 0.5 * np.sin(4 * z + x)], axis=1)


def directions(mesh):
    return mesh.vertices / np.linalg.norm(mesh.vertices, axis=1)[:, None]


def shaped(mesh):
    """A mesh of the unit sphere as one of the shape."""
    return meshes.Mesh(mesh.vertices * shape(*mesh.vertices.T)[:, None], mesh.faces)


def register(source, target, features, **options):
    return authalic.register_spheres(source, target, energy="surface", features=features, **options)


def assert_sound(result):
    pairs.assert_embedding(result.registered, result.faces)
    pairs.assert_embedding(result.target_registered, result.target_faces)


@pytest.mark.parametrize("seed", range(4))
def test_a_turned_copy_with_another_grid_is_found(seed):
    source, target = shaped(meshes.ball(4)), shaped(meshes.icosphere(4, turned=0))
    values = signals(directions(source)), signals(directions(target))
    turn = meshes.rotation(seed)
    result = register(source, (target.vertices @ turn.T, target.faces), values)
    assert_sound(result)
    gap = np.linalg.norm(result.positions - source.vertices @ turn.T, axis=1)
    assert gap.mean() < 0.01 * pairs.size(target)
    assert gap.max() < 0.05 * pairs.size(target)


def test_a_surface_is_found_on_itself():
    mesh = shaped(meshes.ball(4))
    values = signals(directions(mesh))
    result = register(mesh, mesh, (values, values))
    assert_sound(result)
    assert np.abs(result.positions - mesh.vertices).max() < 1e-6 * pairs.size(mesh)


def test_a_target_that_is_inside_out_is_found():
    source, target = shaped(meshes.ball(4)), shaped(meshes.icosphere(4, turned=0))
    values = signals(directions(source)), signals(directions(target))
    result = register(source, (target.vertices, target.faces[:, ::-1]), values)
    gap = np.linalg.norm(result.positions - source.vertices, axis=1)
    assert gap.mean() < 0.01 * pairs.size(target)


def test_noise_hardly_moves_what_features_find():
    source, target = shaped(meshes.ball(4)), shaped(meshes.icosphere(4, turned=0))
    values = signals(directions(source)), signals(directions(target))

    def noisy(mesh, seed):
        noise = np.random.default_rng(seed).standard_normal(mesh.vertices.shape)
        return meshes.Mesh(mesh.vertices + 1e-12 * pairs.size(mesh) * noise, mesh.faces)

    plain = register(source, target, values)
    moved = register(noisy(source, 1), noisy(target, 2), values)
    assert np.abs(moved.positions - plain.positions).max() < 1e-6 * pairs.size(target)


@pytest.mark.parametrize("count", [1, 2, 6])
def test_features_steer_between_landmarks(count):
    """The target's signals are turned about its axis between landmarks on the axis and on a ring."""
    source, target = shaped(meshes.ball(4)), shaped(meshes.icosphere(4, turned=0))
    x, y, z = directions(target).T
    turn = 0.4 * (1 - z * z) * np.sin(3 * z)
    turned = np.stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn), z], axis=1)
    values = signals(directions(source)), signals(turned)
    ring = np.pi / 2 * np.arange(4)
    places = np.array([[0, 0, 1], [0, 0, -1], *np.stack([np.cos(ring), np.sin(ring), 0 * ring], axis=1)])[
        :count
    ]
    landmarks = {
        f"{side}_landmarks": pairs.nearest(meshes.Mesh(directions(mesh), mesh.faces), places)
        for side, mesh in (("source", source), ("target", target))
    }
    result = register(source, target, values, **landmarks)
    assert_sound(result)
    assert len(result.missed) == 0
    agreement = [result.compare(*(value[:, k] for value in values))[0] for k in (0, 1)]
    assert min(agreement) > 0.95
    if count > 1:
        without = authalic.register_spheres(source, target, energy="surface", **landmarks)
        before = [without.compare(*(value[:, k] for value in values))[0] for k in (0, 1)]
        assert 1 - min(agreement) < 0.5 * (1 - min(before))


@pytest.mark.parametrize("last", [0, 3, 8, 15, 25, 40])
def test_a_run_with_features_can_be_cancelled_anywhere(last):
    source, target = shaped(meshes.ball(3)), shaped(meshes.icosphere(3, turned=0))
    values = signals(directions(source)), signals(directions(target))
    calls = []

    def progress(fraction, message):
        calls.append(fraction)
        return len(calls) <= last

    try:
        result = register(source, target, values, progress=progress)
    except authalic.SolverError as error:
        assert error.kind == "cancelled"
        return
    assert_sound(result)
    assert (result.status == "cancelled") == (len(calls) > last)
