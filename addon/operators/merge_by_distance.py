# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.merge_by_distance: joins faces of the object or its target where vertices lie on each other."""

import bpy
from bpy.app.handlers import persistent
from bpy.props import EnumProperty

from .. import messages
from ..blender.types import Status, is_mesh
from ..jobs import unjoined
from ..landmarks.objects import active_source, side_object, target_problem
from . import poll


class AUTHALIC_OT_merge_by_distance(bpy.types.Operator):
    """Merge the vertices of open edges that lie on each other, so that faces are joined.

    UV maps, landmarks and shape keys stay"""

    bl_idname = "authalic.merge_by_distance"
    bl_label = "Merge by Distance"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)

    side: EnumProperty(
        name="Side",
        description="The object whose vertices are merged",
        items=(
            ("SOURCE", "Source", "The object that is wrapped"),
            ("TARGET", "Target", "The object that it is wrapped onto"),
        ),
        default="SOURCE",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.is_object_mode(cls, context) and poll.has_source(cls, context)

    def execute(self, context: bpy.types.Context) -> Status:
        source = active_source(context)
        problem = target_problem(source) if self.side == "TARGET" else None
        obj = side_object(source, self.side.lower())
        if problem or not is_mesh(obj):
            self.report({"ERROR"}, f"{source.name}: {problem}")
            return {"CANCELLED"}
        try:
            count = unjoined.merge(obj)
        except unjoined.CannotMerge as reason:
            self.report({"ERROR"}, str(reason))
            return {"CANCELLED"}
        self.report({"INFO"}, f"{obj.name}: {messages.count(count, 'vertex')} merged")
        return {"FINISHED"}


@persistent  # type: ignore[untyped-decorator]
def _loaded(*_: object) -> None:
    unjoined.forget_all()


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_merge_by_distance)
    bpy.app.handlers.load_post.append(_loaded)


def unregister() -> None:
    bpy.app.handlers.load_post.remove(_loaded)
    bpy.utils.unregister_class(AUTHALIC_OT_merge_by_distance)
