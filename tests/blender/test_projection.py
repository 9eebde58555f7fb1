# SPDX-License-Identifier: GPL-3.0-or-later
"""From the sphere to the plane, in numpy alone: areas, gluing, singular points, folds."""

import os
from pathlib import Path
from typing import Any

import meshes
import numpy as np
import pytest
import spheres
from installed import part
from meshes import Array

LAYOUTS = ("LAMBERT", "OCTAHEDRAL")
DATA = Path(os.environ.get("AUTHALIC_DATA") or Path(__file__).resolve().parents[3] / "shared" / "data")


def project(*arguments: Any, **options: Any) -> Array:
    return part("sphere_layout.projection").project(*arguments, **options)


def small_triangles(count: int = 2000, size: float = 1e-4) -> Array:
    """Random triangles (count, 3, 3) of the sphere, away from where the octahedral map has its creases."""
    random = np.random.default_rng(5)
    centres = spheres.unit(random.normal(size=(3 * count, 3)))
    centres = centres[(np.abs(centres) > 0.01).all(axis=1)][:count]
    across = spheres.unit(np.cross(centres, random.normal(size=centres.shape)))
    corners = [across, np.cross(centres, across), -across]
    return spheres.unit(centres[:, None] + size * np.stack(corners, axis=1))


def uneven_sphere(subdivisions: int = 4, seed: int = 3) -> tuple[Array, Array]:
    vertices, faces = spheres.icosphere(subdivisions, turned=seed)
    return spheres.uneven(vertices), faces


@pytest.mark.parametrize("name", LAYOUTS)
def test_places_keep_areas(name: str) -> None:
    layout, triangles = part("sphere_layout.layouts").LAYOUTS[name], small_triangles()
    places = layout.places(triangles.reshape(-1, 3)).reshape(-1, 3, 2)
    whole = (np.ptp(places[..., 0], axis=1) < 1) & (np.ptp(places[..., 1], axis=1) < 1)
    ratios = meshes.uv_areas(places[whole]) / (layout.scale * spheres.areas(triangles[whole]))
    assert whole.sum() > 1900
    np.testing.assert_allclose(ratios, 1, atol=2e-2)
    assert np.median(np.abs(ratios - 1)) < 1e-4


def test_octahedral_square() -> None:
    places = part("sphere_layout.layouts").Octahedral.places
    points = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0.6, 0.64, -0.48]], float)
    np.testing.assert_allclose(places(points)[:5], [[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1]], atol=1e-15)
    assert (places(points)[5] > 0).all() and places(points)[5].sum() > 1
    near_south = spheres.unit(np.array([[a, b, -1e6] for a in (-1, 1) for b in (-1, 1)]))
    np.testing.assert_allclose(places(near_south), np.sign(near_south[:, :2]), atol=1e-5)


@pytest.mark.parametrize("name", LAYOUTS)
@pytest.mark.parametrize("turned", [None, 1, 2])
def test_faces_fit_together_and_fill_the_plane(name: str, turned: int | None) -> None:
    vertices, faces = spheres.icosphere(3, turned)
    uv = project(vertices, faces, layout=name)
    assert spheres.exactly_folded(uv) == []
    area = meshes.uv_areas(uv)
    if name == "OCTAHEDRAL":
        assert area.sum() == pytest.approx(4 * np.pi, rel=1e-9)
    else:
        assert 0.98 * 4 * np.pi < area.sum() < 4 * np.pi
    joined, sides = edges_joined(faces, uv, half_turns=name == "OCTAHEDRAL")
    # At a pole of Lambert's cylinder the faces about it come apart.
    assert (~joined).sum() == (0 if name == "OCTAHEDRAL" else poles_valence(uv, faces))
    assert sides < 6 * np.sqrt(len(faces))


