# SPDX-License-Identifier: MIT OR Apache-2.0
"""The promises of the default method: small area errors, no fold on any shape, areas against angles."""

import json
import time

import numpy as np
import pytest

import authalic

from . import effort, meshes, oracle, random_checks, random_meshes, real_meshes
from .test_runs import bumpy_square

DISK_FACTOR, SPHERE_FACTOR = 30, 100
"""The factors by which E_A is smaller than after the papers' 50 and 100 iterations without folds."""


def fine_capsule(aspect, around=24):
    """A tube with round ends, `aspect` times longer than wide, its faces about equilateral."""
    step = 2 * np.pi / around
    polar = np.linspace(0, np.pi / 2, 2 + int(np.pi / 2 / step))[1:]
    along = np.linspace(0, 2 * (aspect - 1), 2 + int(2 * (aspect - 1) / step))[1:-1]
    height = np.concatenate([1 - np.cos(polar), 1 + along, 2 * aspect - 1 + np.cos(polar[::-1])])
    radius = np.concatenate([np.sin(polar), np.ones(len(along)), np.sin(polar[::-1])])
    return random_meshes.closed_tube(height, radius, around, 2 * aspect)


def flat_tube(length, around=10):
    """A closed tube of constant width with flat ends, `length` times longer than wide."""
    rings = int(length * around / np.pi) + 1
    height = np.linspace(0, 2 * length, rings)
    return random_meshes.closed_tube(height, np.ones(rings), around, 2 * length)


def horned(sharpness, length, level=5):
    """A ball with one thin horn."""
    return meshes.radial(lambda x, y, z: 1 + length * np.exp(-sharpness * (1 - z)), level)


def graded(areas, level=4):
    """A ball on which vertices are drawn toward a pole, so that face areas differ by a factor of `areas`."""
    mesh = meshes.ball(level)
    power = np.linspace(1, 12, 200)
    spread = [ratio_of(drawn(mesh, p)) for p in power]
    return drawn(mesh, power[int(np.searchsorted(spread, areas))])


def drawn(mesh, power):
    x, y, z = mesh.vertices.T
    polar = np.pi * (np.arccos(np.clip(z, -1, 1)) / np.pi) ** power
    angle = np.arctan2(y, x)
    points = np.stack([np.sin(polar) * np.cos(angle), np.sin(polar) * np.sin(angle), np.cos(polar)], axis=1)
    return meshes.Mesh(points, mesh.faces)


def ratio_of(mesh):
    areas = oracle.face_areas(*mesh)
    return areas.max() / max(areas.min(), 1e-300)


def figures(result):
    return result.distortion.area_ratio_std, result.distortion.angle_distortion_mean


# Exactness; on coarser and smoother meshes the papers' methods come near the least E_A themselves


FINE_DISKS = {
    "bumpy_square": bumpy_square(90),
    "slit_sphere": meshes.slit_sphere(40, 60),
}
FINE_SPHERES = {
    "bumpy_ball": meshes.bumpy_ball(5),
    "capsule": fine_capsule(4),
}


@pytest.mark.parametrize("name", FINE_DISKS)
def test_disks_are_far_more_exact_than_by_conjugate_gradients(name):
    mesh = FINE_DISKS[name]
    default, published = (authalic.disk_map(*mesh, method=m) for m in ("gauss_newton", "conjugate_gradient"))
    oracle.assert_disk_embedding(default)
    energy, papers = (
        oracle.authalic_energy(r.uv, r.faces, oracle.face_areas(*mesh)) for r in (default, published)
    )
    assert energy <= papers / DISK_FACTOR


@pytest.mark.parametrize("name", FINE_SPHERES)
def test_spheres_are_far_more_exact_than_by_gradient_descent(name):
    mesh = FINE_SPHERES[name]
    default, published = (authalic.sphere_map(*mesh, method=m) for m in ("gauss_newton", "gradient_descent"))
    oracle.assert_sphere_embedding(default)
    targets = oracle.face_areas(*mesh)
    energy, papers = (oracle.sphere_energy(r.positions, r.faces, targets) for r in (default, published))
    assert energy <= papers / SPHERE_FACTOR


