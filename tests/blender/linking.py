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


def local(obj: MeshObject) -> MeshObject:
    """A new object of this file with the mesh of another."""
    copy = bpy.data.objects.new(f"Local {obj.name}", obj.data)
    bpy.context.collection.objects.link(copy)
    return copy
