# SPDX-License-Identifier: MIT OR Apache-2.0
"""The course and the end of a run: limits, restarts, progress, cancel, Ctrl-C, threads."""

import json
import threading
import time

import numpy as np
import pytest

import authalic

from . import meshes, oracle

METHODS = ("gauss_newton", "conjugate_gradient", "fixed_point")
ROUGH = meshes.DISKS["rough_cap"]
methods = pytest.mark.parametrize("method", METHODS)
papers_methods = pytest.mark.parametrize("method", METHODS[1:])


def map_disk(mesh=ROUGH, **options):
    result = authalic.disk_map(*mesh, **options)
    return result, result.uv


def map_sphere(mesh=meshes.SPHERES["hedgehog"], **options):
    result = authalic.sphere_map(*mesh, **options)
    return result, result.positions


# checks for every long call
maps = pytest.mark.parametrize("call", [map_disk, map_sphere])


def bumpy_square(side):
    """A mesh of side² vertices that is quickly made."""
    mesh = meshes.grid(side, side, aspect=1.0)
    x, y, _ = mesh.vertices.T
    return meshes.Mesh(np.stack([x, y, 0.2 * np.sin(9 * x) * np.cos(7 * y)], axis=1), mesh.faces)


# Limits and restarts


@papers_methods
@pytest.mark.parametrize("limit", [0, 1, 7])
def test_the_limit_of_iterations_is_kept(method, limit):
    result = authalic.disk_map(*meshes.bumpy_cap(), method=method, max_iterations=limit)
    fixed_point_steps = min(5, limit) if method == "conjugate_gradient" else 0
    assert result.iterations == limit + fixed_point_steps
    assert result.status == "max_iterations"
    oracle.assert_disk_embedding(result)


@papers_methods
def test_the_limit_holds_again_for_the_descent_from_a_mended_map(method):
    result = authalic.disk_map(*ROUGH, method=method, max_iterations=1)
    assert result.iterations <= 2 + (5 if method == "conjugate_gradient" else 0)
    oracle.assert_disk_embedding(result)


@pytest.mark.parametrize("method", METHODS[:2])
def test_more_iterations_are_never_worse(method):
    energies = [
        authalic.disk_map(*ROUGH, method=method, max_iterations=limit).distortion.authalic_energy
        for limit in (0, 1, 2, 5, 20, 80)
    ]
    assert energies == sorted(energies, reverse=True)
    assert energies[-1] < energies[0] / 10


@methods
def test_a_huge_tolerance_is_reached_at_once(method):
    result = authalic.disk_map(*ROUGH, method=method, tolerance=1e300)
    assert result.status == "converged"
    assert result.iterations <= 5
    oracle.assert_disk_embedding(result)


def test_the_tolerance_of_conjugate_gradients_is_that_of_the_gradient_norm():
    mesh = meshes.bumpy_cap()
    result = authalic.disk_map(*mesh, method="conjugate_gradient", tolerance=1e-3, max_iterations=500)
    norms = result.history["gradient_norm"]
    assert result.status == "converged"
    assert norms[-1] <= 1e-3 < norms[-2]


@pytest.mark.parametrize("boundary", ["sliding", "arc_length"])
@papers_methods
def test_a_restart_continues(method, boundary):
    options = {"method": method, "boundary": boundary}
    first = authalic.disk_map(*ROUGH, max_iterations=10, **options)
    second = authalic.disk_map(*ROUGH, max_iterations=20, initial=first.uv, **options)
    oracle.assert_disk_embedding(second)
    start = second.history["authalic_energy"][0]
    assert start == pytest.approx(first.distortion.authalic_energy, rel=1e-9)
    assert second.distortion.authalic_energy < 0.9 * start


def test_a_restart_without_iterations_gives_the_same_map():
    first = authalic.disk_map(*ROUGH, max_iterations=10)
    again = authalic.disk_map(*ROUGH, max_iterations=0, initial=first.uv)
    assert np.abs(again.uv - first.uv).max() < 1e-14
    assert again.iterations == 0