@pytest.mark.parametrize("tolerance", [1e-1, 1e-2])
def test_the_tolerance_is_that_of_the_deviation_of_the_area_ratio(tolerance):
    disk = authalic.disk_map(*bumpy_square(40), tolerance=tolerance)
    sphere = authalic.sphere_map(*meshes.bumpy_ball(4), tolerance=tolerance)
    for result in (disk, sphere):
        assert result.status == "converged"
        assert result.distortion.area_ratio_std < 1.01 * tolerance


def test_a_limit_of_iterations_is_kept():
    """Not counted are the steps of the start and the steps that unfold it."""
    for limit in (0, 1, 3):
        disk = authalic.disk_map(*meshes.DISKS["rough_cap"], max_iterations=limit)
        sphere = authalic.sphere_map(*meshes.SPHERES["bumpy_ball"], max_iterations=limit)
        assert disk.iterations <= 5 + 2 * limit
        assert sphere.iterations <= 5 + limit
        oracle.assert_disk_embedding(disk)
        oracle.assert_sphere_embedding(sphere)


@pytest.mark.parametrize("boundary", ["sliding", "arc_length"])
def test_a_restart_of_a_disk_continues(boundary):
    mesh = meshes.DISKS["rough_cap"]
    start = authalic.disk_map(*mesh, boundary=boundary, method="fixed_point")
    result = authalic.disk_map(*mesh, boundary=boundary, initial=start.uv)
    oracle.assert_disk_embedding(result)
    energy = result.history["authalic_energy"]
    assert energy[0] == pytest.approx(start.distortion.authalic_energy, rel=1e-9)
    assert energy[-1] < 0.5 * energy[0]


# No folds, on any shape


def assert_sphere_without_folds(mesh, deviation=np.inf):
    result = authalic.sphere_map(*mesh)
    oracle.assert_sphere_embedding(result)
    assert result.distortion.area_ratio_std <= deviation


@pytest.mark.parametrize(
    ("aspect", "deviation"), [(2, 0.02), (5, 0.02), (10, 0.05), (20, 0.2), (50, np.inf), (100, np.inf)]
)
def test_capsules_of_any_length_are_mapped(aspect, deviation):
    assert_sphere_without_folds(fine_capsule(aspect, around=12), deviation)


@pytest.mark.parametrize("length", [10, 30, 60])
def test_closed_tubes_many_times_longer_than_wide_are_mapped(length):
    assert_sphere_without_folds(flat_tube(length), 0.05 if length == 10 else np.inf)


@pytest.mark.parametrize("around", [3, 5, 20])
def test_closed_tubes_of_many_and_of_few_sides_are_mapped(around):
    assert_sphere_without_folds(flat_tube(30, around))


@pytest.mark.parametrize(("sharpness", "length"), [(50, 3), (200, 5), (800, 8), (3000, 3)])
def test_thin_horns_are_mapped(sharpness, length):
    assert_sphere_without_folds(horned(sharpness, length), 0.2)


@pytest.mark.parametrize("ratio", [1e3, 1e5, 1e7])
def test_closed_surfaces_with_tiny_faces_are_mapped(ratio):
    mesh = graded(ratio)
    assert ratio_of(mesh) >= ratio
    assert_sphere_without_folds(mesh)


@pytest.mark.parametrize("boundary", ["sliding", "arc_length"])
@pytest.mark.parametrize("power", [2, 4, 7])
def test_disks_with_tiny_faces_are_mapped(power, boundary):
    """Rings drawn toward the center: 1e7 and more between the largest and the smallest face at power 4."""
    mesh = meshes.bumpy_cap(20, 40, noise=0)
    radius = np.hypot(*mesh.vertices[:, :2].T)[:, None]
    points = np.hstack([mesh.vertices[:, :2] * radius ** (power - 1), mesh.vertices[:, 2:] * radius**power])
    oracle.assert_disk_embedding(authalic.disk_map(points, mesh.faces, boundary=boundary))


@pytest.mark.parametrize("boundary", ["sliding", "arc_length"])
@pytest.mark.parametrize("length", [5, 20, 60])
def test_fingers_of_any_length_are_mapped(length, boundary):
    mesh = meshes.tube_disk(8, 6 * length, radius=3 / length)
    if boundary == "arc_length" and length == 60:
        # a held boundary leaves only Tutte's embedding, which collapses below double precision
        with pytest.raises(authalic.SolverError, match="no map without folds"):
            authalic.disk_map(*mesh, boundary=boundary)
        return
    oracle.assert_disk_embedding(authalic.disk_map(*mesh, boundary=boundary))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", ["capsule", "horned ball", "noisy icosphere", "delaunay cap", "bumpy disk"])
