# SPDX-License-Identifier: MIT OR Apache-2.0
"""Surfaces with several boundary loops: refused, or filled virtually."""

import numpy as np
import pytest

import authalic

from . import meshes, oracle

HOLED = {"annulus": meshes.annulus(), "plate": meshes.plate_with_holes()}
holed = pytest.mark.parametrize("mesh", HOLED.values(), ids=HOLED)


def assert_embedding(result):
    """No fold by exact arithmetic, and everything in the disk."""
    assert oracle.folded(result.uv, result.faces) == []
    assert len(result.distortion.folded) == 0
    assert np.hypot(*result.uv.T).max() <= 1 + 1e-12


@pytest.mark.parametrize(
    ("name", "sizes", "words"),
    [
        ("annulus", (40, 40), "2 boundary loops of 40, 40 edges"),
        ("plate", (96, 24, 16, 8), "4 boundary loops of 96, 24, 16, 8 edges"),
    ],
)
def test_holes_are_refused_and_named(name, sizes, words):
    mesh = HOLED[name]
    with pytest.raises(authalic.MeshError, match=words) as caught:
        authalic.disk_map(*mesh)
    assert "fill_holes=True" in str(caught.value)
    loops = [set(loop.tolist()) for loop in authalic.cut(*mesh)[0].boundary_loops]
    assert caught.value.count == len(loops)
    assert [len(loop) for loop in loops] == list(sizes)
    assert all(vertex in loop for vertex, loop in zip(caught.value.indices, loops, strict=True))


@holed
@pytest.mark.parametrize("boundary", ["sliding", "arc_length"])
@pytest.mark.parametrize("method", ["conjugate_gradient", "fixed_point"])
def test_filled_holes_give_an_embedding_of_the_real_faces(mesh, boundary, method):
    result = authalic.disk_map(*mesh, fill_holes=True, boundary=boundary, method=method)
    assert_embedding(result)
    assert result.uv.shape == (len(mesh.vertices), 2)
    assert np.array_equal(result.faces, mesh.faces)
    assert len(result.distortion.log2_area_ratio) == len(mesh.faces)


@holed
def test_the_longest_loop_runs_around_the_circle(mesh):
    result = authalic.disk_map(*mesh, fill_holes=True)
    outer, *inner = authalic.cut(*mesh)[0].boundary_loops
    assert np.abs(np.hypot(*result.uv[outer].T) - 1).max() < 1e-12
    arcs = oracle.boundary_arcs(result.uv, outer)
    assert (arcs > 0).all()
    assert arcs.sum() == pytest.approx(2 * np.pi)
    assert all(np.hypot(*result.uv[loop].T).max() < 1 for loop in inner)


@holed
def test_the_real_faces_keep_their_areas(mesh):
    figures = authalic.disk_map(*mesh, fill_holes=True, max_iterations=200).distortion
    ratio = 2**figures.log2_area_ratio
    assert figures.area_ratio_std < 0.05
    assert ((ratio > 0.8) & (ratio < 1.25)).mean() > 0.99


def test_a_flat_annulus_keeps_its_hole():
    mesh = HOLED["annulus"]
    uv = authalic.disk_map(*mesh, fill_holes=True, max_iterations=200).uv
    radius = np.hypot(*uv.T).reshape(5, 40)
    assert np.allclose(radius[-1], 0.4, atol=0.02)


def test_filling_changes_nothing_without_holes():
    mesh = meshes.bumpy_cap()
    assert np.array_equal(authalic.disk_map(*mesh, fill_holes=True).uv, authalic.disk_map(*mesh).uv)


def test_densities_hold_on_a_surface_with_holes():
    mesh = HOLED["plate"]
    center = mesh.vertices[mesh.faces].mean(axis=1)
    density = oracle.face_areas(*mesh) * np.where(center[:, 0] > 0.5, 3.0, 1.0)
    result = authalic.disk_map(*mesh, fill_holes=True, density=density, max_iterations=300)
    assert_embedding(result)
    image, dense = oracle.signed_areas(result.uv, mesh.faces), center[:, 0] > 0.5
    assert image[dense].sum() / image.sum() == pytest.approx(density[dense].sum() / density.sum(), rel=0.02)


@pytest.mark.parametrize("corners", [[0], [0, 1]])
def test_the_smallest_holes_are_filled(corners):
    """One or two missing faces leave loops of three and four edges."""
    mesh = meshes.grid(9, 9, aspect=1.0)
    middle = 8 * 8 + 8
    solid = np.setdiff1d(np.arange(len(mesh.faces)), middle + np.array(corners))
    result = authalic.disk_map(mesh.vertices, mesh.faces[solid], fill_holes=True)
    assert_embedding(result)


def test_many_holes_are_filled():
    mesh = meshes.grid(31, 31, aspect=1.0)
    column, row = np.divmod(np.arange(len(mesh.faces)) // 2, 30)
    holes = (column % 3 == 1) & (row % 3 == 1)
    result = authalic.disk_map(mesh.vertices, mesh.faces[~holes], fill_holes=True)
    assert_embedding(result)


def test_a_slit_of_no_area_is_filled():
    mesh = meshes.grid(9, 9, aspect=1.0)
    seams = np.stack([np.arange(37, 42), np.arange(38, 43)], axis=1)
    (patch,) = authalic.cut(*mesh, seams=seams)
    assert [len(loop) for loop in patch.boundary_loops] == [32, 10]
    assert_embedding(authalic.disk_map(patch.vertices, patch.faces, fill_holes=True))


def test_a_closed_surface_stays_refused():
    with pytest.raises(authalic.MeshError, match="closed"):
        authalic.disk_map(*meshes.sphere()[0], fill_holes=True)


def test_handles_stay_refused():
    mesh = meshes.torus()
    with pytest.raises(authalic.MeshError, match="genus 1"):
        authalic.disk_map(mesh.vertices, mesh.faces[1:], fill_holes=True)
