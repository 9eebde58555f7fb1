# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of version 0.1.0: `tests/compatibility/test_1_before.py` made them in Blender 4.2."""

from pathlib import Path
from typing import Any

import bpy
import curving
import meshes
import numpy as np
import pairing
import pytest
from installed import part

DATA = Path(__file__).resolve().parents[1] / "data"
POINTS = [("Nose", 0, 0, None), ("Landmark 2", 5, 5, None), ("Chin", 17, 17, None), ("Back", 40, 40, None)]


@pytest.fixture
def opened() -> None:
    bpy.ops.wm.open_mainfile(filepath=str(DATA / "saved_by_0.1.0.blend"), load_ui=False)


def _activate(name: str) -> Any:
    meshes.select(bpy.data.objects[name])
    return bpy.data.objects[name]


def test_landmarks_and_curves_are_there(opened: None) -> None:
    ball, sheet = bpy.data.objects["Ball A"], bpy.data.objects["Sheet A"]
    assert pairing.listed(ball) == POINTS and ball.authalic_target == bpy.data.objects["Ball B"]
    assert pairing.listed(sheet) == [("Top", 24, 40, None)]
    assert curving.listed(sheet) == [("Brow", (8, 9, 10, 11), (10, 11, 12, 13, 14), None)]
    assert not any(landmark.is_soft for landmark in ball.authalic_landmarks)


def test_the_last_method_is_known(opened: None) -> None:
    last = part("jobs.last_registration")
    for name, method in (("Ball A", "POINTS"), ("Sheet A", "CURVES")):
        settings = last.settings(bpy.data.objects[name])
        assert (settings.method, settings.energy) == (method, "AREA")


def test_a_new_target_makes_the_last_method_void(opened: None) -> None:
    sheet = bpy.data.objects["Sheet A"]
    sheet.authalic_target = bpy.data.objects["Ball B"]
    assert part("jobs.last_registration").settings(sheet) is None


def test_what_was_wrapped_by_curves_is_transferred_by_curves(opened: None) -> None:
    source, target = _activate("Sheet A"), bpy.data.objects["Sheet B"]
    group = target.vertex_groups.new(name="Row")
    group.add(list(range(len(target.data.vertices))), 0.0, "REPLACE")
    group.add([10, 11, 12, 13, 14], 1.0, "REPLACE")  # the vertices of the target's curve
    assert bpy.ops.authalic.transfer(uv_maps=False, smooth="OFF") == {"FINISHED"}
    weights = [source.vertex_groups["Row"].weight(vertex) for vertex in (8, 9, 10, 11)]
    np.testing.assert_allclose(weights, 1.0, atol=1e-6)


def test_it_is_wrapped_again(opened: None) -> None:
    ball, target = _activate("Ball A"), bpy.data.objects["Ball B"]
    assert bpy.ops.authalic.register() == {"FINISHED"}
    key = ball.data.shape_keys.key_blocks["Morph → Ball B"]
    for _, vertex, goal, _ in POINTS:
        there = ball.matrix_world.inverted() @ target.matrix_world @ target.data.vertices[goal].co
        assert (key.data[vertex].co - there).length < 1e-4
    assert ball.authalic_registered_by == "" and ball.authalic_registration.method == "POINTS"


def test_its_landmark_files_are_read(opened: None) -> None:
    ball = _activate("Ball A")
    bpy.ops.authalic.landmark_clear()
    bpy.ops.authalic.landmark_import(filepath=str(DATA / "saved_by_0.1.0.json"))
    assert pairing.listed(ball) == POINTS


@pytest.mark.parametrize(("before", "now"), [({"align": True}, "ALIGN"), ({"align": False}, "WORLD")])
def test_an_option_of_its_scripts_is_understood(opened: None, before: dict[str, bool], now: str) -> None:
    source, target = _activate("Sheet A"), bpy.data.objects["Sheet B"]
    target.scale = (1, 2, 3)
    target.shape_key_add(name="Basis")
    key = target.shape_key_add(name="Smile")
    for number in range(20, 40):
        key.data[number].co.x += 0.1
    results = []
    for options in ({"offsets": now}, before, {"offsets": "SURFACE"}):
        assert bpy.ops.authalic.transfer(uv_maps=False, **options) == {"FINISHED"}
        results.append([tuple(point.co) for point in source.data.shape_keys.key_blocks["Smile"].data])
    assert results[0] == results[1] != results[2]
