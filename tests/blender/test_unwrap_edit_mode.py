# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.unwrap in edit mode: the selected faces, of all objects being edited, and nothing else."""

from collections.abc import Collection

import bmesh
import bpy
import meshes
import numpy as np
import pytest
from meshes import Array, MeshObject


def corner_mask(obj: MeshObject, polygons: Collection[int]) -> Array:
    return np.repeat(np.isin(np.arange(len(obj.data.polygons)), list(polygons)), 4)


def test_only_selected_faces_change() -> None:
    obj = meshes.add_grid()
    obj.data.uv_layers.new(name="UVMap")
    before, chosen = meshes.uv(obj), set(range(12))
    mask = corner_mask(obj, chosen)
    meshes.edit(obj)
    meshes.select_faces(obj, chosen.__contains__)
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}
    assert bpy.context.mode == "EDIT_MESH"
    selected = {face.index for face in bmesh.from_edit_mesh(obj.data).faces if face.select}
    assert selected == chosen
    after = meshes.uv(obj)
    assert (after[~mask] == before[~mask]).all() and (after[mask] != before[mask]).any(axis=1).all()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert (meshes.uv(obj) == after).all()
    corners, polygons, points = meshes.triangles(obj)
    is_chosen = np.isin(polygons, list(chosen))
    ratio = meshes.uv_areas(after[corners[is_chosen]]) / meshes.surface_areas(points[is_chosen])
    assert ratio.min() > 0 and ratio.std() / ratio.mean() < 0.1
    # The selection alone fills the square.
    assert np.ptp(after[mask], axis=0).max() > 0.9


def test_hidden_faces_are_not_touched() -> None:
    obj = meshes.add_grid()
    obj.data.uv_layers.new(name="UVMap")
    before, hidden = meshes.uv(obj), {0, 1, 2, 6, 7, 8}
    mask = corner_mask(obj, hidden)
    meshes.edit(obj)
    meshes.select_faces(obj, lambda index: True, hidden)
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}
    after = meshes.uv(obj)
    assert (after[mask] == before[mask]).all() and (after[~mask] != before[~mask]).any(axis=1).all()
    assert {face.index for face in bmesh.from_edit_mesh(obj.data).faces if face.hide} == hidden


def test_several_objects_in_edit_mode() -> None:
    first, second = meshes.add_grid("First"), meshes.add_grid("Second", n=4)
    third = meshes.add_grid("Third")
    meshes.edit(first, second)
    third.select_set(True)
    for obj in (first, second):
        meshes.select_faces(obj, lambda index: True)
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}
    assert first.mode == second.mode == "EDIT" and third.mode == "OBJECT"
    assert bpy.context.view_layer.objects.active == first and third.select_get()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert not third.data.uv_layers
    density = meshes.densities(first, second)
    assert np.ptp(density) < 1e-4 * density.max()


def test_nothing_selected(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.add_grid()
    meshes.edit(obj)
    meshes.select_faces(obj, lambda index: False)
    assert bpy.ops.authalic.unwrap(uv_layer="New") == {"CANCELLED"}
    assert "No faces are selected" in capfd.readouterr().out
    assert len(obj.data.uv_layers) == 0


def test_new_layer_keeps_the_other_faces() -> None:
    obj = meshes.add_grid()
    obj.data.uv_layers.new(name="Old")
    old, mask = meshes.uv(obj), corner_mask(obj, range(12))
    meshes.edit(obj)
    meshes.select_faces(obj, lambda index: index < 12)
    assert bpy.ops.authalic.unwrap(uv_layer="New") == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert obj.data.uv_layers.active.name == "New"
    assert (meshes.uv(obj, "Old") == old).all()
    assert (meshes.uv(obj, "New")[~mask] == old[~mask]).all()
    assert (meshes.uv(obj, "New")[mask] != old[mask]).any(axis=1).all()


def test_same_as_in_object_mode() -> None:
    obj = meshes.seam_sphere()
    bpy.ops.authalic.unwrap(uv_layer="A")
    meshes.edit(obj)
    meshes.select_faces(obj, lambda index: True)
    bpy.ops.authalic.unwrap(uv_layer="B")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert (meshes.uv(obj, "A") == meshes.uv(obj, "B")).all()


def test_shape_keys_in_edit_mode() -> None:
    obj = meshes.add_grid()
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Key")
    key.data[3].co.z = 5
    points = [[tuple(point.co) for point in block.data] for block in obj.data.shape_keys.key_blocks]
    meshes.edit(obj)
    meshes.select_faces(obj, lambda index: True)
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert points == [[tuple(point.co) for point in block.data] for block in obj.data.shape_keys.key_blocks]


def test_other_modes_say_what_is_missing() -> None:
    meshes.add_grid()
    bpy.ops.object.mode_set(mode="SCULPT")
    assert not bpy.ops.authalic.unwrap.poll() and not bpy.ops.authalic.measure.poll()
    bpy.ops.object.mode_set(mode="OBJECT")
