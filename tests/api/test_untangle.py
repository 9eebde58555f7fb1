# SPDX-License-Identifier: MIT OR Apache-2.0
"""Maps with folds become maps without folds, and change as little as possible."""

import numpy as np
import pytest

import authalic

from . import meshes
from .test_contract import assert_array, public_attributes

GRID = meshes.quads(20, 20)


def plane(side=20, bend=0.0):
    """The places of a grid of vertices, with an outline that `bend` makes concave."""
    y, x = np.meshgrid(np.arange(side, dtype=float), np.arange(side, dtype=float), indexing="ij")
    x, y = x - bend * side * np.sin(np.pi * y / (side - 1)), y + bend * side * np.cos(np.pi * x / (side - 1))
    return np.stack([x.ravel(), y.ravel()], axis=1)


def surface(places, faces):
    return np.column_stack([places, 0 * places[:, 0]]), faces


def is_boundary(faces, n):
    edges = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    once, counts = np.unique(edges, axis=0, return_counts=True)
    rim = np.zeros(n, bool)
    rim[once[counts == 1].ravel()] = True
    return rim


def areas(faces, image):
    a, b, c = (image[faces[:, k]] for k in range(3))
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def check(result, faces, image, held):
    """No folds; what must stay, or is said to stay, keeps its bits."""
    assert (areas(faces, result.image) > 0).all()
    assert len(result.distortion.folded) == 0
    assert (result.image[held] == image[held]).all()
    changed = np.flatnonzero((result.image != image).any(axis=1))
    assert result.moved.tolist() == changed.tolist()
    assert set(result.folded_before) == set(np.flatnonzero(areas(faces, image) <= 0))


def test_the_result_has_the_attributes_of_the_contract():
    result = authalic.untangle(meshes.fan(), meshes.fan().vertices[:, :2])
    assert public_attributes(result) == {"image", "moved", "folded_before", "status", "distortion", "seconds"}
    assert_array(result.image, (7, 2), np.float64)
    assert_array(result.moved, (0,), np.int64)
    assert_array(result.folded_before, (0,), np.int64)
    assert repr(result).startswith("Untangled(0 of 7 vertices moved, 0 faces were folded, converged, ")


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_a_map_without_folds_comes_back_bit_for_bit(dtype):
    uv = authalic.disk_map(*meshes.bumpy_cap()).uv.astype(dtype)
    for image in (uv, uv * [-1, 1], np.float32(1e-20) * uv, np.float32(1e20) * uv):
        result = authalic.untangle(meshes.bumpy_cap(), image)
        assert (result.image == np.asarray(image, np.float64)).all()
        assert result.status == "converged"
        assert len(result.moved) == len(result.folded_before) == 0


@pytest.mark.parametrize("mirror", [1, -1])
def test_a_vertex_that_has_left_its_star_moves_alone(mirror):
    image = plane() * [mirror, 1]
    image[8 * 20 + 8] = [14.2 * mirror, 11.3]
    result = authalic.untangle(surface(plane(), GRID), image)
    assert result.moved.tolist() == [8 * 20 + 8]
    check(authalic.untangle(surface(plane(), GRID), image * [mirror, 1]), GRID, image * [mirror, 1], [])
    assert (mirror * areas(GRID, result.image) > 0).all()


@pytest.mark.parametrize("seed", range(4))
def test_only_what_is_near_folds_moves(seed):
    random, image = np.random.default_rng(seed), plane()
    inside = np.flatnonzero(~is_boundary(GRID, 400))
    for vertex in random.choice(inside, 8, replace=False):
        image[vertex] += random.normal(0, 1.5, 2)
    result = authalic.untangle(surface(plane(), GRID), image)
    check(result, GRID, image, is_boundary(GRID, 400))
    folded = np.unique(GRID[result.folded_before])
    near = np.abs(plane()[:, None] - plane()[folded]).max(axis=2).min(axis=1) <= 2
    assert near[result.moved].all()


@pytest.mark.parametrize("bend", [0.0, 0.25])
@pytest.mark.parametrize("seed", range(3))
def test_a_shuffled_interior_is_untangled(seed, bend):
    places = plane(bend=bend)
    rim = is_boundary(GRID, 400)
    assert (areas(GRID, places) > 0).all()
    image = places.copy()
    image[~rim] = np.random.default_rng(seed).permutation(places[~rim])
    check(authalic.untangle(surface(plane(), GRID), image), GRID, image, rim)


