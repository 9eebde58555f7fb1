# SPDX-License-Identifier: MIT OR Apache-2.0
"""Real meshes: those of tests/data, and those of a data folder, AUTHALIC_DATA or ../shared/data."""

import numpy as np
import pytest

import authalic

from . import oracle, real_meshes

PUBLISHED = {"chineselion_17334": 4.7e-4, "hand_53054": 3.2e-3}
"""Bounds of E_A after 50 conjugate gradients on a fixed boundary; Liu & Yueh have 4.29e-4 and 2.88e-3."""


@real_meshes.each("disk")
def test_real_disks_have_no_fold(path):
    mesh = real_meshes.load(path)
    result = authalic.disk_map(*mesh)
    oracle.assert_disk_embedding(result)
    targets = oracle.face_areas(mesh.vertices, result.faces)
    energy = oracle.authalic_energy(result.uv, result.faces, targets)
    assert result.distortion.authalic_energy == pytest.approx(energy, rel=1e-6)
    assert result.distortion.area_ratio_std < 0.05


@pytest.mark.parametrize("name", PUBLISHED)
def test_the_paper_is_reproduced(name):
    path = real_meshes.file(f"disk/{name}.npz")
    result = authalic.disk_map(*real_meshes.load(path), boundary="arc_length", max_iterations=50)
    oracle.assert_disk_embedding(result)
    assert result.distortion.authalic_energy <= PUBLISHED[name]


@real_meshes.each("hard")
@pytest.mark.parametrize("fill_holes", [False, True])
def test_hard_meshes_are_refused_or_mapped_without_a_fold(path, fill_holes):
    mesh = real_meshes.load(path)
    try:
        result = authalic.disk_map(*mesh, fill_holes=fill_holes)
    except authalic.MeshError as error:
        assert len(str(error)) > 30
        return
    assert oracle.folded(result.uv, result.faces) == []
    assert np.hypot(*result.uv.T).max() <= 1 + 1e-12


@pytest.mark.parametrize("name", ["mannequindevil_12977", "maze_6120"])
def test_hard_disks_are_mapped(name):
    path = real_meshes.file(f"hard/{name}.npz")
    oracle.assert_disk_embedding(authalic.disk_map(*real_meshes.load(path)))


@real_meshes.each("hard")
def test_hard_meshes_are_cut_into_their_patches(path):
    mesh = real_meshes.load(path)
    patches = authalic.cut(*mesh)
    corners = np.concatenate([patch.corner_of.ravel() for patch in patches])
    assert np.array_equal(np.sort(corners), np.arange(mesh.faces.size))


@real_meshes.each("hard")
def test_every_patch_of_a_hard_mesh_is_refused_or_mapped_without_a_fold(path):
    for patch in authalic.cut(*real_meshes.load(path)):
        try:
            result = authalic.disk_map(patch.vertices, patch.faces, fill_holes=True)
        except authalic.MeshError:
            continue
        assert oracle.folded(result.uv, result.faces) == []


SPHERE_BOUNDS = {"david_10671": 3.3e-3, "bulldog_49797": 1.4e-2}
"""Bounds of E_A after 100 steps of gradient descent; Sutti & Yueh have 3.04e-3 and 1.27e-2."""


@real_meshes.each("sphere")
def test_the_start_map_of_a_real_closed_surface_has_no_fold(path):
    result = authalic.sphere_map(*real_meshes.load(path), method="fixed_point", max_iterations=0)
    assert result.iterations == 0
    oracle.assert_sphere_embedding(result)


@real_meshes.each("sphere")
def test_real_closed_surfaces_have_no_fold(path):
    mesh = real_meshes.load(path)
    result = authalic.sphere_map(*mesh)
    oracle.assert_sphere_embedding(result)
    targets = oracle.face_areas(mesh.vertices, result.faces)
    energy = oracle.sphere_energy(result.positions, result.faces, targets)
    assert result.distortion.authalic_energy == pytest.approx(energy, rel=1e-6)
    assert energy <= SPHERE_BOUNDS.get(path.stem, np.inf)
    weights = oracle.vertex_weights(result.faces, targets, len(mesh.vertices))
    oracle.assert_lies_over(result.positions, mesh.vertices, weights)


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("surface", ["V_white", "V_pial"])
def test_the_cortex_is_mapped_better_than_by_freesurfer(side, surface):
    path = real_meshes.file(f"brain/fsaverage5_{side}_10242.npz")
    with np.load(path) as file:
        vertices, faces, sphere = (file[name].astype(float) for name in (surface, "F", "V_sphere"))
    result = authalic.sphere_map(vertices, faces)
    oracle.assert_sphere_embedding(result)
    sphere /= np.linalg.norm(sphere, axis=1)[:, None]
    freesurfer = authalic.distortion(vertices, faces, sphere)
    assert result.distortion.area_ratio_std < 0.2 * freesurfer.area_ratio_std


def test_slivers_are_mapped_soundly_or_given_up():
    path = real_meshes.file("hard/triceratops_2832.npz")
    try:
        oracle.assert_sphere_embedding(authalic.sphere_map(*real_meshes.load(path)))
    except authalic.SolverError as error:
        assert "no map without folds" in str(error)


@real_meshes.each("hard")
def test_hard_closed_surfaces_are_refused_or_mapped_without_a_fold(path):
    try:
        result = authalic.sphere_map(*real_meshes.load(path), max_iterations=20)
    except (authalic.MeshError, authalic.SolverError) as error:
        assert len(str(error)) > 30
        assert "internal error" not in str(error)
        return
    oracle.assert_sphere_embedding(result)


def test_a_cheese_is_no_sphere():
    path = real_meshes.file("hard/cheese_8629.npz")
    with pytest.raises(authalic.MeshError, match=r"genus 133 .*seams"):
        authalic.sphere_map(*real_meshes.load(path))


@real_meshes.each("sphere")
def test_real_closed_surfaces_are_told_to_mark_seams(path):
    with pytest.raises(authalic.MeshError, match="seams"):
        authalic.disk_map(*real_meshes.load(path))
