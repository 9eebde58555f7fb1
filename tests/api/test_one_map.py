# SPDX-License-Identifier: MIT OR Apache-2.0
"""One map: noise, rotations and numbering do not move it, and no tolerance buys more shear than it needs."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import authalic

from . import meshes, real_meshes

NOISE = 1e-12
"""The noise as a fraction of the surface's size; far below a scanner's error, far above rounding."""

STABLE = 1e-6
"""The farthest that noise may move a vertex, in units of the image's radius."""

CLOSED = {name: meshes.SPHERES[name] for name in ("bumpy_ball", "rough_ball")}
OPEN = {name: meshes.DISKS[name] for name in ("bumpy_cap", "rough_cap")}
weights = pytest.mark.parametrize("angle_weight", [0.0, 1e-3])


def image_of(mesh, **options):
    """The image of an open or closed surface, (n, 2) or (n, 3)."""
    is_closed = len(mesh[1]) == 2 * len(mesh[0]) - 4
    if is_closed:
        return authalic.sphere_map(*mesh, **options).positions
    return authalic.disk_map(*mesh, **options).uv


def turned_onto(image, goal):
    """`image` after the rotation that lays it best over `goal`."""
    u, _, v = np.linalg.svd(image.T @ goal)
    signs = np.ones(image.shape[1])
    signs[-1] = np.sign(np.linalg.det(u @ v))
    return image @ (u * signs) @ v


def noisy(mesh, amount=NOISE):
    vertices, faces = mesh
    size = np.linalg.norm(np.ptp(vertices, axis=0))
    return vertices + amount * size * np.random.default_rng(5).standard_normal(vertices.shape), faces


def rotated(mesh):
    turn, _ = np.linalg.qr(np.random.default_rng(4).standard_normal((3, 3)))
    return mesh[0] @ (turn * np.sign(np.linalg.det(turn))), mesh[1]


def renumbered(mesh):
    """The mesh with its vertices and faces in another order, and the new place of each vertex."""
    vertices, faces = mesh
    random = np.random.default_rng(8)
    place = random.permutation(len(vertices))
    moved = np.empty_like(vertices)
    moved[place] = vertices
    return (moved, np.roll(place[faces], 1, axis=1)[random.permutation(len(faces))]), place


def assert_one_map(mesh, **options):
    plain = image_of(mesh, **options)
    for changed in (noisy(mesh), rotated(mesh)):
        moved = image_of(changed, **options)
        assert np.abs(turned_onto(moved, plain) - plain).max() < STABLE
    changed, place = renumbered(mesh)
    moved = image_of(changed, **options)[place]
    assert np.abs(turned_onto(moved, plain) - plain).max() < STABLE


@weights
@pytest.mark.parametrize("name", [*OPEN, *CLOSED])
def test_noise_rotation_and_numbering_do_not_move_the_map(name, angle_weight, request):
    if (name, angle_weight) == ("bumpy_cap", 0.0):
        reason = "known: a hundred steps of a small coarse disk amplify noise to 3e-3"
        request.applymarker(pytest.mark.xfail(reason=reason))
    assert_one_map({**OPEN, **CLOSED}[name], angle_weight=angle_weight)


UNSTABLE = {"bull_6200": (0.0, 1e-3), "cowboyhat_2327": (0.0,)}
"""Known misses: the bull's horns move by up to 6e-2, the hat by 2e-6 if areas alone count."""


@weights
@real_meshes.each("disk", "sphere")
def test_noise_does_not_move_real_maps(path, angle_weight, request):
    if angle_weight in UNSTABLE.get(path.stem, ()):
        request.applymarker(pytest.mark.xfail(reason="known: noise moves this map by more than 1e-6"))
    mesh = real_meshes.load(path)
    if len(mesh[0]) > 20_000:
        pytest.skip("takes long; the smaller ones suffice here")
    plain = image_of(mesh, angle_weight=angle_weight)
    moved = image_of(noisy(mesh), angle_weight=angle_weight)
    assert np.abs(turned_onto(moved, plain) - plain).max() < STABLE


