# SPDX-License-Identifier: GPL-3.0-or-later
"""What an editor shows."""

from typing import Any

import bpy

from ..blender.types import is_mesh


def shows_uvs(context: bpy.types.Context) -> bool:
    """Whether an image editor is a UV editor with a mesh to edit, and shows no render."""
    space: Any = context.space_data
    return is_mesh(context.object) and space.mode == "UV" and not space.show_render
