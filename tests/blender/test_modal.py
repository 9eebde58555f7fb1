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
    """Starts an operator, sends events, then timer ticks until it has ended; returns how it ended."""
    assert running._start(context) == {"RUNNING_MODAL"}
    return run_on(running, context, events)


def run_on(running: Any, context: Any, events: Sequence[Any] = ()) -> Any:
    """Sends events to a running operator, then timer ticks until it has ended; returns how it ended."""
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
    assert running.said == [("INFO", "Plain: cancelled, nothing was changed")]
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
    # islands that are large enough to be mapped one after the other
    n = 50
    obj = meshes.add(*meshes.together(*(meshes.grid(n, offset=(4 * k, 0, 0)) for k in range(3))))
    obj.data.uv_layers.new(name="UVMap")
    before, islands, unwrap = meshes.uv(obj), part("bridge.islands"), part("jobs.unwrap")
    job = unwrap.job(bpy.context, unwrap.Settings())
    disk_maps = islands.disk_maps

    def first_only(pieces: Any, settings: Any, result: Any, progress: Any) -> Any:
        def listen(fraction: float, message: str) -> Any:
            if message.startswith("Island 2 of 3"):
                job.end_early()
            return progress(fraction, message)

        return disk_maps(pieces, settings, result, listen)

    islands.disk_maps = first_only
    try:
        report = job.execute()
    finally:
        islands.disk_maps = disk_maps
    assert report.islands == 1
    assert [str(refusal) for refusal in report.refusals] == [
        f"Mesh at face {face}: was not reached before the end" for face in (n * n, 2 * n * n)
    ]
    after, first = meshes.uv(obj), 4 * n * n
    assert (after[first:] == before[first:]).all() and (after[:first] != before[:first]).any()


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


class Layout:
    """A layout that notes what is drawn: (text, icon or fraction, width)."""

    def __init__(self) -> None:
        self.drawn: list[tuple[Any, ...]] = []
        self.ui_units_x = 0.0

    def row(self) -> Any:
        row = Layout()
        row.drawn = self.drawn
        return row

    def label(self, text: str, icon: str = "NONE") -> None:
        self.drawn.append((text, icon))

    def progress(self, factor: float, text: str) -> None:
        self.drawn.append((text, factor, self.ui_units_x))


def status_bar(fraction: float, message: str) -> Any:
    """What the status bar shows."""
    context = types.SimpleNamespace()
    running = operator(None, context)
    running._show(context, fraction, message)
    ((_, draw),) = context.workspace.named("status_text_set")
    layout = Layout()
    draw(types.SimpleNamespace(layout=layout), None)
    return layout.drawn


def test_the_status_bar_names_keys_and_operator_beside_a_wide_bar() -> None:
    *labels, bar = status_bar(0.453, "Island 1 of 1: Evening out areas")
    assert labels == [("Cancel", "EVENT_ESC"), ("Finish Early", "EVENT_RETURN"), ("Plain", "NONE")]
    text, fraction, width = bar
    assert text == "Island 1 of 1: Evening out areas — 45 %" and fraction == 0.453
    assert width >= 12  # units of the interface; without a width the text is cut off


def test_progress_leaves_zero_as_soon_as_meshes_are_read() -> None:
    meshes.suzanne(1)
    job = suzanne_job()
    assert job.poll()[1:] == (0.0, "Reading")
    heard: list[tuple[float, str]] = []
    job._work(lambda fraction, message: heard.append((fraction, message)) or True)
    assert heard[0][0] >= 0.04 and heard[0][1] == "Island 1 of 3"


def test_a_second_job_is_refused_while_one_runs_in_a_window() -> None:
    obj, context = meshes.suzanne(1), types.SimpleNamespace()
    first = operator(lambda: suzanne_job(**LONG), context)
    assert first._start(context) == {"RUNNING_MODAL"}
    second = operator(suzanne_job, types.SimpleNamespace())
    assert second._attempt(lambda: second._start(context)) == {"CANCELLED"}
    assert second.said == [("ERROR", "Plain is still running; wait for its end, or cancel it with Esc")]
    with pytest.raises(RuntimeError, match="Plain is still running"):
        bpy.ops.authalic.unwrap(uv_layer="Script")
    assert "Script" not in obj.data.uv_layers
    assert run_on(first, context, [event("ESC")]) == {"CANCELLED"}
    assert bpy.ops.authalic.unwrap(uv_layer="Script") == {"FINISHED"}


@pytest.mark.parametrize("end", ["done", "refused", "file"])
def test_after_a_job_the_next_one_may_start(end: str) -> None:
    obj, context = meshes.suzanne(1), types.SimpleNamespace()
    running = operator(suzanne_job, context)
    running._start(context)
    if end == "refused":
        running._running._thread.join()
        bpy.data.objects.remove(obj)
    if end == "file":
        running.cancel(context)
    else:
        run_on(running, context)
    meshes.add_grid()
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}


def test_a_preview_does_not_keep_others_from_running() -> None:
    meshes.suzanne(1)
    marking = part("jobs.mark_seams")
    preview = marking.preview(bpy.context, marking.Settings()).start()
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}
    preview.cancel()


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
