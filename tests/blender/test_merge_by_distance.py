# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.merge_by_distance: faces that touch, but are not joined, and the hint that they are."""

from typing import Any

import bmesh
import bpy
import drawing
import meshes
import numpy as np
import pairs
import pytest
from installed import part
from meshes import MeshObject

AUTHALIC = bpy.ops.authalic
KEY = "Morph → Twin"
CORNERS = [(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0), (0, 0, 1)]


def split(obj: MeshObject) -> None:
    """Separates all faces, as in an STL file."""
    edit = bmesh.new()
    edit.from_mesh(obj.data)
    bmesh.ops.split_edges(edit, edges=edit.edges)
    edit.to_mesh(obj.data)
    edit.free()


def balls(apart: str) -> tuple[MeshObject, MeshObject]:
    """A ball and its copy with landmarks, the faces of one of them separated."""
    source = meshes.bumpy(meshes.icosphere(2))
    target = pairs.twin(source)
    split(source if apart == "SOURCE" else target)
    ends = zip(pairs.nearest(source, CORNERS), pairs.nearest(target, CORNERS), strict=True)
    return pairs.pair(source, target, {str(k): both for k, both in enumerate(ends)})


def buttons() -> list[Any]:
    return [text for text in drawing.draw_panel("AUTHALIC_PT_registration_view3d").labels if "Merge" in text]


@pytest.mark.parametrize("side", ["SOURCE", "TARGET"])
def test_unjoined_faces_are_told_and_merged(side: str) -> None:
    source, target = balls(side)
    obj = source if side == "SOURCE" else target
    count, joined = len(obj.data.vertices), len((target if side == "SOURCE" else source).data.vertices)
    assert not buttons()
    with pytest.raises(RuntimeError, match=rf"{obj.name} has {count} vertices that lie on each other"):
        AUTHALIC.register()
    assert source.data.shape_keys is None and buttons()
    assert AUTHALIC.merge_by_distance(side=side) == {"FINISHED"}
    assert len(obj.data.vertices) == joined and not buttons()
    assert [pair.problem for pair in part("landmarks.points").pairs(source)] == [None] * len(CORNERS)
    assert AUTHALIC.register() == {"FINISHED"}
    after = pairs.positions(source, KEY)
    np.testing.assert_allclose(after, pairs.positions(source), atol=1e-4)


def test_a_slit_in_a_closed_mesh_is_told() -> None:
    """It is no hole to be filled."""
    source = meshes.seam_sphere()
    source.name = "Ball"
    target = pairs.twin(source)
    edit = bmesh.new()
    edit.from_mesh(source.data)
    bmesh.ops.split_edges(edit, edges=[edge for edge in edit.edges if edge.seam])
    edit.to_mesh(source.data)
    edit.free()
    ends = zip(pairs.nearest(source, CORNERS), pairs.nearest(target, CORNERS), strict=True)
    pairs.pair(source, target, {str(k): both for k, both in enumerate(ends)})
    with pytest.raises(RuntimeError, match="Ball has 22 vertices that lie on each other, but are not joined"):
        AUTHALIC.register()
    assert AUTHALIC.merge_by_distance() == {"FINISHED"} and AUTHALIC.register() == {"FINISHED"}


def test_another_file_has_no_button() -> None:
    balls("SOURCE")
    with pytest.raises(RuntimeError, match="lie on each other"):
        AUTHALIC.register()
    assert buttons()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    meshes.icosphere(1)
    assert bpy.context.object.name == "Icosphere" and not buttons()


def test_uvs_and_shape_keys_stay_and_undo_works() -> None:
    source, _ = balls("SOURCE")
    uv = np.random.default_rng(1).random((len(source.data.loops), 2)).astype(np.float32)
    source.data.uv_layers.new(name="UVMap")
    meshes.set_uv(source, uv)
    source.shape_key_add(name="Basis")
    smile = source.shape_key_add(name="Smile", from_mix=False)
    smile.points.foreach_set("co", (2 * pairs.positions(source)).astype(np.float32).ravel())
    count = len(source.data.vertices)
    bpy.ops.ed.undo_push(message="Start")
    AUTHALIC.merge_by_distance()
    assert (meshes.uv(source) == uv).all()
    np.testing.assert_allclose(pairs.positions(source, "Smile"), 2 * pairs.positions(source), atol=1e-6)
    bpy.ops.ed.undo_push(message="Merge")
    bpy.ops.ed.undo()
    source = bpy.data.objects["Icosphere"]
    assert len(source.data.vertices) == count and (meshes.uv(source) == uv).all()


def test_nothing_to_merge() -> None:
    source, _ = balls("TARGET")
    with pytest.raises(RuntimeError, match="Icosphere has no vertices of open edges that lie on each other"):
        AUTHALIC.merge_by_distance(side="SOURCE")
    source.authalic_target = None
    with pytest.raises(RuntimeError, match="there is no target object"):
        AUTHALIC.merge_by_distance(side="TARGET")


def test_surfaces_that_touch_without_open_edges_stay_apart() -> None:
    ball = meshes.icosphere(1)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=1)
    meshes.join(ball, bpy.context.object)
    count = len(ball.data.vertices)
    with pytest.raises(RuntimeError, match="no vertices of open edges"):
        AUTHALIC.merge_by_distance()
    assert len(ball.data.vertices) == count


def test_points_that_lie_on_each_other() -> None:
    rng = np.random.default_rng(0)
    points = rng.random((500, 3))
    copies = points[::2] + rng.uniform(-1, 1, (250, 3)) * 1e-6
    first = part("surfaces.coincident").stands_for(np.concatenate([points, copies]), 2e-6)
    assert (first[:500] == np.arange(500)).all() and (first[500:] == np.arange(0, 500, 2)).all()
    chain = np.stack([np.arange(50) * 0.9, np.zeros(50), np.zeros(50)], axis=1)
    assert (part("surfaces.coincident").stands_for(chain, 1.0) == 0).all()
    assert part("surfaces.coincident").count(np.zeros((0, 3))) == 0
