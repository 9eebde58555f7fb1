# SPDX-License-Identifier: MIT OR Apache-2.0
"""Values of maps on grids: pictures, cells of one area, icospheres; at points and conservatively."""

import numpy as np
import pytest

import authalic

from . import meshes

RANDOM = np.random.default_rng(11)


@pytest.fixture(scope="module")
def ball():
    return authalic.sphere_map(*meshes.bumpy_ball())


@pytest.fixture(scope="module")
def limbed():
    return authalic.sphere_map(*meshes.limbed_ball(3), refine=True)


@pytest.fixture(scope="module")
def cap():
    return authalic.disk_map(*meshes.bumpy_cap())


def spherical_areas(points, faces):
    """By the sides of the triangles (L'Huilier)."""
    a, b, c = np.moveaxis(points[faces], 1, 0)
    sides = [2 * np.arcsin(np.linalg.norm(p - q, axis=1) / 2) for p, q in ((a, b), (b, c), (c, a))]
    s = sum(sides) / 2
    product = np.tan(s / 2) * np.prod([np.tan((s - side) / 2) for side in sides], axis=0)
    return 4 * np.arctan(np.sqrt(np.maximum(product, 0)))


def integral(result, values):
    """The sum over the faces on the sphere of area times mean of corners, or of the value of the face."""
    if len(values) == len(result.positions):
        values = values[result.faces].mean(axis=1)
    return np.tensordot(spherical_areas(result.positions, result.faces), values, axes=(0, 0))


def equirectangular_areas(rows, columns):
    latitudes = np.linspace(np.pi / 2, -np.pi / 2, rows + 1)
    return -np.diff(np.sin(latitudes))[:, None] * np.full(columns, 2 * np.pi / columns)


def directions(latitudes, longitudes):
    latitudes, longitudes = np.meshgrid(latitudes, longitudes, indexing="ij")
    points = np.cos(latitudes) * np.cos(longitudes), np.cos(latitudes) * np.sin(longitudes), np.sin(latitudes)
    return np.stack(points, axis=-1)


@pytest.mark.parametrize("per", ["vertex", "face"])
@pytest.mark.parametrize("shape", [(1, 1), (2, 3), (17, 40), (181, 360)])
def test_conservative_pictures_keep_the_integral(ball, per, shape):
    values = RANDOM.normal(size=len(ball.positions if per == "vertex" else ball.faces))
    exact = integral(ball, values)
    totals = ball.equirectangular(values, shape, conservative="total", per=per)
    assert abs(totals.sum() - exact) < 1e-10
    means = ball.equirectangular(values, shape, conservative=True, per=per)
    assert abs((means * equirectangular_areas(*shape)).sum() - exact) < 1e-10
    equal = ball.equal_area_grid(values, shape[0], conservative=True, per=per)
    assert equal.shape == (shape[0], 2 * shape[0])
    assert abs(equal.mean() * 4 * np.pi - exact) < 1e-10


@pytest.mark.parametrize("level", range(5))
@pytest.mark.parametrize("per", ["vertex", "face"])
def test_conservative_resampling_keeps_the_integral(ball, per, level):
    values = RANDOM.normal(size=(len(ball.positions if per == "vertex" else ball.faces), 2))
    exact = integral(ball, values)
    totals, icosphere = ball.resample(values, level, conservative="total")
    np.testing.assert_allclose(totals.sum(axis=0), exact, rtol=0, atol=1e-10)
    means, _ = ball.resample(values, level, conservative=True)
    areas = np.zeros(len(totals))
    thirds = spherical_areas(icosphere.vertices, icosphere.faces) / 3
    np.add.at(areas, icosphere.faces, np.repeat(thirds[:, None], 3, axis=1))
    np.testing.assert_allclose(areas @ means, exact, rtol=0, atol=1e-10)


def test_split_faces_are_laid_out_by_their_parts(limbed):
    refinement = limbed.refinement
    values = RANDOM.normal(size=len(limbed.faces))
    points = np.concatenate([limbed.positions, refinement.positions])
    exact = spherical_areas(points, refinement.faces) @ values[refinement.face_of]
    assert abs(limbed.equirectangular(values, (30, 60), conservative="total").sum() - exact) < 1e-10
    assert abs(limbed.resample(values, 3, conservative="total")[0].sum() - exact) < 1e-10


def test_a_constant_stays_constant(ball, cap):
    ones = np.ones(len(ball.positions))
    for grid in (
        ball.equirectangular(ones, (31, 64), conservative=True),
        ball.equal_area_grid(ones, 20, conservative=True),
        ball.resample(ones, 3, conservative=True)[0],
        ball.equirectangular(ones, (31, 64)),
        ball.resample(ones, 3)[0],
    ):
        np.testing.assert_allclose(grid, 1, rtol=0, atol=1e-9)
    image = cap.image(np.ones(len(cap.uv)), (40, 40), conservative=True)
    np.testing.assert_allclose(image[~np.isnan(image)], 1, rtol=0, atol=1e-9)