def test_folds_of_a_start_map_are_mended():
    start = authalic.disk_map(*ROUGH).uv.copy()
    start[[100, 200, 300]] *= -0.3
    assert len(oracle.folded(start, ROUGH.faces)) > 5
    for method in METHODS:
        oracle.assert_disk_embedding(authalic.disk_map(*ROUGH, initial=start, method=method))


BAD_STARTS = {
    "wrong_length": (lambda uv: uv[:-1], "initial must be of shape"),
    "not_finite": (lambda uv: np.where(np.arange(len(uv))[:, None] == 3, np.nan, uv), "NaN or infinite"),
    "off_the_circle": (lambda uv: 1.5 * uv, "must lie on the unit circle"),
    "clockwise": (lambda uv: uv * [1, -1], "must run once around the unit circle"),
    "collapsed": (lambda uv: 0 * uv + [1, 0], "must run once around the unit circle"),
}


@pytest.mark.parametrize(("spoil", "words"), BAD_STARTS.values(), ids=BAD_STARTS)
def test_a_bad_start_map_is_refused(spoil, words):
    uv = authalic.disk_map(*ROUGH).uv
    with pytest.raises(authalic.MeshError, match=words) as caught:
        authalic.disk_map(*ROUGH, initial=spoil(uv))
    if words == "NaN or infinite":
        assert (caught.value.indices, caught.value.count) == ((3,), 1)


# Progress and cancel


@methods
@pytest.mark.parametrize("name", ["rough_cap", "tube_disk", "grid"])
def test_progress_grows_from_0_to_1_with_messages(name, method):
    heard = []

    def listen(*report):
        heard.append(report)
        return True

    authalic.disk_map(*meshes.DISKS[name], method=method, progress=listen)
    fractions, messages = zip(*heard, strict=True)
    assert len(fractions) > 5
    assert list(fractions) == sorted(fractions)
    assert fractions[0] >= 0
    assert 0.5 < fractions[-1] <= 1
    assert all(type(fraction) is float for fraction in fractions)
    assert all(isinstance(message, str) and message for message in messages)


@maps
def test_listening_changes_no_bit(call):
    assert np.array_equal(call(progress=lambda fraction, message: True)[1], call()[1])


@maps
@pytest.mark.parametrize("answer", [True, 1, None, "yes", np.True_])
def test_these_answers_go_on(call, answer):
    assert call(progress=lambda fraction, message: answer)[0].status != "cancelled"


@methods
@pytest.mark.parametrize("name", ["rough_cap", "tube_disk"])
@pytest.mark.parametrize("last", [0, 1, 3, 6, 12, 40])
def test_a_false_answer_cancels_and_leaves_a_sound_map(name, method, last):
    calls = []

    def progress(fraction, message):
        calls.append(fraction)
        return len(calls) <= last

    result = authalic.disk_map(*meshes.DISKS[name], method=method, progress=progress)
    oracle.assert_disk_embedding(result)
    if len(calls) <= last:
        assert result.status != "cancelled"  # it was done before
        return
    assert (result.status, len(calls)) == ("cancelled", last + 1)
    assert result.iterations <= last


@maps
@pytest.mark.parametrize("answer", [False, 0, np.False_, ""])
def test_these_answers_cancel(call, answer):
    assert call(progress=lambda fraction, message: answer)[0].status == "cancelled"


@maps
@pytest.mark.parametrize("error", [KeyError("mine"), KeyboardInterrupt(), SystemExit(3)])
def test_an_exception_of_the_progress_function_comes_through(call, error):
    def progress(fraction, message):
        raise error

    with pytest.raises(type(error)) as caught:
        call(progress=progress)
    assert caught.value is error
    assert call()[0].status != "cancelled"  # and the next run is none the worse


@maps
def test_a_progress_function_may_run_another_map(call):
    inner = []

    def progress(fraction, message):
        inner.append(authalic.disk_map(*meshes.fan()).status)
        return len(inner) < 3

    assert call(progress=progress)[0].status == "cancelled"
    assert inner == ["converged"] * 3


