# SPDX-License-Identifier: MIT OR Apache-2.0
"""Registrations of surfaces with different numbers of holes, and of open and closed ones."""

import numpy as np
import pytest

import authalic

from . import meshes, oracle, pairs

PLATE, FULL = meshes.plate_with_holes(), meshes.grid(17, 17, aspect=1.0)


def plates():
    """A plate with three holes and a full one, with landmarks at the same places."""
    places = [[0.5, 0.5, 0], [0.2, 0.7, 0], [0.85, 0.85, 0], [0.5, 0.15, 0]]
    return pairs.Pair(PLATE, FULL, pairs.nearest(PLATE, places), pairs.nearest(FULL, places))


def open_ball(level=3, top=0.8):
    """A ball with its top cut off."""
    ball = meshes.ball(level)
    is_below = (ball.vertices[ball.faces][..., 2] < top).all(axis=1)
    return meshes.compact(meshes.Mesh(ball.vertices, ball.faces[is_below]))


def swapped(pair):
    return pairs.Pair(pair.target, pair.source, pair.target_landmarks, pair.source_landmarks)


def register_disks(pair, *, energy="area", **options):
    source, target, source_landmarks, target_landmarks = pair
    marks = {"source_landmarks": source_landmarks, "target_landmarks": target_landmarks}
    return authalic.register_disks(source, target, **marks, energy=energy, **options)


def register_spheres(source, target, directions, *, energy="area", **options):
    marks = [np.argmax(mesh.vertices @ np.transpose(directions), axis=0) for mesh in (source, target)]
    return authalic.register_spheres(
        source, target, source_landmarks=marks[0], target_landmarks=marks[1], energy=energy, **options
    )


def lies_in_a_face(uv, faces, points):
    """Whether each point lies in some face of a planar map, edges included up to rounding."""
    a, b, c = uv[faces].transpose(1, 0, 2)

    def cross(p, q, x):
        return (q[:, 0] - p[:, 0]) * (x[1] - p[:, 1]) - (q[:, 1] - p[:, 1]) * (x[0] - p[:, 0])

    inside = [np.min([cross(a, b, x), cross(b, c, x), cross(c, a, x)], axis=0).max() for x in points]
    return np.array(inside) > -1e-15


def assert_arrays(result, source, target):
    n, m, n_target, m_target = (len(part) for mesh in (source, target) for part in mesh)
    assert result.positions.shape == result.barycentric.shape == (n, 3)
    own = result.source_map
    assert len(result.registered) == len(own.uv if isinstance(own, authalic.DiskMap) else own.positions) == n
    assert result.target_registered.shape[0] == n_target
    assert result.area_ratio.shape == (m,)
    assert result.faces.shape == (m, 3)
    assert result.target_faces.shape == (m_target, 3)
    assert np.isfinite(result.positions).all()
    assert 0 <= result.triangles.min() <= result.triangles.max() < m_target
    assert (result.barycentric >= 0).all()
    assert np.abs(result.barycentric.sum(axis=1) - 1).max() < 1e-14
    on_target = np.setdiff1d(np.arange(n), result.in_holes)
    corners = target.vertices[result.target_faces[result.triangles]]
    places = np.einsum("ik,ikx->ix", result.barycentric, corners)
    assert np.abs(places - result.positions)[on_target].max() < 1e-13 * pairs.size(target)
    # data come from the nearest place, so they stay within their range
    values = np.arange(n_target) % 7
    assert 0 <= result.pull(values).min() <= result.pull(values).max() <= 6
    assert np.isin(result.pull(values, nearest=True), values).all()
    assert result.pull(np.zeros((m_target, 3, 2))).shape == (m, 3, 2)


def test_a_plate_with_holes_onto_a_full_one():
    pair = plates()
    result = register_disks(pair, fill_holes=True)
    assert_arrays(result, *pair[:2])
    assert oracle.folded(result.registered, result.faces) == []
    assert len(result.in_holes) == 0
    assert np.linalg.norm(result.positions - PLATE.vertices, axis=1).mean() < 0.1
    gap = result.positions[pair.source_landmarks] - FULL.vertices[pair.target_landmarks]
    assert np.linalg.norm(gap, axis=1).max() < 1e-3
    assert np.isfinite(result.area_distortion).all()


