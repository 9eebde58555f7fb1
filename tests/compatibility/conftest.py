# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of one Blender after the other in the same profile."""

import os
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
    elif scene.folder().exists():  # Blender 4.2 as a module crashes as it reads them
        bpy.ops.preferences.addon_enable(module=scene.MODULE)
    return {"addons": set(bpy.context.preferences.addons.keys())}


@pytest.fixture(scope="session", autouse=True)
def _end(started_with: dict[str, Any]) -> Iterator[None]:
    """Saves the preferences as Blender does when a person quits it."""
    yield
    bpy.ops.wm.save_userpref()


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    session.config.stash[_STATUS] = int(exitstatus)


def pytest_unconfigure(config: pytest.Config) -> None:
    """Blender 4.2 may crash and Blender 4.5 may hang as the interpreter ends."""
    if _STATUS in config.stash:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(config.stash[_STATUS])