def test_cells_have_the_means_of_many_points(ball):
    """Means over cells against those of the values at many points of the cells."""
    values = RANDOM.normal(size=len(ball.faces))
    rows, columns, fine = 6, 8, 60
    z = 1 - (np.arange(rows * fine) + 0.5) * 2 / (rows * fine)
    longitude = (np.arange(columns * fine) + 0.5) * 2 * np.pi / (columns * fine) - np.pi
    points = directions(np.arcsin(z), longitude)
    sampled = ball.sample(values, points.reshape(-1, 3)).reshape(rows, fine, columns, fine).mean(axis=(1, 3))
    means = ball.equal_area_grid(values, rows, conservative=True)
    assert means.shape == (rows, 2 * rows)
    wide = means.reshape(rows, 4, 3).mean(axis=2)
    np.testing.assert_allclose(sampled.reshape(rows, 4, 2).mean(axis=2), wide, rtol=0, atol=0.02)


def test_the_centers_of_pictures_lie_where_the_documentation_says(ball):
    rows, columns = 12, 20
    latitude = np.pi / 2 - (np.arange(rows) + 0.5) * np.pi / rows
    longitude = (np.arange(columns) + 0.5) * 2 * np.pi / columns - np.pi
    expected = ball.sample(ball.positions, directions(latitude, longitude).reshape(-1, 3))
    picture = ball.equirectangular(ball.positions, (rows, columns))
    assert picture.shape == (rows, columns, 3)
    np.testing.assert_allclose(picture.reshape(-1, 3), expected, atol=1e-9)
    z = 1 - (np.arange(rows) + 0.5) * 2 / rows
    longitude = (np.arange(2 * rows) + 0.5) * np.pi / rows - np.pi
    expected = ball.sample(ball.positions, directions(np.arcsin(z), longitude).reshape(-1, 3))
    np.testing.assert_allclose(ball.equal_area_grid(ball.positions, rows).reshape(-1, 3), expected, atol=1e-9)


def test_an_icosphere_has_the_values_at_its_vertices(ball):
    values, icosphere = ball.resample(ball.positions, 3)
    assert (icosphere.n_vertices, icosphere.n_faces) == (642, 1280)
    assert icosphere.is_closed and icosphere.genus == 0
    np.testing.assert_allclose(values, ball.sample(ball.positions, icosphere.vertices), atol=1e-12)
    # flat faces lie below the sphere, in the same direction
    unit = values / np.linalg.norm(values, axis=1, keepdims=True)
    np.testing.assert_allclose(unit, icosphere.vertices, atol=1e-9)
    coarse = ball.resample(ball.positions, 2)[1]
    assert (icosphere.vertices[: coarse.n_vertices] == coarse.vertices).all()


def test_labels_go_to_grids(ball, cap):
    labels = np.arange(len(ball.positions), dtype=np.int32)
    picture = ball.equirectangular(labels, (9, 18), nearest=True)
    assert picture.dtype == np.int32 and picture.shape == (9, 18)
    assert ball.resample(labels, 1, nearest=True)[0].dtype == np.int32
    image = cap.image(np.full(len(cap.uv), 3, np.uint8), (8, 8), nearest=True)
    assert image[0, 0] == 0 and image[4, 4] == 3
    with pytest.raises(ValueError, match="labels, which have no means"):
        ball.equirectangular(labels, (9, 18), nearest=True, conservative=True)


def test_pictures_of_disks_have_row_0_on_top(cap):
    image = cap.image(cap.uv, (50, 40))
    assert image.shape == (50, 40, 2)
    u, v = np.meshgrid((np.arange(40) + 0.5) / 20 - 1, 1 - (np.arange(50) + 0.5) / 25)
    inside = ~np.isnan(image[..., 0])
    np.testing.assert_allclose(image[inside], np.stack([u, v], axis=-1)[inside], atol=1e-9)
    assert (inside == (np.hypot(u, v) < 0.98))[np.abs(np.hypot(u, v) - 0.99) > 0.02].all()
    assert not np.isnan(cap.image(cap.uv, (50, 40), outside="nearest")).any()
    assert cap.image(cap.uv, (50, 40), outside=7)[0, 0].tolist() == [7, 7]


@pytest.mark.parametrize("extent", [None, (-1, 1, -1, 1), (-2, 2, -1.5, 3)])
def test_conservative_pictures_of_disks_keep_the_integral(cap, extent):
    values = RANDOM.normal(size=len(cap.uv))
    a, b, c = np.moveaxis(cap.uv[cap.faces], 1, 0)
    areas = np.linalg.det(np.stack([b - a, c - a], axis=1)) / 2
    exact = areas @ values[cap.faces].mean(axis=1)
    for shape in ((1, 1), (33, 20), (200, 256)):
        totals = cap.image(values, shape, extent=extent, conservative="total")
        assert abs(totals.sum() - exact) < 1e-10
    covered = cap.image(np.ones(len(cap.uv)), (64, 64), extent=extent, conservative="total")
    assert abs(covered.sum() - areas.sum()) < 1e-10


