# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.swap_target and authalic.side_by_side: the two objects of a registration."""

import bpy

from ..blender import places
from ..blender.types import MeshObject, Status
from ..landmarks import swapping
from ..landmarks.objects import active_source, target_problem
from . import poll, views
from .landmark_base import LandmarkOperator


class AUTHALIC_OT_swap_target(LandmarkOperator, bpy.types.Operator):
    """Let the object and its target change places, with all landmarks and landmark curves between them.

    Shape keys and UV maps of earlier registrations stay where they are"""

    bl_idname = "authalic.swap_target"
    bl_label = "Swap Source and Target"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.is_object_mode(cls, context) and poll.can_pair(cls, context)

    def run(self, context: bpy.types.Context, source: MeshObject) -> Status:
        new_source = swapping.swap(source)
        if new_source.visible_get():
            new_source.select_set(True)
            context.view_layer.objects.active = new_source
        self.report({"INFO"}, f"{new_source.name} is the source now, {source.name} its target")
        return {"FINISHED"}


class AUTHALIC_OT_side_by_side(bpy.types.Operator):
    """Move the target beside the object, so that both can be seen and picked, or back to where it stood.

    Morphs and transfers go by where it stood"""

    bl_idname = "authalic.side_by_side"
    bl_label = "Side by Side"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not poll.is_object_mode(cls, context) or not poll.has_source(cls, context):
            return False
        source = active_source(context)
        problem = target_problem(source)
        if problem is None and not source.authalic_target.is_editable:
            problem = f"{source.authalic_target.name} is linked from another file and cannot be moved"
        if problem:
            cls.poll_message_set(problem[:1].upper() + problem[1:])
        return not problem

    def execute(self, context: bpy.types.Context) -> Status:
        source = active_source(context)
        target = source.authalic_target
        if places.is_beside(target):
            places.put_back(target)
        else:
            places.put_beside(target, source)
            context.view_layer.update()
            views.frame(context, *places.box_of([source, target]))
        return {"FINISHED"}


_CLASSES = (AUTHALIC_OT_swap_target, AUTHALIC_OT_side_by_side)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
