# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.fix_flips: turns the flipped faces of the active UV map over."""

from typing import Any

import bpy

from ..jobs import fix_flips
from ..jobs.job import Job
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
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.has_uv_maps(cls, context)

    def job(self, context: bpy.types.Context) -> Job[Any, fix_flips.Report]:
        return fix_flips.job(context)

    def line(self, report: fix_flips.Report) -> str:
        return str(report)


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_fix_flips)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_OT_fix_flips)