def test_a_full_plate_onto_one_with_holes():
    pair = swapped(plates())
    result = register_disks(pair, fill_holes=True)
    assert_arrays(result, *pair[:2])
    found = ~lies_in_a_face(result.target_registered, result.target_faces, result.registered)
    assert np.array_equal(np.flatnonzero(found), result.in_holes)
    assert len(result.in_holes) > 5
    # the fillings are flat like the plate, and the holes lie where they lie in the plate
    places = result.positions[result.in_holes]
    assert np.abs(places[:, 2]).max() < 1e-12
    middle = np.array([[0.25, 0.25], [0.7, 0.3], [0.5, 0.75]])
    half = np.array([0.09, 0.13, 0.05]) + 1 / 24
    assert (np.abs(places[:, None, :2] - middle).max(axis=2) <= half).any(axis=1).all()
    assert np.linalg.norm(result.positions - FULL.vertices, axis=1).mean() < 0.1
    assert np.isfinite(result.area_distortion).all()


def test_the_inverse_of_a_registration_with_filled_holes():
    pair = plates()
    result = register_disks(pair, fill_holes=True)
    back = result.inverse()
    assert_arrays(back, *pair[1::-1])
    assert len(back.in_holes) > 5
    assert np.linalg.norm(back.positions - FULL.vertices, axis=1).mean() < 0.1
    again = back.inverse()
    assert np.array_equal(again.positions, result.positions)


def test_the_same_holes_on_both_sides_are_the_identity():
    marks = pairs.spread(PLATE, 4)
    result = register_disks(pairs.Pair(PLATE, PLATE, marks, marks), fill_holes=True)
    assert_arrays(result, PLATE, PLATE)
    assert len(result.in_holes) == 0
    assert np.abs(result.positions - PLATE.vertices).max() < 1e-9


def test_without_holes_nothing_changes():
    pair = pairs.DISK_PAIRS["caps"]
    plain, filled = pairs.register(pair), pairs.register(pair, fill_holes=True)
    assert np.array_equal(plain.positions, filled.positions)
    assert np.array_equal(plain.registered, filled.registered)
    assert len(filled.in_holes) == 0


@pytest.mark.parametrize("options", [{}, {"angle_weight": 1.0}, {"energy": "surface"}])
def test_an_open_surface_onto_a_closed_one(options):
    source, target = open_ball(), meshes.ball(3)
    directions = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, -1]]
    result = register_spheres(source, target, directions, fill_holes=True, **options)
    assert_arrays(result, source, target)
    assert oracle.folded_on_sphere(result.registered, result.faces) == []
    assert len(result.in_holes) == 0
    assert len(result.missed) == 0
    moved = np.linalg.norm(result.positions - source.vertices, axis=1)
    assert moved.mean() < 0.2


def test_a_closed_surface_onto_an_open_one():
    source, target = meshes.ball(3), open_ball()
    directions = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, -1]]
    result = register_spheres(source, target, directions, fill_holes=True, angle_weight=1.0)
    assert_arrays(result, source, target)
    assert len(result.in_holes) > 3
    rim = target.vertices[pairs.boundary_vertices(target.faces)]
    places = result.positions[result.in_holes]
    # the filling spans the loop, in its convex hull
    assert (places.min(axis=0) >= rim.min(axis=0) - 1e-12).all()
    assert (places.max(axis=0) <= rim.max(axis=0) + 1e-12).all()
    assert (source.vertices[result.in_holes][:, 2] > 0.3).all()
    assert_arrays(result.inverse(), target, source)


def test_features_reach_over_filled_holes():
    pair = plates()
    features = (PLATE.vertices[:, :2], FULL.vertices[:, :2])
    result = register_disks(pair, fill_holes=True, energy="surface", features=features)
    assert_arrays(result, *pair[:2])


def test_holes_are_refused_unless_they_are_to_be_filled():
    with pytest.raises(authalic.MeshError, match="source"):
        register_disks(plates())
    with pytest.raises(authalic.MeshError, match="source"):
        register_spheres(open_ball(), meshes.ball(3), np.eye(3))


def test_landmarks_are_those_of_the_given_surface():
    pair = plates()
    with pytest.raises(authalic.MeshError, match=str(len(PLATE.vertices))):
        register_disks(pair._replace(source_landmarks=[len(PLATE.vertices), 1, 2, 3]), fill_holes=True)


def test_handles_cannot_be_filled():
    with pytest.raises(authalic.MeshError, match="target"):
        register_spheres(meshes.ball(3), meshes.Mesh(*meshes.torus()), np.eye(3), fill_holes=True)
