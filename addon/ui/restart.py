# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels while an earlier version's native library is in memory, which asks for a restart of Blender.

Python cannot exchange a native library. Where the extension is updated after it was used, it would find the
old one. So nothing else is registered until Blender starts again; the extension stays enabled meanwhile.
"""

import sys
import tomllib
from pathlib import Path
from typing import Any

import bpy

from ..blender.types import PanelMixin
from . import translations

_LIBRARY = "authalic"


def is_needed(folder: Path | None = None) -> bool:
    """Whether the library in memory is that of another version than the extension in a folder, this one."""
    loaded: Any = sys.modules.get(_LIBRARY)
    if loaded is None:
        return False
    manifest = (folder or Path(__file__).parents[1]) / "blender_manifest.toml"
    wanted = tomllib.loads(manifest.read_text(encoding="utf-8"))["version"]
    return bool(getattr(loaded, "__version__", None) != wanted)


class _Panel(PanelMixin):
    bl_label = "Authalic"
    bl_category = "Authalic"
    bl_region_type = "UI"

    def draw(self, _context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        column.alert = True
        column.label(text="Authalic was updated", icon="INFO")
        column.label(text="Save your work and restart Blender")


class AUTHALIC_PT_restart_view3d(_Panel, bpy.types.Panel):
    bl_space_type = "VIEW_3D"


class AUTHALIC_PT_restart_image(_Panel, bpy.types.Panel):
    bl_space_type = "IMAGE_EDITOR"


_CLASSES = (AUTHALIC_PT_restart_view3d, AUTHALIC_PT_restart_image)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)


MODULES = (translations, sys.modules[__name__])
