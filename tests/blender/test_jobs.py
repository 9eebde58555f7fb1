# SPDX-License-Identifier: GPL-3.0-or-later
"""The path below the operators: jobs, the bridge, and the plain logic around them."""

import importlib
import threading
import time

import bpy
import conftest
import meshes
import numpy as np
import pytest


def part(name):
    return importlib.import_module(f"{conftest.MODULE}.{name}")


def test_operator_and_job_write_the_same():
    obj = meshes.seam_sphere()
    bpy.ops.authalic.unwrap(uv_layer="Operator")
    unwrap = part("jobs.unwrap")
    report = unwrap.job(bpy.context, unwrap.Settings(uv_layer="Job")).execute()
    assert report.islands == 1 and report.figures.flips == 0
    np.testing.assert_array_equal(meshes.uv(obj, "Operator"), meshes.uv(obj, "Job"))


def test_job_computes_first_and_writes_on_apply():
    obj = meshes.add_grid()
    unwrap = part("jobs.unwrap")
    job = unwrap.job(bpy.context, unwrap.Settings()).start()
    while job.poll()[0]:
        time.sleep(0.01)
    assert not obj.data.uv_layers
    job.apply()
    assert len(obj.data.uv_layers) == 1


def test_cancelled_job_writes_nothing():
    obj, bridge, unwrap = meshes.suzanne(), part("bridge"), part("jobs.unwrap")
    obj.data.uv_layers.active.name = "Old"
    before = meshes.uv(obj)
    settings = unwrap.Settings(uv_layer="New", mapping=bridge.UnwrapSettings(iterations=100000))
    job = unwrap.job(bpy.context, settings).start()
    time.sleep(0.1)
    started = time.perf_counter()
    job.cancel()
    with pytest.raises(bridge.Cancelled):
        job.apply()
    assert time.perf_counter() - started < 2
    assert [layer.name for layer in obj.data.uv_layers] == ["Old"]
    assert (meshes.uv(obj) == before).all()


def test_progress_rises_to_the_end():
    surface, bridge = part("mesh_io").read(meshes.suzanne()), part("bridge")
    seen = []
    bridge.unwrap([surface], bridge.UnwrapSettings(), lambda fraction, message: seen.append(fraction) or True)
    assert len(seen) > 10 and seen == sorted(seen) and seen[0] >= 0 and seen[-1] <= 1


def test_job_works_on_another_thread_and_finishes_on_this_one():
    threads = []

    def work(progress):
        threads.append(threading.current_thread())
        assert progress(0.5, "half")
        return 1

    def finish(result):
        threads.append(threading.current_thread())
        return result + 1

    job = part("bridge").Job(work, finish)
    assert job.execute() == 2
    assert threads[0] is not threads[1] is threading.current_thread()
    assert job.poll() == (False, 0.5, "half")


def test_job_raises_what_the_work_raised():
    def work(_progress):
        raise ValueError("why")

    with pytest.raises(ValueError, match="why"):
        part("bridge").Job(work).execute()


def test_failing_packer_changes_nothing(monkeypatch):
    obj, unwrap = meshes.add_grid(), part("jobs.unwrap")

    def fail(*_):
        raise RuntimeError("no room")

    monkeypatch.setattr(unwrap, "pack", fail)
    with pytest.raises(RuntimeError, match="no room"):
        bpy.ops.authalic.unwrap(uv_layer="New")
    assert not obj.data.uv_layers


def test_not_finite_results_are_not_written(monkeypatch):
    obj, unwrap = meshes.add_grid(), part("jobs.unwrap")

    def spoil(islands, _settings):
        islands[0].uv[0] = np.nan

    monkeypatch.setattr(unwrap, "pack", spoil)
    with pytest.raises(RuntimeError, match="not finite"):
        bpy.ops.authalic.unwrap(uv_layer="New")
    assert not obj.data.uv_layers


def test_outline_encloses_and_similarity_is_found():
    shapes, rng = part("islands"), np.random.default_rng(3)
    points = rng.normal(size=(500, 2)) * [3, 1]
    outline = shapes.outline(points)
    ends = np.roll(outline, -1, axis=0)
    for start, end in zip(outline, ends, strict=True):
        side, gap = end - start, points - start
        assert (side[0] * gap[:, 1] - side[1] * gap[:, 0] > -1e-9).all()
    factor, offset = 0.3 * np.exp(2j), 4 - 1j
    found = shapes.similarity(outline, shapes.moved(outline, factor, offset))
    assert found == (pytest.approx(factor), pytest.approx(offset))


def test_upright_turns_a_square_and_leaves_a_disk():
    shapes, corners = part("islands"), np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    tilted = shapes.moved(corners, np.exp(0.4j), 0)
    turned = shapes.moved(tilted, shapes.upright(tilted), 0)
    np.testing.assert_allclose(np.ptp(turned, axis=0), 2)
    angle = np.linspace(0, 2 * np.pi, 100)
    assert shapes.upright(shapes.outline(np.stack([np.cos(angle), np.sin(angle)], axis=1))) == 1


def test_messages_name_the_faces_of_the_mesh():
    bridge = part("bridge")
    piece = bridge._Piece("", 0, None, None, None, np.array([70, 80, 90]), np.array([5, 6, 7]), False)
    assert piece.in_mesh_terms("no area in face 1: dissolve") == "no area in face 80: dissolve"
    assert piece.in_mesh_terms("2 faces (0, 2) repeat") == "2 faces (70, 90) repeat"
    assert piece.in_mesh_terms("9 vertices (0, 1, 2, …) loose") == "9 vertices (5, 6, 7, …) loose"
