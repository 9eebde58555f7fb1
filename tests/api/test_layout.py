# SPDX-License-Identifier: MIT OR Apache-2.0
"""SphereMap.layout: areas, gluing along the seam, singular points, polygons, folds in exact arithmetic."""

import doctest
import inspect
import json
import pickle

import numpy as np
import pytest

import authalic

from . import meshes, oracle, real_meshes

KINDS = ("lambert", "octahedral")
PRECISIONS = ("float64", "float32")
AXES = {"x": (0, 1, 0), "y": (0, 0, -1), "z": (0, 1, 0)}


def map_of(mesh, **options):
    """A mesh of the sphere as a map of itself."""
    vertices, faces = mesh
    return authalic.sphere_map(
        vertices, faces, method="fixed_point", max_iterations=0, initial=vertices, unfold=False, **options
    )


def laid_out(mesh, kind, **options):
    """A mesh of the sphere, laid out."""
    return map_of(mesh).layout(kind, **options)


def corners(layout):
    """The images of all corners, (m, 3, 2)."""
    return layout.points[layout.faces].astype(float)


def uneven(mesh, strength=0.4):
    """A mesh of the sphere pulled toward one side, smoothly and without a fold."""
    return meshes.on_the_sphere(meshes.Mesh(mesh.vertices + strength * np.array([0.3, 0.5, 0.8]), mesh.faces))


def area_ratios(layout, mesh, polygons=None):
    """The area ratio of each polygon, image over surface, scaled to the mean 1."""
    image, surface = oracle.signed_areas(layout.points, layout.faces), oracle.face_areas(*mesh)
    if polygons is not None:
        image, surface = np.bincount(polygons, image), np.bincount(polygons, surface)
    return image / surface * (surface.sum() / image.sum())


def uv_sphere(stacks, slices):
    """A UV sphere, the polygon of each triangle (a quad, or itself at a pole), the ring of each vertex."""
    mesh, _ = meshes.sphere(stacks, slices)
    quads = (stacks - 2) * slices
    polygons = np.concatenate([np.repeat(np.arange(quads), 2), quads + np.arange(2 * slices)])
    rings = np.concatenate([1 + np.repeat(np.arange(stacks - 1), slices), [0, stacks]])
    return mesh, polygons, rings


def edge_images(layout, mesh):
    """The starts and ends, (e, 2) each, of the two images of each edge, in either face."""
    ends = np.stack([mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel()])
    image = corners(layout)
    images = np.stack([image.reshape(-1, 2), np.roll(image, -1, axis=1).reshape(-1, 2)])
    order = np.lexsort((*np.sort(ends, axis=0),))
    first, second = order[::2], order[1::2]
    assert (np.sort(ends[:, first], axis=0) == np.sort(ends[:, second], axis=0)).all()
    return images[:, first], images[::-1, second]


def turn(points, pole):
    """The directions of points about a pole."""
    flat = points - (points @ pole)[..., None] * pole
    return flat / np.linalg.norm(flat, axis=-1, keepdims=True)


# The contract


def test_the_kind_comes_first_and_all_else_is_keyword_only():
    parameters = list(inspect.signature(authalic.SphereMap.layout).parameters.values())[1:]
    assert [(p.name, p.default) for p in parameters if p.kind is p.POSITIONAL_OR_KEYWORD] == [
        ("kind", "lambert")
    ]
    assert {p.name: p.default for p in parameters if p.kind is p.KEYWORD_ONLY} == {
        "pole": "z",
        "seam": 0.0,
        "polygons": None,
        "density": None,
        "candidates": None,
        "precision": "float64",
        "progress": None,
    }
    with pytest.raises(TypeError, match="positional"):
        map_of(meshes.ball(1)).layout("lambert", "z")


def test_the_docstring_has_all_sections_names_all_parameters_and_its_example_runs():
    text = authalic.SphereMap.layout.__doc__
    for section in ("Parameters", "Returns", "Raises", "Examples"):
        assert f"{section}\n------" in text
    for name in inspect.signature(authalic.SphereMap.layout).parameters:
        assert name == "self" or f"\n{name} : " in text
    test = doctest.DocTestParser().get_doctest(text, {}, "layout", None, 0)
    report = []
    outcome = doctest.DocTestRunner(verbose=False).run(test, out=report.append)
    assert outcome.attempted >= 3
    assert outcome.failed == 0, "".join(report)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_layout_has_the_attributes_of_the_contract(precision):
    mesh = meshes.bumpy_ball()
    layout = authalic.sphere_map(*mesh).layout(precision=precision)
    names = {name for name in dir(layout) if not name.startswith("_")}
    assert names == {"points", "faces", "vertex_of", "status", "seconds", "provenance", "save"}
    assert all(getattr(authalic.Layout, name).__doc__ for name in names)
    assert (layout.points.dtype, layout.points.shape[1:]) == (np.dtype(precision), (2,))
    assert (layout.faces.dtype, layout.faces.shape) == (np.int64, mesh.faces.shape)
    assert (layout.vertex_of.dtype, layout.vertex_of.shape) == (np.int64, (len(layout.points),))
    assert layout.status in {"converged", "stalled"}
    assert type(layout.seconds) is float
    assert repr(layout).startswith(f"Layout({len(layout.points)} points, {len(mesh.faces)} faces, ")
    with pytest.raises(AttributeError):
        layout.points = None


