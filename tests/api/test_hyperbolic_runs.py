# SPDX-License-Identifier: MIT OR Apache-2.0
"""The course and the end of registrations by curves: progress, cancel, Ctrl-C, threads, slow solvers."""

import json
import threading

import numpy as np
import pytest

import authalic

from . import curves, meshes, pairs

SMALL = curves.balls(4, source=meshes.bumpy_ball(3), target=meshes.radial(lambda x, y, z: 1.2 + x * y, 4))


def assert_same_bits(here, there):
    for name in ("positions", "triangles", "barycentric", "registered", "target_registered", "area_ratio"):
        assert np.array_equal(getattr(here, name), getattr(there, name)), name
    assert [e.tolist() for e in here.energies] == [e.tolist() for e in there.energies]


# Progress and cancel


def test_progress_grows_from_0_to_1_with_messages():
    heard = []
    curves.register(SMALL, progress=lambda *report: heard.append(report))
    fractions, messages = zip(*heard, strict=True)
    assert len(fractions) > 5
    assert list(fractions) == sorted(fractions)
    assert 0 <= fractions[0] < 0.1
    assert fractions[-1] == 1
    assert all(type(fraction) is float for fraction in fractions)
    assert all(isinstance(message, str) and message for message in messages)


def test_listening_changes_no_bit():
    heard = curves.register(SMALL, progress=lambda fraction, message: True)
    assert_same_bits(heard, curves.register(SMALL))


@pytest.mark.parametrize("last", [0, 1, 2, 3, 5, 8, 13, 21])
def test_a_false_answer_cancels(last):
    """Maps before the last step may be folded: none is returned, or one that is proved to be sound."""
    calls = []

    def progress(fraction, message):
        calls.append(fraction)
        return len(calls) <= last

    try:
        result = curves.register(SMALL, progress=progress)
    except authalic.SolverError as error:
        assert "cancelled" in str(error)
        assert len(calls) == last + 1
        return
    assert result.certificates.folded.tolist() == []
    curves.assert_curves_meet(result, SMALL)
    assert (result.status == "cancelled") == (len(calls) > last and calls[-1] < 1)


@pytest.mark.parametrize("error", [KeyError("mine"), KeyboardInterrupt(), SystemExit(3)])
def test_an_exception_of_the_progress_function_comes_through(error):
    def progress(fraction, message):
        raise error

    with pytest.raises(type(error)) as caught:
        curves.register(SMALL, progress=progress)
    assert caught.value is error
    assert curves.register(SMALL).status == "converged"


def test_a_progress_function_may_run_another_map():
    inner = []

    def progress(fraction, message):
        inner.append(authalic.disk_map(*meshes.fan()).status)
        return True

    assert curves.register(SMALL, progress=progress).status == "converged"
    assert set(inner) == {"converged"}


# Threads


def test_registrations_run_side_by_side():
    expected, results = curves.register(SMALL), [None] * 3

    def work(k):
        results[k] = curves.register(SMALL)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(len(results))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for result in results:
        assert_same_bits(result, expected)


DIGEST = """
import hashlib
from api import curves, meshes
for pair in (curves.balls(6), curves.balls(2), curves.balls(1), curves.balls(3, source=meshes.ball(5))):
    result = curves.register(pair)
    values = result.pull(pair.target.vertices)
    back = result.inverse()
    arrays = (result.positions, result.triangles, result.registered, values, back.positions)
    for array in (*arrays, *result.energies):
        print(hashlib.sha256(array.tobytes()).hexdigest())
"""


def test_one_and_several_threads_and_another_call_give_the_same_bits(run_python):
    one, two, again, seven = (run_python(DIGEST, RAYON_NUM_THREADS=threads) for threads in "1227")
    assert len(one.split("\n")) == 4 * 5 + 2
    assert one == two == again == seven


INTERRUPT = """
import json, signal, threading, authalic
from api import curves, effort, meshes
authalic.set_threads(effort.THREADS)
# a shell's background job inherits SIGINT ignored, and Python then installs no handler of its own
signal.signal(signal.SIGINT, signal.default_int_handler)
pair = curves.identical(meshes.bumpy_ball(6), curves.arcs(5))
sent = []
def interrupt():
    sent.append(effort.spent())
    signal.raise_signal(signal.SIGINT)
threading.Timer({delay}, interrupt).start()
try:
    while True:  # a fast machine may be done before it is stopped
        curves.register(pair, **{options})
except KeyboardInterrupt:
    outcome = "interrupted"
print(json.dumps([outcome, effort.spent() - sent[0]]))
"""


@pytest.mark.parametrize(
    ("delay", "options"),
    [
        (0.2, {}),
        (0.5, {}),
        (2.0, {"solver": "heat", "max_iterations": 1_000_000, "tolerance": 0.0}),
        (0.8, {"metric": "ricci_flow"}),
    ],
)
def test_ctrl_c_ends_a_registration(run_python, delay, options):
    """0.2 s of work is promised; the bound leaves room for a slow machine."""
    outcome, latency = json.loads(run_python(INTERRUPT.format(delay=delay, options=options)))
    assert outcome == "interrupted"
    assert latency < 1.0


# The paper's solvers


def test_the_heat_diffusion_lowers_the_energy_from_step_to_step_without_a_fold():
    best = curves.register(SMALL).energies[0]
    result = curves.register(SMALL, solver="heat", max_iterations=300)
    (energies,) = result.energies
    assert result.status == "max_iterations"
    assert (result.iterations, len(energies)) == (300, 301)
    assert (np.diff(energies) <= 1e-13 * energies[0]).all()
    assert energies[0] == pytest.approx(best[0], rel=1e-9)
    assert best[-1] <= energies[-1] * (1 + 1e-9)
    assert result.certificates.folded.tolist() == []
    curves.assert_located(result, SMALL)
    curves.assert_curves_meet(result, SMALL)


def test_the_heat_diffusion_may_stop_at_once_or_at_a_tolerance():
    none = curves.register(SMALL, solver="heat", max_iterations=0)
    assert (none.iterations, none.status) == (0, "max_iterations")
    assert none.certificates.folded.tolist() == []
    curves.assert_curves_meet(none, SMALL)
    easy = curves.register(SMALL, solver="heat", tolerance=1e3)
    assert easy.status == "converged"
    assert easy.iterations <= 1


def test_the_ricci_flow_leads_to_the_metric_of_newtons_method():
    """The map is about the same with either metric method."""
    flow, newton = curves.register(SMALL, metric="ricci_flow"), curves.register(SMALL)
    curves.assert_registration(flow, SMALL)
    gap = np.linalg.norm(flow.positions - newton.positions, axis=1)
    assert gap.max() < 1e-2 * pairs.size(SMALL.target)


def test_the_harmonic_energy_falls_to_where_newtons_method_ends():
    for energies in curves.register(SMALL).energies:
        assert (np.diff(energies) <= 1e-12 * energies[0]).all()
        assert 1 <= len(energies) < 30
