# SPDX-License-Identifier: GPL-3.0-or-later
"""The UV maps of meshes, in object mode and, without leaving it, in edit mode."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bmesh
import bpy
import numpy as np

from ..surfaces.arrays import Integers, Singles
from .types import MeshObject

MAX_UV_LAYERS = 8
_NAME_BYTES = 63


def active(obj: MeshObject) -> str | None:
    """The name of the active UV map of an object's mesh, or None."""
    layer = obj.data.uv_layers.active
    return layer.name if layer else None


def has(obj: MeshObject, layer: str) -> bool:
    """Whether an object's mesh has a UV map of a name."""
    return layer in obj.data.uv_layers


def names(obj: MeshObject) -> list[str]:
    """The names of the UV maps of an object's mesh."""
    return [layer.name for layer in obj.data.uv_layers]


@contextmanager
def active_stays(mesh: bpy.types.Mesh, first: str) -> Iterator[None]:
    """Keeps the active UV map active while another is written; if there is none, `first` becomes active."""
    before = mesh.uv_layers.active.name if mesh.uv_layers.active else first
    yield
    if before in mesh.uv_layers:
        mesh.uv_layers.active = mesh.uv_layers[before]


def read(mesh: bpy.types.Mesh, layer: str) -> Singles:
    """The UVs (c, 2) of a layer of a mesh that is not in edit mode, float32."""
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers[layer].uv.foreach_get("vector", uv)
    return uv.reshape(-1, 2)


def write(mesh: bpy.types.Mesh, layer: str, corners: Integers, uv: Singles) -> None:
    """Writes UVs (k, 2) at the mesh corners (k,) of a layer; all other corners keep theirs, bit for bit."""
    if mesh.is_editmode:
        _write_edited(mesh, layer, corners, uv)
        return
    values = read(mesh, layer)
    values[corners] = uv
    # Not `uv_layers[layer].uv`: in Blender 4.2 that writes into the array which the undo step shares.
    attribute: Any = mesh.attributes[layer]
    attribute.data.foreach_set("vector", values.ravel())
    mesh.update()


def name_of(mesh: bpy.types.Mesh, wanted: str) -> str:
    """The name that the UV map `wanted` has or will have. Empty means the active one, or else "UVMap"."""
    if wanted:
        return wanted.encode()[:_NAME_BYTES].decode(errors="ignore")
    return mesh.uv_layers.active.name if mesh.uv_layers.active else "UVMap"


def is_taken(obj: MeshObject, layer: str) -> bool:
    """Whether something else has the name, so that Blender would add the UV layer under another one."""
    mesh = obj.data
    return layer not in mesh.uv_layers and (layer in mesh.attributes or layer in obj.vertex_groups)


def has_room_for(mesh: bpy.types.Mesh, layer: str) -> bool:
    """Whether the UV layer is there or can be added."""
    return layer in mesh.uv_layers or len(mesh.uv_layers) < MAX_UV_LAYERS


def ensure(mesh: bpy.types.Mesh, layer: str) -> str:
    """Makes a UV layer the active one, adding it if need be; returns its name.

    A layer that is added is a copy of the active one. Without one all its UVs are (0, 0): Blender's default,
    every face over the whole square, would lie over whatever is written.
    """
    if layer not in mesh.uv_layers:
        layer = _add_edited(mesh, layer) if mesh.is_editmode else _add(mesh, layer)
    mesh.uv_layers.active = mesh.uv_layers[layer]
    return layer


def _write_edited(mesh: bpy.types.Mesh, layer: str, corners: Integers, uv: Singles) -> None:
    edit = bmesh.from_edit_mesh(mesh)
    uv_layer = edit.loops.layers.uv[layer]
    values = dict(zip(corners.tolist(), uv.tolist(), strict=True))
    start = 0
    for face in edit.faces:
        for corner, loop in enumerate(face.loops, start):
            if corner in values:
                loop[uv_layer].uv = values[corner]
        start += len(face.loops)
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def _add(mesh: bpy.types.Mesh, name: str) -> str:
    return str(mesh.uv_layers.new(name=name, do_init=bool(mesh.uv_layers)).name)


def _add_edited(mesh: bpy.types.Mesh, name: str) -> str:
    edit = bmesh.from_edit_mesh(mesh)
    old = mesh.uv_layers.active.name if mesh.uv_layers.active else None
    new = edit.loops.layers.uv.new(name)
    if old is not None:
        source = edit.loops.layers.uv[old]
        for face in edit.faces:
            for loop in face.loops:
                loop[new].uv = loop[source].uv
    return str(new.name)
