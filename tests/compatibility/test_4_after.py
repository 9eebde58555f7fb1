# SPDX-License-Identifier: GPL-3.0-or-later
"""The new version after a restart, and what is left when it is uninstalled."""

import os
from typing import Any

import bpy
import scene


def test_the_new_version_is_enabled_at_the_start(started_with: dict[str, Any]) -> None:
    assert scene.MODULE in started_with["addons"]
    assert f'version = "{os.environ["AUTHALIC_VERSION"]}"' in scene.manifest()
    before = scene.read_facts()["preferences"]
    assert before is None or scene.values_of_preferences() == before


def test_it_opens_what_it_has_saved() -> None:
    bpy.ops.wm.open_mainfile(filepath=str(scene.FOLDER / "after.blend"))
    ball: Any = bpy.data.objects["Ball A"]
    assert [each.name for each in ball.authalic_landmarks] == [name for name, _ in scene.POINTS]
    assert ball.authalic_registration.method == "POINTS"


def test_uninstalling_leaves_nothing() -> None:
    bpy.ops.extensions.package_uninstall(repo_index=scene.repo_index(), pkg_id="authalic")
    assert not scene.is_enabled() and not scene.folder().exists()
    assert not [name for name in dir(bpy.types) if name.startswith("AUTHALIC_")]
    assert scene.installed_libraries() == []


def test_a_file_with_its_data_opens_without_it() -> None:
    bpy.ops.wm.open_mainfile(filepath=str(scene.FOLDER / "after.blend"))
    assert not hasattr(bpy.data.objects["Ball A"], "authalic_landmarks")
    path = str(scene.FOLDER / "without.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    scene.install(os.environ["AUTHALIC_EXTENSION_ZIP"])
    bpy.ops.wm.open_mainfile(filepath=path)
    ball: Any = bpy.data.objects["Ball A"]
    kept = [(each.name, each.source_vertex, each.target_vertex) for each in ball.authalic_landmarks]
    assert kept == [(name, vertex, vertex) for name, vertex in scene.POINTS]
