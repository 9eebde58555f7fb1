# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects a command works on."""

import bpy

from .. import messages
from ..blender import editability
from ..blender.types import MeshObject, is_mesh
from ..bridge import Refusal


class NothingToDo(Exception):
    """There is nothing selected to work on."""


class CannotWrite(NothingToDo):
    """No mesh of what is selected can be written."""


def meshes(context: bpy.types.Context) -> list[MeshObject]:
    """The mesh objects of the context, those in edit mode or the selected ones, one for each mesh.

    Of several objects with one mesh it is the active one, else the first.
    """
    objects = context.objects_in_mode if context.mode == "EDIT_MESH" else context.selected_objects
    active = context.view_layer.objects.active if context.view_layer else None
    chosen: dict[str, MeshObject] = {}
    for obj in sorted(objects, key=lambda obj: obj != active):
        if is_mesh(obj):
            chosen.setdefault(obj.data.name_full, obj)
    # In the order of the objects, which does not depend on the active one.
    return [obj for obj in objects if is_mesh(obj) and obj in chosen.values()]


def editable(
    context: bpy.types.Context, only: MeshObject | None = None
) -> tuple[list[MeshObject], list[Refusal]]:
    """The mesh objects of the context that can be written, and a refusal for each of the others.

    Those of the context are replaced by the object `only`, if there is one.

    Raises `CannotWrite` where there are meshes, but none can be written.
    """
    objects, refusals = [], []
    for obj in meshes(context) if only is None else [only]:
        reason = editability.why_not_mesh(obj)
        if reason is None:
            objects.append(obj)
        else:
            refusals.append(Refusal(obj.name, None, reason))
    if refusals and not objects:
        raise CannotWrite(messages.listed(refusals))
    return objects, refusals
