# SPDX-License-Identifier: MIT OR Apache-2.0
"""Input that is no disk: a MeshError that names the elements at fault, or a sound map; never a crash."""

import hypothesis.extra.numpy as arrays
import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

import authalic

from . import meshes, oracle

CAP = meshes.bumpy_cap()


def refused(vertices, faces, words, call=authalic.disk_map, **options):
    """The elements that the MeshError names, and their number."""
    with pytest.raises(authalic.MeshError, match=words) as caught:
        call(vertices, faces, **options)
    assert str(caught.value).isprintable()
    return caught.value.indices, caught.value.count


def with_faces(*more):
    return np.vstack([CAP.faces, np.array(more, dtype=CAP.faces.dtype).reshape(-1, 3)])


def replaced(array, rows, value):
    array = array.copy()
    array[rows] = value
    return array


# The arrays


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_coordinates_that_are_not_finite(value):
    vertices = CAP.vertices.copy()
    vertices[[3, 7], [0, 2]] = value
    assert refused(vertices, CAP.faces, "NaN or infinite coordinates at 2 vertices") == ((3, 7), 2)


def test_only_the_first_eight_elements_are_named():
    vertices = replaced(CAP.vertices, slice(10, 30), np.nan)
    assert refused(vertices, CAP.faces, "20 vertices") == (tuple(range(10, 18)), 20)


@pytest.mark.parametrize("bad", [-1, 421, 2**31, 2**32, 2**33 + 1, -(2**62)])
def test_indices_out_of_range(bad):
    faces = CAP.faces.copy()
    faces[5, 1] = faces[9, 2] = bad
    assert refused(CAP.vertices, faces, str(bad)) == ((5, 9), 2)


def test_unsigned_indices_out_of_range():
    faces = CAP.faces.astype(np.uint64)
    faces[5, 1] = 2**64 - 2
    assert refused(CAP.vertices, faces, "in row 5") == ((5,), 1)


@pytest.mark.parametrize("call", [authalic.disk_map, authalic.sphere_map, authalic.cut])
@pytest.mark.parametrize(
    ("vertices", "faces", "words"),
    [
        ([], [], "no vertices"),
        (np.zeros((0, 3)), np.zeros((0, 3), int), "no vertices"),
        (CAP.vertices, [], "no faces"),
        (CAP.vertices, np.zeros((0, 3), np.int32), "no faces"),
        ([], CAP.faces, "no vertices"),
    ],
)
def test_empty_arrays(call, vertices, faces, words):
    with pytest.raises(authalic.MeshError, match=words):
        call(vertices, faces)


# Faces


def test_a_vertex_twice_in_a_face():
    faces = CAP.faces.copy()
    faces[4, 1] = faces[4, 0]
    faces[8] = faces[8, 2]
    assert refused(CAP.vertices, faces, "same vertex twice in 2 faces") == ((4, 8), 2)


@pytest.mark.parametrize("order", [[0, 1, 2], [1, 2, 0], [0, 2, 1]])
def test_duplicate_faces(order):
    faces = with_faces(CAP.faces[7][order])
    assert refused(CAP.vertices, faces, "repeating the vertices of an earlier face") == ((810,), 1)


def test_a_face_given_three_times():
    faces = with_faces(CAP.faces[7], CAP.faces[7])
    assert refused(CAP.vertices, faces, "2 faces") == ((810, 811), 2)


def test_faces_without_area():
    mesh = meshes.grid(4, 4)
    vertices = replaced(mesh.vertices, 5, mesh.vertices[6])  # the edge 5-6 shrinks to a point
    flat = tuple(np.flatnonzero([{5, 6} <= set(face) for face in mesh.faces.tolist()]))
    assert len(flat) == 2
    assert refused(vertices, mesh.faces, "no area in 2 faces") == (flat, 2)


def test_a_face_whose_corners_lie_on_a_line():
    corners = [[0, 0, 0], [1, 1, 1], [3, 3, 3], [0, 1, 0]]
    assert refused(corners, [[0, 2, 3], [0, 1, 2]], "on a line") == ((1,), 1)


