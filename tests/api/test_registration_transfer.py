# SPDX-License-Identifier: MIT OR Apache-2.0
"""Data through a registration: values, corner data, labels, the inverse, comparisons and morphs."""

import numpy as np
import pytest

import authalic

from . import meshes, oracle, pairs

NAMES = ("caps", "turned_caps", "ball_and_ellipsoid", "ball_and_parallels")


@pytest.fixture(scope="module")
def results():
    return {name: pairs.register(pairs.PAIRS[name]) for name in NAMES}


@pytest.fixture(params=NAMES)
def both(request, results):
    return results[request.param], pairs.PAIRS[request.param]


@pytest.fixture(params=["caps", "ball_and_ellipsoid"])
def identity(request):
    mesh = pairs.PAIRS[request.param].source
    marks = pairs.spread(mesh, 4)
    return pairs.register(pairs.Pair(mesh, mesh, marks, marks)), mesh


def seam_faces(mesh):
    """The faces on one side of a seam: where the first coordinate of the center is positive."""
    return mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 0


# Per vertex


def test_the_targets_positions_pulled_are_the_positions(both):
    result, pair = both
    assert np.abs(result.pull(pair.target.vertices) - result.positions).max() < 1e-13 * pairs.size(
        pair.target
    )


def test_linear_functions_of_the_position_are_pulled_as_they_are(both):
    result, pair = both
    values = pair.target.vertices @ [1.5, -2.0, 0.3] + 4
    assert np.abs(result.pull(values) - (result.positions @ [1.5, -2.0, 0.3] + 4)).max() < 1e-12


def test_a_constant_stays_constant(both):
    result, pair = both
    assert np.abs(result.pull(np.full(len(pair.target.vertices), 7.25)) - 7.25).max() < 1e-14 * 7.25 * 4


