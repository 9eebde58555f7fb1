# SPDX-License-Identifier: GPL-3.0-or-later
"""After an update of the extension while it is in use, Blender has to be started again."""

import sys
import types
from pathlib import Path

import drawing
import pytest
from installed import part


def test_the_library_of_this_version_needs_no_restart() -> None:
    assert not part("ui.restart").is_needed()


def test_the_library_of_another_version_needs_one(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "blender_manifest.toml").write_text('version = "0.0.1"')
    assert part("ui.restart").is_needed(tmp_path)
    old = types.ModuleType("authalic")
    monkeypatch.setattr(old, "__version__", "0.0.1", raising=False)
    monkeypatch.setitem(sys.modules, "authalic", old)
    assert part("ui.restart").is_needed() and not part("ui.restart").is_needed(tmp_path)
    monkeypatch.delitem(sys.modules, "authalic")
    assert not part("ui.restart").is_needed()


def test_the_panels_say_so() -> None:
    restart = part("ui.restart")
    restart.register()
    try:
        for space in ("view3d", "image"):
            drawn = drawing.draw_panel(f"AUTHALIC_PT_restart_{space}")
            assert drawn is not None and "Save your work and restart Blender" in drawn.labels
    finally:
        restart.unregister()
