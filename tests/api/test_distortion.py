# SPDX-License-Identifier: MIT OR Apache-2.0
"""The figures of `distortion` against other formulas, in numpy and in exact fractions."""

from fractions import Fraction

import numpy as np
import pytest

import authalic

from . import meshes, oracle

CURVED = ("bumpy_cap", "rough_cap", "slit_sphere", "tube_disk", "single_quad")


@pytest.fixture(scope="module", params=CURVED)
def measured(request):
    """A mesh, a rough map of it without folds, its target areas and its figures."""
    mesh = meshes.DISKS[request.param]
    uv = authalic.disk_map(*mesh, max_iterations=0).uv
    return mesh, uv, oracle.face_areas(*mesh), authalic.distortion(*mesh, uv)


def test_the_authalic_energy(measured):
    mesh, uv, areas, figures = measured
    assert figures.authalic_energy == pytest.approx(
        oracle.authalic_energy(uv, mesh.faces, areas), rel=1e-9, abs=1e-20
    )


def test_the_authalic_energy_is_the_stretch_energy_less_the_area(measured):
    mesh, uv, areas, figures = measured
    area = oracle.signed_areas(uv, mesh.faces).sum()
    stretch = oracle.stretch_energy(uv, mesh.faces, areas * area / areas.sum())
    assert stretch - area == pytest.approx(figures.authalic_energy, rel=1e-7, abs=1e-12)


def test_area_ratios(measured):
    mesh, uv, areas, figures = measured
    ratio = oracle.area_ratio(uv, mesh.faces, areas)
    assert figures.area_ratio_mean == pytest.approx(ratio.mean(), rel=1e-9)
    assert figures.area_ratio_std == pytest.approx(ratio.std(), rel=1e-9, abs=1e-12)
    assert np.allclose(figures.log2_area_ratio, np.log2(ratio), rtol=1e-8, atol=1e-8)


def test_the_energy_on_the_unit_disk_is_near_pi_times_the_variance():
    mesh = meshes.grid(30, 30)
    figures = authalic.disk_map(*mesh).distortion
    assert figures.authalic_energy == pytest.approx(np.pi * figures.area_ratio_std**2, rel=0.05)


def test_angle_distortion_is_the_ratio_of_the_singular_values(measured):
    mesh, uv, _, figures = measured
    expected = oracle.angle_distortion(*mesh, uv)
    assert np.allclose(figures.angle_distortion, expected, rtol=1e-6)
    assert (figures.angle_distortion >= 1).all()
    assert figures.angle_distortion_mean == pytest.approx(expected.mean(), rel=1e-6)
    assert figures.angle_distortion_p99 == pytest.approx(np.percentile(expected, 99), rel=1e-6)
    assert figures.angle_distortion_max == pytest.approx(expected.max(), rel=1e-6)


def test_folds_are_those_of_exact_arithmetic():
    mesh = meshes.bumpy_cap()
    uv = authalic.disk_map(*mesh).uv.copy()
    moved = np.random.default_rng(3).choice(len(uv), 40, replace=False)
    uv[moved] *= -0.5
    expected = oracle.folded(uv, mesh.faces)
    assert len(expected) > 20
    assert authalic.distortion(*mesh, uv).folded.tolist() == expected


@pytest.mark.parametrize("steps", [-3, -1, 0, 1, 3])
def test_a_face_is_folded_by_the_last_bit(steps):
    """(a, b, c) nearly on the line y = x, c some last bits above or below it."""
    mesh = meshes.single_quad()
    on_line = 0.1 + 0.2
    height = on_line
    for _ in range(abs(steps)):
        height = np.nextafter(height, np.sign(steps) * np.inf)
    image = np.array([[0.0, 0.0], [24.0, 24.0], [on_line, height], [-8.0, 8.0]])
    exact = oracle.exact_area(image[[0, 1, 2]])
    assert (exact > 0, exact < 0) == (steps > 0, steps < 0)
    assert isinstance(exact, Fraction)
    assert (0 in authalic.distortion(*mesh, image).folded) == (steps <= 0)


