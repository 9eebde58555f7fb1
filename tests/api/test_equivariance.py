# SPDX-License-Identifier: MIT OR Apache-2.0
"""The same surface, placed, scaled, numbered or oriented in another way, has the same disk map."""

import numpy as np
import pytest

import authalic

from . import meshes, oracle

# those whose maps take many iterations
CURVED = ("grid", "bumpy_cap", "rough_cap", "slit_sphere", "tube_disk")
disks = pytest.mark.parametrize("name", meshes.DISKS)
curved = pytest.mark.parametrize("name", CURVED)
boundaries = pytest.mark.parametrize("boundary", ("sliding", "arc_length"))


def moved(vertices, scale):
    turn, _ = np.linalg.qr(np.random.default_rng(4).standard_normal((3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    return scale * (vertices @ turn + [3.0, -2.0, 5.0])


@pytest.mark.parametrize("scale", [1.0, 1e8, 1e-8])
@disks
@boundaries
def test_a_surface_moved_and_scaled_has_the_same_map(name, boundary, scale):
    mesh = meshes.DISKS[name]
    here = authalic.disk_map(*mesh, boundary=boundary).uv
    there = authalic.disk_map(moved(mesh.vertices, scale), mesh.faces, boundary=boundary).uv
    assert np.abs(there - here).max() < 1e-6


@pytest.mark.parametrize("scale", [2.0**300, 2.0**-300])
def test_a_power_of_two_changes_no_bit(scale):
    mesh = meshes.bumpy_cap()
    assert np.array_equal(
        authalic.disk_map(scale * mesh.vertices, mesh.faces).uv, authalic.disk_map(*mesh).uv
    )


@curved
@boundaries
def test_the_numbering_of_the_vertices_does_not_matter(name, boundary):
    """The start turns with the boundary vertex of the lowest number; areas do not see it."""
    mesh = meshes.DISKS[name]
    order = np.random.default_rng(8).permutation(len(mesh.vertices))
    place = np.argsort(order)
    plain = authalic.disk_map(*mesh, boundary=boundary)
    other = authalic.disk_map(mesh.vertices[order], place[mesh.faces], boundary=boundary)
    assert_same_areas(plain, other, slice(None))


@curved
@boundaries
def test_the_order_of_the_faces_does_not_matter(name, boundary):
    mesh = meshes.DISKS[name]
    order = np.random.default_rng(9).permutation(len(mesh.faces))
    turned = np.roll(mesh.faces[order], 1, axis=1)
    plain = authalic.disk_map(*mesh, boundary=boundary)
    other = authalic.disk_map(mesh.vertices, turned, boundary=boundary)
    assert_same_areas(plain, other, order)
    assert np.abs(plain.uv - other.uv).max() < 1e-6


def assert_same_areas(plain, other, order):
    """Equal but for rounding, which 50 iterations may enlarge by some orders of magnitude."""
    before, after = plain.distortion, other.distortion
    assert after.authalic_energy == pytest.approx(before.authalic_energy, rel=1e-5, abs=1e-10)
    assert np.allclose(after.log2_area_ratio, before.log2_area_ratio[order], atol=1e-5)


@disks
@boundaries
def test_the_other_orientation_gives_the_mirrored_map(name, boundary):
    mesh = meshes.DISKS[name]
    plain = authalic.disk_map(*mesh, boundary=boundary)
    mirrored = authalic.disk_map(mesh.vertices, mesh.faces[:, ::-1], boundary=boundary)
    oracle.assert_disk_embedding(mirrored)
    assert np.array_equal(mirrored.faces, mesh.faces[:, ::-1])
    assert np.abs(mirrored.uv * [1, -1] - plain.uv).max() < 1e-6


def test_faces_turned_against_the_rest_are_turned_and_reported():
    mesh = meshes.bumpy_cap()
    turned = mesh.faces.copy()
    turned[50:90] = turned[50:90, [0, 2, 1]]
    result = authalic.disk_map(mesh.vertices, turned)
    assert np.array_equal(result.faces, mesh.faces)
    assert np.array_equal(result.uv, authalic.disk_map(*mesh).uv)
