# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether an operator can be used now; else a poll tells the user why not."""

import bpy

from ..blender import editability, uv_maps
from ..blender.types import is_mesh
from ..landmarks.objects import active_source, pairing_problem


def has_meshes(operator: "type[bpy.types.Operator]", context: bpy.types.Context) -> bool:
    """Object or edit mode with a mesh to work on."""
    if context.mode not in {"OBJECT", "EDIT_MESH"}:
        operator.poll_message_set("Only in Object Mode and in Edit Mode of a mesh")
        return False
    if context.mode == "OBJECT" and not any(obj.type == "MESH" for obj in context.selected_objects):
        operator.poll_message_set("Select at least one mesh object")
        return False
    return True


def has_meshes_in_object_mode(operator: "type[bpy.types.Operator]", context: bpy.types.Context) -> bool:
    """Object mode with a mesh to work on."""
    return is_object_mode(operator, context) and has_meshes(operator, context)


def is_object_mode(operator: "type[bpy.types.Operator]", context: bpy.types.Context) -> bool:
    """Object mode."""
    if context.mode != "OBJECT":
        operator.poll_message_set("Only in Object Mode")
    return context.mode == "OBJECT"


def has_uv_maps(operator: "type[bpy.types.Operator]", context: bpy.types.Context) -> bool:
    """Object or edit mode with a mesh that has a UV map."""
    if not has_meshes(operator, context):
        return False
    objects = context.objects_in_mode if context.mode == "EDIT_MESH" else context.selected_objects
    if not any(is_mesh(obj) and uv_maps.active(obj) for obj in objects):
        operator.poll_message_set("The selected meshes have no UV map")
        return False
    return True


def has_source(operator: "type[bpy.types.Operator]", context: bpy.types.Context) -> bool:
    """Object or edit mode with an active mesh."""
    if context.mode not in {"OBJECT", "EDIT_MESH"}:
        operator.poll_message_set("Only in Object Mode and in Edit Mode of a mesh")
        return False
    if context.object is None or context.object.type != "MESH":
        operator.poll_message_set("Make a mesh object the active one")
        return False
    return True


def can_pair(operator: "type[bpy.types.Operator]", context: bpy.types.Context) -> bool:
    """Object or edit mode with an active mesh that has a target and can keep landmarks."""
    if not has_source(operator, context):
        return False
    problem = pairing_problem(active_source(context))
    if problem:
        operator.poll_message_set(problem)
    return not problem


def can_change_lists(operator: "type[bpy.types.Operator]", context: bpy.types.Context) -> bool:
    """Object or edit mode with an active mesh whose lists of landmarks can be changed."""
    if not has_source(operator, context):
        return False
    source = active_source(context)
    reason = editability.why_not_object(source)
    if reason:
        operator.poll_message_set(f"{source.name}: {reason}")
    return not reason


def has_landmarks(operator: "type[bpy.types.Operator]", context: bpy.types.Context) -> bool:
    """An active mesh that has landmarks."""
    if not has_source(operator, context):
        return False
    if not active_source(context).authalic_landmarks:
        operator.poll_message_set("There are no landmarks yet")
        return False
    return True


def has_curves(operator: "type[bpy.types.Operator]", context: bpy.types.Context) -> bool:
    """An active mesh that has landmark curves."""
    if not has_source(operator, context):
        return False
    if not active_source(context).authalic_landmark_curves:
        operator.poll_message_set("There are no landmark curves yet")
        return False
    return True


def has_points_or_curves(operator: "type[bpy.types.Operator]", context: bpy.types.Context) -> bool:
    """An active mesh that has landmarks of either kind."""
    if not has_source(operator, context):
        return False
    source = active_source(context)
    if not source.authalic_landmarks and not source.authalic_landmark_curves:
        operator.poll_message_set("There are no landmarks yet")
        return False
    return True
