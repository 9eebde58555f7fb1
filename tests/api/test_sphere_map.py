# SPDX-License-Identifier: MIT OR Apache-2.0
"""Every sphere map is a bijection that preserves areas, whatever the mesh and the density."""

import numpy as np
import pytest

import authalic

from . import meshes, oracle

METHODS = ("gauss_newton", "gradient_descent", "fixed_point")
LINE_SEARCHES = ("interpolation", "bounded")
# meshes with enough vertices to preserve areas better than the conformal start
IMPROVABLE = ("ellipsoid", "bumpy_ball", "rough_ball", "spiky_ball", "capsule")
spheres = pytest.mark.parametrize("name", meshes.SPHERES)
improvable = pytest.mark.parametrize("name", IMPROVABLE)
methods = pytest.mark.parametrize("method", METHODS)
line_searches = pytest.mark.parametrize("line_search", LINE_SEARCHES)


def energy_of(mesh, result, targets=None):
    targets = oracle.face_areas(*mesh) if targets is None else targets
    return oracle.sphere_energy(result.positions, mesh.faces, targets)


def descended(mesh, **options):
    return authalic.sphere_map(*mesh, method="gradient_descent", **options)


@spheres
@methods
@line_searches
def test_the_map_is_a_bijection_onto_the_unit_sphere(name, method, line_search):
    mesh = meshes.SPHERES[name]
    result = authalic.sphere_map(*mesh, method=method, line_search=line_search)
    oracle.assert_sphere_embedding(result)
    assert np.array_equal(result.faces, mesh.faces)


@spheres
@methods
def test_the_start_map_is_a_bijection(name, method):
    result = authalic.sphere_map(*meshes.SPHERES[name], method=method, max_iterations=0)
    oracle.assert_sphere_embedding(result)
    assert result.iterations <= (5 if method == "gauss_newton" else 0)


@spheres
@methods
def test_the_figures_are_those_of_the_map(name, method):
    mesh = meshes.SPHERES[name]
    result = authalic.sphere_map(*mesh, method=method)
    again = authalic.distortion(*mesh, result.positions)
    assert result.distortion.authalic_energy == pytest.approx(energy_of(mesh, result), rel=1e-8, abs=1e-13)
    assert result.distortion.authalic_energy == pytest.approx(again.authalic_energy, rel=1e-9, abs=1e-20)
    assert np.allclose(result.distortion.log2_area_ratio, again.log2_area_ratio, atol=1e-9)
    assert np.allclose(result.distortion.angle_distortion, again.angle_distortion, rtol=1e-6)


@improvable
@methods
def test_areas_are_kept_better_than_by_the_start(name, method):
    mesh = meshes.SPHERES[name]
    start = energy_of(mesh, authalic.sphere_map(*mesh, method=method, max_iterations=0))
    assert energy_of(mesh, authalic.sphere_map(*mesh, method=method)) < 0.6 * start


@improvable
@line_searches
def test_each_method_beats_the_next(name, line_search):
    mesh = meshes.SPHERES[name]
    energies = [
        energy_of(mesh, authalic.sphere_map(*mesh, method=method, line_search=line_search))
        for method in METHODS
    ]
    assert energies == sorted(energies)


@line_searches
def test_gradient_descent_lowers_the_normalized_energy_in_every_step(line_search):
    """E = (|M|/A) Σ a²/|τ|, on the scale |M| = A; runs of one more iteration each share all others."""
    mesh = meshes.bumpy_ball()
    targets, energies = oracle.face_areas(*mesh), []
    for limit in range(10, 25):
        image = descended(mesh, line_search=line_search, max_iterations=limit).positions
        areas = oracle.face_areas(image, mesh.faces)
        energies.append((areas**2 / targets).sum() * targets.sum() / areas.sum())
    assert (np.diff(energies) < 0).all()


def test_both_line_searches_come_to_the_same_energy():
    mesh = meshes.bumpy_ball()
    first, second = (energy_of(mesh, descended(mesh, line_search=search)) for search in LINE_SEARCHES)
    assert 1 / 3 < first / second < 3