def edges_joined(faces: Array, uv: Array, half_turns: bool) -> Any:
    """For each edge if its two images are congruent, and how many edges lie apart in the plane."""
    ends = np.stack([faces.ravel(), np.roll(faces, -1, axis=1).ravel()])
    images = np.stack([uv.reshape(-1, 2), np.roll(uv, -1, axis=1).reshape(-1, 2)])
    order = np.lexsort((*np.sort(ends, axis=0),))
    one, two = order[::2], order[1::2]
    assert (np.sort(ends[:, one], axis=0) == np.sort(ends[:, two], axis=0)).all()
    first, second = images[1, one] - images[0, one], images[0, two] - images[1, two]
    same = np.abs(first - second).max(axis=1) < 1e-9
    if half_turns:
        same |= np.abs(first + second).max(axis=1) < 1e-9
    apart = np.abs(images[0, one] - images[1, two]).max(axis=1) > 1e-6
    return same, apart.sum()


def poles_valence(uv: Array, faces: Array) -> Any:
    return np.count_nonzero(np.abs(np.abs(uv[..., 1]) - 1) < 1e-12)


def test_lambert_rectangle() -> None:
    vertices, faces = uneven_sphere()
    uv = project(vertices, faces)
    low, high = uv.min(axis=(0, 1)), uv.max(axis=(0, 1))
    assert low[1] == -1 and high[1] == 1 and -0.02 < low[0] < 0.2
    first = uv[..., 0].min(axis=1)
    assert first.max() < 2 * np.pi + 0.02 and high[0] > 2 * np.pi
    assert np.ptp(uv[..., 0], axis=1).max() < np.pi
    polar = np.abs(uv[..., 1]) == 1
    assert 6 <= polar.sum() <= 14
    for face, corner in np.argwhere(polar):
        others = np.delete(uv[face, :, 0], corner)
        assert uv[face, corner, 0] == pytest.approx(others.mean(), abs=1e-12)


@pytest.mark.parametrize("name", LAYOUTS)
@pytest.mark.parametrize("turned", [None, 4])
def test_areas_come_out_even(name: str, turned: int | None) -> None:
    vertices, faces = spheres.icosphere(4, turned)
    wanted = spheres.areas(vertices[faces])
    ratios = meshes.uv_areas(project(vertices, faces, areas=wanted, layout=name)) / wanted
    assert ratios.std() < 0.03 and 0.8 < ratios.min() < ratios.max() < 1.2


@pytest.mark.parametrize(("axis", "seam"), [("X", (0, 1, 0)), ("Y", (0, 0, -1)), ("Z", (0, 1, 0))])
@pytest.mark.parametrize("angle", [0.0, 1.0])
def test_pole_axis_and_seam_direction(axis: str, seam: Any, angle: float) -> None:
    vertices, faces = spheres.icosphere(4)
    uv = project(vertices, faces, axis=axis, seam=angle)
    pole, seam = np.eye(3)["XYZ".index(axis)], np.array(seam, float)
    seam = np.cos(angle) * seam + np.sin(angle) * np.cross(pole, seam)
    points = vertices[faces]
    middle = np.abs(points @ pole).max(axis=1) < 0.9
    # A vertex has been moved onto each pole: by less than an edge.
    np.testing.assert_allclose(uv[middle][..., 1], points[middle] @ pole, atol=0.1)
    np.testing.assert_allclose(np.cos(uv[middle][..., 0]), turn(points[middle], pole) @ seam, atol=0.25)
    quarter = turn(points[middle], pole) @ np.cross(pole, seam)
    np.testing.assert_allclose(np.sin(uv[middle][..., 0]), quarter, atol=0.25)


def test_uv_sphere_keeps_its_poles() -> None:
    obj = meshes.uv_sphere(24, 12)
    vertices = np.array([vertex.co for vertex in obj.data.vertices], np.float64)
    obj.data.calc_loop_triangles()
    faces = np.array([tuple(triangle.vertices) for triangle in obj.data.loop_triangles])
    polygons = np.array([triangle.polygon_index for triangle in obj.data.loop_triangles])
    uv = project(spheres.unit(vertices), faces, polygons=polygons)
    assert (np.abs(uv[..., 1]) == 1).sum() == 48 and np.ptp(uv[..., 0]) == pytest.approx(2 * np.pi, abs=1e-4)
    # The rows stay rows, a bit lower, where polar faces need room.
    np.testing.assert_allclose(uv[..., 1], spheres.unit(vertices)[faces][..., 2], atol=0.05)
    rows = np.unique(uv[..., 1].round(4))
    assert len(rows) == 13