@pytest.mark.parametrize("kind", KINDS)
def test_the_points_are_those_of_the_vertices_split_along_the_seam(kind):
    mesh = meshes.icosphere(3, turned=1)
    layout = laid_out(mesh, kind)
    assert (layout.vertex_of[layout.faces] == mesh.faces).all()
    assert (np.diff(layout.vertex_of) >= 0).all()
    assert (np.unique(layout.vertex_of) == np.arange(len(mesh.vertices))).all()
    assert (np.unique(layout.faces) == np.arange(len(layout.points))).all()
    # the points of one vertex lie apart
    pairs = np.unique(np.column_stack([layout.vertex_of, layout.points]), axis=0)
    assert len(pairs) == len(layout.points)
    counts = np.bincount(layout.vertex_of)
    assert 0 < (counts > 1).sum() < 4 * np.sqrt(len(mesh.faces))


# Areas and gluing


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("turned", [None, 1, 2])
def test_faces_fit_together_and_fill_the_plane(kind, turned):
    mesh = meshes.icosphere(3, turned)
    layout = laid_out(mesh, kind)
    assert oracle.folded(layout.points, layout.faces) == []
    area = oracle.signed_areas(layout.points, layout.faces)
    if kind == "octahedral":
        assert area.sum() == pytest.approx(4 * np.pi, rel=1e-9)
    else:
        assert 0.98 * 4 * np.pi < area.sum() < 4 * np.pi
    (one_start, one_end), (other_start, other_end) = edge_images(layout, mesh)
    joined = np.abs((one_end - one_start) - (other_end - other_start)).max(axis=1) < 1e-9
    if kind == "octahedral":
        joined |= np.abs((one_end - one_start) + (other_end - other_start)).max(axis=1) < 1e-9
    # At a pole of Lambert's cylinder the faces about it come apart.
    at_poles = np.count_nonzero(np.abs(np.abs(corners(layout)[..., 1]) - 1) < 1e-12)
    assert (~joined).sum() == (0 if kind == "octahedral" else at_poles)
    apart = np.abs(one_start - other_start).max(axis=1) > 1e-6
    assert apart.sum() < 6 * np.sqrt(len(mesh.faces))


def test_both_sides_of_a_lambert_seam_are_a_turn_apart():
    mesh = uneven(meshes.icosphere(4))
    layout = laid_out(mesh, "lambert")
    counts = np.bincount(layout.vertex_of)
    poles = np.unique(layout.vertex_of[np.abs(layout.points[:, 1]) == 1])
    for vertex in np.setdiff1d(np.flatnonzero(counts > 1), poles):
        points = layout.points[layout.vertex_of == vertex]
        assert len(points) == 2
        np.testing.assert_allclose(np.abs(points[1] - points[0]), [2 * np.pi, 0], atol=1e-12)


def test_lambert_is_a_rectangle():
    layout = laid_out(uneven(meshes.icosphere(4)), "lambert")
    image = corners(layout)
    low, high = image.min(axis=(0, 1)), image.max(axis=(0, 1))
    assert low[1] == -1
    assert high[1] == 1
    assert -0.02 < low[0] < 0.2
    assert image[..., 0].min(axis=1).max() < 2 * np.pi + 0.02
    assert high[0] > 2 * np.pi
    assert np.ptp(image[..., 0], axis=1).max() < np.pi
    polar = np.abs(image[..., 1]) == 1
    assert 6 <= polar.sum() <= 14
    for face, corner in np.argwhere(polar):
        others = np.delete(image[face, :, 0], corner)
        assert image[face, corner, 0] == pytest.approx(others.mean(), abs=1e-12)


def test_octahedral_is_a_square_with_poles_in_its_middle_and_corners():
    mesh = meshes.icosphere(4)
    layout = laid_out(mesh, "octahedral")
    half = np.sqrt(np.pi)
    assert np.abs(np.abs(layout.points).max(axis=0) - half).max() < 0.1
    z = mesh.vertices[layout.vertex_of, 2]
    radius = np.linalg.norm(layout.points, axis=1)
    assert radius[z > 0.99].max() < 0.3
    corner = np.linalg.norm(np.abs(layout.points) - half, axis=1)
    assert corner[z < -0.99].max() < 0.35
    # the equator is the square between the middles of the sides
    assert np.abs(np.abs(layout.points[np.abs(z) < 0.02]).sum(axis=1) - half).max() < 0.15


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("turned", [None, 4])
def test_areas_come_out_even(kind, turned):
    mesh = meshes.icosphere(4, turned)
    ratios = area_ratios(laid_out(mesh, kind), mesh)
    assert ratios.std() < 0.03
    assert ratios.min() > 0.8
    assert ratios.max() < 1.2


