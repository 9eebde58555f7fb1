# SPDX-License-Identifier: MIT OR Apache-2.0
"""The course and the end of a run onto the sphere: limits, tolerances, start maps, progress, cancel."""

import numpy as np
import pytest

import authalic

from . import meshes, oracle

METHODS = ("gauss_newton", "gradient_descent", "fixed_point")
BUMPY = meshes.SPHERES["bumpy_ball"]
HEDGEHOG = meshes.SPHERES["hedgehog"]  # faces fold on the way
methods = pytest.mark.parametrize("method", METHODS)
papers_methods = pytest.mark.parametrize("method", METHODS[1:])


def stretch_energy(result, mesh=BUMPY):
    """Σ a²/|τ| with image and targets scaled to the area of the sphere, which Algorithm 2 watches."""
    targets, areas = oracle.face_areas(*mesh), oracle.face_areas(result.positions, mesh.faces)
    return 4 * np.pi * (areas**2 / targets).sum() * targets.sum() / areas.sum() ** 2


# Limits and tolerances


@papers_methods
@pytest.mark.parametrize("limit", [0, 1, 7, 30])
def test_the_limit_of_iterations_is_kept(method, limit):
    result = authalic.sphere_map(*BUMPY, method=method, max_iterations=limit)
    fixed_point_steps = min(10, limit) if method == "gradient_descent" else 0
    assert result.iterations <= limit + fixed_point_steps
    assert method == "fixed_point" or result.iterations >= limit
    oracle.assert_sphere_embedding(result)


@papers_methods
def test_the_limit_holds_again_for_the_descent_from_a_mended_map(method):
    result = authalic.sphere_map(*HEDGEHOG, method=method, max_iterations=15)
    assert result.iterations <= 30 + (10 if method == "gradient_descent" else 0)
    oracle.assert_sphere_embedding(result)


@papers_methods
def test_the_default_limit_is_a_hundred(method):
    default, given = (
        authalic.sphere_map(*BUMPY, method=method, **options) for options in ({}, {"max_iterations": 100})
    )
    assert np.array_equal(default.positions, given.positions)


def test_the_tolerance_of_gradient_descent_is_that_of_the_gradient_norm():
    result = authalic.sphere_map(*BUMPY, method="gradient_descent", tolerance=3e-2, max_iterations=1000)
    norms = result.history["gradient_norm"]
    assert result.status == "converged"
    assert norms[-1] <= 3e-2 < norms[-2]


def test_a_huge_tolerance_is_reached_at_once():
    for method in METHODS:
        result = authalic.sphere_map(*BUMPY, method=method, tolerance=1e300)
        assert (result.status, result.iterations <= 10) == ("converged", True)
        oracle.assert_sphere_embedding(result)


@pytest.mark.parametrize("tolerance", [0.3, 1e-2, 1e-3, None, 0.0])
def test_the_fixed_point_stops_as_algorithm_2_says(tolerance):
    through = [
        stretch_energy(
            authalic.sphere_map(*BUMPY, method="fixed_point", tolerance=-np.inf, max_iterations=limit)
        )
        for limit in range(15)
    ]
    falls = -np.diff(through)
    last = int(np.argmax(falls <= (1e-6 if tolerance is None else tolerance)))
    assert falls[last] <= (tolerance or 1e-6), "no stop within so few steps"
    expected = last + (falls[last] > 0)  # a step that rises is not taken
    result = authalic.sphere_map(*BUMPY, method="fixed_point", tolerance=tolerance)
    assert (result.status, result.iterations) == ("converged", expected)
    assert stretch_energy(result) == pytest.approx(through[expected], rel=1e-12)


@pytest.mark.parametrize("unfold", [True, False])
def test_the_fixed_point_without_a_stopping_rule_runs_through_and_returns_the_last_map(unfold):
    result = authalic.sphere_map(
        *BUMPY, method="fixed_point", tolerance=-np.inf, max_iterations=50, unfold=unfold
    )
    energy = result.history["authalic_energy"]
    assert (result.status, result.iterations) == ("max_iterations", 50)
    assert result.distortion.authalic_energy == pytest.approx(energy[-1], rel=1e-9)
    assert (np.diff(energy) > 0).any(), "a run that never rises tests nothing"


# Start maps


@methods
def test_a_restart_continues_where_the_start_map_lies(method):
    first = authalic.sphere_map(*BUMPY, method="gradient_descent", max_iterations=3).positions
    turn, _ = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))
    turned = first @ (turn * np.sign(np.linalg.det(turn)))
    second = authalic.sphere_map(*BUMPY, method=method, initial=turned)
    oracle.assert_sphere_embedding(second)
    start = oracle.sphere_energy(first, BUMPY.faces, oracle.face_areas(*BUMPY))
    assert second.history["authalic_energy"][0] == pytest.approx(start, rel=1e-9)
    assert second.distortion.authalic_energy < 0.95 * start
    near, far = (np.linalg.norm(second.positions - image, axis=1).mean() for image in (turned, first))
    assert near < 0.2 < far