def test_a_surface_in_one_point():
    assert refused(np.ones_like(CAP.vertices), CAP.faces, "no area")[1] == len(CAP.faces)


# Edges and vertices


def test_an_edge_of_three_faces():
    vertices = np.vstack([CAP.vertices, [[0, 0, 9]]])
    a, b, _ = CAP.faces[100]
    faces = with_faces([a, b, 421])
    indices, count = refused(vertices, faces, "more than two faces at edge")
    assert count == 1
    assert sorted(indices[0]) == sorted([a, b])


def test_a_vertex_in_which_parts_touch():
    vertices = np.vstack([CAP.vertices, [[0, 0, 9], [0, 1, 9]]])
    assert refused(vertices, with_faces([33, 421, 422]), "touch only in a point") == ((33,), 1)


def test_a_moebius_strip():
    indices, count = refused(*meshes.moebius(), "not orientable")
    assert count >= 1
    assert all(len(edge) == 2 for edge in indices)


def test_vertices_without_a_face():
    vertices = np.vstack([CAP.vertices, np.ones((2, 3))])
    assert refused(vertices, CAP.faces, "2 vertices .421, 422. without a face") == ((421, 422), 2)


# The kind of surface


def test_several_components():
    vertices = np.vstack([CAP.vertices, CAP.vertices + 5])
    faces = np.vstack([CAP.faces, CAP.faces + 421])
    assert refused(vertices, faces, "2 separate pieces") == ((0, 810), 2)


def test_a_closed_surface_is_told_to_mark_seams():
    assert refused(*meshes.sphere()[0], "closed .*seams") == ((), 0)
    assert refused(*meshes.torus(), "closed .genus 1.*seams") == ((), 0)


def test_a_torus_with_a_hole():
    mesh = meshes.torus()
    assert refused(mesh.vertices, mesh.faces[1:], "genus 1") == ((), 0)


