# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.select_reported: the faces that the last report named."""

from typing import Any

import bpy
import numpy as np
from bpy.app.handlers import persistent
from bpy.props import EnumProperty

from .. import messages
from ..blender import selection
from ..blender.types import MeshObject, Status, is_mesh
from ..jobs import reported
from ..surfaces.arrays import Integers


class AUTHALIC_OT_select_reported(bpy.types.Operator):
    """Select the faces of the islands that the last report named, in Edit Mode"""

    bl_idname = "authalic.select_reported"
    bl_label = "Select Reported Islands"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)

    which: EnumProperty(
        name="Which",
        description="The islands to select",
        items=(
            ("WORST", "Worst", "The island that came out worst, or the first that was left as it was"),
            ("ALL", "All", "All islands that the report named"),
        ),
        default="ALL",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.mode not in {"OBJECT", "EDIT_MESH"}:
            cls.poll_message_set("Only in Object Mode and in Edit Mode of a mesh")
            return False
        if not reported.last():
            cls.poll_message_set("The last report named no islands")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> Status:
        places = reported.last()
        places = places[:1] if self.which == "WORST" else places
        by_object = _by_object(context, places)
        changed = [obj.name for obj, polygons in by_object if not selection.has_polygons(obj, polygons)]
        if changed or not by_object:
            named = messages.named(changed or [place.name for place in places])
            self.report({"ERROR"}, f"{named} has changed since the report, or cannot be seen; run it again")
            return {"CANCELLED"}
        _enter(context, [obj for obj, _ in by_object])
        for obj, polygons in by_object:
            selection.select_polygons(obj, polygons)
        self.report(
            {"INFO"}, f"{messages.count(len(places), 'island')}: {places[0].name}: {places[0].reason}"
        )
        return {"FINISHED"}


def _by_object(context: bpy.types.Context, places: list[reported.Place]) -> list[tuple[MeshObject, Integers]]:
    """The objects that can be selected, with their polygons."""
    polygons: dict[str, list[Integers]] = {}
    for place in places:
        polygons.setdefault(place.name, []).append(place.polygons)
    objects: list[Any] = [context.view_layer.objects.get(name) for name in polygons]
    return [
        (obj, np.unique(np.concatenate(polygons[obj.name])))
        for obj in objects
        if is_mesh(obj) and obj.visible_get()
    ]


def _enter(context: bpy.types.Context, objects: list[MeshObject]) -> None:
    """Edit mode of these objects alone, where faces are selected."""
    if context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for obj in context.view_layer.objects:
        obj.select_set(obj in objects)
    context.view_layer.objects.active = objects[0]
    bpy.ops.object.mode_set(mode="EDIT")
    settings: Any = context.tool_settings
    settings.mesh_select_mode = False, False, True


@persistent  # type: ignore[untyped-decorator]
def _loaded(*_: object) -> None:
    reported.forget()


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_select_reported)
    bpy.app.handlers.load_post.append(_loaded)


def unregister() -> None:
    bpy.app.handlers.load_post.remove(_loaded)
    bpy.utils.unregister_class(AUTHALIC_OT_select_reported)
    reported.forget()
