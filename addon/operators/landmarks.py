# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.landmark_add, _remove, _clear and _jump: the pairs of the source object."""

import bmesh
import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from ..landmarks import points as landmarks
from . import poll, views

_GIVEN = {"SKIP_SAVE"}  # of this use alone, not remembered for the next


class _LandmarkOperator:
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)
    needs_pairs = True

    @classmethod
    def poll(cls, context):
        return poll.has_landmarks(cls, context) if cls.needs_pairs else poll.has_source(cls, context)

    def execute(self, context):
        try:
            return self.run(context, landmarks.source(context))
        except landmarks.CannotPair as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}

    def chosen(self, source):
        """The index of the pair that is meant."""
        index, count = self.index, len(source.authalic_landmarks)
        index = source.authalic_landmark_index if index == landmarks.NONE else index
        if not 0 <= index < count:
            raise landmarks.CannotPair(f"{source.name} has no pair {index}, its {count} are 0 to {count - 1}")
        return index


def _index():
    return IntProperty(
        name="Index",
        description="The place of the pair in the list, from 0. -1 for the active one",
        min=landmarks.NONE,
        default=landmarks.NONE,
        options=_GIVEN,
    )


class AUTHALIC_OT_landmark_add(_LandmarkOperator, bpy.types.Operator):
    """Pair the vertex that is selected on this object with the one that is selected on its target.

    Both objects have to be in Edit Mode, with one vertex selected on each"""

    bl_idname = "authalic.landmark_add"
    bl_label = "Add Landmark"
    needs_pairs = False

    name: StringProperty(name="Name", description="Empty for a number", default="", options=_GIVEN)
    source_vertex: IntProperty(
        name="Source Vertex",
        description="The vertex on this object. -1 for the selected one",
        min=landmarks.NONE,
        default=landmarks.NONE,
        options=_GIVEN,
    )
    target_vertex: IntProperty(
        name="Target Vertex",
        description="The vertex on the target. -1 for the selected one",
        min=landmarks.NONE,
        default=landmarks.NONE,
        options=_GIVEN,
    )

    @classmethod
    def poll(cls, context):
        return poll.has_target(cls, context)

    def run(self, _context, source):
        target = source.authalic_target
        source_vertex = _or_selected(self.source_vertex, source)
        target_vertex = _or_selected(self.target_vertex, target)
        added = landmarks.add(source, source_vertex, target_vertex, self.name)
        self.report(
            {"INFO"},
            f"{added.name}: vertex {source_vertex} of {source.name}, {target_vertex} of {target.name}",
        )
        return {"FINISHED"}


class AUTHALIC_OT_landmark_remove(_LandmarkOperator, bpy.types.Operator):
    """Remove a pair of landmarks"""

    bl_idname = "authalic.landmark_remove"
    bl_label = "Remove Landmark"
    index: _index()

    def run(self, _context, source):
        index = self.chosen(source)
        name = source.authalic_landmarks[index].name
        landmarks.remove(source, index)
        self.report({"INFO"}, f"Removed {name}, {len(source.authalic_landmarks)} left")
        return {"FINISHED"}


class AUTHALIC_OT_landmark_clear(_LandmarkOperator, bpy.types.Operator):
    """Remove all pairs of landmarks"""

    bl_idname = "authalic.landmark_clear"
    bl_label = "Clear Landmarks"

    def run(self, _context, source):
        count = len(source.authalic_landmarks)
        landmarks.clear(source)
        self.report({"INFO"}, f"Removed {count} landmarks of {source.name}")
        return {"FINISHED"}


class AUTHALIC_OT_landmark_jump(_LandmarkOperator, bpy.types.Operator):
    """Select the vertex of a landmark and bring it into view"""

    bl_idname = "authalic.landmark_jump"
    bl_label = "Jump to Landmark"
    index: _index()
    side: EnumProperty(
        name="Side",
        description="Whose vertex to go to",
        items=(
            ("SOURCE", "Source", "The vertex on this object"),
            ("TARGET", "Target", "The vertex on the target"),
        ),
        default="SOURCE",
    )

    def run(self, context, source):
        index = self.chosen(source)
        pair = landmarks.pairs(source)[index]
        is_source = self.side == "SOURCE"
        vertex = pair.source_vertex if is_source else pair.target_vertex
        if vertex == landmarks.NONE:
            raise landmarks.CannotPair(f"{pair.name}: {pair.problem}")
        obj = source if is_source else source.authalic_target
        source.authalic_landmark_index = index
        _select_vertex(obj, vertex)
        views.show(context, obj, vertex)
        self.report({"INFO"}, f"{pair.name}: vertex {vertex} of {obj.name}")
        return {"FINISHED"}


def _or_selected(vertex, obj):
    """The vertex, or for -1 the one that is selected on the object."""
    if vertex != landmarks.NONE:
        return vertex
    if not obj.data.is_editmode:
        raise landmarks.CannotPair(f"{obj.name} is not in Edit Mode: select both objects and enter it")
    edit = bmesh.from_edit_mesh(obj.data)
    selected = [number for number, one in enumerate(edit.verts) if one.select and not one.hide]
    if len(selected) != 1:
        count = len(selected) or "none"
        raise landmarks.CannotPair(f"Select exactly one vertex of {obj.name}, not {count}")
    return selected[0]


def _select_vertex(obj, vertex):
    """Selects a vertex and nothing else of the mesh."""
    mesh = obj.data
    if not mesh.is_editmode:
        for elements in (mesh.polygons, mesh.edges, mesh.vertices):
            elements.foreach_set("select", [False] * len(elements))
        mesh.vertices[vertex].select = True
        return
    edit = bmesh.from_edit_mesh(mesh)
    for one in edit.verts:
        one.select = False
    edit.select_flush(False)
    edit.verts.ensure_lookup_table()
    edit.verts[vertex].hide_set(False)
    edit.verts[vertex].select_set(True)
    edit.select_history.clear()
    edit.select_history.add(edit.verts[vertex])
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


_CLASSES = (
    AUTHALIC_OT_landmark_add,
    AUTHALIC_OT_landmark_remove,
    AUTHALIC_OT_landmark_clear,
    AUTHALIC_OT_landmark_jump,
)


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
