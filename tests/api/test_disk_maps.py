# SPDX-License-Identifier: MIT OR Apache-2.0
"""Many maps in one go are those of each surface alone; flat and developable islands keep their shapes."""

import numpy as np
import pytest

import authalic

OPTIONS = {"boundary": "free", "angle_weight": 1e-3, "fill_holes": True}


def hills(rows, columns, seed):
    """A random graph over a grid of quads."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0))
    points = np.stack([x.ravel(), y.ravel(), 0.4 * rng.normal(size=x.size)], axis=1)
    number = np.arange(x.size).reshape(x.shape)
    quads = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], -1).reshape(-1, 4)
    return points, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def lengths(points, faces):
    """The lengths of the edges of triangles."""
    return np.linalg.norm(points[faces] - points[np.roll(faces, 1, axis=1)], axis=2)


def assert_isometric(points, faces, uv):
    """All edges have the same length in space and in the plane, up to one scale."""
    ratio = lengths(uv, faces) / lengths(points, faces)
    assert np.ptp(ratio) <= 1e-9 * ratio.mean()


def test_many_maps_are_those_of_each_surface_alone():
    meshes = [hills(1 + seed % 4, 2 + seed % 5, seed) for seed in range(40)] + [hills(50, 50, 99)]
    for mesh, each in zip(meshes, authalic.disk_maps(meshes, **OPTIONS), strict=True):
        alone = authalic.disk_map(*mesh, **OPTIONS)
        np.testing.assert_array_equal(each.uv, alone.uv)
        assert (each.status, each.iterations) == (alone.status, alone.iterations)
        assert len(each.history) == each.iterations + 1


def test_what_has_no_map_has_its_error_in_its_place():
    closed = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    first, second, third = authalic.disk_maps([hills(2, 2, 0), closed, hills(2, 3, 1)], **OPTIONS)
    assert isinstance(first, authalic.DiskMap)
    assert isinstance(third, authalic.DiskMap)
    assert isinstance(second, authalic.MeshError)
    assert second.kind == "closed_surface"


def test_options_out_of_range_are_refused_for_all():
    with pytest.raises(ValueError, match="angle_weight"):
        authalic.disk_maps([hills(2, 2, 0)], angle_weight=-1.0)
    with pytest.raises(authalic.MeshError, match="densities must be of length 1"):
        authalic.disk_maps([hills(2, 2, 0)], densities=[None, None])


def test_each_surface_has_a_density_of_its_own():
    mesh = hills(3, 3, 0)
    density = np.linspace(1.0, 2.0, len(mesh[1]))
    _, dense = authalic.disk_maps([mesh, mesh], densities=[None, density], **OPTIONS)
    np.testing.assert_array_equal(dense.uv, authalic.disk_map(*mesh, density=density, **OPTIONS).uv)


def test_a_run_that_ends_early_leaves_out_what_was_not_begun():
    heard = []

    def progress(fraction, message):
        heard.append((fraction, message))
        return not message.startswith("Island 2")

    meshes = [hills(50, 50, seed) for seed in range(4)]
    maps = authalic.disk_maps(meshes, progress=progress, **OPTIONS)
    assert [each is None for each in maps] == [False, True, True, True]
    assert heard[0] == (0.0, "Island 1 of 4")
    assert [fraction for fraction, _ in heard] == sorted(fraction for fraction, _ in heard)


def test_many_figures_are_those_of_each_map_alone():
    meshes = [hills(2, 3, seed) for seed in range(10)]
    images = [authalic.disk_map(*mesh, **OPTIONS).uv.astype(np.float32) for mesh in meshes]
    images[3] = images[3][:, ::-1]
    every = authalic.distortions(meshes, images)
    for mesh, image, each in zip(meshes, images, every, strict=True):
        alone = authalic.distortion(*mesh, image)
        assert each.area_ratio_std == alone.area_ratio_std
        np.testing.assert_array_equal(each.angle_distortion, alone.angle_distortion)
        np.testing.assert_array_equal(each.folded, alone.folded)
    assert len(every[3].folded) == len(meshes[3][1])
    collapsed = authalic.distortions([meshes[0]], [np.zeros_like(images[0])])
    assert isinstance(collapsed[0], authalic.MeshError)


@pytest.mark.parametrize("weight", [0.0, 1e-3, 0.3, 30.0])
def test_a_strip_a_hundred_times_as_long_as_wide_keeps_its_shape(weight):
    x, y = np.meshgrid(np.arange(101.0), [0.0, 1.0])
    points = np.stack([x.ravel(), np.zeros(x.size), y.ravel()], axis=1)
    first = np.arange(100)
    faces = np.concatenate(
        [np.stack([first, first + 1, first + 102], 1), np.stack([first, first + 102, first + 101], 1)]
    )
    result = authalic.disk_map(points, faces, boundary="free", angle_weight=weight)
    assert result.status == "converged"
    assert_isometric(points, faces, result.uv)


def test_the_side_of_a_frustum_unrolls():
    angles = np.linspace(0, 2 * np.pi, 33)
    ring = np.stack([np.cos(angles), np.sin(angles), np.zeros(33)], axis=1)
    points = np.concatenate([ring, 0.4 * ring + [0, 0, 2]])
    first = np.arange(32)
    faces = np.concatenate(
        [np.stack([first, first + 1, first + 34], 1), np.stack([first, first + 34, first + 33], 1)]
    )
    result = authalic.disk_map(points, faces, boundary="free", angle_weight=0.3)
    assert result.status == "converged"
    assert_isometric(points, faces, result.uv)


def test_a_quad_folded_along_its_diagonal_and_a_flat_grid_with_a_hole_keep_their_shapes():
    folded = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.7], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
    points, faces = hills(3, 3, 0)
    points[:, 2] = points @ [0.3, 0.5, 0.0]
    middle = np.isin(faces, [5, 6, 9, 10]).all(axis=1)
    for mesh in (folded, (points, faces[~middle])):
        assert_isometric(*mesh, authalic.disk_map(*mesh, **OPTIONS).uv)
