# SPDX-License-Identifier: GPL-3.0-or-later
"""Jobs behind a living window: Esc, Enter, progress. There is no window here, so the events are made up."""

import time
import types
from collections.abc import Callable, Sequence
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
from installed import part
from meshes import Array, MeshObject


class Recorder:
    """Accepts any call and records its name and arguments."""

    def __init__(self) -> None:
        self.calls: list[tuple[Any, ...]] = []

    def __getattr__(self, name: str) -> Callable[..., str]:
        def call(*arguments: Any, **_options: Any) -> str:
            self.calls.append((name, *arguments))
            return name

        return call

    def named(self, name: str) -> list[tuple[Any, ...]]:
        return [call for call in self.calls if call[0] == name]


def operator(job: Any, context: Any) -> Any:
    """An operator of the mixin as a plain object, which Blender forbids, with a context that records."""
    modal = part("operators.modal").Modal

    class Plain(modal):  # type: ignore[misc, valid-type]
        bl_label = "Plain"
        refused = (part("jobs.unwrap").CannotUnwrap,)

        def __init__(self) -> None:
            self.said: list[Any] = []

        def job(self, _context: Any) -> Any:
            return job()

        def line(self, report: Any) -> str:
            return str(report)

        def report(self, kinds: set[str], text: str) -> None:
            self.said.append((*kinds, text))

    plain = Plain()
    context.window_manager, context.workspace, context.window = Recorder(), Recorder(), object()
    return plain


def event(kind: str, value: str = "PRESS") -> Any:
    return types.SimpleNamespace(type=kind, value=value)


def run(running: Any, context: Any, events: Sequence[Any] = ()) -> Any:
    """Sends events, then timer ticks until the operator has ended; returns how it ended."""
    assert running._start(context) == {"RUNNING_MODAL"}
    for event_ in events:
        assert running.modal(context, event_) <= {"RUNNING_MODAL", "PASS_THROUGH"}
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        ended = running.modal(context, event("TIMER", "NOTHING"))
        if ended != {"RUNNING_MODAL"}:
            return ended
        time.sleep(0.01)
    raise AssertionError("the operator did not end")


def suzanne_job(**solver: Any) -> Any:
    unwrap, bridge = part("jobs.unwrap"), part("bridge")
    mapping = bridge.UnwrapSettings(solver=bridge.Solver(**solver))
    return unwrap.job(bpy.context, unwrap.Settings(uv_layer="New", mapping=mapping))


LONG = {"method": "GRADIENT_DESCENT", "iterations": 100000}


def test_a_run_to_its_end_writes_what_execute_writes() -> None:
    obj, context = meshes.suzanne(1), types.SimpleNamespace()
    running = operator(suzanne_job, context)
    assert run(running, context) == {"FINISHED"}
    assert running.said[0][0] == "INFO" and "3 islands" in running.said[0][1]
    modal = meshes.uv(obj, "New")
    bpy.ops.authalic.unwrap(uv_layer="New")
    assert (meshes.uv(obj, "New") == modal).all()


def test_esc_discards() -> None:
    obj, context = meshes.suzanne(), types.SimpleNamespace()
    before = [layer.name for layer in obj.data.uv_layers]
    running = operator(lambda: suzanne_job(**LONG), context)
    assert run(running, context, [event("ESC")]) == {"CANCELLED"}
    assert running.said == [("ERROR", "cancelled, nothing was changed")]
    assert [layer.name for layer in obj.data.uv_layers] == before


@pytest.mark.parametrize("key", ["RET", "NUMPAD_ENTER"])
def test_enter_keeps_the_best_so_far(key: str) -> None:
    obj, context = meshes.suzanne(), types.SimpleNamespace()
    running = operator(lambda: suzanne_job(**LONG), context)
    assert running._start(context) == {"RUNNING_MODAL"}
    time.sleep(1.0)
    running.modal(context, event(key))
    running._running._thread.join(10)
    assert running.modal(context, event("TIMER")) == {"FINISHED"}
    ((kind, line),) = running.said
    assert kind == "WARNING" and "stopped early" in line
    assert (meshes.area_ratios(obj, "New")[_written(obj)] > 0).all()


def _written(obj: MeshObject) -> Array:
    """Triangles whose UVs differ from the first layer's."""
    corners, _, _ = meshes.triangles(obj)
    changed = (meshes.uv(obj, "New") != meshes.uv(obj, obj.data.uv_layers[0].name)).any(axis=1)
    return changed[corners].any(axis=1)