def turn(points: Array, pole: Array) -> Array:
    return spheres.unit(points - (points @ pole)[..., None] * pole)


@pytest.mark.parametrize("name", LAYOUTS)
def test_inside_out_is_mirrored(name: str) -> None:
    vertices, faces = uneven_sphere(3)
    uv = project(vertices, faces[:, ::-1], layout=name)
    assert spheres.exactly_folded(uv) == []


@pytest.mark.parametrize("name", LAYOUTS)
@pytest.mark.parametrize("seed", range(4))
def test_random_triangulations_have_no_folds(name: str, seed: int) -> None:
    vertices, faces = spheres.icosphere(3, turned=seed)
    random = np.random.default_rng(seed)
    moved = spheres.unit(vertices + 0.025 * random.normal(size=vertices.shape))
    if (np.linalg.det(moved[faces]) <= 0).any():
        pytest.skip("the noise folds the sphere itself")
    assert spheres.exactly_folded(project(spheres.uneven(moved), faces, layout=name)) == []


@pytest.mark.parametrize("name", LAYOUTS)
@pytest.mark.parametrize("subdivisions", [0, 1, 2])
def test_coarse_spheres(name: str, subdivisions: int) -> None:
    uv = project(*spheres.icosphere(subdivisions, turned=7), layout=name)
    assert spheres.exactly_folded(uv) == []


@pytest.mark.parametrize("name", LAYOUTS)
def test_cube_of_quads(name: str) -> None:
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    faces = np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])
    uv = project(spheres.unit(corners), faces, polygons=np.tile(np.arange(6), 2), layout=name)
    assert spheres.exactly_folded(uv) == []
    assert (uv[:6, 0] == uv[6:, 0]).all() and (uv[:6, 2] == uv[6:, 1]).all()
    area = meshes.uv_areas(uv)
    assert area.std() < 0.01 * area.mean()


@pytest.mark.parametrize("name", LAYOUTS)
def test_tetrahedron_is_refused(name: str) -> None:
    vertices, faces = meshes.tetrahedron()
    projection = part("sphere_layout.projection")
    with pytest.raises(projection.CannotProject) as refusal:
        project(spheres.unit(vertices.astype(float)), faces, layout=name)
    assert 0 < refusal.value.count <= 4


@pytest.mark.parametrize("name", LAYOUTS)
def test_polygons_keep_together(name: str) -> None:
    vertices, faces = spheres.icosphere(3, turned=9)
    polygons = pairs(faces)
    uv = project(vertices, faces, polygons=polygons, layout=name)
    assert spheres.exactly_folded(uv) == []
    key = np.column_stack([np.repeat(polygons, 3), faces.ravel()])
    corner = np.unique(key, axis=0, return_inverse=True)[1].ravel()
    for axis in (0, 1):
        low, high = np.full((2, corner.max() + 1), np.nan)
        np.fmin.at(low, corner, uv[..., axis].ravel())
        np.fmax.at(high, corner, uv[..., axis].ravel())
        assert (high - low).max() < 1e-12
    assert corner.max() + 1 < 0.8 * faces.size


def pairs(faces: Array) -> Any:
    """Numbers (m,) that two neighbouring triangles have in common wherever possible."""
    owner: dict[tuple[int, ...], int] = {}
    found = np.full(len(faces), -1)
    for face, (a, b, c) in enumerate(faces):
        for edge in ((a, b), (b, c), (c, a)):
            other = owner.setdefault(tuple(sorted(edge)), face)
            if other != face and found[other] < 0 and found[face] < 0:
                found[[other, face]] = face
    return np.where(found < 0, np.arange(len(faces)), found)


def test_vertices_that_may_not_move_are_at_no_pole() -> None:
    vertices, faces = spheres.icosphere(2)
    may = vertices[:, 2] < 0.9
    uv = project(vertices, faces, movable=may)
    at_pole = np.unique(faces[np.abs(uv[..., 1]) == 1])
    assert len(at_pole) == 2 and may[at_pole].all()