@pytest.mark.parametrize("boundary", ["sliding", "arc_length", "free"])
@pytest.mark.parametrize("name", [*OPEN, "slit_sphere"])
def test_a_disk_has_one_rotation(name, boundary):
    """The first boundary vertex lies at (1, 0), or to the right of the mean."""
    vertices, faces = meshes.DISKS[name]
    result = authalic.disk_map(vertices, faces, boundary=boundary, angle_weight=1e-3)
    directed = {(a, b) for face in faces.tolist() for a, b in zip(face, face[1:] + face[:1], strict=True)}
    first = min(a for a, b in directed if (b, a) not in directed)
    if boundary == "free":
        x, y = result.uv[first] - result.uv.mean(axis=0)
        assert x > 0 and abs(y) < 1e-9
    else:
        np.testing.assert_allclose(result.uv[first], [1, 0], rtol=0, atol=1e-15)
        assert np.abs(result.uv).max() <= 1


def test_noise_does_not_move_limbs():
    """The descent goes to a stationary point at every stage, which forgets what noise has done on the way."""
    mesh = meshes.limbed_ball()
    results = [authalic.sphere_map(*surface, angle_weight=1e-3) for surface in (mesh, noisy(mesh))]
    assert all(result.status == "converged" for result in results)
    assert all(len(result.distortion.folded) == 0 for result in results)
    plain, moved = (result.positions for result in results)
    assert np.abs(turned_onto(moved, plain) - plain).max() < STABLE


@pytest.mark.parametrize("name", [*OPEN, *CLOSED])
@pytest.mark.parametrize("tolerance", [0.05, 0.01])
def test_a_tolerance_of_areas_is_met_with_less_shear(name, tolerance):
    mesh = {**OPEN, **CLOSED}[name]
    call = authalic.disk_map if name in OPEN else authalic.sphere_map
    result = call(*mesh, area_tolerance=tolerance)
    full = np.pi if name in OPEN else 4 * np.pi
    deviation = np.sqrt(result.distortion.authalic_energy / full)
    assert result.status == "converged"
    assert len(result.distortion.folded) == 0
    assert deviation <= 1.02 * tolerance  # the image's area is a little less than the whole
    even, rigid = call(*mesh), call(*mesh, angle_weight=1.0)
    has_less = result.distortion.angle_distortion_mean < even.distortion.angle_distortion_mean
    # or the least shear of all is that even already
    assert has_less or rigid.distortion.area_ratio_std <= 1.5 * tolerance


@pytest.mark.parametrize("tolerance", [0.2, 0.3])
@pytest.mark.parametrize("kind", ["sliding", "free", "rectangle", "sphere"])
def test_a_wide_tolerance_of_areas_is_made_use_of(kind, tolerance):
    """If even a weight of 1 leaves areas within the tolerance, a larger weight has less shear."""
    if kind == "sphere":
        mesh = meshes.bumpy_ball()
        call, full = authalic.sphere_map, 4 * np.pi
    else:
        mesh = meshes.bumpy_cap()
        full = None
        call = lambda *mesh, **options: authalic.disk_map(*mesh, boundary=kind, **options)  # noqa: E731
    result, lighter = call(*mesh, area_tolerance=tolerance), call(*mesh, angle_weight=1.0)

    def deviation(of):
        area = full or polygon_area(of.uv[of.faces])
        return np.sqrt(of.distortion.authalic_energy / area)

    assert result.status == "converged" and len(result.distortion.folded) == 0
    assert deviation(result) <= 1.02 * tolerance
    if deviation(lighter) < 0.9 * tolerance:
        assert result.distortion.angle_distortion_mean < lighter.distortion.angle_distortion_mean


def polygon_area(corners):
    (ax, ay), (bx, by), (cx, cy) = (corners[:, k].T for k in range(3))
    return 0.5 * ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)).sum()


