# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects a command works on."""

from ..bridge import Refusal


class NothingToDo(Exception):
    """There is nothing selected to work on."""


def meshes(context):
    """The mesh objects of the context, those in edit mode or the selected ones, one for each mesh.

    Of several objects with one mesh the active one counts, else the first.
    """
    objects = context.objects_in_mode if context.mode == "EDIT_MESH" else context.selected_objects
    active = context.view_layer.objects.active
    found = {}
    for obj in sorted(objects, key=lambda obj: obj != active):
        if obj.type == "MESH":
            found.setdefault(obj.data.name_full, obj)
    # In the order of the objects, which does not depend on the active one.
    return [obj for obj in objects if obj in found.values()]


def editable(context):
    """The same without those that cannot be written, and a refusal for each of those."""
    objects, refusals = [], []
    for obj in meshes(context):
        if obj.data.library is None:
            objects.append(obj)
        else:
            refusals.append(Refusal(obj.name, None, "its mesh is linked from another file; make it local"))
    return objects, refusals
