# SPDX-License-Identifier: MIT OR Apache-2.0
"""Sphere maps with `refine`: faces that keep areas uneven are split."""

import numpy as np
import pytest

import authalic

from . import meshes, oracle, real_meshes

LIMBED = meshes.limbed_ball(3)


def whole(mesh, result):
    """The surface with its split points, (n + k, 3), the faces, and the images of all."""
    refinement = result.refinement
    vertices = np.concatenate([np.asarray(mesh[0], float), refinement.vertices])
    return vertices, refinement.faces, np.concatenate([result.positions, refinement.positions])


def edges(faces):
    return {
        tuple(sorted((a, b)))
        for face in faces.tolist()
        for a, b in zip(face, face[1:] + face[:1], strict=True)
    }


@pytest.fixture(scope="module")
def refined():
    return authalic.sphere_map(*LIMBED, refine=True)


def test_limbs_become_even(refined):
    plain = authalic.sphere_map(*LIMBED)
    assert refined.status == "converged"
    assert refined.distortion.authalic_energy < 0.1 * plain.distortion.authalic_energy
    assert refined.distortion.area_ratio_std < 0.01
    assert refined.refinement.distortion.authalic_energy < 0.1 * plain.distortion.authalic_energy


def test_the_refined_surface_is_the_same_surface(refined):
    vertices, faces, _ = whole(LIMBED, refined)
    refinement, n = refined.refinement, len(LIMBED[0])
    # 1. Split points halve edges that were there before them
    halves = np.arange(len(refinement.parents))[:, None] + n
    assert (refinement.parents < halves).all() and len(refinement.parents) > 0
    np.testing.assert_allclose(vertices[n:], vertices[refinement.parents].mean(axis=1), rtol=0, atol=1e-12)
    # 2. Parts fill their faces, and have their orientation
    normals = np.cross(
        vertices[faces[:, 1]] - vertices[faces[:, 0]], vertices[faces[:, 2]] - vertices[faces[:, 0]]
    )
    sums = np.zeros((len(LIMBED[1]), 3))
    np.add.at(sums, refinement.face_of, normals)
    a, b, c = np.moveaxis(vertices[refined.faces], 1, 0)
    np.testing.assert_allclose(sums, np.cross(b - a, c - a), rtol=0, atol=1e-12)
    # 3. A closed surface of genus 0, so that no point hangs on an edge
    assert len(vertices) - len(edges(faces)) + len(faces) == 2
    assert (np.diff(refinement.face_of) >= 0).all()


def test_no_part_folds_and_figures_are_those_of_the_parts(refined):
    vertices, faces, positions = whole(LIMBED, refined)
    np.testing.assert_allclose(np.linalg.norm(positions, axis=1), 1, rtol=0, atol=1e-14)
    again = authalic.distortion(vertices, faces, positions)
    of_parts = refined.refinement.distortion
    assert len(again.folded) == len(of_parts.folded) == len(refined.distortion.folded) == 0
    assert again.authalic_energy == pytest.approx(of_parts.authalic_energy, rel=1e-9)
    # whole faces: areas added up
    image, rest = (oracle.face_areas(x, faces) for x in (positions, vertices))
    image, rest = (np.bincount(refined.refinement.face_of, x) for x in (image, rest))
    ratio = image / rest * (rest.sum() / image.sum())
    np.testing.assert_allclose(2**refined.distortion.log2_area_ratio, ratio, rtol=1e-9)
    assert refined.distortion.area_ratio_std == pytest.approx(ratio.std(), rel=1e-9)
    assert refined.distortion.angle_distortion.shape == (len(LIMBED[1]),)
    assert (refined.distortion.angle_distortion >= 1).all()