def test_pins_stay_as_indices_and_as_a_mask():
    image = plane()
    image[8 * 20 + 8] += [2.3, 0.2]
    pins = np.array([8 * 20 + 8, 0, 8 * 20 + 8])
    mask = np.zeros(400, bool)
    mask[pins] = True
    results = [
        authalic.untangle(surface(plane(), GRID), image, fixed=fixed) for fixed in (pins, mask, pins.tolist())
    ]
    for result in results:
        check(result, GRID, image, pins)
        assert (result.image == results[0].image).all()


def test_islands_and_holes_are_kept_apart():
    plate, ring = meshes.plate_with_holes(), meshes.annulus()
    faces = np.vstack([plate.faces, ring.faces + len(plate.vertices)])
    good = np.vstack([plate.vertices, np.add(ring.vertices, [5, 0, 0])])
    # the second island is mirrored
    flat = good[:, :2] * np.where(np.arange(len(good)) < len(plate.vertices), 1, -1)[:, None] ** [[1, 0]]
    rim, image = is_boundary(faces, len(good)), flat.copy()
    image[~rim] += np.random.default_rng(1).normal(0, 0.04, (int((~rim).sum()), 2))
    result = authalic.untangle((good, faces), image)
    assert len(result.folded_before) > 0
    assert (areas(faces, result.image) * areas(faces, flat) > 0).all()
    assert (result.image[rim] == image[rim]).all()


def test_a_tangle_on_the_sphere():
    mesh = meshes.bumpy_ball()
    image = authalic.sphere_map(*mesh).positions.copy()
    good = image.copy()
    image[7] = image[40]
    image[100] = -image[3]
    result = authalic.untangle(mesh, image)
    assert len(result.distortion.folded) == 0
    assert set(result.moved) >= {7, 100}
    assert len(result.moved) < 30
    assert np.linalg.norm(result.image, axis=1) == pytest.approx(1)
    assert (
        result.image[np.setdiff1d(np.arange(len(good)), result.moved)] == np.delete(good, result.moved, 0)
    ).all()


def test_what_cannot_be_is_refused_with_the_faces():
    image = plane()
    image[19] = [15, 3]
    with pytest.raises(
        authalic.MeshError, match=r"cannot be unfolded, because the corners stay .*leave them out of fixed"
    ) as caught:
        authalic.untangle(surface(plane(), GRID), image)
    assert caught.value.indices
    image = plane()
    image[[42, 43]] = image[[43, 42]]
    with pytest.raises(authalic.MeshError, match="cannot be unfolded") as caught:
        authalic.untangle(surface(plane(), GRID), image, fixed=[42, 43, 63, 62])
    assert set(caught.value.indices) <= set(np.flatnonzero(areas(GRID, image) <= 0))
    eight = plane()
    eight[:, 1] = (eight[:, 1] - 9.5) * (eight[:, 0] - 9.4)
    with pytest.raises(authalic.MeshError, match="outline"):
        authalic.untangle(surface(plane(), GRID), eight)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"image": np.full((400, 2), np.nan)}, "image is NaN or infinite at 400 vertices"),
        ({"image": np.zeros((399, 2))}, "image must be of shape"),
        ({"fixed": [400]}, "fixed must be indices of the 400 vertices"),
        ({"fixed": np.zeros(3, bool)}, r"fixed must be of shape \(400,\)"),
        ({"surface": plane()}, r"surface must be a pair \(vertices, faces\)"),
    ],
)
def test_arguments_that_do_not_fit_are_refused(change, words):
    arguments = {"surface": surface(plane(), GRID), "image": plane(), **change}
    with pytest.raises(authalic.MeshError, match=words):
        authalic.untangle(arguments.pop("surface"), arguments.pop("image"), **arguments)


@pytest.mark.parametrize("tolerance", [-0.1, 1.0, float("nan")])
def test_a_tolerance_out_of_range_is_a_plain_value_error(tolerance):
    with pytest.raises(ValueError, match="tolerance must be a number ≥ 0 and < 1") as caught:
        authalic.untangle(surface(plane(), GRID), plane(), tolerance=tolerance)
    assert type(caught.value) is ValueError


def test_faces_keep_the_tolerance():
    image = plane()
    image[8 * 20 + 8] += [2.3, 0.2]
    ratios = [
        areas(GRID, authalic.untangle(surface(plane(), GRID), image, tolerance=tolerance).image).min() / 0.5
        for tolerance in (0.001, 0.01, 0.2)
    ]
    assert ratios == pytest.approx([0.001, 0.01, 0.2], rel=0.01)


def test_cancelling_before_there_is_a_map_without_folds_is_an_error():
    image = plane()
    image[8 * 20 + 8] += [2.3, 0.2]
    with pytest.raises(authalic.SolverError, match="cancelled"):
        authalic.untangle(surface(plane(), GRID), image, progress=lambda fraction, message: False)
