# SPDX-License-Identifier: MIT OR Apache-2.0
"""The course and the end of registrations: progress, cancel, Ctrl-C, threads."""

import json
import threading

import numpy as np
import pytest

import authalic

from . import meshes, pairs

BOTH = {"disk": pairs.PAIRS["turned_caps"], "sphere": pairs.PAIRS["ball_and_parallels"]}
both = pytest.mark.parametrize("pair", BOTH.values(), ids=BOTH)


@both
def test_progress_grows_from_0_to_1_with_messages(pair):
    heard = []
    pairs.register(pair, progress=lambda *report: heard.append(report))
    fractions, messages = zip(*heard, strict=True)
    assert len(fractions) > 5
    assert list(fractions) == sorted(fractions)
    assert 0 <= fractions[0] < 0.1
    assert fractions[-1] == 1
    assert all(type(fraction) is float for fraction in fractions)
    assert all(isinstance(message, str) and message for message in messages)


@both
def test_listening_changes_no_bit(pair):
    heard = pairs.register(pair, progress=lambda fraction, message: True)
    assert_same_bits(heard, pairs.register(pair))


def assert_same_bits(here, there):
    for name in (
        "positions",
        "triangles",
        "barycentric",
        "registered",
        "target_registered",
        "landmark_error",
    ):
        assert np.array_equal(getattr(here, name), getattr(there, name)), name


@both
def test_two_calls_give_the_same_bits(pair):
    assert_same_bits(pairs.register(pair), pairs.register(pair))


def cancelled_after(pair, last):
    """The registration, cancelled at its report number `last`, with the number of reports; or the error."""
    calls = []

    def progress(fraction, message):
        calls.append(fraction)
        return len(calls) <= last

    try:
        return pairs.register(pair, progress=progress), len(calls)
    except authalic.SolverError as error:
        return error, len(calls)


@both
@pytest.mark.parametrize("last", [0, 1, 3, 6, 12, 24, 40, 80, 160])
def test_a_false_answer_cancels_and_leaves_a_sound_map_or_none(pair, last):
    """Until both surfaces have a map there is nothing to return."""
    result, count = cancelled_after(pair, last)
    if isinstance(result, authalic.SolverError):
        assert "cancelled" in str(result)
        assert count == last + 1
        return
    pairs.assert_registration(result, pair)
    if count > last:
        assert (result.status, count) == ("cancelled", last + 1)


@both
def test_a_run_cancelled_while_landmarks_are_carried_returns_the_map_so_far(pair):
    reports = []
    pairs.register(pair, progress=lambda *report: reports.append(report))
    seen = [cancelled_after(pair, last)[0] for last in range(len(reports) // 2, len(reports), 5)]
    sound = [result for result in seen if not isinstance(result, authalic.SolverError)]
    assert sound
    assert "cancelled" in {result.status for result in sound}
    for result in sound:
        pairs.assert_registration(result, pair)


@both
@pytest.mark.parametrize("error", [KeyError("mine"), KeyboardInterrupt(), SystemExit(3)])
def test_an_exception_of_the_progress_function_comes_through(pair, error):
    def progress(fraction, message):
        raise error

    with pytest.raises(type(error)) as caught:
        pairs.register(pair, progress=progress)
    assert caught.value is error
    assert pairs.register(pair).status != "cancelled"  # and the next run is none the worse


@both
def test_a_progress_function_may_run_another_map(pair):
    inner = []

    def progress(fraction, message):
        inner.append(authalic.disk_map(*meshes.fan()).status)
        return True

    assert pairs.register(pair, progress=progress).status != "cancelled"
    assert set(inner) == {"converged"}


@both
def test_registrations_run_side_by_side(pair):
    expected, results = pairs.register(pair), [None] * 3

    def work(k):
        results[k] = pairs.register(pair)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(len(results))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for result in results:
        assert_same_bits(result, expected)


DIGEST = """
import hashlib
from api import meshes, pairs
large = pairs.identical(meshes.bumpy_ball(5), 6)
large = large._replace(target=meshes.Mesh(large.target.vertices * [1, 2, 3], large.target.faces))
for pair in (*pairs.PAIRS.values(), large):
    result = pairs.register(pair)
    values = result.pull(pair.target.vertices[result.target_faces])
    for array in (result.positions, result.triangles, result.registered, result.area_ratio, values):
        print(hashlib.sha256(array.tobytes()).hexdigest())
"""


def test_one_and_several_threads_give_the_same_bits(run_python):
    one, two, seven = (run_python(DIGEST, RAYON_NUM_THREADS=threads) for threads in ("1", "2", "7"))
    assert len(one.split("\n")) == 5 * (len(pairs.PAIRS) + 1)
    assert one == two == seven


INTERRUPT = """
import json, signal, threading, authalic
import numpy as np
from api import effort, meshes, pairs
from api.test_runs import bumpy_square
authalic.set_threads(effort.THREADS)
# a shell's background job inherits SIGINT ignored, and Python then installs no handler of its own
signal.signal(signal.SIGINT, signal.default_int_handler)
mesh = {mesh}
sent = []
def interrupt():
    sent.append(effort.spent())
    signal.raise_signal(signal.SIGINT)
marks = [len(mesh.vertices) // 2 + 200, len(mesh.vertices) // 3 + 7]
threading.Timer({delay}, interrupt).start()
try:
    while True:  # a fast machine may be done before it is stopped
        authalic.{call}(mesh, mesh, source_landmarks=marks, target_landmarks=marks[::-1])
except KeyboardInterrupt:
    outcome = "interrupted"
print(json.dumps([outcome, effort.spent() - sent[0]]))
"""


@pytest.mark.parametrize("delay", [0.3, 3.0])
@pytest.mark.parametrize(
    ("call", "mesh"),
    [("register_disks", "bumpy_square(400)"), ("register_spheres", "meshes.bumpy_ball(7)")],
    ids=["disk", "sphere"],
)
def test_ctrl_c_ends_a_registration(run_python, call, mesh, delay):
    """0.2 s of work is promised; the bound leaves room for a slow machine."""
    outcome, latency = json.loads(run_python(INTERRUPT.format(call=call, mesh=mesh, delay=delay)))
    assert outcome == "interrupted"
    assert latency < 1.0
