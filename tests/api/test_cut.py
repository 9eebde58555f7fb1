# SPDX-License-Identifier: MIT OR Apache-2.0
"""Cutting along seams: patches, their maps back to the input, their topology."""

import numpy as np
import pytest

import authalic

from . import meshes, oracle

BALL, MERIDIAN = meshes.sphere()
UNCUT = {
    **meshes.DISKS,
    "ball": BALL,
    "annulus": meshes.annulus(),
    "plate": meshes.plate_with_holes(),
    "torus": meshes.torus(),
    "moebius": meshes.moebius(),
}


def assert_maps_back(patches, mesh):
    """Every input corner is in one patch corner, with its vertex, its position and its winding."""
    for patch in patches:
        corners, vertices = patch.corner_of, mesh.faces.ravel()[patch.corner_of]
        assert np.array_equal(patch.vertex_of[patch.faces], vertices)
        assert np.array_equal(patch.vertices, mesh.vertices[patch.vertex_of])
        assert np.array_equal(corners, 3 * patch.face_of[:, None] + np.arange(3))
        assert np.array_equal(np.unique(patch.faces), np.arange(len(patch.vertices)))
    every = np.concatenate([patch.corner_of.ravel() for patch in patches])
    assert np.array_equal(np.sort(every), np.arange(mesh.faces.size))


def euler_characteristic(patch):
    edges = np.sort(np.concatenate([patch.faces[:, [0, 1]], patch.faces[:, [1, 2]], patch.faces[:, [2, 0]]]))
    return len(patch.vertices) - len(np.unique(edges, axis=0)) + len(patch.faces)


@pytest.mark.parametrize("mesh", UNCUT.values(), ids=UNCUT)
def test_without_seams_a_connected_mesh_is_one_patch(mesh):
    (patch,) = authalic.cut(*mesh)
    assert_maps_back([patch], mesh)
    assert np.array_equal(patch.faces, mesh.faces)
    assert np.array_equal(patch.vertices, mesh.vertices)
    assert patch.euler_characteristic == euler_characteristic(patch)


@pytest.mark.parametrize(
    ("name", "genus", "loops", "is_disk", "is_closed"),
    [
        ("bumpy_cap", 0, [30], True, False),
        ("slit_sphere", 0, [32], True, False),
        ("ball", 0, [], False, True),
        ("annulus", 0, [40, 40], False, False),
        ("plate", 0, [96, 24, 16, 8], False, False),
        ("torus", 1, [], False, True),
        ("moebius", None, [40], False, False),
    ],
)
def test_topology(name, genus, loops, is_disk, is_closed):
    (patch,) = authalic.cut(*UNCUT[name])
    assert patch.genus == genus
    assert [len(loop) for loop in patch.boundary_loops] == loops
    assert (patch.is_disk, patch.is_closed) == (is_disk, is_closed)


def test_the_boundary_loop_has_the_surface_on_its_left():
    mesh = meshes.bumpy_cap()
    (patch,) = authalic.cut(*mesh)
    loop = patch.boundary_loops[0]
    expected = oracle.boundary_loop(mesh.faces)
    assert np.array_equal(np.roll(loop, -np.argmin(loop)), expected)


def test_seams_that_separate_give_patches_in_the_order_of_their_lowest_faces():
    mesh = meshes.grid(9, 9, aspect=1.0)
    row = np.arange(4 * 9, 5 * 9)
    patches = authalic.cut(*mesh, seams=np.stack([row[1:], row[:-1]], axis=1))
    assert_maps_back(patches, mesh)
    assert [len(patch.faces) for patch in patches] == [64, 64]
    assert [patch.face_of[0] for patch in patches] == [0, 64]
    assert all(patch.is_disk for patch in patches)


def test_a_seam_that_does_not_separate_opens_the_surface():
    mesh = meshes.grid(9, 9, aspect=1.0)
    seams = [[38, 39], [39, 40], [40, 41]]
    (patch,) = authalic.cut(*mesh, seams=seams)
    assert_maps_back([patch], mesh)
    assert len(patch.vertices) == len(mesh.vertices) + 2
    assert [len(loop) for loop in patch.boundary_loops] == [32, 6]


def test_a_single_edge_inside_opens_nothing():
    mesh = meshes.grid(9, 9, aspect=1.0)
    (patch,) = authalic.cut(*mesh, seams=[[39, 40]])
    assert np.array_equal(patch.faces, mesh.faces)


