# SPDX-License-Identifier: MIT OR Apache-2.0
"""Maps onto a rectangle: corners, sides, aspect, and no folds."""

import numpy as np
import pytest

import authalic

from . import meshes
from .oracle import folded


def rectangle(mesh, **options):
    return authalic.disk_map(*mesh, boundary="rectangle", **options)


def rim_of(mesh):
    """The boundary vertices, counter-clockwise."""
    (patch,) = authalic.cut(*mesh)
    return patch.vertex_of[max(patch.boundary_loops, key=len)]


def check(result, mesh):
    """No folds, and the boundary runs once around the rectangle."""
    assert len(folded(result.uv, result.faces)) == 0
    assert len(result.distortion.folded) == 0
    (width, height), rim = result.uv.max(axis=0), rim_of(mesh)
    assert (result.uv.min(axis=0) == 0).all()
    assert max(width, height) == 1
    u, v = result.uv[rim].T
    assert ((u == 0) | (u == width) | (v == 0) | (v == height)).all()
    corners = [
        ((result.uv == corner).all(axis=1)).sum()
        for corner in ((0, 0), (width, 0), (width, height), (0, height))
    ]
    assert corners == [1] * 4
    return width / height


def turned(mesh, seed):
    """The surface, turned in space."""
    frame, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return meshes.Mesh(mesh.vertices @ frame * 7, mesh.faces)


@pytest.mark.parametrize("weight", [0.0, 0.03, 0.3])
@pytest.mark.parametrize(
    ("rows", "columns", "aspect"), [(9, 13, 1.5), (2, 2, 1.0), (2, 30, 20.0), (40, 20, 0.3), (3, 3, 1.0)]
)
def test_a_flat_grid_comes_out_exactly_with_its_own_aspect(rows, columns, aspect, weight):
    mesh = meshes.grid(rows, columns, aspect)
    result = rectangle(mesh, angle_weight=weight)
    assert check(result, mesh) == pytest.approx(aspect, rel=1e-9)
    assert result.distortion.area_ratio_std < 1e-9
    assert result.distortion.angle_distortion_max < 1 + 1e-9
    # the way it lies
    assert result.uv * max(aspect, 1) == pytest.approx(mesh.vertices[:, :2], abs=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_the_corners_of_a_grid_are_found_anywhere_in_space(seed):
    mesh = turned(meshes.grid(8, 15, 2.5), seed)
    result = rectangle(mesh)
    assert check(result, mesh) == pytest.approx(2.5) or check(result, mesh) == pytest.approx(0.4)
    assert result.distortion.angle_distortion_max < 1 + 1e-6


def test_given_corners_go_where_they_are_told_and_the_aspect_is_kept():
    mesh = meshes.bumpy_cap()
    rim = rim_of(mesh)
    corners = rim[[3, 10, 20, 26]]
    for aspect in (0.5, 1.0, 3.0):
        result = rectangle(mesh, corners=corners, aspect=aspect)
        assert check(result, mesh) == pytest.approx(aspect, rel=1e-12)
        width, height = result.uv.max(axis=0)
        expected = [[0, 0], [width, 0], [width, height], [0, height]]
        assert result.uv[corners].tolist() == np.array(expected).tolist()
        assert (result.uv[rim[3:11], 1] == 0).all()
        assert (np.diff(result.uv[rim[3:11], 0]) > 0).all()


@pytest.mark.parametrize("weight", [0.0, 0.03])
@pytest.mark.parametrize("name", ["bumpy_cap", "slit_sphere", "tube_disk", "fan"])
def test_surfaces_that_are_no_rectangles_go_onto_one(name, weight):
    mesh = getattr(meshes, name)()
    check(rectangle(mesh, angle_weight=weight), mesh)


def test_areas_are_kept_better_than_by_the_start():
    mesh = meshes.bumpy_cap()
    result = rectangle(mesh)
    assert result.distortion.area_ratio_std < 0.01
    assert result.history["authalic_energy"][-1] == pytest.approx(result.distortion.authalic_energy, rel=1e-6)
    assert result.iterations == len(result.history) - 1


@pytest.mark.parametrize("weight", [0.03, 0.3])
def test_the_free_aspect_is_the_best(weight):
    mesh = meshes.bumpy_cap()
    free = rectangle(mesh, angle_weight=weight)
    aspect = check(free, mesh)

    def energy(result):
        ratio, sigma = 2**result.distortion.log2_area_ratio, result.distortion.angle_distortion
        p, q, r = (mesh.vertices[result.faces[:, k]] for k in range(3))
        share = np.linalg.norm(np.cross(q - p, r - p), axis=1)
        excess = (sigma + 1 / sigma) / 2 - 1
        cost = (ratio - 1) ** 2 * (1 + 1 / ratio) / 2 + weight * (excess + 0.05 * excess**2)
        return (cost * share).sum() / share.sum()

    best = energy(free)
    for change in (0.9, 1.1):
        assert best < energy(rectangle(mesh, angle_weight=weight, aspect=aspect * change))
    assert best == pytest.approx(energy(rectangle(mesh, angle_weight=weight, aspect=aspect)), rel=1e-3)


def test_no_limit_is_as_good_as_a_high_one():
    columns, rows = np.meshgrid(np.arange(10.0), np.arange(7.0))
    height = 9 * np.exp(-((columns - 2) ** 2 + (rows - 2) ** 2))
    points = np.stack([columns, rows, height], axis=-1).reshape(-1, 3)
    spike = meshes.Mesh(points, meshes.grid(7, 10).faces)
    aspects = []
    for limit in (None, 10**6):
        result = rectangle(spike, angle_weight=0.3, max_iterations=limit)
        aspects.append(check(result, spike))
    assert aspects[0] == aspects[1]


def test_neither_rounding_nor_numbering_decides():
    mesh = meshes.bumpy_cap()
    random = np.random.default_rng(1)
    first = rectangle(mesh, angle_weight=0.03).uv
    noisy = meshes.Mesh(mesh.vertices + random.normal(0, 1e-12, mesh.vertices.shape), mesh.faces)
    assert rectangle(noisy, angle_weight=0.03).uv == pytest.approx(first, abs=1e-6)
    order = random.permutation(len(first))
    renumbered = meshes.Mesh(mesh.vertices[order], np.argsort(order)[mesh.faces])
    assert rectangle(renumbered, angle_weight=0.03).uv == pytest.approx(first[order], abs=1e-6)
    assert (rectangle(mesh, angle_weight=0.03).uv == first).all()


def test_density_holes_and_a_start_map():
    mesh = meshes.grid(12, 12, 1.0)
    density = 1 + mesh.vertices[mesh.faces].mean(axis=1)[:, 0]
    result = rectangle(mesh, density=density)
    check(result, mesh)
    assert result.distortion.area_ratio_std < 0.02
    plate = meshes.plate_with_holes()
    check(rectangle(plate, fill_holes=True), plate)
    again = rectangle(mesh, initial=result.uv, density=density)
    assert again.uv == pytest.approx(result.uv, abs=1e-3)
    with pytest.raises(authalic.MeshError, match="sides of an upright rectangle"):
        rectangle(mesh, corners=[0, 11, 143, 132], initial=authalic.disk_map(*mesh).uv)
    with pytest.raises(authalic.MeshError, match="mirror the map"):
        rectangle(mesh, initial=result.uv * [-1, 1])
    with pytest.raises(authalic.MeshError, match="sides of an upright rectangle"):
        rectangle(mesh, initial=result.uv @ np.array([[0.6, 0.8], [-0.8, 0.6]]))


def test_it_can_be_cancelled_and_reports_progress():
    seen = []
    mesh = meshes.bumpy_cap()
    rectangle(mesh, progress=lambda fraction, message: seen.append(fraction))
    assert seen == sorted(seen)
    assert seen[-1] == 1
    result = rectangle(mesh, progress=lambda fraction, message: False)
    assert result.status == "cancelled"
    check(result, mesh)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (
            {"corners": [0, 12, 116]},
            r"corners must be of shape \(4,\), boundary vertices, but is of shape \(3,\)",
        ),
        ({"corners": [0, 12, 116, 117]}, "corners must be indices of the 117 vertices"),
        ({"corners": [0, 104, 116, 12]}, "corners run clockwise"),
        ({"corners": [0, 12, 116, 50]}, "corners must be vertices of the longest boundary loop"),
        ({"corners": [0, 12, 12, 104]}, "corners must be four different vertices"),
        ({"corners": [0, 12, 115, 91]}, "2 vertices .105, 91.: an edge inside the surface joins them"),
    ],
)
def test_corners_that_do_not_fit_are_refused(options, words):
    with pytest.raises(authalic.MeshError, match=words):
        rectangle(meshes.grid(), **options)