def test_two_boundary_loops():
    indices, count = refused(*meshes.annulus(), "2 boundary loops of 40, 40 edges.*fill_holes=True")
    assert count == 2
    assert [vertex // 40 for vertex in sorted(indices)] == [0, 4]


# Coordinates


@pytest.mark.parametrize("scale", [1e300, 1e-300, 1e150, 1e-150])
@pytest.mark.parametrize("boundary", ["sliding", "arc_length"])
def test_huge_and_tiny_coordinates_work(scale, boundary):
    plain = authalic.disk_map(*CAP, boundary=boundary)
    result = authalic.disk_map(scale * CAP.vertices, CAP.faces, boundary=boundary)
    oracle.assert_disk_embedding(result)
    # near the minimum rounding moves vertices along directions in which areas hardly change
    assert abs(result.distortion.area_ratio_std - plain.distortion.area_ratio_std) < 1e-3


def test_coordinates_up_to_the_largest_number():
    largest = np.finfo(float).max
    vertices = CAP.vertices / np.abs(CAP.vertices).max() * largest
    oracle.assert_disk_embedding(authalic.disk_map(vertices, CAP.faces))


def test_a_small_surface_far_from_the_origin():
    oracle.assert_disk_embedding(authalic.disk_map(CAP.vertices + 1e8, CAP.faces))


def test_what_rounding_far_away_flattens_is_refused():
    indices, count = refused(CAP.vertices + 1e16, CAP.faces, "no area")
    assert count == len(CAP.faces)
    assert indices == tuple(range(8))


def test_a_needle_and_a_giant_in_one_mesh():
    vertices = meshes.fan(8).vertices * [1, 1e-9, 1]
    oracle.assert_disk_embedding(authalic.disk_map(vertices, meshes.fan(8).faces))


@pytest.mark.parametrize("aspect", [1e3, 1e6, 1e9])
def test_slivers(aspect):
    mesh = meshes.grid(9, 9, aspect=1.0)
    oracle.assert_disk_embedding(authalic.disk_map(mesh.vertices * [1, 1 / aspect, 1], mesh.faces))


@pytest.mark.parametrize("seed", range(6))
def test_a_crumpled_surface(seed):
    """Random positions: no face lies well, yet the surface is a disk."""
    mesh = meshes.grid(12, 12)
    vertices = np.random.default_rng(seed).standard_normal(mesh.vertices.shape)
    oracle.assert_disk_embedding(authalic.disk_map(vertices, mesh.faces))


def test_faces_of_very_different_sizes():
    mesh = meshes.bumpy_cap(40, 12, noise=0)
    radius = np.hypot(*mesh.vertices[:, :2].T)[:, None]
    oracle.assert_disk_embedding(authalic.disk_map(mesh.vertices * radius**8, mesh.faces))


# Anything at all

QUIET = settings(deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
COORDINATES = st.one_of(
    st.integers(-2, 2).map(float),
    st.floats(-1, 1, width=16),
    st.floats(allow_nan=False, allow_infinity=False),
    st.sampled_from([0.0, -0.0, 5e-324, 1e-300, 1e300, np.nan, np.inf]),
)


def map_or_refuse(vertices, faces, **options):
    try:
        result = authalic.disk_map(vertices, faces, **options)
    except (authalic.MeshError, authalic.SolverError) as error:
        assert "internal error" not in str(error)
        return
    assert oracle.folded(result.uv, result.faces) == []
    assert len(result.distortion.folded) == 0
    assert np.isfinite(result.distortion.authalic_energy)


@st.composite
def any_arrays(draw):
    n, m = draw(st.integers(0, 7)), draw(st.integers(0, 9))
    vertices = draw(arrays.arrays(float, (n, 3), elements=COORDINATES))
    return vertices, draw(arrays.arrays(np.int64, (m, 3), elements=st.integers(-1, n)))


@st.composite
def disks_of_any_shape(draw):
    """Triangles glued one by one to an edge, or into a corner, of the boundary; positions at random."""
    faces, loop, n = [[0, 1, 2]], [0, 1, 2], 3
    for _ in range(draw(st.integers(0, 12))):
        k = draw(st.integers(0, len(loop) - 1))
        before, here, after = loop[k - 1], loop[k], loop[(k + 1) % len(loop)]
        joined = any({before, after} <= set(face) for face in faces)
        if joined or draw(st.booleans()):
            faces.append([after, here, n])
            loop.insert(k + 1, n)
            n += 1
        else:
            faces.append([after, here, before])
            loop.pop(k)
    return draw(arrays.arrays(float, (n, 3), elements=st.integers(-9, 9).map(float))), np.array(faces)


@settings(QUIET, max_examples=400)
@given(any_arrays())
def test_any_small_arrays_are_mapped_or_refused(mesh):
    map_or_refuse(*mesh)
    map_or_refuse(*mesh, fill_holes=True, boundary="arc_length", method="fixed_point")


@settings(QUIET, max_examples=300)
@given(disks_of_any_shape(), st.sampled_from(["sliding", "arc_length"]))
def test_any_disk_is_mapped_without_a_fold(mesh, boundary):
    try:
        result = authalic.disk_map(*mesh, boundary=boundary)
    except authalic.MeshError as error:
        assert "no area" in str(error)
        return
    oracle.assert_disk_embedding(result)


@settings(QUIET, max_examples=300)
@given(any_arrays(), st.data())
def test_any_small_arrays_are_cut_or_refused(mesh, data):
    vertices, faces = mesh
    seams = data.draw(arrays.arrays(np.int64, (3, 2), elements=st.integers(-1, len(vertices))))
    for chosen in (None, seams):
        try:
            patches = authalic.cut(vertices, faces, seams=chosen)
        except authalic.MeshError:
            continue
        assert sum(len(patch.faces) for patch in patches) == len(faces)


@settings(QUIET, max_examples=300)
@given(any_arrays(), st.data())
def test_any_small_arrays_are_measured_or_refused(mesh, data):
    vertices, faces = mesh
    shape = (len(vertices), data.draw(st.integers(2, 3)))
    image = data.draw(arrays.arrays(float, shape, elements=COORDINATES))
    try:
        figures = authalic.distortion(vertices, faces, image)
    except (authalic.MeshError, authalic.SolverError) as error:
        assert "internal error" not in str(error)
        return
    assert len(figures.log2_area_ratio) == len(faces)
    assert not np.isnan(figures.authalic_energy)
