# SPDX-License-Identifier: GPL-3.0-or-later
"""What the new version makes of what version 0.1.0 has left."""

import importlib
import os
from typing import Any

import bpy
import numpy as np
import pytest
import scene


def test_the_new_version_is_enabled_at_the_start(started_with: dict[str, Any]) -> None:
    assert scene.MODULE in started_with["addons"]
    import authalic

    assert authalic.__version__ == os.environ["AUTHALIC_VERSION"]
    assert f'version = "{authalic.__version__}"' in scene.manifest()


def test_preferences_are_as_they_were() -> None:
    """Or the defaults, after a version that has none."""
    before = scene.read_facts()["preferences"]
    values: Any = scene.values_of_preferences()
    if before:
        assert values == before == scene.PREFERENCES
    else:
        assert (values["threads"], values["preset"]) == (0, "EVEN")
    # They count, in the panels and in the heat map. Blender without a window runs no timers.
    timer = importlib.import_module(f"{scene.MODULE}.ui.preferences").start_with_preset
    if bpy.app.timers.is_registered(timer):
        timer()
    last = bpy.context.window_manager.operator_properties_last("authalic.unwrap")
    assert last.angle_preset == values["preset"]
    heat_map = importlib.import_module(f"{scene.MODULE}.overlay.heat_map")
    assert {name: list(getattr(heat_map.colors(), name)) for name in scene.COLORS} == {
        name: pytest.approx(values[name]) for name in scene.COLORS
    }


@pytest.fixture(params=["before", "meanwhile"])
def saved(request: pytest.FixtureRequest) -> dict[str, Any]:
    """The file of version 0.1.0, or the one saved between the update and the restart, and what it had."""
    bpy.ops.wm.open_mainfile(filepath=str(scene.FOLDER / f"{request.param}.blend"))
    return scene.read_facts()


def _activate(name: str) -> Any:
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj.name == name)
    bpy.context.view_layer.objects.active = bpy.data.objects[name]
    return bpy.data.objects[name]


def _points(obj: Any) -> list[tuple[str, int, int]]:
    return [(each.name, each.source_vertex, each.target_vertex) for each in obj.authalic_landmarks]


def test_landmarks_curves_and_morphs_are_as_they_were(saved: dict[str, Any]) -> None:
    ball, sheet = bpy.data.objects["Ball A"], bpy.data.objects["Sheet A"]
    assert ball.authalic_target.name == "Ball B" and sheet.authalic_target.name == "Sheet B"
    assert _points(ball) == [(name, vertex, vertex) for name, vertex in scene.POINTS]
    assert _points(sheet) == [("Top", 24, 40)]
    (curve,) = sheet.authalic_landmark_curves
    assert curve.name == "Brow"
    assert (curve.source_vertices, curve.target_vertices) == (scene.text(scene.ROW), scene.text(scene.ROW_B))
    assert scene.key_positions("Ball A", scene.KEY) == saved["balls"]
    assert scene.key_positions("Sheet A", scene.KEY_OF_SHEETS) == saved["sheets"]
    uvs = [round(value, 6) for each in sheet.data.uv_layers.active.uv for value in each.vector]
    assert uvs == saved["uvs"]


def test_what_the_panels_show_is_as_it_was(saved: dict[str, Any]) -> None:
    assert scene.settings() == scene.SETTINGS


def test_what_was_wrapped_by_curves_is_transferred_by_curves(saved: dict[str, Any]) -> None:
    _activate("Sheet A")
    target: Any = bpy.data.objects["Sheet B"]
    group = target.vertex_groups.new(name="Height")
    for vertex in target.data.vertices:
        group.add([vertex.index], min(max(vertex.co.z, 0), 1), "REPLACE")
    assert bpy.ops.authalic.transfer(uv_maps=False) == {"FINISHED"}
    source: Any = bpy.data.objects["Sheet A"]
    weights = [source.vertex_groups["Height"].weight(vertex) for vertex in scene.ROW]
    # The ends of the curve lie exactly on those of the target's curve.
    ends = [target.vertex_groups["Height"].weight(vertex) for vertex in (scene.ROW_B[0], scene.ROW_B[-1])]
    np.testing.assert_allclose([weights[0], weights[-1]], ends, atol=1e-5)


def test_they_are_wrapped_again(saved: dict[str, Any]) -> None:
    ball = _activate("Ball A")
    assert bpy.ops.authalic.register() == {"FINISHED"}
    target = bpy.data.objects["Ball B"]
    key: Any = ball.data.shape_keys.key_blocks[scene.KEY]
    for _, vertex in scene.POINTS:
        there = ball.matrix_world.inverted() @ target.matrix_world @ target.data.vertices[vertex].co
        assert (key.data[vertex].co - there).length < 1e-4
    bpy.ops.wm.save_as_mainfile(filepath=str(scene.FOLDER / "after.blend"))


def test_landmark_files_are_read(saved: dict[str, Any]) -> None:
    ball = _activate("Ball A")
    bpy.ops.authalic.landmark_clear()
    assert bpy.ops.authalic.landmark_import(filepath=str(scene.LANDMARKS)) == {"FINISHED"}
    assert _points(ball) == [(name, vertex, vertex) for name, vertex in scene.POINTS]


def test_operators_take_all_options_that_they_had(saved: dict[str, Any]) -> None:
    """A preset or a script that was written for version 0.1.0 sets these."""
    gone = {}
    for operator, before in saved["options"].items():
        missing = set(before) - set(scene.options(operator))
        now = scene.values(operator)
        for name, listed in saved["values"][operator].items():
            missing |= {f"{name}={value}" for value in set(listed) - set(now.get(name, listed))}
        if missing:
            gone[operator] = sorted(missing)
    assert gone == {}


def test_it_is_disabled_and_enabled(quitting: dict[str, bool]) -> None:
    bpy.ops.wm.save_userpref()
    quitting["saves"] = False  # Blender forgets the preferences of what is disabled
    bpy.ops.preferences.addon_disable(module=scene.MODULE)
    assert not scene.is_enabled() and not [name for name in dir(bpy.types) if name.startswith("AUTHALIC_")]
    bpy.ops.preferences.addon_enable(module=scene.MODULE)
    assert scene.is_enabled() and hasattr(bpy.types.Object, "authalic_landmarks")
