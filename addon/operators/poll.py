# SPDX-License-Identifier: GPL-3.0-or-later
"""When commands can be used."""


def has_meshes(operator, context):
    """Object or edit mode with a mesh to work on; else tells the user what is missing."""
    if context.mode not in {"OBJECT", "EDIT_MESH"}:
        operator.poll_message_set("Only in Object Mode and in Edit Mode of a mesh")
        return False
    if context.mode == "OBJECT" and not any(obj.type == "MESH" for obj in context.selected_objects):
        operator.poll_message_set("Select at least one mesh object")
        return False
    return True


def has_meshes_in_object_mode(operator, context):
    """Object mode with a mesh to work on; else tells the user what is missing."""
    if context.mode != "OBJECT":
        operator.poll_message_set("Only in Object Mode")
        return False
    return has_meshes(operator, context)