@pytest.mark.parametrize("kind", KINDS)
def test_areas_are_those_of_the_density_given(kind):
    mesh = meshes.icosphere(4, turned=3)
    density = oracle.face_areas(*mesh) * (1 + 0.02 * np.sin(5 * mesh.vertices[mesh.faces[:, 0], 0]))
    layout = laid_out(mesh, kind, density=1e9 * density)
    image = oracle.signed_areas(layout.points, layout.faces)
    ratios = image / density * (density.sum() / image.sum())
    assert ratios.std() < 0.01
    without = laid_out(mesh, kind)
    image = oracle.signed_areas(without.points, without.faces)
    assert ratios.std() < 0.7 * (image / density * (density.sum() / image.sum())).std()
    # the density of the map is the default
    by_map = map_of(mesh, density=density).layout(kind)
    assert (by_map.points == laid_out(mesh, kind, density=density).points).all()


@pytest.mark.parametrize("kind", KINDS)
def test_a_map_is_laid_out_about_as_even_as_it_is(kind):
    mesh = meshes.bumpy_ball(5)
    sphere_map = authalic.sphere_map(*mesh)
    layout = sphere_map.layout(kind)
    ratios = area_ratios(layout, mesh)
    assert oracle.folded(layout.points, layout.faces) == []
    assert ratios.std() < sphere_map.distortion.area_ratio_std + 0.01
    assert ratios.min() > 0.9
    assert ratios.max() < 1.1


# Pole and seam


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("angle", [0.0, 1.0])
def test_pole_axis_and_seam_direction(axis, angle):
    mesh = meshes.icosphere(4)
    layout = laid_out(mesh, "lambert", pole=axis, seam=angle)
    pole, seam = np.eye(3)["xyz".index(axis)], np.array(AXES[axis], float)
    seam = np.cos(angle) * seam + np.sin(angle) * np.cross(pole, seam)
    points = mesh.vertices[layout.vertex_of]
    middle = np.abs(points @ pole) < 0.9
    points, image = points[middle], layout.points[middle]
    # A vertex has been moved onto each pole: by less than an edge.
    np.testing.assert_allclose(image[:, 1], points @ pole, atol=0.1)
    np.testing.assert_allclose(np.cos(image[:, 0]), turn(points, pole) @ seam, atol=0.25)
    quarter = turn(points, pole) @ np.cross(pole, seam)
    np.testing.assert_allclose(np.sin(image[:, 0]), quarter, atol=0.25)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("axis", AXES)
def test_names_and_angles_are_directions(kind, axis):
    sphere_map = map_of(meshes.icosphere(3, turned=6))
    pole = np.eye(3)["xyz".index(axis)]
    named = sphere_map.layout(kind, pole=axis, seam=0.0)
    given = sphere_map.layout(kind, pole=4 * pole, seam=2 * np.array(AXES[axis]))
    assert (named.points == given.points).all()
    # only the component perpendicular to the pole counts
    slanted = sphere_map.layout(kind, pole=pole, seam=np.array(AXES[axis]) + 4 * pole)
    np.testing.assert_allclose(slanted.points, named.points, atol=1e-9)


def test_a_quarter_turn_of_the_pole_on_the_octahedral_square():
    mesh = meshes.icosphere(4)
    layout = laid_out(mesh, "octahedral", pole="z", seam=0.0)
    toward_y = (mesh.vertices[layout.vertex_of] @ [0, 1, 0]) > 0.98
    assert (layout.points[toward_y] @ [0, 1] > 1.5).all()
    toward_minus_x = (mesh.vertices[layout.vertex_of] @ [-1, 0, 0]) > 0.98
    assert (layout.points[toward_minus_x] @ [-1, 0] > 1.5).all()


# Folds


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(4))
def test_random_triangulations_have_no_folds(kind, seed, precision):
    mesh = meshes.icosphere(3, turned=seed)
    noise = 0.025 * np.random.default_rng(seed).normal(size=mesh.vertices.shape)
    moved = meshes.on_the_sphere(meshes.Mesh(mesh.vertices + noise, mesh.faces))
    if (np.linalg.det(moved.vertices[moved.faces]) <= 0).any():
        pytest.skip("the noise folds the sphere itself")
    layout = laid_out(uneven(moved), kind, precision=precision)
    assert all(oracle.exact_area(triangle) > 0 for triangle in layout.points[layout.faces])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("level", [0, 1, 2])
def test_coarse_spheres(kind, level):
    layout = laid_out(meshes.icosphere(level, turned=7), kind, precision="float32")
    assert all(oracle.exact_area(triangle) > 0 for triangle in layout.points[layout.faces])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", sorted(meshes.SPHERES))
def test_maps_of_surfaces_of_all_kinds(kind, name):
    """Maps are laid out without folds, or refused by naming the faces that would fold."""
    mesh = meshes.SPHERES[name]
    sphere_map = authalic.sphere_map(*mesh)
    try:
        layout = sphere_map.layout(kind)
    except authalic.SolverError as problem:
        assert problem.kind == "layout_fold"
        assert 0 < problem.count <= len(mesh.faces)
        assert len(problem.indices) == min(problem.count, 8)
        assert set(problem.indices) <= set(range(len(mesh.faces)))
        assert name in {"tetrahedron", "octahedron", "hedgehog", "capsule", "spiky_ball"}
    else:
        assert (layout.vertex_of[layout.faces] == sphere_map.faces).all()
        assert oracle.folded(layout.points, layout.faces) == []


