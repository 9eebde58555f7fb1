# SPDX-License-Identifier: MIT OR Apache-2.0
"""Maps read backwards: `locate`, `image_of`, `sample`."""

import numpy as np
import pytest

import authalic

from . import meshes

RANDOM = np.random.default_rng(7)
DIRECTIONS = RANDOM.normal(size=(400, 3)) * RANDOM.uniform(0.01, 100, size=(400, 1))


@pytest.fixture(scope="module")
def ball():
    return authalic.sphere_map(*meshes.bumpy_ball())


@pytest.fixture(scope="module")
def limbed():
    result = authalic.sphere_map(*meshes.limbed_ball(3), refine=True)
    assert len(result.refinement.parents) > 0
    return result


@pytest.fixture(scope="module")
def cap():
    return authalic.disk_map(*meshes.bumpy_cap())


def unit(points):
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def points_in(disk, count=400):
    """Points of random faces."""
    weights = RANDOM.dirichlet([1, 1, 1], size=count)
    return np.einsum("kc,kcd->kd", weights, disk.uv[disk.faces[RANDOM.integers(len(disk.faces), size=count)]])


def cones(positions, faces, x):
    """All faces whose cone contains each of `x`, by solving for its coordinates: (points, faces, 3)."""
    return np.einsum("fij,pj->pfi", np.linalg.inv(np.swapaxes(positions[faces], 1, 2)), x)


def test_a_point_of_the_sphere_lies_in_the_face_whose_cone_contains_it(ball):
    triangles, barycentric = ball.locate(DIRECTIONS)
    coordinates = cones(ball.positions, ball.faces, DIRECTIONS)
    assert (coordinates.min(axis=2).argmax(axis=1) == triangles).all()
    expected = coordinates[np.arange(len(triangles)), triangles]
    np.testing.assert_allclose(barycentric, expected / expected.sum(axis=1, keepdims=True), atol=1e-9)


def test_a_point_of_the_disk_lies_in_the_face_that_contains_it(cap):
    points = points_in(cap)
    triangles, barycentric = cap.locate(points)
    homogeneous = np.pad(cap.uv, ((0, 0), (0, 1)), constant_values=1)
    coordinates = cones(homogeneous, cap.faces, np.pad(points, ((0, 0), (0, 1)), constant_values=1))
    assert (coordinates.min(axis=2).argmax(axis=1) == triangles).all()
    np.testing.assert_allclose(barycentric, coordinates[np.arange(len(triangles)), triangles], atol=1e-9)


@pytest.mark.parametrize("name", ["ball", "limbed"])
def test_on_the_sphere_the_inverse_of_the_inverse_is_the_identity(name, request):
    result = request.getfixturevalue(name)
    triangles, barycentric = result.locate(DIRECTIONS)
    assert (barycentric >= -1e-15).all() and np.allclose(barycentric.sum(axis=1), 1, atol=1e-12)
    image = result.image_of(triangles, barycentric)
    np.testing.assert_allclose(image, unit(DIRECTIONS), rtol=0, atol=1e-9)
    again, weights = result.locate(image)
    assert (again == triangles).all()
    np.testing.assert_allclose(weights, barycentric, rtol=0, atol=1e-9)


def test_on_the_disk_the_inverse_of_the_inverse_is_the_identity(cap):
    points = points_in(cap)
    np.testing.assert_allclose(cap.image_of(*cap.locate(points)), points, rtol=0, atol=1e-9)


def test_vertices_lie_at_themselves(ball, cap):
    for result, image in ((ball, ball.positions), (cap, cap.uv)):
        triangles, barycentric = result.locate(image)
        corner = barycentric.argmax(axis=1)
        assert (result.faces[triangles, corner] == np.arange(len(image))).all()
        assert (barycentric.max(axis=1) == 1).all()


def test_split_faces_are_read_by_their_parts(limbed):
    """The place of a split point is where it lies on the surface."""
    mesh, refinement = meshes.limbed_ball(3), limbed.refinement
    triangles, barycentric = limbed.locate(refinement.positions)
    places = np.einsum("kc,kcd->kd", barycentric, mesh.vertices[limbed.faces[triangles]])
    np.testing.assert_allclose(places, refinement.vertices, rtol=0, atol=1e-9)
    np.testing.assert_allclose(limbed.image_of(triangles, barycentric), refinement.positions, atol=1e-9)


