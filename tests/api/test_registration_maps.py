# SPDX-License-Identifier: MIT OR Apache-2.0
"""The maps of registrations: identities, known maps, landmarks, and never a fold."""

import numpy as np
import pytest

import authalic

from . import meshes, oracle, pairs

DISKS = ("grid", "bumpy_cap", "rough_cap", "slit_sphere", "tube_disk")
SPHERES = ("octahedron", "ball", "ellipsoid", "bumpy_ball", "rough_ball", "spiky_ball", "parallels")
SURFACES = {name: {**meshes.DISKS, **meshes.SPHERES}[name] for name in (*DISKS, *SPHERES)}
all_pairs = pytest.mark.parametrize("pair", pairs.PAIRS.values(), ids=pairs.PAIRS)


def turned(seed=4):
    turn, _ = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    return turn * np.sign(np.linalg.det(turn))


# Maps that are known


@pytest.mark.parametrize("count", [2, 5, 12])
@pytest.mark.parametrize("name", SURFACES)
def test_a_surface_onto_itself_is_the_identity(name, count):
    mesh = SURFACES[name]
    pair = pairs.identical(mesh, min(count, 6))
    result = pairs.register(pair)
    assert np.abs(result.positions - mesh.vertices).max() <= 1e-6 * pairs.size(mesh)
    assert result.landmark_error.max() <= 1e-9
    assert np.allclose(result.area_ratio, 1, atol=1e-3)
    pairs.assert_registration(result, pair)
    pairs.assert_landmarks_meet(result, pair)


@pytest.mark.parametrize("scale", [2.0**40, 2.0**-40])
@pytest.mark.parametrize("name", SURFACES)
def test_a_surface_onto_its_copy_scaled_by_a_power_of_two_is_the_identity(name, scale):
    mesh = SURFACES[name]
    marks = pairs.spread(mesh, 4)
    result = pairs.register(pairs.Pair(mesh, meshes.Mesh(scale * mesh.vertices, mesh.faces), marks, marks))
    assert np.abs(result.positions / scale - mesh.vertices).max() <= 1e-6 * pairs.size(mesh)


@pytest.mark.parametrize("count", [2, 12])
@pytest.mark.parametrize("name", SURFACES)
def test_a_surface_onto_its_copy_turned_moved_and_scaled(name, count):
    """Rounding may turn or shear the two maps against each other, but landmarks meet."""
    mesh = SURFACES[name]
    marks = pairs.spread(mesh, min(count, 6))
    target = meshes.Mesh(3 * (mesh.vertices @ turned() + [3.0, -2.0, 5.0]), mesh.faces)
    pair = pairs.Pair(mesh, target, marks, marks)
    result = pairs.register(pair)
    pairs.assert_registration(result, pair)
    pairs.assert_landmarks_meet(result, pair)


@pytest.mark.parametrize("name", SURFACES)
def test_a_surface_onto_its_renumbered_copy(name):
    mesh = SURFACES[name]
    order = np.random.default_rng(8).permutation(len(mesh.vertices))
    place = np.argsort(order)
    target = meshes.Mesh(mesh.vertices[order], place[mesh.faces][::-1])
    marks = pairs.spread(mesh, 5)
    pair = pairs.Pair(mesh, target, marks, place[marks])
    result = pairs.register(pair)
    pairs.assert_registration(result, pair)
    pairs.assert_landmarks_meet(result, pair)


@pytest.mark.parametrize("name", ["bumpy_cap", "rough_cap", "bumpy_ball", "rough_ball"])
def test_a_surface_onto_a_finer_mesh_of_itself_stays_in_place(name):
    """There are many area-preserving maps; angles and a dozen landmarks choose one."""
    mesh = SURFACES[name]
    marks = pairs.spread(mesh, 12)
    pair = pairs.Pair(mesh, meshes.split_in_four(mesh), marks, marks)
    result = pairs.register(pair, angle_weight=0.3)
    pairs.assert_registration(result, pair)
    pairs.assert_landmarks_meet(result, pair)
    moved = np.linalg.norm(result.positions - mesh.vertices, axis=1) / pairs.size(mesh)
    assert moved.mean() < 0.03
    assert moved.max() < 0.15


# Landmarks


@all_pairs
@pytest.mark.parametrize("angle_weight", [0.0, 0.1])
def test_landmarks_meet_without_a_fold(pair, angle_weight):
    result = pairs.register(pair, angle_weight=angle_weight)
    pairs.assert_registration(result, pair)
    pairs.assert_landmarks_meet(result, pair)


