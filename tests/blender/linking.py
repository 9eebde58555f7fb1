# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects linked from another file, overridden or not, for the tests."""

from pathlib import Path
from typing import Any

import bpy
from meshes import MeshObject


def relink(path: Path, *objects: MeshObject) -> list[MeshObject]:
    """Saves objects as a file of their own, links them into an empty one, and puts them into its scene."""
    names = [obj.name for obj in objects]
    file = str(path / "library.blend")
    bpy.data.libraries.write(file, set(objects))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(file, link=True) as (_, target):
        target.objects = names
    linked: list[Any] = list(target.objects)
    for obj in linked:
        bpy.context.collection.objects.link(obj)
    return linked


def overridden(obj: MeshObject, *, is_mesh_too: bool) -> MeshObject:
    """An override of a linked object in its place, and of its mesh too."""
    override: Any = obj.override_create(remap_local_usages=True)
    if override.name not in bpy.context.collection.objects:
        bpy.context.collection.objects.link(override)
    if is_mesh_too:
        override.data = obj.data.override_create()
    return override


def linked_action(path: Path, obj: MeshObject) -> Any:
    """Saves the action of an object's shape keys, and has the linked one in its place move them."""
    data: Any = obj.data.shape_keys.animation_data
    name, file = data.action.name, str(path / "actions.blend")
    bpy.data.libraries.write(file, {data.action})
    bpy.data.actions.remove(data.action)
    with bpy.data.libraries.load(file, link=True) as (_, target):
        target.actions = [name]
    data.action = target.actions[0]
    if hasattr(data, "action_slot"):
        data.action_slot = data.action_suitable_slots[0]
    return data.action


def local(obj: MeshObject) -> MeshObject:
    """A new object of this file with the mesh of another."""
    copy = bpy.data.objects.new(f"Local {obj.name}", obj.data)
    bpy.context.collection.objects.link(copy)
    return copy