@spheres
@methods
def test_the_map_lies_over_the_surface(name, method):
    mesh = meshes.SPHERES[name]
    result = authalic.sphere_map(*mesh, method=method)
    weights = oracle.vertex_weights(mesh.faces, oracle.face_areas(*mesh), len(mesh.vertices))
    oracle.assert_lies_over(result.positions, mesh.vertices, weights)


def test_a_ball_stays_where_it_is():
    mesh = meshes.ball()
    result = authalic.sphere_map(*mesh)
    assert np.linalg.norm(result.positions - mesh.vertices, axis=1).max() < 0.06
    assert result.distortion.area_ratio_std < 0.02


# Density


@methods
def test_image_areas_follow_the_density(method):
    mesh = meshes.ball(4)
    center = mesh.vertices[mesh.faces].mean(axis=1)
    density = oracle.face_areas(*mesh) * np.where(center[:, 2] > 0, 4.0, 1.0)
    result = authalic.sphere_map(*mesh, method=method, density=density, max_iterations=200)
    oracle.assert_sphere_embedding(result)
    share = oracle.solid_angles(result.positions, mesh.faces) / (4 * np.pi)
    wanted = density / density.sum()
    assert share[center[:, 2] > 0].sum() == pytest.approx(0.8, rel=0.01)
    assert np.median(np.abs(share / wanted - 1)) < 0.05
    assert result.distortion.authalic_energy == pytest.approx(energy_of(mesh, result, density), rel=1e-8)


def test_a_map_of_a_density_lies_over_the_surface_by_the_density():
    mesh = meshes.bumpy_ball()
    density = np.random.default_rng(2).uniform(1, 3, len(mesh.faces))
    result = authalic.sphere_map(*mesh, density=density)
    weights = oracle.vertex_weights(mesh.faces, density, len(mesh.vertices))
    oracle.assert_lies_over(result.positions, mesh.vertices, weights)


def test_the_face_areas_are_the_default_density():
    mesh = meshes.bumpy_ball()
    given = authalic.sphere_map(*mesh, density=oracle.face_areas(*mesh), max_iterations=20)
    assert np.abs(given.positions - authalic.sphere_map(*mesh, max_iterations=20).positions).max() < 1e-3


@methods
def test_extreme_densities_leave_no_fold(method):
    mesh = meshes.bumpy_ball()
    density = 10 ** np.random.default_rng(6).uniform(-3, 3, len(mesh.faces))
    oracle.assert_sphere_embedding(authalic.sphere_map(*mesh, density=density, method=method))


# Folds


@pytest.mark.parametrize("method", METHODS[1:])
def test_folds_are_listed_where_they_are_not_unfolded(method):
    mesh = meshes.SPHERES["hedgehog"]
    result = authalic.sphere_map(*mesh, method=method, unfold=False)
    expected = oracle.folded_on_sphere(result.positions, mesh.faces)
    assert len(expected) > 0, "a mesh that tests nothing"
    assert result.distortion.folded.tolist() == expected
    oracle.assert_sphere_embedding(authalic.sphere_map(*mesh, method=method))


@methods
def test_without_folds_nothing_is_unfolded(method):
    mesh = meshes.bumpy_ball()
    plain = authalic.sphere_map(*mesh, method=method, unfold=False)
    assert len(plain.distortion.folded) == 0
    assert np.array_equal(plain.positions, authalic.sphere_map(*mesh, method=method).positions)


@pytest.mark.parametrize("name", ["tetrahedron", "octahedron"])
def test_the_coarsest_meshes_are_mapped_no_worse_than_by_the_start(name):
    mesh = meshes.SPHERES[name]
    start = energy_of(mesh, authalic.sphere_map(*mesh, max_iterations=0))
    assert energy_of(mesh, authalic.sphere_map(*mesh)) <= start + 1e-12


@pytest.mark.parametrize("name", ["tetrahedron", "octahedron", "parallels"])
def test_what_is_a_sphere_already_stays_where_it_is(name):
    mesh = meshes.SPHERES[name]
    points = np.asarray(mesh.vertices, float)
    corners = points[np.asarray(mesh.faces)]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    seen = points - (areas @ corners.mean(axis=1)) / areas.sum()
    seen /= np.linalg.norm(seen, axis=1)[:, None]
    assert np.abs(authalic.sphere_map(*mesh).positions - seen).max() < 1e-6