@pytest.mark.parametrize("kind", KINDS)
def test_a_tetrahedron_is_refused(kind):
    with pytest.raises(authalic.SolverError, match="would fold in a layout in float64") as refusal:
        laid_out(meshes.on_the_sphere(meshes.tetrahedron()), kind)
    assert 0 < refusal.value.count <= 4
    assert refusal.value.kind == "layout_fold"


@pytest.mark.parametrize("kind", KINDS)
def test_a_surface_that_looks_inward_has_no_folds(kind):
    vertices, faces = meshes.bumpy_ball(4)
    layout = authalic.sphere_map(vertices, faces[:, ::-1]).layout(kind)
    assert oracle.folded(layout.points, layout.faces) == []


@pytest.mark.parametrize("kind", KINDS)
def test_inconsistent_faces_are_laid_out_as_the_map_has_them(kind):
    vertices, faces = meshes.bumpy_ball(3)
    faces = faces.copy()
    faces[[5, 50]] = faces[[5, 50], ::-1]
    sphere_map = authalic.sphere_map(vertices, faces)
    layout = sphere_map.layout(kind)
    assert (layout.vertex_of[layout.faces] == sphere_map.faces).all()
    assert oracle.folded(layout.points, layout.faces) == []


# Polygons


@pytest.mark.parametrize("kind", KINDS)
def test_a_cube_of_quads(kind):
    vertices = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    faces = np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])
    polygons = np.tile(np.arange(6), 2)
    layout = laid_out(meshes.on_the_sphere(meshes.Mesh(vertices, faces)), kind, polygons=polygons)
    assert oracle.folded(layout.points, layout.faces) == []
    assert (layout.faces[:6, 0] == layout.faces[6:, 0]).all()
    assert (layout.faces[:6, 2] == layout.faces[6:, 1]).all()
    area = np.bincount(polygons, oracle.signed_areas(layout.points, layout.faces))
    assert area.std() < 0.01 * area.mean()


@pytest.mark.parametrize("kind", KINDS)
def test_polygons_keep_together(kind):
    mesh = meshes.icosphere(3, turned=9)
    polygons = pairs(mesh.faces)
    layout = laid_out(mesh, kind, polygons=polygons)
    assert oracle.folded(layout.points, layout.faces) == []
    key = np.column_stack([np.repeat(polygons, 3), mesh.faces.ravel()])
    corner = np.unique(key, axis=0, return_inverse=True)[1].ravel()
    assert corner.max() + 1 < 0.8 * mesh.faces.size
    # each polygon has one point for each of its vertices
    pairs_of_points = np.unique(np.column_stack([corner, layout.faces.ravel()]), axis=0)
    assert len(pairs_of_points) == corner.max() + 1
    ratios = area_ratios(layout, mesh, np.unique(polygons, return_inverse=True)[1])
    assert ratios.std() < 0.01


def pairs(faces):
    """Numbers (m,), negative ones among them, that two neighboring triangles share wherever possible."""
    owner, partner = {}, np.full(len(faces), -1)
    for face, (a, b, c) in enumerate(faces):
        for edge in ((a, b), (b, c), (c, a)):
            neighbor = owner.setdefault(tuple(sorted(edge)), face)
            if neighbor != face and partner[neighbor] < 0 and partner[face] < 0:
                partner[[neighbor, face]] = face
    return np.where(partner < 0, np.arange(len(faces)), partner) - 100


def test_labels_of_polygons_are_any_integers():
    mesh = meshes.icosphere(2, turned=9)
    polygons, sphere_map = pairs(mesh.faces), map_of(mesh)
    layout = sphere_map.layout(polygons=polygons)
    for labels in (polygons * 10**12, -polygons, polygons.astype(np.int32), polygons.astype(float)):
        assert (sphere_map.layout(polygons=labels).points == layout.points).all()
    # a label of faces that do not meet joins nothing
    assert (sphere_map.layout(polygons=np.arange(len(mesh.faces))).points == sphere_map.layout().points).all()