@pytest.mark.parametrize("aspect", [0.0, -1.0, float("nan"), float("inf"), 1e5])
def test_an_aspect_out_of_range_is_a_plain_value_error(aspect):
    with pytest.raises(ValueError, match="aspect must be width over height, from 1e-4 to 1e4") as caught:
        rectangle(meshes.grid(), aspect=aspect)
    assert type(caught.value) is ValueError


def test_what_has_no_rectangle_is_refused():
    with pytest.raises(authalic.MeshError, match="a boundary of at least four edges"):
        rectangle(meshes.single_triangle())
    # six ears around a hexagon
    rim = meshes.fan(12).vertices[1:]
    ears = [[k, (k + 1) % 12, (k + 2) % 12] for k in range(0, 12, 2)]
    inside = [[0, 2, 4], [4, 6, 8], [8, 10, 0], [0, 4, 8]]
    with pytest.raises(authalic.MeshError, match="each needs a corner of its own"):
        rectangle(meshes.Mesh(rim, np.array(ears + inside)))
    for options in ({"method": "fixed_point"}, {"method": "conjugate_gradient"}):
        with pytest.raises(ValueError, match="only gauss_newton has rectangles"):
            rectangle(meshes.grid(), **options)
    for options in ({"corners": [0, 12, 116, 104]}, {"aspect": 2.0}):
        with pytest.raises(ValueError, match="left out unless the boundary is a rectangle"):
            authalic.disk_map(*meshes.grid(), **options)