def test_what_was_not_reached_before_enter_is_named_and_left_alone() -> None:
    obj = meshes.add(*meshes.together(*(meshes.grid(offset=(4 * k, 0, 0)) for k in range(3))))
    obj.data.uv_layers.new(name="UVMap")
    before, islands, unwrap = meshes.uv(obj), part("bridge.islands"), part("jobs.unwrap")
    job = unwrap.job(bpy.context, unwrap.Settings())
    map_ = islands._map

    def first_only(*arguments: Any) -> Any:
        job.end_early()
        return map_(*arguments)

    islands._map = first_only
    try:
        report = job.execute()
    finally:
        islands._map = map_
    assert report.islands == 1
    assert [str(refusal) for refusal in report.refusals] == [
        f"Mesh at face {face}: was not reached before the end" for face in (36, 72)
    ]
    after = meshes.uv(obj)
    assert (after[144:] == before[144:]).all() and (after[:144] != before[:144]).any()


def test_the_last_island_kept_early_is_said_too() -> None:
    meshes.suzanne()
    job = suzanne_job(**LONG)
    job.start()
    time.sleep(1.0)
    job.end_early()
    assert "stopped early; a longer run gives more even areas" in str(job.apply())


def test_a_shape_key_can_be_kept_early() -> None:
    obj = meshes.bumpy(meshes.icosphere(5))
    key, bridge = part("jobs.sphere_shape_key"), part("bridge")
    job = key.job(bpy.context, key.Settings(bridge.Solver(**LONG))).start()
    time.sleep(1.0)
    job.end_early()
    assert "stopped early" in str(job.apply())
    assert obj.data.shape_keys.key_blocks["Authalic Sphere"].value == 0


def test_other_keys_are_held_back_and_looking_around_is_not() -> None:
    meshes.suzanne(1)
    context = types.SimpleNamespace()
    running = operator(suzanne_job, context)
    running._start(context)
    for kind in ("X", "G", "TAB", "LEFTMOUSE", "RIGHTMOUSE", "Z"):
        assert running.modal(context, event(kind)) == {"RUNNING_MODAL"}
    for kind in ("MIDDLEMOUSE", "WHEELUPMOUSE", "MOUSEMOVE"):
        assert running.modal(context, event(kind)) == {"PASS_THROUGH"}
    running.modal(context, event("ESC", "RELEASE"))  # of the key that opened a menu, say
    assert not running._running._cancel.is_set()
    running.cancel(context)
    running._running._thread.join(10)


def test_the_header_and_the_timer_are_cleared() -> None:
    meshes.suzanne(1)
    context = types.SimpleNamespace()
    running = operator(suzanne_job, context)
    run(running, context)
    manager, workspace = context.window_manager, context.workspace
    assert len(manager.named("event_timer_add")) == len(manager.named("event_timer_remove")) == 1
    assert len(manager.named("progress_begin")) == len(manager.named("progress_end")) == 1
    assert workspace.calls[-1] == ("status_text_set", None)
    fractions = [call[1] for call in manager.named("progress_update")]
    assert fractions == sorted(fractions) and fractions[0] >= 0 and fractions[-1] <= 100
    drawn = Recorder()
    workspace.calls[0][1](types.SimpleNamespace(layout=drawn), None)
    assert len(drawn.named("label")) == 2 and len(drawn.named("progress")) == 1


@pytest.mark.parametrize("change", ["remove", "subdivide"])
def test_a_mesh_that_changed_meanwhile_is_left_alone(change: Any) -> None:
    obj, context = meshes.add_grid(), types.SimpleNamespace()
    job = suzanne_job().start()
    job._thread.join()
    if change == "remove":
        bpy.data.objects.remove(obj)
        bpy.context.view_layer.update()
    else:
        meshes.subdivided(obj, 1)
    running = operator(lambda: job, context)
    running._running, running._timer = job, None
    assert running.modal(context, event("TIMER")) == {"CANCELLED"}
    assert running.said == [("ERROR", "Grid has changed meanwhile; nothing was written")]


def test_without_a_window_invoke_runs_to_the_end() -> None:
    obj = meshes.add_grid()
    assert bpy.ops.authalic.unwrap("INVOKE_DEFAULT") == {"FINISHED"}
    assert np.ptp(meshes.uv(obj), axis=0).min() > 0.9
