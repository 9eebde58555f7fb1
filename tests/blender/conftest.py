# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the extension as installed: the zip AUTHALIC_EXTENSION_ZIP, in a scratch profile."""

import os

import bpy
import pytest

MODULE = "bl_ext.user_default.authalic"


def _setting(name, meaning):
    value = os.environ.get(name)
    if not value:
        pytest.exit(f"set {name} to {meaning} (scripts/test does)", returncode=2)
    return value


def install():
    """Installs and enables the zip as a person would."""
    archive = _setting("AUTHALIC_EXTENSION_ZIP", "the extension zip")
    bpy.ops.extensions.package_install_files(
        filepath=os.path.abspath(archive), repo="user_default", enable_on_install=True
    )


@pytest.fixture(scope="session", autouse=True)
def extension():
    """The installed extension; the module itself."""
    _setting("BLENDER_USER_RESOURCES", "an empty folder for Blender's profile")
    install()
    assert MODULE in bpy.context.preferences.addons, "the extension was not enabled"
    return MODULE


@pytest.fixture(autouse=True)
def empty_file(extension):
    """A file without objects for every test, and undo that starts there."""
    for obj in list(bpy.context.view_layer.objects):
        if obj.mode != "OBJECT":
            bpy.context.view_layer.objects.active = obj
            bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    if MODULE not in bpy.context.preferences.addons:
        bpy.ops.preferences.addon_enable(module=MODULE)
