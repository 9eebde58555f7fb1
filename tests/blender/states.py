# SPDX-License-Identifier: GPL-3.0-or-later
"""The data of all meshes of a file, to compare them before and after."""

from dataclasses import dataclass, field
from typing import Any

import bmesh
import bpy
import numpy as np
from meshes import Array


@dataclass
class MeshState:
    """The data of one mesh, as arrays."""

    vertices: Array
    corners: Array
    """The vertex of each corner."""
    sizes: Array
    """The number of corners of each face."""
    chosen: Array
    """Whether each face is selected and not hidden."""
    seams: Array
    uv: dict[str, Array] = field(default_factory=dict)
    active_uv: str = ""
    keys: dict[str, Array] = field(default_factory=dict)


State = dict[str, MeshState]
"""By the full names of the meshes of the scene."""


def read() -> State:
    """The present state; edit mode included."""
    objects = [obj for obj in bpy.context.scene.objects if obj.type == "MESH"]
    for obj in objects:
        if obj.mode == "EDIT":
            obj.update_from_editmode()
    meshes = {obj.data.name_full: obj.data for obj in objects}
    return {name: _read(mesh) for name, mesh in meshes.items()}


def difference(before: State, after: State) -> str:
    """What differs in two states, apart from the selection; empty if nothing does."""
    if before.keys() != after.keys():
        return f"meshes {sorted(before)} became {sorted(after)}"
    changes = [(name, change) for name in before for change in changed(before[name], after[name])]
    return ", ".join(f"{name}: {change}" for name, change in changes)


def changed(before: MeshState, after: MeshState) -> list[str]:
    """The names of the data of a mesh that differ, apart from the selection."""
    plain = ("vertices", "corners", "sizes", "seams")
    names = [name for name in plain if not _same(getattr(before, name), getattr(after, name))]
    for kind in ("uv", "keys"):
        old, new = getattr(before, kind), getattr(after, kind)
        names += [f"{kind} {name}" for name in old.keys() ^ new.keys()]
        names += [f"{kind} {name}" for name in old.keys() & new.keys() if not _same(old[name], new[name])]
    return names if before.active_uv == after.active_uv else [*names, "active UV map"]


def _same(first: Array, second: Array) -> bool:
    return first.shape == second.shape and first.tobytes() == second.tobytes()


def _read(mesh: Any) -> MeshState:
    state = MeshState(
        vertices=_get(mesh.vertices, "co", np.float32, 3),
        corners=_get(mesh.loops, "vertex_index", np.int32),
        sizes=_get(mesh.polygons, "loop_total", np.int32),
        chosen=_get(mesh.polygons, "select", bool) & ~_get(mesh.polygons, "hide", bool),
        seams=_get(mesh.edges, "use_seam", bool),
    )
    state.uv = _uv_while_edited(mesh) if mesh.is_editmode else _uv(mesh)
    state.active_uv = mesh.uv_layers.active.name if mesh.uv_layers.active else ""
    if mesh.shape_keys:
        state.keys = {key.name: _get(key.data, "co", np.float32, 3) for key in mesh.shape_keys.key_blocks}
    return state


def _uv(mesh: Any) -> dict[str, Array]:
    attributes = {layer.name: mesh.attributes[layer.name] for layer in mesh.uv_layers}
    return {name: _get(layer.data, "vector", np.float32, 2) for name, layer in attributes.items()}


def _uv_while_edited(mesh: Any) -> dict[str, Array]:
    edited = bmesh.from_edit_mesh(mesh)
    loops = [loop for face in edited.faces for loop in face.loops]
    values = {layer.name: [loop[layer].uv[:] for loop in loops] for layer in edited.loops.layers.uv.values()}
    return {name: np.array(uv, np.float32).reshape(-1, 2) for name, uv in values.items()}


def _get(items: Any, name: str, kind: Any, width: int = 1) -> Array:
    values = np.empty(len(items) * width, kind)
    items.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values