def test_a_rectangle_is_the_extent_of_its_picture():
    result = authalic.disk_map(*meshes.grid(), boundary="rectangle")
    image = result.image(result.uv, (30, 40))
    assert not np.isnan(image).any()
    assert image[0, 0, 1] > image[-1, 0, 1] and image[0, -1, 0] > image[0, 0, 0]
    total = result.image(np.ones(len(result.uv)), (30, 40), conservative="total").sum()
    assert total == pytest.approx(np.prod(result.uv.max(axis=0)), abs=1e-10)


def test_two_surfaces_have_the_vertices_of_an_icosphere_in_common(ball):
    """Without landmarks: a surface and its copy with other numbers."""
    mesh, order = meshes.bumpy_ball(), RANDOM.permutation(len(meshes.bumpy_ball().vertices))
    renumbered = np.argsort(order)[mesh.faces]
    other = authalic.sphere_map(mesh.vertices[order], renumbered)
    one = ball.resample(mesh.vertices, 3)[0]
    two = other.resample(mesh.vertices[order], 3)[0]
    np.testing.assert_allclose(one, two, atol=1e-4)


def test_grids_do_not_depend_on_the_threads(ball):
    values = RANDOM.normal(size=len(ball.positions))
    grids = []
    for threads in (1, 3):
        authalic.set_threads(threads)
        calls = (ball.equirectangular(values, (40, 80), conservative=True), ball.resample(values, 3)[0])
        grids.append([grid.tobytes() for grid in (*calls, ball.resample(values, 3, conservative=True)[0])])
    authalic.set_threads(0)
    assert grids[0] == grids[1]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda ball, cap: ball.equirectangular(np.ones(258), (0, 5)), "shape must be"),
        (lambda ball, cap: ball.equirectangular(np.ones(258), 7), r"shape must be \(rows, columns\).*is 7"),
        (lambda ball, cap: cap.image(np.ones(421), (2, 3, 4)), r"shape must be .* is \(2, 3, 4\)"),
        (lambda ball, cap: ball.equirectangular(np.ones(258), (10**9, 10**9)), "shape must be of 1 to"),
        (lambda ball, cap: ball.equal_area_grid(np.ones(258), -1), "n must be ≥ 1, but is -1"),
        (lambda ball, cap: ball.resample(np.ones(258), 11), "level must be 0 to 10, but is 11"),
        (lambda ball, cap: ball.resample(np.ones(258), -1), "level must be 0 to 10, but is -1"),
        (
            lambda ball, cap: ball.resample(np.ones(258), 1, conservative="sum"),
            "conservative must be True, False",
        ),
        (lambda ball, cap: cap.image(np.ones(421), (5, 5), extent=(1, 0, 0, 1)), "extent must be"),
        (lambda ball, cap: cap.image(np.ones(421), (5, 5), extent=(1, 0)), "extent must be of shape"),
        (lambda ball, cap: cap.image(np.ones(421), (5, 5), outside="far"), "outside must be"),
        (lambda ball, cap: ball.resample(np.ones(5), 1, conservative=True), "values must be of shape"),
    ],
)
def test_what_is_no_grid_is_refused(ball, cap, call, words):
    with pytest.raises(ValueError, match=words):
        call(ball, cap)


def test_shapes_may_be_any_two_numbers(ball, cap):
    values = ball.positions[:, 0]
    expected = ball.equirectangular(values, (4, 6))
    for shape in ([4, 6], np.array([4, 6]), (np.int32(4), np.uint8(6))):
        assert np.array_equal(ball.equirectangular(values, shape), expected)
    assert cap.image(cap.uv[:, 0], [3, 5]).shape == (3, 5)


def test_maps_show_a_picture_in_notebooks(ball, cap):
    for result in (ball, cap):
        html = result._repr_html_()
        assert 'src="data:image/png;base64,iVBORw0KGgo' in html
        assert repr(result).split("(")[0] in html and len(html) < 60_000
    assert (
        authalic.Surface(*meshes.bumpy_cap())._repr_html_() == "<code>Surface(421 vertices, 810 faces)</code>"
    )


def test_the_pictures_are_png_files(cap, tmp_path):
    """As another decoder reads them."""
    import base64
    import re

    image = pytest.importorskip("matplotlib.image")
    data = re.search(r"base64,([^\"]+)", cap._repr_html_())[1]
    (tmp_path / "picture.png").write_bytes(base64.b64decode(data))
    pixels = image.imread(tmp_path / "picture.png")
    assert pixels.shape == (128, 128, 4)
    assert pixels[64, 64, 3] == 1 and pixels[0, 0, 3] == 0
    assert np.allclose(pixels[64, 64, :3], 245 / 255, atol=0.2)
