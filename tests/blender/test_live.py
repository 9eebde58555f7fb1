# SPDX-License-Identifier: GPL-3.0-or-later
"""UVs that follow the options. There is no window here, so the timer is called by the tests."""

import time
from collections.abc import Iterator
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
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
