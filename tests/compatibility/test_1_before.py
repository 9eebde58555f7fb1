# SPDX-License-Identifier: GPL-3.0-or-later
"""What a person did with version 0.1.0."""

import json
import os
from typing import Any

import bpy
import pytest
import scene


@pytest.fixture(scope="module", autouse=True)
def old_version() -> None:
    scene.install(os.environ["AUTHALIC_OLD_ZIP"])
    assert scene.is_enabled() and 'version = "0.1.0"' in scene.manifest()
    bpy.ops.wm.read_homefile(use_empty=True)
    if not scene.is_enabled():
        bpy.ops.preferences.addon_enable(module=scene.MODULE)


def test_landmarks_curves_and_wraps_are_saved() -> None:
    scene.balls()
    for name, vertex in scene.POINTS:
        given = {"name": name, "source_vertex": vertex, "target_vertex": vertex}
        assert bpy.ops.authalic.landmark_add(**given) == {"FINISHED"}
    assert bpy.ops.authalic.register() == {"FINISHED"}
    bpy.ops.authalic.landmark_export(filepath=str(scene.LANDMARKS))
    sheet, _ = scene.sheets()
    assert bpy.ops.authalic.landmark_add(name="Top", source_vertex=24, target_vertex=40) == {"FINISHED"}
    paths: dict[str, Any] = {
        "source_vertices": scene.text(scene.ROW),
        "target_vertices": scene.text(scene.ROW_B),
    }
    assert bpy.ops.authalic.landmark_curve_add(name="Brow", **paths) == {"FINISHED"}
    assert bpy.ops.authalic.register(method="CURVES") == {"FINISHED"}
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}
    uvs = [round(value, 6) for each in sheet.data.uv_layers.active.uv for value in each.vector]
    bpy.data.objects["Ball A"].authalic_landmark_index = 2
    bpy.context.scene.authalic_show_landmarks = False
    assert scene.settings() == scene.SETTINGS
    facts = {
        "balls": scene.key_positions("Ball A", scene.KEY),
        "sheets": scene.key_positions("Sheet A", scene.KEY_OF_SHEETS),
        "uvs": uvs,
        "options": {operator: scene.options(operator) for operator in scene.operators()},
        "values": {operator: scene.values(operator) for operator in scene.operators()},
    }
    scene.FACTS.write_text(json.dumps(facts), encoding="utf-8")
    bpy.ops.wm.save_as_mainfile(filepath=str(scene.SAVED), compress=True)


def test_preferences_are_set() -> None:
    """They are saved as this Blender ends; an early version 0.1.0 has none."""
    preferences = scene.preferences()
    if preferences is not None:
        for name, value in scene.PREFERENCES.items():
            setattr(preferences, name, value)
    facts = {**scene.read_facts(), "preferences": scene.values_of_preferences()}
    assert facts["preferences"] in (None, scene.PREFERENCES)
    scene.FACTS.write_text(json.dumps(facts), encoding="utf-8")
