# SPDX-License-Identifier: MIT OR Apache-2.0
"""Open surfaces mapped onto the sphere, with their holes filled for the time of the map."""

import numpy as np
import pytest

import authalic

from . import meshes, oracle


def without_vertices(mesh, lost):
    """The mesh without some vertices and the faces at them, and the numbers of the faces that are left."""
    kept = np.flatnonzero(~np.isin(mesh.faces, lost).any(axis=1))
    return meshes.compact(meshes.Mesh(mesh.vertices, mesh.faces[kept])), kept


def assert_embedded(mapped):
    assert len(mapped.distortion.folded) == 0
    assert oracle.folded_on_sphere(mapped.positions, mapped.faces) == []
    assert np.allclose(np.linalg.norm(mapped.positions, axis=1), 1, atol=1e-12)


def test_holes_of_any_number_and_size_are_filled():
    whole = meshes.bumpy_ball(4)
    up = whole.vertices @ [0.2, 0.3, 1.0]
    lost = np.concatenate([np.flatnonzero(up > np.quantile(up, 0.93)), np.argsort(up)[[0, 300]]])
    mesh, _ = without_vertices(whole, lost)
    loops = [len(loop) for loop in authalic.Surface(*mesh).boundary_loops]
    assert len(loops) == 3
    assert max(loops) > 20
    with pytest.raises(authalic.MeshError, match=r"3 boundary loops .* \(fill_holes=True fills them\)"):
        authalic.sphere_map(*mesh)
    mapped = authalic.sphere_map(*mesh, fill_holes=True)
    assert mapped.positions.shape == mesh.vertices.shape
    assert np.array_equal(mapped.faces, mesh.faces)
    assert_embedded(mapped)
    # the areas of the given faces are even, and what they leave of the sphere is the holes' share
    share = oracle.solid_angles(mapped.positions, mapped.faces)
    areas = oracle.face_areas(*mesh)
    ratio = share / areas / (share.sum() / areas.sum())
    assert ratio.std() < 0.03
    assert mapped.distortion.area_ratio_std == pytest.approx(ratio.std(), abs=5e-3)
    filled = authalic.repair(*mesh, close_holes=True)
    expected = areas.sum() / oracle.face_areas(filled.vertices, filled.faces).sum()
    assert share.sum() / (4 * np.pi) == pytest.approx(expected, rel=0.02)


def test_a_hemisphere_covers_its_part_of_the_sphere():
    ball = meshes.ball(3)
    is_upper = ball.vertices[ball.faces, 2].mean(axis=1) > 0
    cap = meshes.compact(meshes.Mesh(ball.vertices, ball.faces[is_upper]))
    mapped = authalic.sphere_map(*cap, fill_holes=True)
    assert_embedded(mapped)
    # a disk of area pi fills the rim of a half of area 2 pi
    share = oracle.solid_angles(mapped.positions, mapped.faces).sum() / (4 * np.pi)
    assert share == pytest.approx(2 / 3, abs=0.01)


def test_closed_surfaces_are_mapped_as_ever():
    mesh = meshes.bumpy_ball(2)
    filled = authalic.sphere_map(*mesh, fill_holes=True)
    assert np.array_equal(filled.positions, authalic.sphere_map(*mesh).positions)


def test_densities_hold_on_a_surface_with_holes():
    mesh, _ = without_vertices(meshes.ball(3), [5, 60])
    dense = mesh.vertices[mesh.faces, 0].mean(axis=1) > 0
    density = oracle.face_areas(*mesh) * np.where(dense, 3.0, 1.0)
    mapped = authalic.sphere_map(*mesh, fill_holes=True, density=density)
    assert_embedded(mapped)
    share = oracle.solid_angles(mapped.positions, mapped.faces)
    assert share[dense].sum() / share.sum() == pytest.approx(density[dense].sum() / density.sum(), rel=0.01)


def test_options_that_need_the_fillings_are_refused():
    mesh, _ = without_vertices(meshes.ball(2), [0])
    with pytest.raises(ValueError, match="initial must be left out where holes are filled"):
        authalic.sphere_map(*mesh, fill_holes=True, initial=mesh.vertices)
    with pytest.raises(ValueError, match="refine must be left out where holes are filled"):
        authalic.sphere_map(*mesh, fill_holes=True, refine=True)


@pytest.mark.parametrize("kind", ["lambert", "octahedral"])
def test_an_open_map_is_laid_out_with_its_hole(kind):
    mesh, _ = without_vertices(meshes.ball(3), [0])
    layout = authalic.sphere_map(*mesh, fill_holes=True).layout(kind)
    assert layout.faces.shape == mesh.faces.shape
    assert oracle.folded(layout.points, layout.faces) == []


def test_handles_stay_refused():
    mesh = meshes.torus()
    with pytest.raises(authalic.MeshError, match="genus 1"):
        authalic.sphere_map(mesh.vertices, mesh.faces[1:], fill_holes=True)


def test_small_holes_are_closed_and_large_ones_filled_by_both_options():
    whole = meshes.bumpy_ball(3)
    up = whole.vertices[:, 2]
    mesh, _ = without_vertices(whole, np.append(np.flatnonzero(up > np.quantile(up, 0.95)), up.argmin()))
    mapped = authalic.sphere_map(*mesh, fill_holes=True, repair=True)
    assert mapped.repaired.counts["closed_holes"] == 1
    assert len(mapped.repaired.surface.boundary_loops) == 1
    assert_embedded(mapped)