def test_random_meshes_of_a_thousand_vertices_are_mapped(name, seed):
    case = random_meshes.sound_case(500 + seed, 1000, [name])
    outcome = random_checks.assert_sound_case(case)
    assert not outcome.status.startswith("SolverError"), outcome.status


# Angles against areas


WEIGHTS = (0.0, 1e-4, 1e-3, 1e-2, 0.1, 1.0)


@pytest.mark.parametrize(
    ("call", "mesh"),
    [
        (authalic.disk_map, bumpy_square(40)),
        (authalic.disk_map, meshes.bumpy_cap(24, 50, noise=0)),
        (authalic.sphere_map, meshes.bumpy_ball(4)),
        (authalic.sphere_map, fine_capsule(6)),
    ],
    ids=["square", "cap", "ball", "capsule"],
)
def test_angles_gain_what_areas_lose(call, mesh):
    results = [call(*mesh, angle_weight=weight) for weight in WEIGHTS]
    deviations, angles = np.array([figures(result) for result in results]).T
    assert (np.diff(deviations) >= -5e-3).all(), deviations  # below 1 % a descent ends where it is
    assert (np.diff(angles) <= 1e-3).all(), angles
    assert deviations[-1] > 10 * deviations[0] and angles[-1] < 0.9 * angles[0]
    assert_embedding = (
        oracle.assert_disk_embedding if call is authalic.disk_map else oracle.assert_sphere_embedding
    )
    for result in results:
        assert_embedding(result)
        assert result.status in {"converged", "stalled"}


def test_a_flat_disk_stays_what_it_is_at_any_weight():
    radius, angle = np.linspace(0, 1, 12)[1:, None], 2 * np.pi * np.arange(40) / 40
    rows = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * radius + 0 * angle], axis=-1)
    mesh = meshes.with_pole(rows, [0, 0, 0])
    for weight in (0.0, 0.01, 10.0):
        result = authalic.disk_map(*mesh, angle_weight=weight)
        assert result.distortion.area_ratio_std < 2e-3
        assert result.distortion.angle_distortion_mean < 1.01


# Cancel


SPEEDY = 1.0
"""Seconds of work within which a cancelled call returns: 0.2 are promised, the rest is for a slow machine."""


def cancelled_after(seconds, call, mesh):
    """The outcome of a call that is cancelled at its first report after so many seconds, and its delay."""
    began, asked = time.perf_counter(), []

    def progress(fraction, message):
        if time.perf_counter() - began < seconds:
            return True
        asked.append(effort.spent())
        return False

    try:
        outcome = call(*mesh, progress=progress)
    except authalic.SolverError as error:
        assert "cancelled before there was a map without folds" in str(error)
        outcome = None
    assert len(asked) == 1
    return outcome, effort.spent() - asked[0]


@pytest.mark.parametrize("seconds", [0.0, 2.0, 4.0, 5.0])
@pytest.mark.parametrize(
    ("call", "make"),
    [
        (authalic.disk_map, lambda: bumpy_square(450)),
        (authalic.sphere_map, lambda: meshes.bumpy_ball(8)),
    ],
    ids=["disk", "sphere"],
)
def test_a_run_on_hundreds_of_thousands_of_vertices_can_be_cancelled_at_any_time(call, make, seconds):
    with effort.counted():
        outcome, latency = cancelled_after(seconds, call, make())
    print(f"cancel after {seconds} s was answered after {latency:.3f} s")
    if outcome is not None:
        assert outcome.status == "cancelled"
        assert len(outcome.distortion.folded) == 0
    assert latency < SPEEDY


@pytest.mark.parametrize("reports", [0, 1, 2, 5, 9, 14, 20])
@pytest.mark.parametrize("name", ["capsule", "hedgehog", "spiky_ball", "ball"])
def test_a_cancelled_sphere_is_sound_or_none(name, reports):
    progress = random_checks.cancel_after(reports)
    try:
        result = authalic.sphere_map(*meshes.SPHERES[name], progress=progress)
    except authalic.SolverError as error:
        assert "cancelled before there was a map without folds" in str(error)
    else:
        oracle.assert_sphere_embedding(result)


