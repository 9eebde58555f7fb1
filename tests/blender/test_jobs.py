# SPDX-License-Identifier: GPL-3.0-or-later
"""The path below the operators: jobs, the bridge, and the logic around them."""

import threading
import time
from collections.abc import Callable
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
from installed import part


def test_operator_and_job_write_the_same() -> None:
    obj = meshes.seam_sphere()
    bpy.ops.authalic.unwrap(uv_layer="Operator")
    unwrap = part("jobs.unwrap")
    report = unwrap.job(bpy.context, unwrap.Settings(uv_layer="Job")).execute()
    assert report.islands == 1 and report.figures.flips == 0
    np.testing.assert_array_equal(meshes.uv(obj, "Operator"), meshes.uv(obj, "Job"))


def test_job_computes_first_and_writes_on_apply() -> None:
    obj = meshes.add_grid()
    unwrap = part("jobs.unwrap")
    job = unwrap.job(bpy.context, unwrap.Settings()).start()
    while job.poll()[0]:
        time.sleep(0.01)
    assert not obj.data.uv_layers
    job.apply()
    assert len(obj.data.uv_layers) == 1


def test_cancelled_job_writes_nothing() -> None:
    obj, bridge, unwrap = meshes.suzanne(), part("bridge"), part("jobs.unwrap")
    obj.data.uv_layers.active.name = "Old"
    before = meshes.uv(obj)
    solver = bridge.Solver("GRADIENT_DESCENT", iterations=100000)
    settings = unwrap.Settings(uv_layer="New", mapping=bridge.UnwrapSettings(solver=solver))
    job = unwrap.job(bpy.context, settings).start()
    time.sleep(0.1)
    job.cancel()
    with pytest.raises(part("jobs.job").Cancelled):
        job.apply()
    assert [layer.name for layer in obj.data.uv_layers] == ["Old"]
    assert (meshes.uv(obj) == before).all()


def test_a_cancelled_job_does_not_wait_for_its_thread() -> None:
    may_end = threading.Event()
    job = part("jobs.job").Job(lambda _progress: may_end.wait(60)).start()
    job.cancel()
    with pytest.raises(part("jobs.job").Cancelled):
        job.apply()
    assert job._thread.is_alive()
    may_end.set()
    assert job.wait(60)


def test_progress_rises_to_the_end() -> None:
    surface, bridge = part("blender.meshes").read(meshes.suzanne(1)), part("bridge")
    seen: list[float] = []
    bridge.unwrap([surface], bridge.UnwrapSettings(), lambda fraction, message: seen.append(fraction) or True)
    assert len(seen) > 10 and seen == sorted(seen) and seen[0] >= 0 and seen[-1] <= 1


def test_job_works_on_another_thread_and_finishes_on_this_one() -> None:
    threads = []

    def work(progress: Callable[[float, str], Any]) -> int:
        threads.append(threading.current_thread())
        assert progress(0.5, "half")
        return 1

    def finish(result: Any) -> int:
        threads.append(threading.current_thread())
        return result + 1

    job = part("jobs.job").Job(work, finish)
    assert job.execute() == 2
    assert threads[0] is not threads[1] is threading.current_thread()
    assert job.poll() == (False, 0.5, "half")


def test_job_raises_what_the_work_raised() -> None:
    def work(_progress: Any) -> None:
        raise ValueError("why")

    with pytest.raises(ValueError, match="why"):
        part("jobs.job").Job(work).execute()


def test_failing_packer_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    obj, placement = meshes.add_grid(), part("bridge.placement")

    def fail(*_: Any) -> None:
        raise RuntimeError("no room")

    monkeypatch.setattr(placement, "_pack", fail)
    with pytest.raises(RuntimeError, match="no room"):
        bpy.ops.authalic.unwrap(uv_layer="New")
    assert not obj.data.uv_layers


def test_not_finite_results_are_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    obj, placement = meshes.add_grid(), part("bridge.placement")

    def spoil(islands: Any, *_: Any) -> None:
        islands[0].uv[0] = np.nan

    monkeypatch.setattr(placement, "_pack", spoil)
    with pytest.raises(RuntimeError, match="No island could be unwrapped"):
        bpy.ops.authalic.unwrap(uv_layer="New")
    assert not obj.data.uv_layers


