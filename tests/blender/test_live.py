# SPDX-License-Identifier: GPL-3.0-or-later
"""UVs that follow the options. There is no window here, so the timer is called by the tests."""

import time
from collections.abc import Iterator
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
from editors import uv_editor
from installed import part


def tick() -> bool:
    return bool(part("operators.live").tick(bpy.context))


def settle() -> None:
    """Ticks until nothing changes."""
    live, deadline = part("operators.live"), time.monotonic() + 60
    for _ in range(3):
        assert tick()
    while live._state.running is not None and time.monotonic() < deadline:
        tick()
        time.sleep(0.01)
    assert tick() and live._state.running is None


def options() -> Any:
    return bpy.context.window_manager.operator_properties_last("authalic.unwrap")


@pytest.fixture(autouse=True)
def manager() -> Iterator[Any]:
    manager: Any = bpy.context.window_manager
    former = options().angle_weight
    manager.authalic_live = True
    yield manager
    manager = bpy.context.window_manager
    manager.authalic_live = False
    assert not tick()
    options().angle_weight = former


def deviation(obj: Any) -> float:
    return float(np.abs(meshes.area_ratios(obj)).std())


def test_uvs_follow_the_slider_and_only_then(manager: Any) -> None:
    obj = meshes.add(*meshes.grid(bump=1.5))
    bpy.ops.authalic.unwrap()
    before = meshes.uv(obj)
    settle()
    assert (meshes.uv(obj) == before).all() and manager.authalic_live_figures == ""
    deviations = []
    for weight in (0.9, 0.5, 0.2):
        options().angle_weight = weight
        settle()
        deviations.append(deviation(obj))
        said = manager.authalic_live_figures.removeprefix("Area ratio SD ").split(",")[0]
        assert float(said) == pytest.approx(deviations[-1], rel=0.01)
    assert deviations[0] > 2 * deviations[1] > 4 * deviations[2]


def test_only_the_active_object_follows() -> None:
    first, second = meshes.add_grid("First"), meshes.add_grid("Second")
    meshes.select(first, second)
    settle()
    options().angle_weight = 0.9
    settle()
    assert first.data.uv_layers and not second.data.uv_layers


def test_another_object_keeps_its_uvs_until_an_option_changes() -> None:
    first, second = meshes.add_grid("First"), meshes.add_grid("Second")
    meshes.select(first)
    settle()
    options().angle_weight = 0.9
    settle()
    meshes.select(second)
    settle()
    assert not second.data.uv_layers


def test_a_drag_is_undone_in_one_step() -> None:
    name = meshes.add_grid().name
    bpy.ops.authalic.unwrap()
    bpy.ops.ed.undo_push(message="Start")
    before = meshes.uv(bpy.data.objects[name])
    settle()
    options().angle_weight = 0.9
    settle()
    assert (meshes.uv(bpy.data.objects[name]) != before).any()
    bpy.ops.ed.undo()
    assert (meshes.uv(bpy.data.objects[name]) == before).all()


def test_what_cannot_be_unwrapped_is_said(manager: Any) -> None:
    obj = meshes.torus()
    settle()
    options().angle_weight = 0.9
    settle()
    assert "has a handle" in manager.authalic_live_figures
    assert not obj.data.uv_layers or deviation(obj) >= 0


def test_only_the_active_object_follows_in_edit_mode() -> None:
    first, second = meshes.add_grid("First"), meshes.add_grid("Second")
    meshes.select(first, second)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    settle()
    options().angle_weight = 0.9
    settle()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert first.data.uv_layers and not second.data.uv_layers


def test_no_seams_are_marked() -> None:
    obj = meshes.icosphere(2)
    former = options().seams
    try:
        options().seams = "AUTOMATIC"
        settle()
        for shear in (1.6, 1.3):
            options().shear = shear
            settle()
        assert obj.data.uv_layers and not any(edge.use_seam for edge in obj.data.edges)
    finally:
        options().seams, options().shear_preset = former, "AUTO"


def test_nothing_is_written_while_an_operator_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    obj = meshes.add_grid()
    settle()
    options().angle_weight = 0.9
    assert tick()
    running = part("operators.live")._state.running
    assert running is not None and running.wait(60)
    monkeypatch.setattr(part("operators.modal"), "_in_window", ["Authalic Unwrap"])
    assert tick() and not obj.data.uv_layers
    monkeypatch.undo()
    settle()
    assert obj.data.uv_layers


def test_it_keeps_to_the_editor_where_it_was_turned_on(manager: Any) -> None:
    live, windows = part("operators.live"), bpy.context.window_manager.windows
    assert live._override(windows) == {"window": windows[0]}
    with uv_editor():
        manager.authalic_live = True
        assert live._override(windows)["area"] == bpy.context.area
    assert live._override(windows) == {"window": windows[0]}
