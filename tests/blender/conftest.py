# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the installed extension: the zip AUTHALIC_EXTENSION_ZIP, in a scratch profile."""

import os
import sys
from collections.abc import Iterator

import bpy
import pytest
from installed import MODULE, part

_STATUS = pytest.StashKey[int]()


def _setting(name: str, meaning: str) -> str:
    value = os.environ.get(name)
    if not value:
        pytest.exit(f"set {name} to {meaning} (scripts/test does)", returncode=2)
    return value


def install() -> None:
    """Installs and enables the zip as a person would."""
    archive = _setting("AUTHALIC_EXTENSION_ZIP", "the extension zip")
    bpy.ops.extensions.package_install_files(
        filepath=os.path.abspath(archive), repo="user_default", enable_on_install=True
    )


@pytest.fixture(scope="session", autouse=True)
def extension() -> Iterator[str]:
    """The installed extension; the module itself."""
    _setting("BLENDER_USER_RESOURCES", "an empty folder for Blender's profile")
    install()
    assert MODULE in bpy.context.preferences.addons, "the extension was not enabled"
    yield MODULE
    # disabled as a person would, so that nothing of it is registered when Blender ends
    bpy.ops.preferences.addon_disable(module=MODULE)


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    session.config.stash[_STATUS] = int(exitstatus)


def pytest_unconfigure(config: pytest.Config) -> None:
    """Blender 4.2 may crash and Blender 4.5 hang as the interpreter ends, after the report is written."""
    if bpy.app.version < (5, 0) and _STATUS in config.stash:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(config.stash[_STATUS])


@pytest.fixture(autouse=True)
def empty_file(extension: str) -> None:
    """A file without objects for every test, undo that starts there, and no maps of earlier tests."""
    for obj in list(bpy.context.view_layer.objects):
        if obj.mode != "OBJECT":
            bpy.context.view_layer.objects.active = obj
            bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    if MODULE not in bpy.context.preferences.addons:
        bpy.ops.preferences.addon_enable(module=MODULE)
    part("bridge").forget()