@pytest.mark.parametrize("weight", [1e-6, 1e-3, 0.01, 1.0, 1e6])
@pytest.mark.parametrize("name", ["caps", "ball_and_ellipsoid"])
def test_landmarks_meet_from_any_weight(name, weight):
    pair = pairs.PAIRS[name]
    result = pairs.register(pair, weight=weight)
    pairs.assert_registration(result, pair)
    pairs.assert_landmarks_meet(result, pair)


@pytest.mark.parametrize("name", ["caps", "turned_caps", "ball_and_ellipsoid", "ball_and_parallels"])
def test_areas_are_kept(name):
    result = pairs.register(pairs.PAIRS[name])
    assert result.distortion.area_ratio_std < 0.1


def test_angles_count_where_they_are_asked_to():
    plain, weighted = (pairs.register(pairs.PAIRS["turned_caps"], angle_weight=w) for w in (0.0, 0.3))
    assert weighted.distortion.angle_distortion_mean < plain.distortion.angle_distortion_mean


@all_pairs
def test_the_order_of_the_pairs_hardly_matters(pair):
    back = pair._replace(
        source_landmarks=pair.source_landmarks[::-1], target_landmarks=pair.target_landmarks[::-1]
    )
    result = pairs.register(back)
    pairs.assert_registration(result, back)
    pairs.assert_landmarks_meet(result, back)


def with_marks(mesh, source, target):
    return pairs.Pair(mesh, mesh, np.array(source), np.array(target))


def inner_face(mesh):
    """A face without a boundary vertex."""
    edge = pairs.boundary_vertices(mesh.faces)
    return mesh.faces[np.flatnonzero(~np.isin(mesh.faces, edge).any(axis=1))[0]]


CAP, BALL = meshes.bumpy_cap(), meshes.bumpy_ball()
IMPOSSIBLE = {
    "disk_face_reversed": with_marks(CAP, inner_face(CAP), inner_face(CAP)[[0, 2, 1]]),
    "sphere_face_reversed": with_marks(BALL, BALL.faces[100], BALL.faces[100][[0, 2, 1]]),
    "whole_ring_reversed": with_marks(CAP, range(60, 90), range(89, 59, -1)),
    "all_vertices_shuffled": with_marks(
        BALL, range(len(BALL.vertices)), np.random.default_rng(2).permutation(len(BALL.vertices))
    ),
}


@pytest.mark.parametrize("pair", IMPOSSIBLE.values(), ids=IMPOSSIBLE)
def test_landmarks_that_would_fold_faces_are_missed_and_named(pair):
    result = pairs.register(pair)
    pairs.assert_registration(result, pair)
    pairs.assert_the_others_meet(result, pair)
    assert result.status == "landmarks_missed"
    assert len(result.missed) > 0


AWKWARD = {
    "disk_neighbors_swapped": with_marks(CAP, [100, 101], [101, 100]),
    "sphere_neighbors_swapped": with_marks(BALL, BALL.faces[100][:2], BALL.faces[100][1::-1]),
    "sphere_neighbors_swapped_and_more": with_marks(
        BALL, [*BALL.faces[100][:2], 0, 1, 2], [*BALL.faces[100][1::-1], 0, 1, 2]
    ),
    "beside_the_boundary": with_marks(CAP, range(360, 390, 3), np.roll(range(360, 390, 3), 1)),
    "across_the_disk": with_marks(CAP, [330], [345]),
    "antipodal": with_marks(BALL, [0, 1], [3, 4]),
    "poles_swapped": with_marks(BALL, [0, 3, 1], [3, 0, 1]),
    "two_landmarks_far_and_near": with_marks(
        BALL, [0, 1], [0, pairs.nearest(BALL, BALL.vertices[:1] + 0.2)[0]]
    ),
    "many": with_marks(CAP, range(0, 390, 2), range(0, 390, 2)),
    "all_inside": with_marks(CAP, [*range(390), 420], [*range(390), 420]),
    "all_of_a_sphere": with_marks(BALL, range(len(BALL.vertices)), range(len(BALL.vertices))),
    "all_of_a_tetrahedron": with_marks(meshes.tetrahedron(), range(4), range(4)),
    "tetrahedron_turned": with_marks(meshes.tetrahedron(), range(4), [1, 2, 0, 3]),
    "tetrahedron_reversed": with_marks(meshes.tetrahedron(), range(4), [1, 0, 2, 3]),
    "one_inside": with_marks(meshes.fan(), [0], [0]),
}