# Threads


DIGEST = """
import hashlib, json, authalic
from api import meshes
from api.test_runs import bumpy_square
from api.test_gauss_newton import fine_capsule
def digest(result, image):
    energy = result.history["authalic_energy"]
    return [hashlib.sha256(array.tobytes()).hexdigest() for array in (image, energy)]
found = []
for mesh in (bumpy_square(100), meshes.DISKS["rough_cap"], meshes.DISKS["tube_disk"]):
    for options in ({}, {"boundary": "arc_length"}, {"angle_weight": 0.03}):
        result = authalic.disk_map(*mesh, **options)
        found.append(digest(result, result.uv))
for mesh in (meshes.bumpy_ball(5), meshes.SPHERES["hedgehog"], fine_capsule(8)):
    for options in ({}, {"angle_weight": 0.03}):
        result = authalic.sphere_map(*mesh, **options)
        found.append(digest(result, result.positions))
print(json.dumps(found))
"""


def test_the_number_of_threads_changes_no_bit(run_python):
    one, two, five = (json.loads(run_python(DIGEST, RAYON_NUM_THREADS=threads)) for threads in "123")
    assert len(one) == 15
    assert one == two == five


# Real meshes


MISSED_DISKS = {"hand_53054": 10}
"""The factors of meshes that do not reach the general one."""


@real_meshes.each("disk")
def test_real_disks_are_far_more_exact_than_by_conjugate_gradients(path):
    mesh = real_meshes.load(path)
    default = authalic.disk_map(*mesh)
    oracle.assert_disk_embedding(default)
    published = authalic.disk_map(*mesh, method="conjugate_gradient", boundary="arc_length")
    factor = published.distortion.authalic_energy / default.distortion.authalic_energy
    print(f"{path.stem}: E_A {default.distortion.authalic_energy:.2e}, {factor:.0f} times smaller")
    assert factor >= MISSED_DISKS.get(path.stem, DISK_FACTOR)


@real_meshes.each("sphere")
def test_real_spheres_are_far_more_exact_than_by_gradient_descent(path):
    mesh = real_meshes.load(path)
    default = authalic.sphere_map(*mesh)
    oracle.assert_sphere_embedding(default)
    published = authalic.sphere_map(*mesh, method="gradient_descent", unfold=False)
    factor = published.distortion.authalic_energy / default.distortion.authalic_energy
    print(f"{path.stem}: E_A {default.distortion.authalic_energy:.2e}, {factor:.0f} times smaller")
    assert factor >= SPHERE_FACTOR or len(published.distortion.folded)
    if path.stem == "david_10671":
        assert default.distortion.authalic_energy <= 1e-5


def closed_and_valid(path):
    """The patch of a mesh that is a single closed surface without handles, else None."""
    patches = authalic.cut(*real_meshes.load(path))
    is_sphere = len(patches) == 1 and patches[0].is_closed and patches[0].genus == 0
    return patches[0] if is_sphere else None


@real_meshes.each("hard")
def test_hard_spheres_are_mapped_without_a_fold(path):
    patch = closed_and_valid(path)
    if patch is None:
        pytest.skip("no sphere")
    oracle.assert_sphere_embedding(authalic.sphere_map(patch.vertices, patch.faces))


@pytest.mark.parametrize("boundary", ["sliding", "arc_length"])
@pytest.mark.parametrize("name", ["mannequindevil_12977", "maze_6120", "inverted_12577"])
def test_hard_disks_are_mapped_without_a_fold(name, boundary):
    path = real_meshes.file(f"hard/{name}.npz")
    result = authalic.disk_map(*real_meshes.load(path), boundary=boundary, fill_holes=True)
    assert oracle.folded(result.uv, result.faces) == []
    assert len(result.distortion.folded) == 0


def test_small_targets_do_not_make_a_tolerance_forgotten():
    vertices, faces = meshes.DISKS["bumpy_cap"]
    density = np.ones(len(faces))
    density[100] = 1e-3
    plain = authalic.disk_map(vertices, faces, density=density)
    exact = authalic.disk_map(vertices, faces, density=density, tolerance=1e-6)
    assert exact.distortion.authalic_energy <= plain.distortion.authalic_energy