def test_linear_values_are_sampled_where_the_places_are(ball):
    mesh = meshes.bumpy_ball()
    triangles, barycentric = ball.locate(DIRECTIONS)
    places = np.einsum("kc,kcd->kd", barycentric, mesh.vertices[ball.faces[triangles]])
    np.testing.assert_allclose(ball.sample(mesh.vertices, DIRECTIONS), places, atol=1e-12)
    assert ball.sample(mesh.vertices[:, 0], DIRECTIONS).shape == (len(DIRECTIONS),)
    tensors = mesh.vertices[:, :, None] * mesh.vertices[:, None]
    assert ball.sample(tensors, DIRECTIONS).shape == (len(DIRECTIONS), 3, 3)


def test_values_per_face_are_those_of_the_face(ball):
    triangles, _ = ball.locate(DIRECTIONS)
    assert (ball.sample(np.arange(len(ball.faces)), DIRECTIONS) == triangles).all()
    labels = ball.sample(np.arange(len(ball.faces), dtype=np.int16), DIRECTIONS, nearest=True)
    assert labels.dtype == np.int16 and (labels == triangles).all()


def test_where_both_fit_values_belong_to_vertices_unless_said_otherwise():
    result = authalic.sphere_map(*meshes.tetrahedron())
    values, centers = np.arange(4.0), unit(result.positions[result.faces].mean(axis=1))
    triangles, _ = result.locate(centers)
    assert (result.sample(values, centers, per="face") == triangles).all()
    assert not np.allclose(result.sample(values, centers), triangles)


def test_labels_are_those_of_the_corner_with_the_largest_weight(ball):
    triangles, barycentric = ball.locate(DIRECTIONS)
    names = np.array([f"vertex {vertex}" for vertex in range(len(ball.positions))])
    expected = names[ball.faces[triangles, barycentric.argmax(axis=1)]]
    assert (ball.sample(names, DIRECTIONS, nearest=True) == expected).all()


def test_points_outside_a_disk_have_no_place_or_the_nearest(cap):
    points = np.array([[0.1, 0.2], [3.0, 0.0], [0.0, -1.5]])
    triangles, barycentric = cap.locate(points)
    assert (triangles == -1).tolist() == [False, True, True]
    assert np.isnan(barycentric[1:]).all() and not np.isnan(barycentric[0]).any()
    assert np.isnan(cap.image_of(triangles, barycentric)[1:]).all()
    nearest = cap.image_of(*cap.locate(points, outside="nearest"))
    rim = cap.uv[authalic.Surface(*meshes.bumpy_cap()).boundary_loops[0]]
    t = np.linspace(0, 1, 2001)[:, None, None]
    chords = ((1 - t) * rim + t * np.roll(rim, -1, axis=0)).reshape(-1, 2)
    for point, place in zip(points[1:], nearest[1:], strict=True):
        assert np.linalg.norm(point - place) == pytest.approx(
            np.linalg.norm(chords - point, axis=1).min(), abs=1e-6
        )


def test_points_outside_a_disk_get_what_is_asked_for(cap):
    points, ones = [[0.1, 0.2], [3.0, 0.0]], np.ones(len(cap.uv))
    assert np.isnan(cap.sample(ones, points)[1])
    assert cap.sample(ones, points, outside=-5).tolist() == [1, -5]
    assert cap.sample(ones, points, outside="nearest").tolist() == [1, 1]
    labels = np.full(len(cap.uv), 7, np.uint8)
    assert cap.sample(labels, points, nearest=True).tolist() == [7, 0]
    assert cap.sample(labels, points, nearest=True, outside=9).tolist() == [7, 9]
    assert np.isnan(cap.sample(ones.astype("f4"), points, nearest=True)[1])