# Threads and signals


@pytest.mark.parametrize(
    ("call", "mesh"),
    [(map_disk, bumpy_square(170)), (map_sphere, meshes.bumpy_ball(6))],
    ids=["disk", "sphere"],
)
def test_other_python_threads_run_meanwhile(call, mesh):
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.002)

    ticker = threading.Thread(target=tick)
    ticker.start()
    began = time.perf_counter()
    call(mesh)
    ended = time.perf_counter()
    done.set()
    ticker.join()
    inside = [moment for moment in ticks if began + 0.05 < moment < ended - 0.05]
    assert ended - began > 0.15, "too fast to tell"
    assert len(inside) > 10


@maps
def test_maps_run_side_by_side(call):
    expected = call()[1]
    results = [None] * 4

    def work(k):
        results[k] = call()[1]

    threads = [threading.Thread(target=work, args=(k,)) for k in range(len(results))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(image, expected) for image in results)


DIGEST = """
import hashlib, authalic
from api.test_runs import bumpy_square
from api import meshes
for mesh in (bumpy_square(120), meshes.DISKS["rough_cap"]):
    for boundary in ("sliding", "arc_length"):
        result = authalic.disk_map(*mesh, boundary=boundary, method="conjugate_gradient")
        figures, energy = result.distortion, result.history["authalic_energy"]
        for array in (result.uv, energy, figures.log2_area_ratio, figures.angle_distortion):
            print(hashlib.sha256(array.tobytes()).hexdigest(), repr(figures.authalic_energy))
for mesh in (meshes.bumpy_ball(5), meshes.SPHERES["hedgehog"]):
    for method in ("gradient_descent", "fixed_point"):
        result = authalic.sphere_map(*mesh, method=method, max_iterations=20)
        figures, energy = result.distortion, result.history["authalic_energy"]
        for array in (result.positions, energy, figures.log2_area_ratio, figures.angle_distortion):
            print(hashlib.sha256(array.tobytes()).hexdigest(), repr(figures.authalic_energy))
"""


def test_one_and_several_threads_give_the_same_bits(run_python):
    one, two, seven = (run_python(DIGEST, RAYON_NUM_THREADS=threads) for threads in ("1", "2", "7"))
    assert len(one.split("\n")) == 32
    assert one == two == seven


INTERRUPT = """
import json, signal, threading, authalic
from api import effort, meshes
from api.test_runs import bumpy_square
authalic.set_threads(effort.THREADS)
# a shell's background job inherits SIGINT ignored, and Python then installs no handler of its own
signal.signal(signal.SIGINT, signal.default_int_handler)
mesh = {mesh}
sent = []
def interrupt():
    sent.append(effort.spent())
    signal.raise_signal(signal.SIGINT)
threading.Timer({delay}, interrupt).start()
try:
    while True:  # a fast machine may be done before it is stopped
        authalic.{call}(*mesh{options})
except KeyboardInterrupt:
    outcome = "interrupted"
print(json.dumps([outcome, effort.spent() - sent[0]]))
"""


@pytest.mark.parametrize("options", ["", ", progress=lambda fraction, message: True"])
@pytest.mark.parametrize("delay", [0.3, 2.0])
@pytest.mark.parametrize(
    ("call", "mesh"),
    [("disk_map", "bumpy_square(710)"), ("sphere_map", "meshes.bumpy_ball(8)")],
    ids=["disk", "sphere"],
)
def test_ctrl_c_ends_a_run_on_hundreds_of_thousands_of_vertices(run_python, call, mesh, delay, options):
    """0.2 s of work is promised; the bound leaves room for a slow machine."""
    code = INTERRUPT.format(call=call, mesh=mesh, delay=delay, options=options)
    outcome, latency = json.loads(run_python(code))
    print(f"Ctrl-C after {delay} s was answered after {latency:.3f} s")
    assert outcome == "interrupted"
    assert latency < 1.0
