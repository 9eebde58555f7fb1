# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys of meshes that are not in edit mode, as numpy arrays."""

import re
from collections.abc import Mapping
from dataclasses import replace

import bpy
import numpy as np

from ..surfaces.arrays import Floats, Reals
from ..surfaces.surface import Surface
from . import meshes
from .types import MeshObject

_IN_PATH = re.compile(r'key_blocks\["((?:[^"\\]|\\.)*)"\]')


def read(obj: MeshObject) -> Surface:
    """The surface of an object in the coordinates of its mesh, or of its first shape key."""
    surface, mesh = meshes.read(obj), obj.data
    if mesh.shape_keys is None:
        values = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", values)
        positions = values.reshape(-1, 3).astype(float)
    else:
        positions = coordinates(mesh.shape_keys.reference_key)
    return replace(surface, positions=positions)


def coordinates(key: bpy.types.ShapeKey) -> Floats:
    """The coordinates (n, 3) of a shape key."""
    values = np.empty(3 * len(key.points), np.float32)
    key.points.foreach_get("co", values)
    return values.reshape(-1, 3).astype(float)


def why_not(mesh: bpy.types.Mesh, name: str) -> str | None:
    """Why a mesh cannot have a relative shape key of this name, or None."""
    keys = mesh.shape_keys
    if keys is not None and not keys.use_relative:
        return "its shape keys are absolute; turn on Relative in its shape keys"
    if keys is not None and keys.reference_key.name == name:
        return f'its first shape key, of which all others are changes, is called "{name}"; rename that'
    return None


def write(obj: MeshObject, name: str, positions: Reals) -> None:
    """Writes coordinates (n, 3) into the shape key of a name, added with value 0 if need be.

    A mesh without shape keys also gets its first one. All other shape keys stay as they are, bit for bit, and
    the active one stays active: edit mode shows and changes that. So does the value of a key that is there.
    """
    active = obj.active_shape_key_index
    if obj.data.shape_keys is None:
        obj.shape_key_add(name="Basis", from_mix=False)
    keys = obj.data.shape_keys
    key: bpy.types.ShapeKey | None = keys.key_blocks.get(name)
    if key is None:
        key = obj.shape_key_add(name=name, from_mix=False)
        key.value = 0.0  # Blender 5 starts with 1
    key.points.foreach_set("co", np.ascontiguousarray(positions, np.float32).ravel())
    key.relative_key = keys.reference_key
    key.slider_min, key.slider_max = min(key.slider_min, 0.0), max(key.slider_max, 1.0)
    key.mute, key.vertex_group = False, ""
    obj.active_shape_key_index = active
    obj.data.update()


def find(obj: MeshObject, name: str) -> bpy.types.ShapeKey | None:
    """The shape key of a name, or None."""
    keys = obj.data.shape_keys
    return None if keys is None else keys.key_blocks.get(name)


def in_path(path: str) -> str | None:
    """The name of the shape key that a data path begins with, or None."""
    match = _IN_PATH.match(path)
    return bpy.utils.unescape_identifier(match[1]) if match else None


def make_relative(obj: MeshObject, wanted: Mapping[str, str]) -> list[str]:
    """Makes keys {name: name of another} relative to others, which they are moved with; all are there.

    Returns those that stay relative to the first key, because they are relative to each other in a circle.
    """
    keys = obj.data.shape_keys
    left = dict(wanted)
    while ready := [name for name, relative in left.items() if relative not in left]:
        for name in ready:
            key, relative = keys.key_blocks[name], keys.key_blocks[left.pop(name)]
            moved = coordinates(key) + coordinates(relative) - coordinates(keys.reference_key)
            key.points.foreach_set("co", np.ascontiguousarray(moved, np.float32).ravel())
            key.relative_key = relative
    return list(left)