@pytest.mark.parametrize(("stacks", "slices"), [(8, 16), (12, 24), (32, 64)])
@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_uv_sphere_keeps_its_rings_and_gets_rows_of_equal_area(stacks, slices, precision):
    mesh, polygons, rings = uv_sphere(stacks, slices)
    layout = authalic.sphere_map(*mesh).layout(polygons=polygons, precision=precision)
    assert all(oracle.exact_area(triangle) > 0 for triangle in layout.points[layout.faces])
    height = layout.points[:, 1].astype(float)
    ring = rings[layout.vertex_of]
    # 1. straight rings, as the projection of the sphere has them but for what poles cost
    for number in range(stacks + 1):
        assert np.ptp(height[ring == number]) < 1e-4
    assert (height[ring == 0] == 1).all()
    assert (height[ring == stacks] == -1).all()
    np.testing.assert_allclose(height, np.cos(np.pi * ring / stacks), atol=0.6 / stacks)
    # 2. evenly spaced vertices, so equal triangles at the poles
    longitude = np.sort(layout.points[ring == stacks // 2, 0].astype(float))
    np.testing.assert_allclose(np.diff(longitude), 2 * np.pi / slices, atol=1e-3)
    areas = oracle.signed_areas(layout.points, layout.faces)
    for pole in (0, stacks):
        at_pole = (rings[mesh.faces] == pole).any(axis=1)
        assert at_pole.sum() == slices
        assert np.ptp(areas[at_pole]) < 1e-3 * areas[at_pole].mean()
    # 3. rows with the areas that they have on the surface
    ratios = area_ratios(layout, mesh, polygons)
    assert ratios.min() > 0.99
    assert ratios.max() < 1.01
    assert ratios.std() < 0.005


def test_a_uv_sphere_keeps_its_poles():
    mesh, polygons, _ = uv_sphere(12, 24)
    image = corners(laid_out(mesh, "lambert", polygons=polygons))
    assert (np.abs(image[..., 1]) == 1).sum() == 48
    assert np.ptp(image[..., 0]) == pytest.approx(2 * np.pi, abs=1e-4)
    # The rows stay rows, a bit lower, where polar faces need room.
    np.testing.assert_allclose(image[..., 1], mesh.vertices[mesh.faces][..., 2], atol=0.05)
    assert len(np.unique(image[..., 1].round(4))) == 13


# Candidates


def test_vertices_that_are_no_candidates_are_at_no_pole():
    mesh = meshes.icosphere(2)
    may = mesh.vertices[:, 2] < 0.9
    sphere_map = map_of(mesh)
    layout = sphere_map.layout(candidates=may)
    at_pole = np.unique(layout.vertex_of[np.abs(layout.points[:, 1]) == 1])
    assert len(at_pole) == 2
    assert may[at_pole].all()
    by_index = sphere_map.layout(candidates=np.flatnonzero(may))
    assert (by_index.points == layout.points).all()
    free = sphere_map.layout()
    at_pole = np.unique(free.vertex_of[np.abs(free.points[:, 1]) == 1])
    assert not may[at_pole].all()


# Refined maps


@pytest.mark.parametrize("kind", KINDS)
def test_a_refined_map_is_laid_out_with_the_parts_of_its_faces(kind):
    mesh = meshes.limbed_ball(3, 4.0)
    sphere_map = authalic.sphere_map(*mesh, refine=True)
    parts = sphere_map.refinement
    assert len(parts.parents) > 0
    layout = sphere_map.layout(kind)
    assert (layout.vertex_of[layout.faces] == parts.faces).all()
    assert oracle.folded(layout.points, layout.faces) == []
    surface = np.vstack([mesh.vertices, parts.vertices])
    whole = np.bincount(parts.face_of, oracle.signed_areas(layout.points, layout.faces))
    wanted = np.bincount(parts.face_of, oracle.face_areas(surface, parts.faces))
    ratios = whole / wanted * (wanted.sum() / whole.sum())
    assert ratios.std() < sphere_map.distortion.area_ratio_std + 0.02
    # options that are arrays speak of the faces and vertices of the map
    polygons = np.arange(len(mesh.faces))
    assert (sphere_map.layout(kind, polygons=polygons).points == layout.points).all()
    again = sphere_map.layout(
        kind, density=oracle.face_areas(*mesh), candidates=np.ones(len(mesh.vertices), bool)
    )
    assert oracle.folded(again.points, again.faces) == []
    with pytest.raises(authalic.MeshError, match="polygons must be of shape"):
        sphere_map.layout(kind, polygons=parts.face_of)


def test_maps_of_a_registration_are_laid_out():
    source, target = meshes.bumpy_ball(3), meshes.rough_ball(3, noise=0.05)
    landmarks = [0, 1, 2, 3]
    registered = authalic.register_spheres(
        source, target, source_landmarks=landmarks, target_landmarks=landmarks
    )
    for sphere_map, mesh in ((registered.source_map, source), (registered.target_map, target)):
        layout = sphere_map.layout("octahedral")
        assert oracle.folded(layout.points, layout.faces) == []
        assert area_ratios(layout, mesh).std() < sphere_map.distortion.area_ratio_std + 0.02


# Open surfaces


def covered(layout, points):
    """The number of faces in which each point lies."""
    a, b, c = corners(layout).transpose(1, 0, 2)
    x, y = points.T[..., None]
    sides = [
        (q - p)[:, 0] * (y - p[:, 1]) - (q - p)[:, 1] * (x - p[:, 0]) for p, q in ((a, b), (b, c), (c, a))
    ]
    return (np.min(sides, axis=0) > 1e-12).sum(axis=1)


def opened_ball(is_hole):
    ball = meshes.bumpy_ball(3)
    middles = ball.vertices[ball.faces].mean(axis=1)
    middles /= np.linalg.norm(middles, axis=1, keepdims=True)
    return meshes.compact(meshes.Mesh(ball.vertices, ball.faces[~is_hole(middles)]))


HOLES = {
    "a pole": lambda x: x[:, 2] > 0.8,
    "both poles": lambda x: abs(x[:, 2]) > 0.7,
    "six": lambda x: (abs(x) > 0.93).any(axis=1),
    "a long slit": lambda x: (abs(x[:, 0]) < 0.2) & (x[:, 2] > -0.5),
    "more than half": lambda x: x[:, 2] > -0.3,
}


@pytest.mark.parametrize("kind", ["lambert", "octahedral"])
@pytest.mark.parametrize("pole", ["x", "z"])
@pytest.mark.parametrize("holes", HOLES)
def test_holes_stay_open_in_a_layout_that_lies_nowhere_over_itself(kind, pole, holes):
    mesh = opened_ball(HOLES[holes])
    ball = authalic.sphere_map(*mesh, fill_holes=True)
    layout = ball.layout(kind, pole=pole)
    # the points are those of the surface alone, all of them in a face
    assert layout.faces.shape == mesh.faces.shape
    assert np.array_equal(layout.vertex_of[layout.faces], ball.faces)
    assert np.array_equal(np.unique(layout.faces), np.arange(len(layout.points)))
    assert (np.diff(layout.vertex_of) >= 0).all()
    assert oracle.folded(layout.points, layout.faces) == []
    # areas are those on the sphere, holes left out
    area = oracle.signed_areas(layout.points, layout.faces)
    on_sphere = oracle.face_areas(ball.positions, ball.faces)
    assert area.sum() == pytest.approx(on_sphere.sum(), rel=0.05)
    assert area_ratios(layout, mesh).std() < (0.06 if holes == "more than half" else 0.03)
    # no point lies in two faces, nor in the next period of a Lambert layout
    rng = np.random.default_rng(4)
    weights = rng.dirichlet([1, 1, 1], len(mesh.faces))
    inside = np.einsum("ij,ijk->ik", weights, layout.points[layout.faces])
    turn = [2 * np.pi, 0] if kind == "lambert" else [0, 0]
    for shift in ([0, 0], turn):
        assert (covered(layout, inside + shift) <= 1).all()
    saved = pickle.loads(pickle.dumps(ball)).layout(kind, pole=pole)
    assert np.array_equal(saved.points, layout.points)


def test_polygons_and_densities_are_those_of_the_given_faces():
    mesh = opened_ball(HOLES["a pole"])
    ball = authalic.sphere_map(*mesh, fill_holes=True)
    density = np.where(np.arange(len(mesh.faces)) % 2, 1.0, 1.2)
    layout = ball.layout(density=density * oracle.face_areas(*mesh))
    area = oracle.signed_areas(layout.points, layout.faces) / oracle.face_areas(*mesh)
    assert area[1::2].mean() / area[::2].mean() == pytest.approx(1 / 1.2, rel=0.01)
    polygons = ball.layout(polygons=np.arange(len(mesh.faces)) // 2)
    assert oracle.folded(polygons.points, polygons.faces) == []
    with pytest.raises(authalic.MeshError, match=f"of shape \\({len(mesh.faces)},\\)"):
        ball.layout(density=np.ones(len(mesh.faces) + 1))


def test_maps_of_a_registration_with_filled_holes_are_laid_out():
    source, target = opened_ball(HOLES["a pole"]), meshes.bumpy_ball(3)
    registered = authalic.register_spheres(
        source, target, source_landmarks=[10, 200], target_landmarks=[10, 200], fill_holes=True
    )
    for each in (registered, pickle.loads(pickle.dumps(registered))):
        layout = each.source_map.layout()
        assert np.array_equal(layout.vertex_of[layout.faces], each.source_map.faces)
        assert oracle.folded(layout.points, layout.faces) == []


def test_a_map_whose_holes_nobody_filled_is_refused(tmp_path):
    """As files of earlier versions have it."""
    ball = authalic.sphere_map(*opened_ball(HOLES["six"]), fill_holes=True)
    ball.save(tmp_path / "ball.npz")
    with np.load(tmp_path / "ball.npz") as entries:
        arrays = {name: array for name, array in entries.items() if not name.startswith("_filling")}
    table = json.loads(str(arrays["authalic"]))
    del table["content"]["state"]["_filling"]
    np.savez(tmp_path / "old.npz", **{**arrays, "authalic": np.array(json.dumps(table))})
    old = authalic.load(tmp_path / "old.npz")
    assert np.array_equal(old.positions, ball.positions)
    with pytest.raises(authalic.MeshError, match=r"has holes, .* map the surface anew") as caught:
        old.layout()
    assert caught.value.kind == "open_surface"
    rims = np.concatenate(authalic.Surface(ball.positions, ball.faces).boundary_loops)
    assert caught.value.count == len(rims)
    assert set(caught.value.indices) <= set(rims.tolist())


# Runs


def test_progress_grows_from_0_to_1_with_messages():
    heard = []
    authalic.sphere_map(*meshes.bumpy_ball(4)).layout(
        "octahedral", progress=lambda fraction, message: heard.append((fraction, message))
    )
    fractions = [fraction for fraction, _ in heard]
    assert fractions == sorted(fractions)
    assert fractions[0] == 0
    assert fractions[-1] == 1
    assert all(message for _, message in heard)
    assert len({message for _, message in heard}) >= 3


def test_listening_changes_no_bit():
    sphere_map = authalic.sphere_map(*meshes.bumpy_ball(4))
    silent, heard = sphere_map.layout(), sphere_map.layout(progress=lambda fraction, message: True)
    assert (silent.points == heard.points).all()
    assert (silent.faces == heard.faces).all()


@pytest.mark.parametrize("last", range(8))
def test_a_false_answer_cancels_and_leaves_a_sound_layout_or_none(last):
    sphere_map = authalic.sphere_map(*meshes.bumpy_ball(5))
    heard = []

    def progress(fraction, message):
        heard.append(fraction)
        return len(heard) <= last

    try:
        layout = sphere_map.layout("octahedral", progress=progress)
    except authalic.SolverError as problem:
        assert problem.kind == "cancelled"
        assert last < 3
    else:
        assert layout.status == "cancelled"
        assert oracle.folded(layout.points, layout.faces) == []
    assert len(heard) == last + 1


def test_an_exception_of_the_progress_function_comes_through():
    def progress(fraction, message):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        map_of(meshes.ball(2)).layout(progress=progress)


DIGEST = """
import hashlib, numpy as np, authalic
from api import meshes
for mesh in (meshes.bumpy_ball(5), meshes.SPHERES["parallels"]):
    sphere_map = authalic.sphere_map(*mesh)
    for kind in ("lambert", "octahedral"):
        for options in ({}, {"precision": "float32"}, {"polygons": np.arange(len(mesh.faces)) // 2}):
            layout = sphere_map.layout(kind, **options)
            for array in (layout.points, layout.faces, layout.vertex_of):
                print(hashlib.sha256(array.tobytes()).hexdigest())
"""


def test_one_and_several_threads_give_the_same_bits(run_python):
    one, two, seven = (run_python(DIGEST, RAYON_NUM_THREADS=threads) for threads in ("1", "2", "7"))
    assert len(one.split("\n")) == 36
    assert one == two == seven


INTERRUPT = """
import json, signal, threading, authalic
from api import effort, meshes
authalic.set_threads(effort.THREADS)
# a shell's background job inherits SIGINT ignored, and Python then installs no handler of its own
signal.signal(signal.SIGINT, signal.default_int_handler)
mesh = meshes.bumpy_ball(7)
sphere_map = authalic.sphere_map(
    *mesh, method="fixed_point", max_iterations=0, initial=meshes.ball(7).vertices, unfold=False
)
sent, asked = [], []
def stop():
    sent.append(effort.spent())
    {stop}
def progress(fraction, message):
    return not sent
threading.Timer({delay}, stop).start()
try:
    while True:  # a fast machine may be done before it is stopped
        sphere_map.layout("octahedral", progress={progress})
except KeyboardInterrupt:
    outcome = "interrupted"
except authalic.SolverError as problem:
    outcome = problem.kind
print(json.dumps([outcome, effort.spent() - sent[0]]))
"""


@pytest.mark.parametrize("delay", [0.02, 0.15, 0.5])
@pytest.mark.parametrize(
    ("stop", "progress", "outcome"),
    [("signal.raise_signal(signal.SIGINT)", None, "interrupted"), ("pass", "progress", "cancelled")],
    ids=["Ctrl-C", "False"],
)
def test_a_run_on_a_hundred_thousand_faces_ends_at_once(run_python, delay, stop, progress, outcome):
    """0.2 s of work is promised; the bound leaves room for a slow machine."""
    code = INTERRUPT.format(delay=delay, stop=stop, progress=progress)
    result, latency = json.loads(run_python(code))
    print(f"{outcome} after {delay} s was answered after {latency:.3f} s")
    assert result == outcome
    assert latency < 1.0


# Hostile input


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"kind": "mercator"}, 'kind must be "lambert" or "octahedral", but is "mercator"'),
        ({"kind": "LAMBERT"}, 'kind must be "lambert" or "octahedral", but is "LAMBERT"'),
        ({"precision": "float16"}, 'precision must be "float64" or "float32", but is "float16"'),
        ({"pole": "w"}, 'pole must be "x", "y", "z" or a direction, but is "w"'),
        ({"pole": [0, 0, 0]}, "pole must be a finite direction (x, y, z), not zero, but is [0.0, 0.0, 0.0]"),
        (
            {"pole": [np.nan, 0, 1]},
            "pole must be a finite direction (x, y, z), not zero, but is [NaN, 0.0, 1.0]",
        ),
        (
            {"pole": [np.inf, 0, 1]},
            "pole must be a finite direction (x, y, z), not zero, but is [inf, 0.0, 1.0]",
        ),
        ({"seam": np.nan}, "seam must be a finite angle in radians, or a direction, but is NaN"),
        ({"seam": np.inf}, "seam must be a finite angle in radians, or a direction, but is inf"),
        ({"seam": [0, 0, 2]}, "seam must be a finite direction (x, y, z), not parallel to the pole, but is"),
        ({"seam": [0, 0, 0]}, "seam must be a finite direction (x, y, z), not parallel to the pole, but is"),
    ],
)
def test_an_option_out_of_range_is_a_plain_value_error(options, words):
    with pytest.raises(ValueError) as refusal:
        map_of(meshes.ball(2)).layout(**options)
    assert words in str(refusal.value)
    assert type(refusal.value) is ValueError
    assert refusal.value.kind == "invalid_option"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"pole": [0, 1]}, "pole must be of shape (3,), a direction, but is of shape (2,)"),
        ({"pole": [[0, 0, 1]]}, "pole must be of shape (3,), a direction, but is of shape (1, 3)"),
        ({"pole": [0, 0, 1j]}, "pole must be of shape (3,), a direction, but is of dtype complex128"),
        ({"seam": "back"}, "seam must be of shape (3,), a direction, but is of shape ()"),
        ({"seam": [1, 2]}, "seam must be of shape (3,), a direction, but is of shape (2,)"),
        ({"polygons": [1, 2]}, "polygons must be of shape (128,), one number per face, but is of shape (2,)"),
        ({"polygons": np.zeros((128, 1), int)}, "polygons must be of shape (m,), one number per face"),
        ({"polygons": np.full(128, 0.5)}, "polygons must be integers, but is not whole: 0.5"),
        ({"polygons": np.full(128, "a")}, "polygons must be integers, but is of dtype"),
        ({"density": np.ones(3)}, "density must be of shape (128,), one value per face"),
        ({"density": np.zeros(128)}, "density must be positive, finite"),
        ({"density": np.full(128, np.nan)}, "density must be positive, finite"),
        ({"candidates": [0, 66]}, "candidates must be indices of the 66 vertices"),
        ({"candidates": [-1, 0]}, "candidates must be indices of the 66 vertices"),
        ({"candidates": np.ones(5, bool)}, "candidates must be of shape (66,), one truth value per vertex"),
        (
            {"candidates": [3]},
            "candidates must be at least 2 vertices, one for each singular point, but is 1",
        ),
        ({"candidates": []}, "candidates must be at least 2 vertices, one for each singular point, but is 0"),
    ],
)
def test_an_array_that_does_not_fit_is_a_mesh_error(options, words):
    with pytest.raises(authalic.MeshError) as refusal:
        map_of(meshes.ball(2)).layout(**options)
    assert words in str(refusal.value)


