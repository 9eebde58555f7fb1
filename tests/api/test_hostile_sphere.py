# SPDX-License-Identifier: MIT OR Apache-2.0
"""Input that is no sphere: a MeshError that names the elements at fault, or a sound map; never a crash."""

import hypothesis.extra.numpy as arrays
import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings

import authalic

from . import meshes, oracle
from .test_hostile import CAP, QUIET, any_arrays, refused, replaced

# What is no sphere

BALL = meshes.bumpy_ball()


def no_sphere(vertices, faces, words):
    return refused(vertices, faces, words, call=authalic.sphere_map)


def test_a_surface_with_a_boundary_is_told_to_close_it():
    indices, count = no_sphere(*CAP, "a boundary loop of 30 edges.*close the holes, or .* disk_map")
    assert count == 1
    assert indices[0] in oracle.boundary_loop(CAP.faces)


def test_every_boundary_is_named():
    indices, count = no_sphere(*meshes.annulus(), "2 boundary loops of 40, 40 edges")
    assert count == 2
    assert sorted(vertex // 40 for vertex in indices) == [0, 4]


def test_one_missing_face_is_a_boundary():
    corners = BALL.faces[77]
    indices, count = no_sphere(BALL.vertices, np.delete(BALL.faces, 77, axis=0), "a boundary loop of 3 edges")
    assert count == 1
    assert indices[0] in corners


def test_a_torus_is_told_to_cut_its_handle():
    assert no_sphere(*meshes.torus(), "genus 1 .*seams.*disk_map") == ((), 0)


def test_two_balls_are_two_pieces():
    vertices = np.vstack([BALL.vertices, BALL.vertices + 5])
    faces = np.vstack([BALL.faces, BALL.faces + len(BALL.vertices)])
    assert no_sphere(vertices, faces, "2 separate pieces") == ((0, 512), 2)


def test_the_faults_of_any_mesh_are_those_of_spheres_too():
    n = len(BALL.vertices)
    loose = np.vstack([BALL.vertices, np.ones((2, 3))])
    assert no_sphere(loose, BALL.faces, "2 vertices .258, 259. without a face") == ((n, n + 1), 2)
    twice = np.vstack([BALL.faces, BALL.faces[7:8, [1, 2, 0]]])
    assert no_sphere(BALL.vertices, twice, "repeating the vertices of an earlier face") == ((512,), 1)
    missing = replaced(BALL.vertices, [3, 7], np.nan)
    assert no_sphere(missing, BALL.faces, "NaN or infinite coordinates at 2 vertices") == ((3, 7), 2)
    assert no_sphere(np.ones_like(BALL.vertices), BALL.faces, "no area")[1] == 512
    assert no_sphere(*meshes.moebius(), "not orientable")[1] >= 1


def test_a_fin_on_a_ball_is_no_manifold():
    vertices = np.vstack([BALL.vertices, [[0, 0, 9]]])
    a, b, _ = BALL.faces[100]
    indices, count = no_sphere(
        vertices, np.vstack([BALL.faces, [[a, b, 258]]]), "more than two faces at edge"
    )
    assert (sorted(indices[0]), count) == (sorted([a, b]), 1)


def test_two_balls_that_touch_in_a_point_are_refused():
    faces = BALL.faces + len(BALL.vertices)
    faces[faces == faces.max()] = 0
    vertices = np.vstack([BALL.vertices, BALL.vertices + 5])[:-1]
    assert no_sphere(vertices, np.vstack([BALL.faces, faces]), "touch only in a point") == ((0,), 1)


# Closed surfaces that lie badly


@pytest.mark.parametrize("scale", [1e300, 1e-300, 1e150, 1e-150])
def test_huge_and_tiny_closed_surfaces_work(scale):
    plain = authalic.sphere_map(*BALL, max_iterations=12)
    result = authalic.sphere_map(scale * BALL.vertices, BALL.faces, max_iterations=12)
    oracle.assert_sphere_embedding(result)
    assert np.abs(result.positions - plain.positions).max() < 1e-3


def test_a_closed_surface_up_to_the_largest_number():
    largest = np.finfo(float).max
    vertices = BALL.vertices / np.abs(BALL.vertices).max() * largest
    oracle.assert_sphere_embedding(authalic.sphere_map(vertices, BALL.faces, max_iterations=12))


def test_a_small_ball_far_from_the_origin():
    oracle.assert_sphere_embedding(authalic.sphere_map(BALL.vertices + 1e8, BALL.faces))


@pytest.mark.parametrize("aspect", [1e3, 1e6, 1e9])
def test_a_ball_as_flat_as_a_coin(aspect):
    oracle.assert_sphere_embedding(authalic.sphere_map(BALL.vertices * [1, 1, 1 / aspect], BALL.faces))


@pytest.mark.parametrize("aspect", [30, 1e3])
def test_a_ball_as_thin_as_a_needle(aspect):
    oracle.assert_sphere_embedding(authalic.sphere_map(BALL.vertices * [1, 1, aspect], BALL.faces))


@pytest.mark.parametrize("seed", range(6))
def test_a_crumpled_ball(seed):
    """Random positions: no face lies well, yet the surface is a sphere."""
    vertices = np.random.default_rng(seed).standard_normal(BALL.vertices.shape)
    oracle.assert_sphere_embedding(authalic.sphere_map(vertices, BALL.faces))


def test_a_ball_of_faces_of_very_different_sizes():
    height = (BALL.vertices[:, 2:] - BALL.vertices[:, 2].min() + 0.05) ** 6
    oracle.assert_sphere_embedding(authalic.sphere_map(BALL.vertices * height, BALL.faces))


# Anything at all


def sphere_or_refuse(vertices, faces, **options):
    try:
        result = authalic.sphere_map(vertices, faces, max_iterations=20, **options)
    except (authalic.MeshError, authalic.SolverError) as error:
        assert "internal error" not in str(error)
        return error
    oracle.assert_sphere_embedding(result)
    assert np.isfinite(result.distortion.authalic_energy)
    return None


@st.composite
def spheres_of_any_shape(draw):
    """A tetrahedron with faces split and edges flipped at random; positions at random."""
    faces, n = [list(face) for face in meshes.tetrahedron().faces], 4
    for _ in range(draw(st.integers(0, 14))):
        chosen = draw(st.integers(0, len(faces) - 1))
        a, b, c = faces[chosen]
        neighbor = next(k for k, face in enumerate(faces) if k != chosen and {a, b} <= set(face))
        d = next(v for v in faces[neighbor] if v not in (a, b))
        joined = any({c, d} <= set(face) for face in faces)
        if joined or draw(st.booleans()):
            faces[chosen : chosen + 1] = [[a, b, n], [b, c, n], [c, a, n]]
            n += 1
        else:
            faces[chosen], faces[neighbor] = [c, a, d], [d, b, c]
    return draw(arrays.arrays(float, (n, 3), elements=st.integers(-9, 9).map(float))), np.array(faces)


@settings(QUIET, max_examples=300)
@given(spheres_of_any_shape(), st.sampled_from(["gradient_descent", "fixed_point"]), st.booleans())
def test_any_closed_surface_of_genus_0_is_mapped_without_a_fold(mesh, method, weighted):
    vertices, faces = mesh
    density = np.exp(np.arange(len(faces)) % 5.0) if weighted else None
    error = sphere_or_refuse(vertices, faces, method=method, density=density)
    assert error is None or "no area" in str(error)


@settings(QUIET, max_examples=300)
@given(any_arrays())
def test_any_small_arrays_are_mapped_to_the_sphere_or_refused(mesh):
    sphere_or_refuse(*mesh)