@pytest.mark.parametrize("name", ["octahedron", "bumpy_ball"])
def test_what_is_even_stays_as_it_is(name):
    mesh = meshes.SPHERES[name]
    plain, refined = (authalic.sphere_map(*mesh, refine=refine) for refine in (False, True))
    assert plain.refinement is None
    assert (refined.positions == plain.positions).all()
    assert refined.refinement.vertices.shape == refined.refinement.positions.shape == (0, 3)
    assert refined.refinement.parents.shape == (0, 2)
    assert (refined.refinement.faces == refined.faces).all()
    assert refined.distortion.authalic_energy == refined.refinement.distortion.authalic_energy


def test_densities_are_shared_out_among_the_parts():
    density = np.where(np.arange(len(LIMBED[1])) % 2 == 0, 1.0, 2.0) * oracle.face_areas(*LIMBED)
    result = authalic.sphere_map(*LIMBED, density=density, refine=True)
    _, faces, positions = whole(LIMBED, result)
    image = np.bincount(result.refinement.face_of, oracle.face_areas(positions, faces))
    ratio = image / density * (density.sum() / image.sum())
    assert ratio.std() < 0.02
    assert result.distortion.area_ratio_std == pytest.approx(ratio.std(), rel=1e-6)


def test_the_result_does_not_depend_on_units(refined):
    vertices, faces = LIMBED
    far = authalic.sphere_map(np.asarray(vertices) * 2.0**400, faces, refine=True)
    assert (far.refinement.faces == refined.refinement.faces).all()
    assert np.isfinite(far.refinement.vertices).all()
    np.testing.assert_allclose(far.refinement.vertices, refined.refinement.vertices * 2.0**400)


def test_the_same_bits_again(refined):
    again = authalic.sphere_map(*LIMBED, refine=True)
    assert (again.positions == refined.positions).all()
    assert (again.refinement.positions == refined.refinement.positions).all()


def test_noise_does_not_move_the_refined_map():
    vertices, faces = LIMBED
    noise = 1e-12 * np.ptp(vertices, axis=0).max() * np.random.default_rng(2).standard_normal(vertices.shape)
    plain, moved = (
        authalic.sphere_map(v, faces, angle_weight=1e-3, refine=True) for v in (vertices, vertices + noise)
    )
    assert (moved.refinement.faces == plain.refinement.faces).all()
    assert np.abs(moved.positions - plain.positions).max() < 1e-6


def test_angles_do_not_make_faces_split():
    """If the weight keeps areas uneven, not the mesh, splitting gains little."""
    result = authalic.sphere_map(*LIMBED, angle_weight=0.3, refine=True)
    assert result.status == "converged" and len(result.refinement.parents) == 0


def test_a_limit_of_iterations_that_was_reached_splits_nothing():
    result = authalic.sphere_map(*LIMBED, max_iterations=5, refine=True)
    assert result.status == "max_iterations" and len(result.refinement.parents) == 0


def test_cancelling_between_rounds_keeps_a_sound_map():
    plain = authalic.sphere_map(*LIMBED).iterations
    seen = []

    def until_refined(fraction, message):
        seen.append(fraction)
        return fraction < 0.45

    result = authalic.sphere_map(*LIMBED, refine=True, progress=until_refined)
    assert result.status == "cancelled" and seen == sorted(seen)
    assert len(result.distortion.folded) == len(result.refinement.distortion.folded) == 0
    assert result.iterations >= plain


def test_only_the_default_method_refines():
    for method in ("fixed_point", "gradient_descent"):
        with pytest.raises(ValueError, match="refine must be off for the papers' methods"):
            authalic.sphere_map(*LIMBED, method=method, refine=True)


@pytest.mark.parametrize("name", ["cat0", "victoria0", "centaur0"])
def test_bodies(name):
    path = real_meshes.file(f"bench/tosca/{name}.npz")
    result = authalic.sphere_map(*real_meshes.load(path), refine=True)
    assert result.status == "converged"
    assert len(result.distortion.folded) == len(result.refinement.distortion.folded) == 0
    assert result.refinement.distortion.area_ratio_std < 0.01
