# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.fix_flips: turns flipped faces of the active UV map over."""

import bpy

from ..jobs import fix_flips
from . import poll
from .modal import Modal


class AUTHALIC_OT_fix_flips(Modal, bpy.types.Operator):
    """Turn the flipped faces of the active UV map over, moving as few UVs as possible.

    Pinned UVs and the outlines of islands stay, and so do islands without flipped faces"""

    bl_idname = "authalic.fix_flips"
    bl_label = "Fix Flips"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)
    refused = (fix_flips.CannotFix,)

    @classmethod
    def poll(cls, context):
        return poll.has_uv_maps(cls, context)

    def job(self, context):
        return fix_flips.job(context)

    def line(self, report):
        return str(report)


def register():
    bpy.utils.register_class(AUTHALIC_OT_fix_flips)


def unregister():
    bpy.utils.unregister_class(AUTHALIC_OT_fix_flips)