def test_direction_and_repetition_of_seams_do_not_matter():
    once = authalic.cut(*BALL, seams=MERIDIAN)[0]
    twice = authalic.cut(*BALL, seams=np.vstack([MERIDIAN[::-1, ::-1], MERIDIAN]))[0]
    assert np.array_equal(once.faces, twice.faces)


def test_a_sphere_slit_open_is_a_disk_that_can_be_mapped():
    (patch,) = authalic.cut(*BALL, seams=MERIDIAN)
    assert_maps_back([patch], BALL)
    assert patch.is_disk
    assert len(patch.boundary_loops[0]) == 2 * len(MERIDIAN)
    result = authalic.disk_map(patch.vertices, patch.faces)
    oracle.assert_disk_embedding(result)
    assert result.distortion.area_ratio_std < 0.05


def test_uvs_go_back_to_the_corners_of_the_input():
    (patch,) = authalic.cut(*BALL, seams=MERIDIAN)
    uv = authalic.disk_map(patch.vertices, patch.faces).uv
    corner_uv = np.full((BALL.faces.size, 2), np.nan)
    corner_uv[patch.corner_of] = uv[patch.faces]
    areas = oracle.signed_areas(corner_uv, np.arange(BALL.faces.size).reshape(-1, 3))
    assert (areas > 0).all()
    assert areas.sum() == pytest.approx(oracle.signed_areas(uv, patch.faces).sum())


def test_a_torus_cut_along_both_circles_is_a_disk():
    mesh = meshes.torus(18, 10)
    index = np.arange(180).reshape(10, 18)
    circles = [index[0], index[:, 0]]
    seams = np.concatenate([np.stack([circle, np.roll(circle, -1)], axis=1) for circle in circles])
    (patch,) = authalic.cut(*mesh, seams=seams)
    assert_maps_back([patch], mesh)
    assert patch.is_disk
    oracle.assert_disk_embedding(authalic.disk_map(patch.vertices, patch.faces))


def test_a_moebius_strip_cut_across_is_a_disk():
    mesh = meshes.moebius(20)
    (patch,) = authalic.cut(*mesh, seams=[[5, 25], [25, 45]])
    assert patch.is_disk
    oracle.assert_disk_embedding(authalic.disk_map(patch.vertices, patch.faces))


def test_components_come_apart():
    cap, sheet = meshes.bumpy_cap(), meshes.grid()
    n = len(cap.vertices)
    mesh = meshes.Mesh(np.vstack([cap.vertices, sheet.vertices]), np.vstack([cap.faces, sheet.faces + n]))
    patches = authalic.cut(*mesh)
    assert_maps_back(patches, mesh)
    assert len(patches) == 2
    assert np.array_equal(patches[0].faces, cap.faces)
    assert np.array_equal(patches[1].faces, sheet.faces)


def test_edges_of_three_faces_act_as_seams():
    mesh = meshes.Mesh(np.eye(5, 3) + np.arange(5)[:, None], np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]]))
    patches = authalic.cut(*mesh)
    assert_maps_back(patches, mesh)
    assert [len(patch.faces) for patch in patches] == [1, 1, 1]


def test_parts_that_touch_in_a_vertex_come_apart():
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
    mesh = meshes.Mesh(np.array(corners, float), np.array([[0, 1, 2], [0, 3, 4]]))
    patches = authalic.cut(*mesh)
    assert_maps_back(patches, mesh)
    assert [patch.vertex_of.tolist() for patch in patches] == [[0, 1, 2], [0, 3, 4]]


def test_loose_vertices_are_in_no_patch():
    mesh = meshes.bumpy_cap()
    (patch,) = authalic.cut(np.vstack([[9.0, 9, 9], mesh.vertices]), mesh.faces + 1)
    assert np.array_equal(patch.vertex_of, 1 + np.arange(len(mesh.vertices)))


def test_a_seam_that_is_no_edge_is_named():
    mesh = meshes.grid(9, 9)
    with pytest.raises(authalic.MeshError, match="not an edge of the mesh") as caught:
        authalic.cut(*mesh, seams=[[0, 1], [0, 80], [5, 5], [1, 2]])
    assert (caught.value.indices, caught.value.count) == (((0, 80), (5, 5)), 2)


@pytest.mark.parametrize("bad", [-1, 81, 10**12])
def test_a_seam_out_of_range_is_named(bad):
    mesh = meshes.grid(9, 9)
    with pytest.raises(authalic.MeshError, match=str(bad)) as caught:
        authalic.cut(*mesh, seams=[[0, 1], [1, 2], [2, bad], [bad, 3]])
    assert (caught.value.indices, caught.value.count) == ((2, 3), 2)