def test_holes_of_a_sphere_are_outside():
    ball = meshes.bumpy_ball()
    result = authalic.sphere_map(ball.vertices, ball.faces[1:], fill_holes=True)
    hole = result.positions[ball.faces[0]].mean(axis=0)
    triangles, barycentric = result.locate([hole, result.positions[5]])
    assert (triangles == -1).tolist() == [True, False] and np.isnan(barycentric[0]).all()
    assert np.isnan(result.sample(np.ones(len(ball.vertices)), [hole])).all()


def test_holes_are_outside():
    plate = meshes.plate_with_holes()
    result = authalic.disk_map(*plate, fill_holes=True)
    hole = authalic.Surface(*plate).boundary_loops[-1]
    assert result.locate([result.uv[hole].mean(axis=0)])[0].tolist() == [-1]


def test_images_of_boundary_edges_are_on_the_map_in_spite_of_rounding(cap):
    rim = cap.uv[authalic.Surface(*meshes.bumpy_cap()).boundary_loops[0]]
    t = RANDOM.uniform(size=(50, 1, 1))
    points = ((1 - t) * rim + t * np.roll(rim, -1, axis=0)).reshape(-1, 2)
    assert (cap.locate(points)[0] >= 0).all()


def test_many_points_are_found_as_few_are(ball):
    """Many points are looked up in an order of their own."""
    many = RANDOM.normal(size=(70_000, 3))
    triangles, barycentric = ball.locate(many)
    few = RANDOM.integers(len(many), size=50)
    for k in few:
        triangle, weights = ball.locate(many[k : k + 1])
        assert triangle[0] == triangles[k] and (weights[0] == barycentric[k]).all()


def test_no_points_have_no_places(ball, cap):
    assert ball.locate(np.zeros((0, 3)))[0].shape == (0,)
    assert cap.sample(np.ones((len(cap.uv), 4)), np.zeros((0, 2))).shape == (0, 4)


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (
            [[0.0, 0, 0], [1, 0, 0]],
            "points must be finite, and no row zero, but is no such thing in 1 of its rows",
        ),
        ([[np.nan, 0, 0]], "points must be finite"),
        ([[np.inf, 0, 0]], "points must be finite"),
        ([[1.0, 0]], r"points must be of shape \(n, 3\)"),
        ([1.0, 0, 0], r"points must be of shape \(n, 3\)"),
        ([["a", "b", "c"]], "points must be real numbers"),
    ],
)
def test_what_are_no_points_is_refused(ball, points, words):
    for call in (ball.locate, lambda points: ball.sample(np.ones(len(ball.positions)), points)):
        with pytest.raises(authalic.MeshError, match=words) as refusal:
            call(points)
        assert refusal.value.kind == "invalid_array"


def test_what_are_no_places_is_refused(ball):
    for triangles, weights in (
        ([0], [[1, 0]]),
        ([len(ball.faces)], [[1, 0, 0]]),
        ([-2], [[1, 0, 0]]),
        ([0, 1], [[1, 0, 0]]),
    ):
        with pytest.raises(authalic.MeshError):
            ball.image_of(triangles, weights)


def test_what_are_no_values_is_refused(ball, cap):
    with pytest.raises(authalic.MeshError, match="per vertex or"):
        ball.sample(np.ones(5), DIRECTIONS)
    with pytest.raises(authalic.MeshError, match="one row per face"):
        ball.sample(np.ones(len(ball.positions)), DIRECTIONS, per="face")
    with pytest.raises(authalic.MeshError, match="nearest=True takes labels"):
        ball.sample(np.full(len(ball.positions), "a"), DIRECTIONS)
    with pytest.raises(ValueError, match='per must be "vertex", "face" or None'):
        ball.sample(np.ones(5), DIRECTIONS, per="corner")
    with pytest.raises(ValueError, match='outside must be "nearest" or a number, but is "far"'):
        cap.locate([[0, 0]], outside="far")


def test_huge_and_tiny_directions_count_alike(ball):
    expected = ball.locate(DIRECTIONS[:5])[0]
    for scale in (1e-300, 1e300):
        assert (ball.locate(unit(DIRECTIONS[:5]) * scale)[0] == expected).all()