def test_twist_keeps_areas_and_fixed_points() -> None:
    twist, triangles = part("sphere_layout.twist").twist, small_triangles()
    start, goal = spheres.unit(np.array([[1, 0.05, 0.08], [1, 0, 0]]))
    fixed = np.array([[0.0, 1, 0], [0, -1, 0], [-1, 0, 0]])
    moved = twist(triangles.reshape(-1, 3), start, goal, fixed).reshape(-1, 3, 3)
    np.testing.assert_allclose(spheres.areas(moved) / spheres.areas(triangles), 1, atol=5e-3)
    assert np.linalg.norm(moved - triangles, axis=2).max() > 0.05
    assert np.sign(np.linalg.det(moved)).tolist() == np.sign(np.linalg.det(triangles)).tolist()
    np.testing.assert_allclose(twist(start[None], start, goal, fixed), goal[None], atol=1e-14)
    np.testing.assert_allclose(twist(fixed, start, goal, fixed), fixed, atol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(moved, axis=2), 1, atol=1e-14)


def test_untangling_unfolds_and_leaves_the_rest() -> None:
    layouts, charts, untangle = (
        part("sphere_layout.layouts"),
        part("sphere_layout.charts"),
        part("sphere_layout.untangle"),
    )
    vertices, faces = spheres.icosphere(3, turned=11)
    for name in LAYOUTS:
        layout = layouts.LAYOUTS[name]
        placed = part("sphere_layout.projection")._Mesh(
            vertices,
            faces,
            np.arange(len(faces)),
            spheres.areas(vertices[faces]),
            np.ones(len(vertices), bool),
        )
        assert part("sphere_layout.projection")._place_singular_points(placed, layout, 0)
        chart = charts.develop(layout, placed.points, faces, placed.polygons)
        inner = np.flatnonzero(np.abs(placed.points[:, 2] - 0.5) < 0.1)[::7]
        before = chart.uv()
        chart.places[inner] += 0.35 * np.sqrt(layout.scale) * spheres.rotation(1)[:2, 0]
        assert len(untangle.folded(chart.uv())) > len(inner)
        untangle.untangle(chart, placed.areas * layout.scale, ~placed.singular)
        uv = chart.uv()
        assert spheres.exactly_folded(uv) == []
        far = ~np.isin(faces, faces[np.isin(faces, inner).any(axis=1)]).any(axis=1)
        assert far.sum() > len(faces) / 4 and (uv[far] == before[far]).mean() > 0.9


def test_map_of_an_inside_out_surface_lies_over_it() -> None:
    spherical = part("surfaces.spherical")
    vertices, faces = spheres.icosphere(3)
    surface = vertices * [1, 2, 3] + [5, 6, 7]
    # Outward-oriented for faces that look inwards, so that it is turned inside out, and somehow rotated.
    positions = vertices * [1, 1, -1] @ spheres.rotation(2).T
    over = spherical.over_surface(surface, faces[:, ::-1], positions)
    assert (np.linalg.det(over[faces]) > 0).all()
    np.testing.assert_allclose(over, vertices, atol=1e-9)
    assert spherical.over_surface(surface, faces, vertices) is vertices
    assert spherical.radius(3 * vertices, faces) == pytest.approx(3, rel=2e-2)
    np.testing.assert_allclose(spherical.centroid(surface, faces), [5, 6, 7], atol=1e-9)


@pytest.mark.skipif(not (DATA / "brain").is_dir(), reason="no folder of real meshes")
@pytest.mark.parametrize("name", LAYOUTS)
def test_a_sphere_of_a_cortex(name: str) -> None:
    with np.load(DATA / "brain" / "fsaverage5_left_10242.npz") as file:
        key = next(key for key in file if key in ("F", "faces"))
        vertices, faces = spheres.unit(file["V_sphere"].astype(float)), file[key]
    uv = project(vertices, faces, layout=name)
    assert len(part("sphere_layout.untangle").folded(uv)) == 0