@pytest.mark.parametrize("pair", AWKWARD.values(), ids=AWKWARD)
def test_awkward_landmarks_fold_nothing_and_what_was_missed_is_named(pair):
    result = pairs.register(pair)
    pairs.assert_registration(result, pair)
    pairs.assert_the_others_meet(result, pair)


@pytest.mark.parametrize(
    "name", ["many", "all_inside", "all_of_a_sphere", "all_of_a_tetrahedron", "one_inside"]
)
def test_landmarks_that_lie_over_each_other_already_meet(name):
    pair = AWKWARD[name]
    result = pairs.register(pair)
    assert len(result.missed) == 0
    assert np.abs(result.positions - pair.target.vertices).max() <= 1e-6 * pairs.size(pair.target)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("closed", [False, True], ids=["disk", "sphere"])
def test_random_landmarks_fold_nothing(closed, seed):
    rng = np.random.default_rng(seed)
    source, target = (BALL, meshes.SPHERES["rough_ball"]) if closed else (CAP, meshes.DISKS["rough_cap"])
    marks = [
        rng.permutation(np.setdiff1d(np.arange(len(mesh.vertices)), pairs.boundary_vertices(mesh.faces)))[:6]
        for mesh in (source, target)
    ]
    pair = pairs.Pair(source, target, *marks)
    result = pairs.register(pair)
    pairs.assert_registration(result, pair)
    pairs.assert_the_others_meet(result, pair)


def test_a_mirrored_surface_is_registered_as_its_faces_say():
    """A left hand onto a right one: mirror one and turn its faces, as for hemispheres of the brain."""
    mesh = meshes.bumpy_ball()
    mirrored = meshes.Mesh(mesh.vertices * [-1, 1, 1], mesh.faces[:, ::-1])
    marks = pairs.spread(mesh, 5)
    pair = pairs.Pair(mirrored, meshes.Mesh(mesh.vertices * [-1, 1, 1], mesh.faces[:, ::-1]), marks, marks)
    result = pairs.register(pair)
    pairs.assert_registration(result, pair)
    assert np.abs(result.positions - mirrored.vertices).max() <= 1e-6 * pairs.size(mesh)


@pytest.mark.parametrize("name", ["bumpy_cap", "bumpy_ball"])
def test_a_closed_target_that_is_turned_inside_out_is_turned_back(name):
    mesh = SURFACES[name]
    marks = pairs.spread(mesh, 4)
    pair = pairs.Pair(mesh, meshes.Mesh(mesh.vertices, mesh.faces[:, ::-1]), marks, marks)
    result = pairs.register(pair)
    pairs.assert_registration(result, pair)
    if name == "bumpy_ball":  # a disk is laid upside down instead
        assert np.abs(result.positions - mesh.vertices).max() <= 1e-3 * pairs.size(mesh)
        assert np.array_equal(np.sort(result.target_faces), np.sort(mesh.faces))


def test_surfaces_of_any_size_and_place_register():
    pair = pairs.PAIRS["caps"]
    far = pair._replace(
        source=meshes.Mesh(1e7 * pair.source.vertices, pair.source.faces),
        target=meshes.Mesh(1e-7 * pair.target.vertices + 3e-7, pair.target.faces),
    )
    result = pairs.register(far)
    pairs.assert_landmarks_meet(result, far)
    assert result.distortion.area_ratio_std < 0.05


def test_the_area_ratio_of_the_identity_on_an_uneven_copy():
    """Stretching a rectangle to twice its width keeps all area ratios."""
    mesh = meshes.grid()
    marks = pairs.spread(mesh, 4)
    wide = meshes.Mesh(mesh.vertices * [2, 1, 1], mesh.faces)
    result = pairs.register(pairs.Pair(mesh, wide, marks, marks))
    shares = oracle.face_areas(result.positions, result.faces)
    assert result.area_ratio.mean() == pytest.approx(1, rel=1e-9)
    assert np.allclose(result.area_ratio * shares.sum() / len(shares), shares, rtol=1e-9)


def test_a_registration_of_the_docstring_kind():
    pyramid = meshes.fan(4)
    result = authalic.register_disks(pyramid, pyramid, source_landmarks=[0], target_landmarks=[0])
    assert np.abs(result.positions - pyramid.vertices).max() < 1e-12