def test_unmeasurable_results_are_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    obj = meshes.add_grid()
    monkeypatch.setattr(part("bridge.placement"), "measure_islands", lambda islands: None)
    with pytest.raises(RuntimeError, match="nothing was changed"):
        bpy.ops.authalic.unwrap(uv_layer="New")
    assert not obj.data.uv_layers


def test_island_that_folds_when_packed_is_left_out_and_the_rest_fills_the_square(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    obj = meshes.add(*meshes.together(meshes.grid(), meshes.grid(offset=(4, 0, 0))))
    obj.data.uv_layers.new(name="UVMap")
    before, unwrap, placement = meshes.uv(obj), part("jobs.unwrap"), part("bridge.placement")
    pack = placement._pack

    def spoil(islands: Any, *settings: Any) -> None:
        pack(islands, *settings)
        if len(islands) > 1:  # one point of the second crosses over to the far side
            inner = np.linalg.norm(islands[1].uv - islands[1].uv.mean(axis=0), axis=1).argmin()
            islands[1].uv[inner] += 2 * np.ptp(islands[1].uv, axis=0)

    monkeypatch.setattr(placement, "_pack", spoil)
    report = unwrap.job(bpy.context, unwrap.Settings()).execute()
    assert report.islands == 1 and report.figures.flips == 0
    assert [str(refusal) for refusal in report.refusals] == [
        "Mesh at face 36: its faces would fold over in UV precision; cut its long or thin parts open by seams"
    ]
    after = meshes.uv(obj)
    assert (after[144:] == before[144:]).all()
    assert np.ptp(after[:144], axis=0).min() > 0.95


_FIGURES = "(area ratio SD 6, angle distortion 1.50)"


@pytest.mark.parametrize(
    ("status", "is_uneven", "text"),
    [
        ("converged", True, f"uneven {_FIGURES}; cut it"),
        ("stalled", True, f"uneven, stopped before it converged {_FIGURES}; cut it"),
        ("stalled", False, f"stopped before it converged {_FIGURES}"),
        ("max_iterations", False, f"stopped at the iteration limit {_FIGURES}; raise Iterations to go on"),
    ],
)
def test_island_that_falls_short_is_named(
    status: str,
    is_uneven: bool,
    text: str,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    meshes.add_grid()
    bridge, islands = part("bridge"), part("bridge.islands")
    map_ = islands._of_disk_map

    def stalled(*arguments: Any) -> Any:
        island = map_(*arguments)
        island.shortfall = bridge.Shortfall(status, 6.0, 1.5, is_uneven, False, ("cut it", "mark seams"))
        return island

    monkeypatch.setattr(islands, "_of_disk_map", stalled)
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}
    said = capfd.readouterr().out
    assert "Warning: Unwrapped 1 island" in said
    assert f"Grid at face 0: {text}" in said


def test_sentences_name_the_elements_of_the_mesh() -> None:
    polygons, vertices = np.array([70, 80, 90, 90]), np.array([5, 6, 7, -1])
    expected = {
        ("face", (1,), 1): "face 80",
        ("face", (0, 2), 2): "triangles of faces (70, 90)",
        ("face", (2, 3), 2): "face 90",
        ("face", (0, 2, 3, 1), 12): "triangles of faces (70, 90, 80, …)",
        ("face", (1, 4, 5), 3): "face 80",
        ("face", (4,), 1): "faces of a filled hole",
        ("vertex", (0, 1, 2), 9): "9 vertices (5, 6, 7, …)",
        ("vertex", (0, 1, 3), 3): "vertices (5, 6)",
        ("vertex", (3,), 1): "vertices that were filled in",
        ("edge", ((1, 2),), 1): "edge (6, 7)",
        ("edge", ((0, 1), (1, 2), (2, 3)), 3): "edges ((5, 6), (6, 7))",
    }
    phrase = part("messages.elements").phrase
    numbers = {"face": polygons, "vertex": vertices, "edge": vertices}
    assert {key: phrase(*key, numbers[key[0]]) for key in expected} == expected
    assert phrase("face", (1,), 1, None) == "some faces"
