# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.landmark_add, _remove, _clear, _mirror and _jump: the pairs of the source object."""

from typing import Any

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty, StringProperty

from .. import messages
from ..blender import selection
from ..blender.types import MeshObject, Status
from ..landmarks import mirroring
from ..landmarks import points as landmark_points
from ..landmarks.objects import NONE, CannotPair, active_source
from . import poll, views
from .landmark_base import GIVEN, LandmarkOperator, index_property


class _PointOperator(LandmarkOperator):
    changes_lists = True

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        is_free = not cls.changes_lists or poll.can_change_lists(cls, context)
        return is_free and poll.has_landmarks(cls, context)


class AUTHALIC_OT_landmark_add(_PointOperator, bpy.types.Operator):
    """Pair the selected vertex of this object with the selected vertex of its target.

    Both objects must be in Edit Mode, with one vertex selected on each"""

    bl_idname = "authalic.landmark_add"
    bl_label = "Add Landmark"

    name: StringProperty(name="Name", description="Empty for a number", default="", options=GIVEN)
    source_vertex: IntProperty(
        name="Source Vertex",
        description="The vertex on this object. -1 for the selected one",
        min=NONE,
        default=NONE,
        options=GIVEN,
    )
    target_vertex: IntProperty(
        name="Target Vertex",
        description="The vertex on the target. -1 for the selected one",
        min=NONE,
        default=NONE,
        options=GIVEN,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.can_pair(cls, context)

    def run(self, _context: bpy.types.Context, source: MeshObject) -> Status:
        target = source.authalic_target
        source_vertex = _or_selected(self.source_vertex, source)
        target_vertex = _or_selected(self.target_vertex, target)
        added = landmark_points.add(source, source_vertex, target_vertex, self.name)
        self.report(
            {"INFO"},
            f"{added.name}: vertex {source_vertex} of {source.name}, {target_vertex} of {target.name}",
        )
        return {"FINISHED"}


class AUTHALIC_OT_landmark_remove(_PointOperator, bpy.types.Operator):
    """Remove a pair of landmarks"""

    bl_idname = "authalic.landmark_remove"
    bl_label = "Remove Landmark"
    index: index_property()

    def run(self, _context: bpy.types.Context, source: MeshObject) -> Status:
        index = self.chosen(source)
        name = source.authalic_landmarks[index].name
        landmark_points.remove(source, index)
        self.report({"INFO"}, f"Removed {name}, {len(source.authalic_landmarks)} left")
        return {"FINISHED"}


class AUTHALIC_OT_landmark_clear(_PointOperator, bpy.types.Operator):
    """Remove all pairs of landmarks"""

    bl_idname = "authalic.landmark_clear"
    bl_label = "Clear Landmarks"

    def run(self, _context: bpy.types.Context, source: MeshObject) -> Status:
        count = len(source.authalic_landmarks)
        landmark_points.clear(source)
        self.report({"INFO"}, f"Removed {messages.count(count, 'landmark')} of {source.name}")
        return {"FINISHED"}


class AUTHALIC_OT_landmark_mirror(_PointOperator, bpy.types.Operator):
    """Pair the vertices that lie mirrored over X in both objects, for each pair beside the mirror plane.

    Left and right in names are swapped. Pairs that have a mirrored pair already are left alone"""

    bl_idname = "authalic.landmark_mirror"
    bl_label = "Mirror Landmarks over X"
    tolerance: FloatProperty(
        name="Tolerance",
        description="How far from the mirrored place a vertex may be, as a part of the size of its object",
        min=0.0,
        soft_max=0.1,
        max=1.0,
        precision=3,
        default=0.02,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.can_pair(cls, context) and poll.has_landmarks(cls, context)

    def run(self, _context: bpy.types.Context, source: MeshObject) -> Status:
        mirrored = mirroring.mirror(source, self.tolerance)
        self.report({"WARNING"} if mirrored.missing else {"INFO"}, _of_mirrored(mirrored, source))
        return {"FINISHED"} if mirrored.added else {"CANCELLED"}


class AUTHALIC_OT_landmark_jump(_PointOperator, bpy.types.Operator):
    """Select the vertex of a landmark and bring it into view"""

    bl_idname = "authalic.landmark_jump"
    bl_label = "Jump to Landmark"
    changes_lists = False
    index: index_property()
    side: EnumProperty(
        name="Side",
        description="The object whose vertex to go to",
        items=(
            ("SOURCE", "Source", "The vertex on this object"),
            ("TARGET", "Target", "The vertex on the target"),
        ),
        default="SOURCE",
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: Any) -> str:
        """The tooltip, with the vertices of the pair and its last error."""
        words = bpy.app.translations.pgettext_tip
        said, source = [words(str(cls.__doc__))], active_source(context)
        if source is not None and 0 <= properties.index < len(source.authalic_landmarks):
            pair, landmark = (
                landmark_points.pairs(source)[properties.index],
                source.authalic_landmarks[properties.index],
            )
            said.append(pair.problem or _vertices(pair, source))
            if pair.problem is None and landmark.error >= 0:
                said.append(
                    words("Missed by {error:.3f} % of the target's size").format(error=landmark.error)
                )
        return ".\n".join(said)

    def run(self, context: bpy.types.Context, source: MeshObject) -> Status:
        index = self.chosen(source)
        pair = landmark_points.pairs(source)[index]
        is_source = self.side == "SOURCE"
        vertex = pair.source_vertex if is_source else pair.target_vertex
        if vertex == NONE:
            raise CannotPair(f"{pair.name}: {pair.problem}")
        obj = source if is_source else source.authalic_target
        source.authalic_landmark_index = index
        selection.select_vertex(obj, vertex)
        views.show(context, obj, vertex)
        self.report({"INFO"}, f"{pair.name}: vertex {vertex} of {obj.name}")
        return {"FINISHED"}


def _vertices(pair: landmark_points.Pair, source: MeshObject) -> str:
    target = source.authalic_target
    return f"Vertex {pair.source_vertex} of {source.name}, vertex {pair.target_vertex} of {target.name}"


def _of_mirrored(mirrored: mirroring.Mirrored, source: MeshObject) -> str:
    """The report: how many landmarks were mirrored, and why others were not."""
    target = source.authalic_target
    left = [
        (len(mirrored.on_plane), "on the mirror plane"),
        (len(mirrored.there), "mirrored already"),
    ]
    said = [f"Mirrored {messages.count(len(mirrored.added), 'landmark')}"]
    said += [f"{number} {why}" for number, why in left if number]
    if mirrored.missing:
        named = messages.named([f'"{name}"' for name in mirrored.missing])
        said.append(f"no free vertex near the mirrored place of {named} on {source.name} or {target.name}")
    return "; ".join(said)


def _or_selected(vertex: int, obj: MeshObject) -> int:
    """The vertex, or for -1 the selected vertex of the object."""
    if vertex != NONE:
        return vertex
    if not obj.data.is_editmode:
        raise CannotPair(f"{obj.name} is not in Edit Mode: select both objects and enter it")
    selected = selection.vertices(obj)
    if len(selected) != 1:
        count = len(selected) or "none"
        raise CannotPair(f"Select exactly one vertex of {obj.name}, not {count}")
    return selected[0]


_CLASSES = (
    AUTHALIC_OT_landmark_add,
    AUTHALIC_OT_landmark_remove,
    AUTHALIC_OT_landmark_clear,
    AUTHALIC_OT_landmark_mirror,
    AUTHALIC_OT_landmark_jump,
)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
