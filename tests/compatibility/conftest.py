# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of one Blender after the other in the same profile."""

import os
import shutil
import sys
from collections.abc import Iterator
from typing import Any

import bpy
import pytest
import scene

_STATUS = pytest.StashKey[int]()


@pytest.fixture(scope="session")
def started_with() -> dict[str, Any]:
    """What Blender had as it started: the names of the add-ons that are enabled."""
    # As a module Blender starts without the preferences that a window starts with.
    if bpy.app.version >= (4, 5):
        bpy.ops.wm.read_userpref()
    else:
        _read_preferences_by_a_template()
    return {"addons": set(bpy.context.preferences.addons.keys())}


def _read_preferences_by_a_template() -> None:
    """As a module Blender 4.2 crashes as it reads preferences, but not as it does so for another template."""
    saved = scene.PROFILE / "config" / "userpref.blend"
    if saved.exists():
        template = scene.PROFILE / "scripts" / "startup" / "bl_app_templates_user" / "template"
        template.mkdir(parents=True, exist_ok=True)
        shutil.copy(saved, template)
        for name in (template.name, ""):
            bpy.ops.wm.read_homefile(app_template=name)


@pytest.fixture(scope="session", autouse=True)
def quitting(started_with: dict[str, Any]) -> Iterator[dict[str, bool]]:
    """Saves the preferences as Blender does when a person quits it, unless a test takes "saves" back."""
    how = {"saves": True}
    yield how
    if how["saves"]:
        bpy.ops.wm.save_userpref()


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    session.config.stash[_STATUS] = int(exitstatus)


def pytest_unconfigure(config: pytest.Config) -> None:
    """Blender 4.2 may crash and Blender 4.5 may hang as the interpreter ends."""
    if _STATUS in config.stash:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(config.stash[_STATUS])