def coarse_balls():
    """Small random polyhedra around the origin, as convex hulls of points on an ellipsoid."""
    for seed in range(8):
        points = np.random.default_rng(seed).standard_normal((12 + 7 * seed, 3))
        points /= np.linalg.norm(points, axis=1, keepdims=True)
        faces = ConvexHull(points).simplices
        a, b, c = np.moveaxis(points[faces], 1, 0)
        inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
        faces[inward] = faces[inward][:, ::-1]
        yield meshes.Mesh(points * [1, 2, 3], faces.astype(np.int64))


def test_noise_does_not_move_coarse_spheres():
    for mesh in coarse_balls():
        results = [authalic.sphere_map(*surface, angle_weight=1e-3) for surface in (mesh, noisy(mesh))]
        assert {result.status for result in results} == {"converged"}
        plain, moved = (result.positions for result in results)
        assert np.abs(turned_onto(moved, plain) - plain).max() < STABLE


@pytest.mark.parametrize("aspect", [1.0, 2.0, 2 + np.sqrt(3)])
def test_noise_does_not_change_the_size_of_a_free_outline(aspect):
    """Nothing jumps at a radius that is a power of two."""
    mesh = meshes.grid(15, 4, aspect=aspect)
    sizes = []
    for seed in range(6):
        noise = NOISE * np.random.default_rng(seed).standard_normal(mesh.vertices.shape)
        result = authalic.disk_map(mesh.vertices + noise, mesh.faces, boundary="free", angle_weight=1e-3)
        sizes.append(np.abs(result.uv).max())
        assert np.hypot(*result.uv.T).max() <= 1
    assert np.ptp(sizes) < STABLE


@pytest.mark.parametrize("angle_weight", [1e-9, 3e-7])
def test_the_lightest_weights_come_to_an_end(angle_weight):
    result = authalic.sphere_map(*meshes.limbed_ball(3), angle_weight=angle_weight)
    assert result.status != "max_iterations" and len(result.distortion.folded) == 0


def test_a_tolerance_of_areas_excludes_a_weight():
    for call, mesh in ((authalic.disk_map, meshes.fan()), (authalic.sphere_map, meshes.bumpy_ball())):
        with pytest.raises(ValueError, match="area_tolerance must be not given together with angle_weight"):
            call(*mesh, area_tolerance=0.01, angle_weight=0.1)


def test_a_tolerance_that_cannot_be_met_is_said():
    mesh = meshes.DISKS["slit_sphere"]
    result = authalic.disk_map(*mesh, area_tolerance=1e-13)
    assert result.status == "stalled"
    assert len(result.distortion.folded) == 0


@pytest.mark.parametrize("boundary", ["sliding", "rectangle", "free", "sphere"])
def test_a_limit_of_iterations_is_one_for_the_whole_search(boundary):
    if boundary == "sphere":
        result = authalic.sphere_map(*meshes.bumpy_ball(), area_tolerance=1e-3, max_iterations=5)
    else:
        mesh = meshes.DISKS["bumpy_cap"]
        result = authalic.disk_map(*mesh, boundary=boundary, area_tolerance=1e-3, max_iterations=5)
    # up to five fixed-point steps come first
    assert result.status == "max_iterations" and result.iterations <= 10


def test_no_weight_within_the_tolerance_has_much_less_shear():
    """A map that has become sheared on the way down to an even one stays so."""
    vertices, faces = meshes.ball()
    vertices = vertices / np.abs(vertices).sum(axis=1, keepdims=True) * [4, 1, 1]
    vertices = vertices + 0.05 * np.sin(3 * vertices)
    tolerance = 0.03
    result = authalic.sphere_map(vertices, faces, area_tolerance=tolerance)
    area = 4 * np.pi
    shear = []
    for weight in (1e-3, 3e-3, 1e-2, 3e-2):
        weighted = authalic.sphere_map(vertices, faces, angle_weight=weight).distortion
        if np.sqrt(weighted.authalic_energy / area) <= tolerance:
            shear.append(weighted.angle_distortion_mean)
    assert shear and np.sqrt(result.distortion.authalic_energy / area) <= 1.02 * tolerance
    assert result.distortion.angle_distortion_mean < 1.03 * min(shear)