def test_an_affine_map_that_keeps_areas_scores_zero():
    mesh = meshes.grid()
    shear = np.array([[2.0, 0.7], [0.0, 0.5]])
    figures = authalic.distortion(*mesh, mesh.vertices[:, :2] @ shear)
    assert figures.authalic_energy < 1e-25
    assert figures.area_ratio_mean == pytest.approx(1, abs=1e-13)
    assert figures.area_ratio_std < 1e-13
    assert np.abs(figures.log2_area_ratio).max() < 1e-12
    first, second = np.linalg.svd(shear, compute_uv=False)
    assert np.allclose(figures.angle_distortion, first / second, rtol=1e-12)


def test_a_similarity_keeps_angles_and_areas_up_to_one_scale():
    mesh = meshes.grid()
    turn = 37.0 * np.array([[0.6, -0.8], [0.8, 0.6]])
    figures = authalic.distortion(*mesh, mesh.vertices[:, :2] @ turn)
    assert figures.angle_distortion_max == pytest.approx(1, abs=1e-12)
    assert figures.area_ratio_std < 1e-12


@pytest.mark.parametrize("name", CURVED)
def test_a_flipped_face_never_scores_better(name):
    """Mirroring one corner over the opposite edge keeps |area| and turns the sign."""
    mesh = meshes.DISKS[name]
    vertices = mesh.vertices[mesh.faces].reshape(-1, 3)  # every face by itself
    faces = np.arange(len(vertices)).reshape(-1, 3)
    image = authalic.disk_map(*mesh).uv[mesh.faces].reshape(-1, 2)
    sound = authalic.distortion(vertices, faces, image)
    for face in range(0, len(faces), 37):
        flipped = image.copy()
        flipped[faces[face, 2]] = mirrored(*image[faces[face]])
        figures = authalic.distortion(vertices, faces, flipped)
        assert figures.folded.tolist() == [face]
        assert figures.authalic_energy > sound.authalic_energy
        assert figures.area_ratio_std > sound.area_ratio_std
        assert figures.area_ratio_mean < sound.area_ratio_mean
        assert figures.log2_area_ratio[face] == -np.inf
        assert figures.angle_distortion[face] == figures.angle_distortion_max == np.inf


def mirrored(a, b, c):
    """The point c on the other side of the line through a and b."""
    along = (b - a) / np.linalg.norm(b - a)
    return 2 * (a + along * ((c - a) @ along)) - c


def test_a_mirrored_map_is_folded_everywhere():
    mesh = meshes.grid()
    figures = authalic.distortion(*mesh, mesh.vertices[:, :2] * [-1, 1])
    assert figures.folded.tolist() == list(range(len(mesh.faces)))
    assert figures.area_ratio_mean == pytest.approx(-1)
    assert figures.authalic_energy == pytest.approx(4 * 1.5)


def test_targets_of_a_density_take_the_place_of_the_areas():
    mesh = meshes.bumpy_cap()
    uv = authalic.disk_map(*mesh).uv.copy()
    density = np.random.default_rng(5).uniform(0.1, 10, len(mesh.faces))
    figures = authalic.distortion(*mesh, uv, density=density)
    assert figures.authalic_energy == pytest.approx(oracle.authalic_energy(uv, mesh.faces, density))
    assert np.allclose(2**figures.log2_area_ratio, oracle.area_ratio(uv, mesh.faces, density))
    scaled = authalic.distortion(*mesh, uv, density=1e9 * density)
    assert scaled.authalic_energy == pytest.approx(figures.authalic_energy, rel=1e-12)
    exact = authalic.distortion(*mesh, uv, density=oracle.signed_areas(uv, mesh.faces))
    assert exact.authalic_energy < 1e-20


@pytest.mark.parametrize("scale", [1e-100, 1e-8, 1e8, 1e100])
def test_the_units_of_the_surface_and_of_the_image_do_not_matter(scale):
    mesh = meshes.DISKS["rough_cap"]
    uv = authalic.disk_map(*mesh, max_iterations=0).uv
    plain, scaled = (authalic.distortion(k * mesh.vertices, mesh.faces, uv) for k in (1, scale))
    assert scaled.authalic_energy == pytest.approx(plain.authalic_energy, rel=1e-9)
    assert np.allclose(scaled.angle_distortion, plain.angle_distortion, rtol=1e-6)