@methods
def test_a_start_map_of_any_radius_is_put_onto_the_sphere(method):
    start = authalic.sphere_map(*BUMPY).positions.copy()
    radius = np.random.default_rng(1).uniform(1e-3, 1e3, (len(start), 1))
    for scale in (1, radius, 1e-300, 1e300):
        result = authalic.sphere_map(*BUMPY, method=method, initial=scale * start, max_iterations=0)
        assert np.abs(result.positions - start).max() < 1e-15
        assert result.iterations == 0


@methods
@pytest.mark.parametrize("name", ["ball", "bumpy_ball", "parallels"])
def test_the_surface_itself_is_a_start_map(name, method):
    mesh = meshes.SPHERES[name]
    result = authalic.sphere_map(*mesh, initial=mesh.vertices, method=method)
    oracle.assert_sphere_embedding(result)


@methods
@pytest.mark.parametrize("limit", [0, 5, None])
def test_folds_of_a_start_map_are_mended(method, limit):
    start = authalic.sphere_map(*BUMPY).positions.copy()
    start[[100, 200, 250]] *= -1
    assert len(oracle.folded_on_sphere(start, BUMPY.faces)) > 5
    result = authalic.sphere_map(*BUMPY, initial=start, method=method, max_iterations=limit)
    oracle.assert_sphere_embedding(result)


def at(row, value):
    def spoil(positions):
        positions = positions.copy()
        positions[row] = value
        return positions

    return spoil


BAD_STARTS = {
    "wrong_length": (lambda x: x[:-1], "initial must be of shape", ()),
    "not_finite": (at(3, np.nan), "NaN or infinite at vertex 3", (3,)),
    "infinite": (at([3, 9], np.inf), "NaN or infinite at 2 vertices", (3, 9)),
    "zero": (at(7, 0.0), "vertex 7: it lies at the origin", (7,)),
    "mirrored": (lambda x: x * [1, 1, -1], "look inward; mirror it", None),
    "collapsed": (lambda x: 0 * x + [1, 0, 0], "look inward|no start", None),
}


@pytest.mark.parametrize(("spoil", "words", "indices"), BAD_STARTS.values(), ids=BAD_STARTS)
@methods
def test_a_bad_start_map_is_refused(method, spoil, words, indices):
    positions = authalic.sphere_map(*BUMPY).positions
    with pytest.raises(authalic.MeshError, match=words) as caught:
        authalic.sphere_map(*BUMPY, initial=spoil(positions), method=method)
    assert indices is None or caught.value.indices == indices


# Progress and cancel


@methods
@pytest.mark.parametrize("mesh", [BUMPY, HEDGEHOG], ids=["bumpy_ball", "hedgehog"])
def test_progress_grows_from_0_to_1_with_messages(mesh, method):
    heard = []

    def listen(*report):
        heard.append(report)
        return True

    authalic.sphere_map(*mesh, method=method, progress=listen)
    fractions, messages = zip(*heard, strict=True)
    assert list(fractions) == sorted(fractions)
    assert 0 <= fractions[0] < 0.1
    assert fractions[-1] == 1
    assert all(type(fraction) is float for fraction in fractions)
    assert all(isinstance(message, str) and message for message in messages)


@papers_methods
@pytest.mark.parametrize("mesh", [BUMPY, HEDGEHOG], ids=["bumpy_ball", "hedgehog"])
@pytest.mark.parametrize("last", [0, 1, 3, 5, 12, 60, 115, 150])
def test_a_false_answer_cancels_and_leaves_a_sound_map(mesh, method, last):
    calls = []

    def progress(fraction, message):
        calls.append(fraction)
        return len(calls) <= last

    result = authalic.sphere_map(*mesh, method=method, progress=progress)
    oracle.assert_sphere_embedding(result)
    if len(calls) <= last or calls[-1] == 1:
        assert result.status != "cancelled"  # it was done before
        return
    assert (result.status, len(calls)) == ("cancelled", last + 1)
    assert result.iterations <= last + 1  # a mended map has a record of its own


@pytest.mark.parametrize("mesh", [BUMPY, HEDGEHOG], ids=["bumpy_ball", "hedgehog"])
def test_a_cancelled_run_without_correction_returns_the_map_so_far(mesh):
    result = authalic.sphere_map(
        *mesh, method="gradient_descent", unfold=False, progress=lambda fraction, message: fraction < 0.6
    )
    last = result.history["authalic_energy"][-1]
    assert result.status == "cancelled"
    assert result.distortion.folded.tolist() == oracle.folded_on_sphere(result.positions, mesh.faces)
    if len(result.distortion.folded) == 0:
        assert result.distortion.authalic_energy == pytest.approx(last, rel=1e-9)
