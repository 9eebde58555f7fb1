# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.select_reported: the faces of the islands that the last report named."""

from typing import Any

import bmesh
import bpy
import meshes
import numpy as np
import pytest
from installed import part
from meshes import MeshObject


def strip(name: str = "Strip") -> MeshObject:
    """A patch of four quads, then a strip of 200 that no circle suits, in one mesh."""
    x = np.arange(201.0)
    long = np.stack([np.repeat(x, 2), np.tile([0.0, 1.0], 201), np.zeros(402)], axis=1)
    first = 2 * np.arange(200)
    faces = np.stack([first, first + 2, first + 3, first + 1], axis=1)
    vertices, quads = meshes.grid(n=2, bump=0.0, offset=(0, 5, 0))
    return meshes.add([*vertices, *long], [*quads, *(faces + len(vertices))], name)


def torus() -> MeshObject:
    bpy.ops.mesh.primitive_torus_add(major_segments=12, minor_segments=6)
    torus: Any = bpy.context.object
    return torus


def selected(obj: MeshObject) -> list[int]:
    if obj.data.is_editmode:
        return [face.index for face in bmesh.from_edit_mesh(obj.data).faces if face.select]
    return [face.index for face in obj.data.polygons if face.select]


def select(**options: Any) -> set[str]:
    return bpy.ops.authalic.select_reported(**options)


def test_the_worst_island_and_all() -> None:
    handle, bad, good = torus(), strip(), meshes.add_grid("Good", offset=(0, 0, 9))
    meshes.select(good, bad, handle)
    assert bpy.ops.authalic.unwrap(angle_preset="CIRCLE", domain="DISK") == {"FINISHED"}
    assert select(which="WORST") == {"FINISHED"}
    assert bpy.context.mode == "EDIT_MESH" and bpy.context.objects_in_mode == [bad]
    assert tuple(bpy.context.tool_settings.mesh_select_mode) == (False, False, True)
    assert selected(bad) == list(range(4, 204))
    assert select(which="ALL") == {"FINISHED"}
    assert {obj.name for obj in bpy.context.objects_in_mode} == {bad.name, handle.name}
    # A circle is not good for the four quads either, but better than for the strip.
    assert selected(bad) == list(range(204)) and len(selected(handle)) == 72


def test_what_was_refused_alone() -> None:
    handle = torus()
    with pytest.raises(RuntimeError, match="handle"):
        bpy.ops.authalic.unwrap()
    handle.data.polygons[3].hide = True
    select()
    assert len(selected(handle)) == 72, "hidden faces are shown"


def test_the_next_report_counts() -> None:
    bad = strip()
    bpy.ops.authalic.unwrap(angle_preset="CIRCLE")
    assert bpy.ops.authalic.select_reported.poll()
    bpy.ops.authalic.unwrap()
    assert not bpy.ops.authalic.select_reported.poll()
    with pytest.raises(RuntimeError, match="The last report named no islands"):
        select()
    assert bad.data.uv_layers


def test_meshes_that_have_changed_are_named_and_stay() -> None:
    bad = strip()
    bpy.ops.authalic.unwrap(angle_preset="CIRCLE")
    meshes.edit(bad)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.delete(type="VERT")
    bpy.ops.object.mode_set(mode="OBJECT")
    with pytest.raises(RuntimeError, match="Strip has changed since the report"):
        select()
    assert bpy.context.mode == "OBJECT"
    bpy.data.objects.remove(bad)
    assert not bpy.ops.authalic.select_reported.poll()


def test_another_file_forgets_the_report() -> None:
    strip()
    bpy.ops.authalic.unwrap(angle_preset="CIRCLE")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    strip()
    assert not bpy.ops.authalic.select_reported.poll()
    assert part("jobs.reported").last() == []