def test_faces_turned_against_the_rest_are_turned_back():
    mesh = meshes.bumpy_cap()
    uv = authalic.disk_map(*mesh).uv.copy()
    faces = mesh.faces.copy()
    faces[100:200] = faces[100:200, ::-1]
    figures = authalic.distortion(mesh.vertices, faces, uv)
    assert len(figures.folded) == 0
    assert figures.authalic_energy == pytest.approx(authalic.distortion(*mesh, uv).authalic_energy, rel=1e-12)


@pytest.fixture(scope="module", name="ball")
def closed_sphere():
    (ball, _) = meshes.sphere(20, 30)
    stretched = ball.vertices * [1.0, 1.5, 0.7]
    corners = ball.vertices[ball.faces]
    outward = np.einsum("ij,ij->i", np.cross(corners[:, 0], corners[:, 1]), corners[:, 2]) > 0
    assert outward.all()
    return meshes.Mesh(stretched, ball.faces), ball.vertices


def test_a_map_onto_the_sphere(ball):
    mesh, image = ball
    figures = authalic.distortion(*mesh, image)
    areas, onto = oracle.face_areas(*mesh), oracle.face_areas(image, mesh.faces)
    ratio = onto / areas * (areas.sum() / onto.sum())
    targets = areas * onto.sum() / areas.sum()
    assert len(figures.folded) == 0
    assert np.allclose(2**figures.log2_area_ratio, ratio, rtol=1e-8)
    assert figures.area_ratio_std == pytest.approx(ratio.std(), rel=1e-8)
    assert figures.authalic_energy == pytest.approx(((onto - targets) ** 2 / targets).sum(), rel=1e-8)


def test_a_fold_on_the_sphere_is_found(ball):
    mesh, image = ball
    moved = image.copy()
    moved[100] = image[100 + 2 * 30]  # two parallels further: the faces in between turn over
    figures = authalic.distortion(*mesh, moved)
    corners = moved[mesh.faces]
    volume = np.linalg.det(corners)
    assert set(np.flatnonzero(volume < -1e-12)) <= set(figures.folded.tolist())
    assert set(figures.folded.tolist()) <= set(np.flatnonzero(volume < 1e-12))
    assert len(figures.folded) > 0
    assert all(100 in mesh.faces[face] for face in figures.folded)


def test_an_inward_sphere_is_folded_everywhere(ball):
    mesh, image = ball
    assert len(authalic.distortion(*mesh, -image).folded) == len(mesh.faces)


def test_an_image_that_is_not_finite_is_refused_by_vertex():
    vertices, faces = meshes.grid()
    for bad in (np.nan, np.inf):
        image = vertices[:, :2].copy()
        image[[3, 5]] = bad
        with pytest.raises(authalic.MeshError, match="image is NaN or infinite") as caught:
            authalic.distortion(vertices, faces, image)
        assert caught.value.indices == (3, 5)


@pytest.mark.parametrize("scale", [1e-100, 1e100])
def test_the_ratios_of_an_image_do_not_depend_on_its_scale(scale):
    vertices, faces = meshes.grid()
    image = vertices[:, :2] * [1, 2] + 0.01 * np.sin(9 * vertices[:, :2])
    plain, scaled = (authalic.distortion(vertices, faces, image * s) for s in (1, scale))
    assert np.allclose(plain.log2_area_ratio, scaled.log2_area_ratio, rtol=0, atol=1e-12)
    assert np.allclose(plain.angle_distortion, scaled.angle_distortion, rtol=1e-12, atol=0)
    assert scaled.authalic_energy == pytest.approx(plain.authalic_energy * scale**2, rel=1e-9)


def test_a_density_that_leaves_no_digits_is_refused():
    vertices, faces = meshes.grid()
    density = np.ones(len(faces))
    density[7] = 1e-13
    with pytest.raises(authalic.MeshError, match="at least 1e-12 of the largest") as caught:
        authalic.disk_map(vertices, faces, density=density)
    assert caught.value.indices == (7,)
