# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of landmarks for the tests: two objects, and steps with them."""

from collections.abc import Callable
from typing import Any

import bmesh
import bpy
import meshes
import numpy as np
import pytest
from installed import part
from meshes import Array, MeshObject


def heads() -> tuple[MeshObject, MeshObject]:
    """Two grids; the active one has the other as its target."""
    source, target = meshes.add_grid("Head A"), meshes.add_grid("Head B", n=8)
    target.location.x = 3
    source.authalic_target = target
    meshes.select(source, target)
    return source, target


def add(source_vertex: int, target_vertex: int, **options: Any) -> None:
    options.update(source_vertex=source_vertex, target_vertex=target_vertex)
    assert bpy.ops.authalic.landmark_add(**options) == {"FINISHED"}


def listed(obj: MeshObject | None = None) -> list[tuple[Any, ...]]:
    return [tuple(pair) for pair in part("landmarks.points").pairs(obj or bpy.data.objects["Head A"])]


def refused(words: str, call: Callable[..., Any], **options: Any) -> None:
    before = listed()
    with pytest.raises(RuntimeError, match=words):
        call(**options)
    assert listed() == before


def select_vertices(obj: MeshObject, *vertices: int) -> None:
    edit = bmesh.from_edit_mesh(obj.data)
    for number, vertex in enumerate(edit.verts):
        vertex.select_set(number in vertices)
    edit.select_flush_mode()
    bmesh.update_edit_mesh(obj.data)


def position(obj: MeshObject, vertex: int) -> Array:
    return np.array(obj.data.vertices[vertex].co)


def in_edit_mode(obj: MeshObject, *vertices: int, do: Callable[[], Any]) -> None:
    """Applies an operator to some vertices of an object in edit mode."""
    meshes.edit(obj)
    select_vertices(obj, *vertices)
    do()
    bpy.ops.object.mode_set(mode="OBJECT")


def step(message: str) -> None:
    bpy.ops.ed.undo_push(message=message)