@pytest.mark.parametrize("shape", [(), (1,), (4,), (2, 3), (2, 0), (1, 1, 5)])
def test_values_of_any_shape_per_vertex(both, shape):
    result, pair = both
    values = np.random.default_rng(1).standard_normal((len(pair.target.vertices), *shape))
    pulled = result.pull(values)
    assert pulled.shape == (len(pair.source.vertices), *shape)
    assert pulled.dtype == np.float64
    assert pulled.flags.c_contiguous
    corners = values[result.target_faces[result.triangles]]
    expected = np.einsum("ik,ik...->i...", result.barycentric, corners)
    assert np.allclose(pulled, expected, rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("dtype", ["u1", "i4", "i8", "f2", "f4", "f8", "?"])
def test_values_of_any_real_dtype(both, dtype):
    result, pair = both
    values = (np.arange(len(pair.target.vertices)) % 100).astype(dtype)
    assert np.array_equal(result.pull(values), result.pull(values.astype(float)))


def test_values_of_any_layout(both):
    result, pair = both
    values = np.random.default_rng(1).standard_normal((len(pair.target.vertices), 3))
    expected = result.pull(values)
    wide = np.zeros((2 * len(values), 6))
    wide[::2, ::2] = values
    for layout in (np.asfortranarray(values), wide[::2, ::2], values.tolist(), values.astype(">f8")):
        assert np.array_equal(result.pull(layout), expected)


def test_what_is_not_a_number_stays_where_it_was(identity):
    """A NaN reaches exactly the vertices that lie in a face with it."""
    result, mesh = identity
    values = np.arange(len(mesh.vertices), dtype=float)
    values[7] = np.nan
    pulled = result.pull(values)
    away = ~np.isin(np.arange(len(values)), mesh.faces[(mesh.faces == 7).any(axis=1)])
    assert np.allclose(pulled[away], values[away], atol=1e-3 * len(values))
    assert np.isnan(pulled[7])


# Labels


@pytest.mark.parametrize("dtype", ["i1", "u2", "i8", "f4", "?", "U5", "O", "c16", "M8[D]"])
def test_labels_are_those_of_the_nearest_vertex_with_their_dtype(both, dtype):
    result, pair = both
    labels = (np.arange(len(pair.target.vertices)) % 7).astype("i8").astype(dtype)
    pulled = result.pull(labels, nearest=True)
    assert pulled.dtype == labels.dtype
    faces = result.target_faces[result.triangles]
    chosen = faces[np.arange(len(faces)), result.barycentric.argmax(axis=1)]
    assert np.array_equal(pulled, labels[chosen])


def test_labels_of_several_columns(both):
    result, pair = both
    labels = np.stack([np.arange(len(pair.target.vertices))] * 2, axis=1)
    pulled = result.pull(labels, nearest=True)
    assert pulled.shape == (len(pair.source.vertices), 2)
    assert np.array_equal(pulled[:, 0], result.pull(labels[:, 0], nearest=True))


def test_labels_come_back_from_the_surface_itself(identity):
    result, mesh = identity
    labels = np.arange(len(mesh.vertices)) ** 2
    assert np.array_equal(result.pull(labels, nearest=True), labels)


# Per corner


def test_corner_data_without_a_seam_is_as_per_vertex(both):
    result, pair = both
    values = pair.target.vertices @ [1.5, -2.0, 0.3] + 4
    pulled = result.pull(values[result.target_faces])
    assert pulled.shape == pair.source.faces.shape
    gap = np.abs(pulled - result.pull(values)[result.faces])
    # a corner that lies just outside the face its own face begins in is taken at that face's rim
    assert np.quantile(gap, 0.9) < 1e-9
    assert gap.max() < 0.2 * np.ptp(values)


def test_corner_data_with_a_seam_keeps_to_its_side(identity):
    result, mesh = identity
    side = np.repeat(seam_faces(mesh)[:, None], 3, axis=1)
    corners = 10.0 * side + mesh.vertices[mesh.faces] @ [0.1, 0.2, 0.3]
    pulled = result.pull(corners)
    assert np.abs(pulled - corners).max() < 1e-5
    assert np.array_equal(result.pull(side.astype("i4"), nearest=True), side)


def test_uv_maps_with_seams_come_back_from_the_surface_itself(identity):
    result, mesh = identity
    corners = np.random.default_rng(3).random((len(mesh.faces), 3, 2))  # every edge is a seam
    assert np.abs(result.pull(corners) - corners).max() < 1e-4
    assert np.array_equal(result.pull(corners, nearest=True), corners)


def test_a_seam_is_crossed_only_where_it_lies(both):
    """Values 0 and 1 on the sides of a seam: no corner lies between, so no face may be smeared over it."""
    result, pair = both
    side = seam_faces(pair.target).astype(float)
    pulled = result.pull(np.repeat(side[:, None], 3, axis=1))
    assert np.isin(pulled, [0, 1]).all()


@pytest.mark.parametrize("shape", [(), (1,), (2,), (2, 2)])
def test_corner_values_of_any_shape(both, shape):
    result, pair = both
    values = np.random.default_rng(1).standard_normal((len(pair.target.faces), 3, *shape))
    pulled = result.pull(values)
    assert pulled.shape == (len(pair.source.faces), 3, *shape)
    assert (pulled.min(), pulled.max()) >= (values.min(), 0)
    assert pulled.max() <= values.max()
    flat = values.reshape(len(pair.target.faces), 3, -1)
    column = result.pull(flat[:, :, 0])
    assert np.array_equal(pulled.reshape(len(pair.source.faces), 3, -1)[:, :, 0], column)


def test_corners_are_those_of_the_faces_as_given():
    """Faces turned against the rest, and a target turned inside out, keep the corners of their data."""
    for name in ("caps", "ball_and_ellipsoid"):
        pair = pairs.PAIRS[name]
        faces = pair.source.faces.copy()
        faces[50:90] = faces[50:90, [0, 2, 1]]
        if name == "caps":
            target_faces = pair.target.faces.copy()
            target_faces[20:40] = target_faces[20:40, [1, 0, 2]]
        else:
            target_faces = pair.target.faces[:, [2, 1, 0]]
        given = pair._replace(
            source=meshes.Mesh(pair.source.vertices, faces),
            target=meshes.Mesh(pair.target.vertices, target_faces),
        )
        result, values = pairs.register(given), pair.target.vertices @ [1.0, 2.0, 3.0]
        pulled = result.pull(values[target_faces])
        assert np.allclose(pulled, result.pull(values)[faces], atol=0.2 * np.ptp(values))
        assert np.quantile(np.abs(pulled - result.pull(values)[faces]), 0.9) < 1e-9


# Refusals


def test_values_of_another_length_are_refused(both):
    result, pair = both
    n, m = len(pair.target.vertices), len(pair.target.faces)
    for values in (np.zeros(n - 1), np.zeros((n + 1, 3)), np.zeros((m, 4)), np.zeros(m), 3.0, []):
        with pytest.raises(authalic.MeshError, match=rf"values must be of shape \({n}, …\).*\({m}, 3, …\)"):
            result.pull(values)
        with pytest.raises(authalic.MeshError, match=rf"values must be of shape \({n}, …\).*\({m}, 3, …\)"):
            result.pull(values, nearest=True)


def test_values_that_are_no_numbers_need_nearest(both):
    result, pair = both
    for dtype in ("U3", "O", "c16"):
        with pytest.raises(authalic.MeshError, match=r"values must be real numbers.*nearest=True"):
            result.pull(np.zeros(len(pair.target.vertices), dtype))


def test_as_many_faces_as_vertices_mean_vertices():
    """A tetrahedron has four of either: (4, 3) are then values per vertex."""
    mesh = meshes.tetrahedron()
    result = pairs.register(pairs.Pair(mesh, mesh, np.arange(4), np.arange(4)))
    assert np.abs(result.pull(mesh.vertices) - mesh.vertices).max() < 1e-12


# The inverse


def test_the_inverse_goes_back(both):
    result, pair = both
    back = result.inverse()
    swapped = pairs.Pair(pair.target, pair.source, pair.target_landmarks, pair.source_landmarks)
    assert isinstance(back, authalic.Registration)
    pairs.assert_registration(back, swapped)
    if result.registered.shape[1] == 3:
        assert np.array_equal(back.registered, result.target_registered)
        assert np.array_equal(back.landmark_error, result.landmark_error)
    assert np.array_equal(back.target_registered, result.registered)
    assert np.array_equal(back.faces, result.target_faces)
    assert back.status == result.status
    gap = back.positions[pair.target_landmarks] - pair.source.vertices[pair.source_landmarks]
    assert np.linalg.norm(gap, axis=1).max() <= 0.005 * pairs.size(pair.source)


def test_there_and_back_is_nearly_where_it_was(both):
    """Both maps are piecewise linear on different meshes, so they agree up to the size of a face."""
    result, pair = both
    there_and_back = result.pull(result.inverse().positions)
    moved = np.linalg.norm(there_and_back - pair.source.vertices, axis=1)
    assert moved.mean() < 0.05 * pairs.size(pair.source)


def test_the_inverse_of_the_inverse_is_the_registration(both):
    result, _ = both
    again = result.inverse().inverse()
    assert np.array_equal(again.triangles, result.triangles)
    assert np.abs(again.positions - result.positions).max() < 1e-12 * np.abs(result.positions).max()
    assert again.distortion.authalic_energy == pytest.approx(result.distortion.authalic_energy, rel=1e-9)


def test_the_inverse_pulls_source_data_to_the_target(both):
    result, pair = both
    back = result.inverse()
    pulled = back.pull(pair.source.vertices)
    assert np.abs(pulled - back.positions).max() < 1e-13 * pairs.size(pair.source)


# Comparing scalars


def reference(values, pulled, weights):
    """The weighted Pearson correlation and mean absolute difference."""
    weights = weights / weights.sum()
    a, b = values - weights @ values, pulled - weights @ pulled
    correlation = weights @ (a * b) / np.sqrt((weights @ a**2) * (weights @ b**2))
    return correlation, weights @ np.abs(values - pulled)


def test_scalars_are_compared_by_area(both):
    result, pair = both
    source_values = pair.source.vertices @ [1.0, 2.0, -1.0]
    target_values = np.sin(pair.target.vertices @ [3.0, 1.0, 2.0])
    areas = oracle.face_areas(pair.source.vertices, result.faces)
    weights = oracle.vertex_weights(result.faces, areas, len(source_values))
    figures = result.compare(source_values, target_values)
    assert isinstance(figures, tuple)
    assert [type(figure) for figure in figures] == [float, float]
    assert figures == pytest.approx(reference(source_values, result.pull(target_values), weights), rel=1e-9)


def test_the_surface_itself_compares_perfectly(identity):
    result, mesh = identity
    values = mesh.vertices[:, 0] ** 2
    correlation, difference = result.compare(values, 3 * values + 1)
    assert correlation == pytest.approx(1, abs=1e-6)
    assert result.compare(values, values)[1] < 1e-5
    assert result.compare(values, -values)[0] == pytest.approx(-1, abs=1e-6)
    assert difference > 0


def test_bad_scalars_are_refused(both):
    result, pair = both
    n, n_target = len(pair.source.vertices), len(pair.target.vertices)
    with pytest.raises(authalic.MeshError, match=rf"source_values must be of shape \({n},\)"):
        result.compare(np.zeros(n + 1), np.zeros(n_target))
    with pytest.raises(authalic.MeshError, match=rf"target_values must be of shape \({n_target},\)"):
        result.compare(np.zeros(n), np.zeros((n_target, 2)))
    with pytest.raises(authalic.MeshError, match="source_values must be real numbers"):
        result.compare(np.zeros(n, complex), np.zeros(n_target))


# Morphs


@pytest.mark.parametrize("align", [False, True])
def test_a_morph_begins_at_the_source(both, align):
    result, pair = both
    start = authalic.homotopy(pair.source.vertices, result, 0, align=align)
    assert np.array_equal(start, pair.source.vertices)
    assert start is not pair.source.vertices


def test_a_morph_ends_on_the_target_by_straight_lines(both):
    result, pair = both
    end = authalic.homotopy(pair.source.vertices, result, 1)
    assert np.array_equal(end, result.positions)
    for t in (0.25, 0.5, 1.5, -0.3):
        between = authalic.homotopy(pair.source.vertices, result, t)
        expected = (1 - t) * pair.source.vertices + t * result.positions
        assert np.abs(between - expected).max() < 1e-12 * (1 + np.abs(expected).max())
        assert between.dtype == np.float64
        assert between.flags.c_contiguous


def weighted_moments(points, weights):
    center = weights @ points / weights.sum()
    return center, np.sqrt(weights @ ((points - center) ** 2).sum(axis=1) / weights.sum())


def test_an_aligned_morph_ends_at_a_similar_copy_of_the_target_that_has_not_traveled(both):
    result, pair = both
    end = authalic.homotopy(pair.source.vertices, result, 1.0, align=True)
    areas = oracle.face_areas(pair.source.vertices, result.faces)
    weights = oracle.vertex_weights(result.faces, areas, len(end))
    here, _ = weighted_moments(pair.source.vertices, weights)
    there, _ = weighted_moments(end, weights)
    assert np.linalg.norm(here - there) < 1e-9 * pairs.size(pair.source)
    # a similar copy: all distances by one factor, no reflection
    a, b = result.positions - result.positions[0], end - end[0]
    scale = np.linalg.norm(b) / np.linalg.norm(a)
    assert (
        np.abs(np.linalg.norm(b, axis=1) - scale * np.linalg.norm(a, axis=1)).max() < 1e-9 * np.abs(b).max()
    )
    turn, *_ = np.linalg.lstsq(a, b, rcond=None)
    assert np.linalg.det(turn) > 0


def test_alignment_removes_travel(identity):
    """The surface itself, moved, turned and scaled, does not move at all."""
    _, mesh = identity
    marks = pairs.spread(mesh, 4)
    turn, _ = np.linalg.qr(np.random.default_rng(4).standard_normal((3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    for scale in (1.0, 2.0**10):
        copy = meshes.Mesh(scale * (mesh.vertices @ turn + 5), mesh.faces)
        result = pairs.register(pairs.Pair(mesh, copy, marks, marks))
        traveled = authalic.homotopy(mesh.vertices, result, 1.0)
        aligned = authalic.homotopy(mesh.vertices, result, 1.0, align=True)
        gaps = [np.linalg.norm(end - mesh.vertices, axis=1).mean() for end in (traveled, aligned)]
        assert gaps[1] < 0.1 * pairs.size(mesh) < gaps[0]


def test_bad_morphs_are_refused(both):
    result, pair = both
    n = len(pair.source.vertices)
    with pytest.raises(authalic.MeshError, match=rf"vertices must be of shape \({n}, 3\)"):
        authalic.homotopy(pair.source.vertices[:-1], result, 0.5)
    with pytest.raises(authalic.MeshError, match="vertices must be of shape"):
        authalic.homotopy(pair.source.vertices[:, :2], result, 0.5)
    for t in (np.nan, np.inf):
        with pytest.raises(ValueError, match="t must be a finite number"):
            authalic.homotopy(pair.source.vertices, result, t)
    with pytest.raises(TypeError):
        authalic.homotopy(pair.source.vertices, None, 0.5)


def test_data_that_would_fit_both_ways_are_taken_as_asked():
    """A tetrahedron has as many faces as vertices."""
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], float)
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]])
    solid = (corners, faces)
    result = authalic.register_spheres(solid, solid, source_landmarks=[0, 1], target_landmarks=[0, 1])
    values = np.arange(12.0).reshape(4, 3)
    assert np.abs(result.pull(values) - values).max() < 1e-12
    assert result.pull(values, per="vertex").shape == (4, 3)
    of_corners = result.pull(corners[faces][..., 0], per="corner")
    assert np.abs(of_corners - corners[faces][..., 0]).max() < 1e-9
    with pytest.raises(ValueError, match='per must be "vertex", "corner" or None, but is "face"'):
        result.pull(values, per="face")


def test_rounding_is_no_seam():
    target = pairs.DISK_PAIRS["caps"].target
    result = pairs.register(pairs.DISK_PAIRS["caps"])
    exact = target.vertices[np.asarray(result.target_faces)][..., :2]
    noisy = exact.astype(np.float32) * (1 + 6e-8 * np.resize([-1, 1, 0], exact.shape))
    assert np.abs(result.pull(noisy, per="corner") - result.pull(exact, per="corner")).max() < 1e-6
