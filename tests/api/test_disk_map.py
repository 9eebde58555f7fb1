# SPDX-License-Identifier: MIT OR Apache-2.0
"""Every disk map is an embedding that preserves areas, whatever the mesh and the density."""

import numpy as np
import pytest

import authalic

from . import meshes, oracle

# at this E_A gauss_newton has converged
ENOUGH = 4e-8 * np.pi
BOUNDARIES = ("sliding", "arc_length")
METHODS = ("gauss_newton", "conjugate_gradient", "fixed_point")
# meshes on which the harmonic start does not preserve areas best
IMPROVABLE = ("grid", "bumpy_cap", "rough_cap", "slit_sphere", "tube_disk")
disks = pytest.mark.parametrize("name", meshes.DISKS)
improvable = pytest.mark.parametrize("name", IMPROVABLE)
boundaries = pytest.mark.parametrize("boundary", BOUNDARIES)
methods = pytest.mark.parametrize("method", METHODS)


@disks
@boundaries
@methods
def test_the_map_is_an_embedding_into_the_unit_disk(name, boundary, method):
    mesh = meshes.DISKS[name]
    result = authalic.disk_map(*mesh, boundary=boundary, method=method)
    oracle.assert_disk_embedding(result)
    assert np.array_equal(result.faces, mesh.faces)


@disks
@boundaries
def test_the_figures_are_those_of_the_map(name, boundary):
    mesh = meshes.DISKS[name]
    result = authalic.disk_map(*mesh, boundary=boundary)
    again = authalic.distortion(*mesh, result.uv)
    assert result.distortion.authalic_energy == pytest.approx(again.authalic_energy, rel=1e-9, abs=1e-25)
    assert np.allclose(result.distortion.log2_area_ratio, again.log2_area_ratio, atol=1e-9)
    assert np.allclose(result.distortion.angle_distortion, again.angle_distortion, rtol=1e-6)


@improvable
@boundaries
@methods
def test_areas_are_kept_better_than_by_the_start(name, boundary, method):
    energy = authalic.disk_map(*meshes.DISKS[name], boundary=boundary, method=method).history[
        "authalic_energy"
    ]
    assert energy[-1] < 0.35 * energy[0]


@improvable
@boundaries
def test_conjugate_gradients_lower_the_energy_in_every_step(name, boundary):
    result = authalic.disk_map(*meshes.DISKS[name], boundary=boundary, method="conjugate_gradient")
    energy = result.history["authalic_energy"]
    assert len(energy) > 20
    assert (np.diff(energy[5:]) < 0).all()


@improvable
def test_each_method_beats_the_next(name):
    default, descent, fixed = (
        authalic.disk_map(*meshes.DISKS[name], method=method).distortion.authalic_energy for method in METHODS
    )
    assert max(default, ENOUGH) <= max(descent, ENOUGH) < fixed


@improvable
def test_a_sliding_boundary_beats_a_fixed_one(name):
    sliding, fixed = (
        authalic.disk_map(*meshes.DISKS[name], boundary=boundary, max_iterations=300).distortion
        for boundary in BOUNDARIES
    )
    assert sliding.authalic_energy <= fixed.authalic_energy + ENOUGH


@disks
@methods
def test_arc_length_boundaries_have_arcs_proportional_to_the_edges(name, method):
    mesh = meshes.DISKS[name]
    result = authalic.disk_map(*mesh, boundary="arc_length", method=method)
    loop = oracle.boundary_loop(mesh.faces)
    lengths = np.linalg.norm(mesh.vertices[np.roll(loop, -1)] - mesh.vertices[loop], axis=1)
    expected = 2 * np.pi * lengths / lengths.sum()
    assert np.allclose(oracle.boundary_arcs(result.uv, loop), expected, atol=1e-12)


def test_a_sliding_boundary_slides():
    mesh = meshes.bumpy_cap(noise=0.15)
    loop = oracle.boundary_loop(mesh.faces)
    arcs = [
        oracle.boundary_arcs(authalic.disk_map(*mesh, boundary=boundary).uv, loop) for boundary in BOUNDARIES
    ]
    assert np.abs(arcs[0] - arcs[1]).max() > 1e-3


def test_what_can_be_mapped_exactly_is():
    for name in ("fan", "single_triangle", "single_quad"):
        result = authalic.disk_map(*meshes.DISKS[name])
        assert result.status == "converged"
        assert result.distortion.authalic_energy < 1e-20


@boundaries
def test_image_areas_follow_the_density(boundary):
    mesh = meshes.bumpy_cap(20, 40, noise=0)
    center = mesh.vertices[mesh.faces].mean(axis=1)
    density = oracle.face_areas(*mesh) * np.where(center[:, 0] > 0, 4.0, 1.0)
    result = authalic.disk_map(*mesh, boundary=boundary, density=density, max_iterations=300)
    oracle.assert_disk_embedding(result)
    image = oracle.signed_areas(result.uv, mesh.faces)
    share, wanted = image / image.sum(), density / density.sum()
    dense = center[:, 0] > 0
    assert share[dense].sum() == pytest.approx(wanted[dense].sum(), rel=0.01)
    assert np.median(np.abs(share / wanted - 1)) < 0.05
    assert result.distortion.area_ratio_std == pytest.approx((share / wanted).std(), rel=1e-6)


def test_the_scale_of_the_density_does_not_matter():
    mesh = meshes.bumpy_cap()
    density = np.random.default_rng(2).uniform(1, 3, len(mesh.faces))
    plain = authalic.disk_map(*mesh, density=density).uv
    for scale in (1e-9, 0.5, 2.0, 1e9):
        assert np.abs(authalic.disk_map(*mesh, density=scale * density).uv - plain).max() < 1e-3


def test_the_face_areas_are_the_default_density():
    mesh = meshes.bumpy_cap()
    given = authalic.disk_map(*mesh, density=oracle.face_areas(*mesh)).uv
    assert np.abs(given - authalic.disk_map(*mesh).uv).max() < 1e-3


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_extreme_densities_leave_no_fold(boundary):
    mesh = meshes.bumpy_cap()
    density = 10 ** np.random.default_rng(6).uniform(-4, 4, len(mesh.faces))
    oracle.assert_disk_embedding(authalic.disk_map(*mesh, density=density, boundary=boundary))
