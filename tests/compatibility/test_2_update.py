# SPDX-License-Identifier: GPL-3.0-or-later
"""The update of version 0.1.0 while it is in use, which ends with the request to start Blender again."""

import os
from typing import Any

import bpy
import scene


def test_version_0_1_0_is_enabled_at_the_start(started_with: dict[str, Any]) -> None:
    assert scene.MODULE in started_with["addons"] and 'version = "0.1.0"' in scene.manifest()
    assert scene.values_of_preferences() == scene.read_facts()["preferences"]
    bpy.ops.wm.open_mainfile(filepath=str(scene.SAVED))
    bpy.context.view_layer.objects.active = bpy.data.objects["Sheet A"]
    # in use: its library is in memory
    assert bpy.ops.authalic.measure() == {"FINISHED"}


def test_it_is_updated_while_it_is_in_use() -> None:
    scene.install(os.environ["AUTHALIC_EXTENSION_ZIP"])
    assert scene.is_enabled()
    assert f'version = "{os.environ["AUTHALIC_VERSION"]}"' in scene.manifest()
    assert len(scene.installed_libraries()) == 1
    panels = [name for name in dir(bpy.types) if name.startswith("AUTHALIC_")]
    assert panels == ["AUTHALIC_PT_restart_image", "AUTHALIC_PT_restart_view3d"]


def test_what_the_file_keeps_outlives_the_time_until_the_restart() -> None:
    path = str(scene.FOLDER / "meanwhile.blend")
    bpy.ops.wm.open_mainfile(filepath=str(scene.SAVED))
    bpy.ops.wm.save_as_mainfile(filepath=path)


def test_it_is_disabled_and_enabled(quitting: dict[str, bool]) -> None:
    bpy.ops.wm.save_userpref()
    quitting["saves"] = False  # Blender forgets the preferences of what is disabled
    bpy.ops.preferences.addon_disable(module=scene.MODULE)
    assert not [name for name in dir(bpy.types) if name.startswith("AUTHALIC_")]
    bpy.ops.preferences.addon_enable(module=scene.MODULE)
    assert scene.is_enabled() and hasattr(bpy.types, "AUTHALIC_PT_restart_view3d")
