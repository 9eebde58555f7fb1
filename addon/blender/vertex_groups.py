# SPDX-License-Identifier: GPL-3.0-or-later
"""The weights of vertex groups, in object mode and in edit mode."""

from typing import Any

import bmesh
import bpy
import numpy as np

from ..surfaces.arrays import Singles
from .types import MeshObject

_ROUNDING = 1e-3  # of sums of weights in single precision


def names(obj: MeshObject) -> list[str]:
    """The names of the vertex groups of an object."""
    return [group.name for group in obj.vertex_groups]


def sharing(obj: MeshObject) -> set[str]:
    """The groups whose weights share out each vertex, so that they add up to one.

    Those of the bones that deform the object; without bones all, if the weights of each vertex that is in a
    group add up to one.
    """
    modifiers: list[Any] = [modifier for modifier in obj.modifiers if modifier.type == "ARMATURE"]
    armatures = [modifier.object for modifier in modifiers if modifier.object]
    bones = [bone for armature in armatures for bone in armature.data.bones]
    deforming = {bone.name for bone in bones if bone.use_deform}
    if deforming:
        return deforming & {*names(obj)}
    sums = [sum(entry.weight for entry in vertex.groups) for vertex in obj.data.vertices if vertex.groups]
    return {*names(obj)} if all(abs(total - 1) < _ROUNDING for total in sums) else set()


def weights(obj: MeshObject, name: str, shown: bpy.types.Mesh | None = None) -> Singles:
    """The weights (n,) of all vertices in a group; 0 outside, or where the object has no such group.

    Those of the object's mesh, or of the mesh `shown` as its modifiers have made it.
    """
    mesh = shown or obj.data
    group: Any = obj.vertex_groups.get(name)
    number = -1 if group is None else group.index
    if not mesh.is_editmode:
        found = np.zeros(len(mesh.vertices), np.float32)
        for vertex in mesh.vertices if number >= 0 else ():
            for entry in vertex.groups:
                if entry.group == number:
                    found[vertex.index] = entry.weight
        return found
    edit = bmesh.from_edit_mesh(mesh)
    layer = edit.verts.layers.deform.active
    if layer is None or number < 0:
        return np.zeros(len(edit.verts), np.float32)
    return np.array([vertex[layer].get(number, 0.0) for vertex in edit.verts], np.float32)