@pytest.mark.parametrize("options", [{"kind": 3}, {"precision": 32}, {"progress": 1}])
def test_an_option_of_the_wrong_type_is_a_type_error(options):
    with pytest.raises(TypeError):
        map_of(meshes.ball(2)).layout(**options)


@pytest.mark.parametrize("kind", KINDS)
def test_polygons_that_wind_around_the_sphere_are_refused_by_naming_them(kind):
    mesh = meshes.icosphere(3)
    with pytest.raises(authalic.SolverError, match="would fold") as refusal:
        laid_out(mesh, kind, polygons=np.zeros(len(mesh.faces), int))
    assert refusal.value.count == len(mesh.faces)


@pytest.mark.parametrize("kind", KINDS)
def test_spoiled_maps_never_crash(kind):
    """Any positions give a layout without folds or an error."""
    random = np.random.default_rng(3)
    for spoil in (
        lambda positions: positions * 0,
        lambda positions: positions * 1e200,
        lambda positions: -positions,
        lambda positions: random.normal(size=positions.shape),
        lambda positions: np.tile(positions[:1], (len(positions), 1)),
        lambda positions: positions * [1, 1, 1e-12],
    ):
        sphere_map = map_of(meshes.ball(2))
        restore, (name, state, _) = sphere_map.__reduce__()
        positions = spoil(np.array(sphere_map.positions))
        sphere_map = restore(name, {**state, "positions": positions}, None)
        try:
            layout = sphere_map.layout(kind)
        except (authalic.SolverError, authalic.MeshError) as problem:
            assert problem.kind in {"layout_fold", "no_direction"}, str(problem)
        else:
            assert oracle.folded(layout.points, layout.faces) == []


# Real meshes


@pytest.mark.parametrize("kind", KINDS)
def test_a_sphere_of_a_cortex(kind):
    with np.load(real_meshes.file("brain/fsaverage5_left_10242.npz")) as arrays:
        key = next(key for key in arrays if key in ("F", "faces"))
        mesh = meshes.on_the_sphere(meshes.Mesh(arrays["V_sphere"].astype(float), arrays[key].astype(int)))
    layout = laid_out(mesh, kind, precision="float32")
    assert oracle.folded(layout.points.astype(float), layout.faces) == []


@pytest.mark.parametrize("kind", KINDS)
def test_a_cow(kind):
    mesh = real_meshes.load(real_meshes.file("sphere/spot_2930.npz"))
    sphere_map = authalic.sphere_map(*mesh)
    layout = sphere_map.layout(kind, precision="float32")
    assert all(oracle.exact_area(triangle) > 0 for triangle in layout.points[layout.faces])
    assert area_ratios(layout, mesh).std() < sphere_map.distortion.area_ratio_std + 0.02
