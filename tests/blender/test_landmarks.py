# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of landmarks: added, refused, listed, removed, and their markers."""

import bmesh
import bpy
import drawing
import meshes
import numpy as np
import pairing
import pytest
from installed import part
from meshes import MeshObject


@pytest.fixture
def heads() -> tuple[MeshObject, MeshObject]:
    return pairing.heads()


def test_add_by_numbers(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.add(3, 5)
    pairing.add(7, 9, name="Nose")
    pairing.add(8, 10)
    assert pairing.listed() == [("Landmark 1", 3, 5, None), ("Nose", 7, 9, None), ("Landmark 3", 8, 10, None)]
    stored = heads[0].authalic_landmarks
    assert [(p.name, p.source_vertex, p.target_vertex, p.error) for p in stored][1] == ("Nose", 7, 9, -1)
    assert heads[0].authalic_landmark_index == 2


def test_numbers_are_not_remembered_for_the_next_use(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.add(3, 5, name="Nose")
    pairing.refused("not in Edit Mode", bpy.ops.authalic.landmark_add)


def test_add_the_selected_vertices_in_edit_mode(heads: tuple[MeshObject, MeshObject]) -> None:
    meshes.edit(*heads)
    for vertices in ((4, 60), (5, 61)):
        for obj, vertex in zip(heads, vertices, strict=True):
            pairing.select_vertices(obj, vertex)
        assert bpy.ops.authalic.landmark_add() == {"FINISHED"}
    assert pairing.listed() == [("Landmark 1", 4, 60, None), ("Landmark 2", 5, 61, None)]
    bpy.ops.object.mode_set(mode="OBJECT")
    assert pairing.listed() == [("Landmark 1", 4, 60, None), ("Landmark 2", 5, 61, None)]


def test_the_source_is_known_from_its_target_too(heads: tuple[MeshObject, MeshObject]) -> None:
    """In edit mode of both, whichever became active last."""
    meshes.edit(heads[1], heads[0])
    pairing.select_vertices(heads[0], 4)
    pairing.select_vertices(heads[1], 60)
    bpy.ops.authalic.landmark_add()
    assert pairing.listed() == [("Landmark 1", 4, 60, None)] and not heads[1].authalic_landmarks


@pytest.mark.parametrize("count", [0, 2])
def test_one_vertex_must_be_selected(heads: tuple[MeshObject, MeshObject], count: int) -> None:
    meshes.edit(*heads)
    pairing.select_vertices(heads[0], 1)
    pairing.select_vertices(heads[1], *range(count))
    words = f"exactly one vertex of Head B, not {count or 'none'}"
    pairing.refused(words, bpy.ops.authalic.landmark_add)


@pytest.mark.parametrize("in_edit", [False, True])
def test_refusals(heads: tuple[MeshObject, MeshObject], in_edit: bool) -> None:
    if in_edit:
        meshes.edit(*heads)
    pairing.add(3, 5)
    call = bpy.ops.authalic.landmark_add
    pairing.refused('vertex 3 of Head A is in the pair "Landmark 1"', call, source_vertex=3, target_vertex=6)
    pairing.refused('vertex 5 of Head B is in the pair "Landmark 1"', call, source_vertex=4, target_vertex=5)
    pairing.refused(
        "Head A has no vertex 49; its 49 vertices are 0 to 48", call, source_vertex=49, target_vertex=6
    )
    pairing.refused("Head B has no vertex 81", call, source_vertex=4, target_vertex=81)
    pairing.refused("has no pair 1; its 1", bpy.ops.authalic.landmark_remove, index=1)
    pairing.refused("has no pair 7", bpy.ops.authalic.landmark_jump, index=7)
    heads[0].authalic_target = None
    with pytest.raises(RuntimeError, match="no target object"):
        call(source_vertex=1, target_vertex=1)


def test_there_must_be_landmarks_and_meshes(heads: tuple[MeshObject, MeshObject]) -> None:
    for name in ("remove", "clear", "jump"):
        pairing.refused("no landmarks", getattr(bpy.ops.authalic, f"landmark_{name}"))
    bpy.ops.object.camera_add()
    for name in ("add", "pick", "import"):
        pairing.refused("mesh object", getattr(bpy.ops.authalic, f"landmark_{name}"))


def test_an_object_is_no_target_of_itself(heads: tuple[MeshObject, MeshObject]) -> None:
    source, _ = heads
    source.authalic_target = source  # a script can, the panel does not offer it
    with pytest.raises(RuntimeError, match="Head A cannot be the target"):
        bpy.ops.authalic.landmark_add(source_vertex=1, target_vertex=2)


def test_remove_and_clear(heads: tuple[MeshObject, MeshObject]) -> None:
    for k in range(4):
        pairing.add(k, k + 10)
    bpy.ops.authalic.landmark_remove(index=1)
    assert [pair[1:3] for pair in pairing.listed()] == [(0, 10), (2, 12), (3, 13)]
    bpy.ops.authalic.landmark_remove()
    assert [pair[1:3] for pair in pairing.listed()] == [(0, 10), (2, 12)]
    pairing.add(1, 11)
    assert pairing.listed()[2] == ("Landmark 4", 1, 11, None)
    bpy.ops.authalic.landmark_clear()
    assert pairing.listed() == []
    for obj in heads:
        values = np.empty(len(obj.data.vertices), np.int32)
        obj.data.attributes["authalic_landmark"].data.foreach_get("value", values)
        assert not values.any()


def test_renaming_keeps_the_pair(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.add(3, 5)
    heads[0].authalic_landmarks[0].name = "Nose"
    assert pairing.listed() == [("Nose", 3, 5, None)]


def test_scripts_may_write_the_list_itself(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    source.authalic_target = None
    pair = source.authalic_landmarks.add()
    pair.name, pair.source_vertex, pair.target_vertex = "Nose", 3, 5
    assert (pair.source_vertex, pair.target_vertex) == (3, 5)
    assert "no target" in pairing.listed()[0][3]
    source.authalic_target = target
    assert pairing.listed() == [("Nose", 3, 5, None)]
    pair.source_vertex = 1000
    assert pairing.listed()[0][1] == -1 and "is gone" in pairing.listed()[0][3]
    pair.source_vertex = 4
    second = source.authalic_landmarks.add()
    second.source_vertex, second.target_vertex = 4, 6
    assert pairing.listed()[1][3] == 'has vertex 4 of Head A, as "Nose" has'


def test_another_target_has_not_the_vertices_of_the_first(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    pairing.add(20, 30)
    other = meshes.add_grid("Other")
    other.authalic_target = target
    bpy.ops.authalic.landmark_add(source_vertex=7, target_vertex=30)
    meshes.select(source)
    source.authalic_target = other
    assert pairing.listed() == [("Landmark 1", 20, -1, "its vertex on Other is gone")]
    source.authalic_target = target
    assert pairing.listed() == [("Landmark 1", 20, 30, None)]
    bpy.ops.authalic.landmark_clear()
    assert pairing.listed(other) == [("Landmark 1", 7, 30, None)]


def test_two_objects_aim_at_each_other_and_share_a_mesh() -> None:
    first = meshes.add_grid("Head A")
    second = bpy.data.objects.new("Second", first.data)
    bpy.context.collection.objects.link(second)
    first.authalic_target, second.authalic_target = second, first
    for obj in (first, second):
        meshes.select(obj)
        pairing.add(3, 4)
        pairing.add(4, 3)
    assert (
        pairing.listed(first)
        == pairing.listed(second)
        == [("Landmark 1", 3, 4, None), ("Landmark 2", 4, 3, None)]
    )
    bpy.ops.authalic.landmark_remove(index=0)
    assert pairing.listed(first)[0] == ("Landmark 1", 3, 4, None) and pairing.listed(second)[0][1:3] == (4, 3)


def test_a_deleted_target_is_told(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.add(20, 30)
    bpy.data.objects.remove(heads[1])
    bpy.context.view_layer.update()
    assert pairing.listed() == [("Landmark 1", 20, -1, "there is no target object; choose one")]


def test_a_target_that_left_the_scene_is_told(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.add(20, 30)
    meshes.select(heads[1])
    bpy.ops.object.delete()
    meshes.select(heads[0])
    assert pairing.listed()[0][2] == -1 and pairing.listed()[0][3] is not None
    with pytest.raises(RuntimeError, match="target"):
        bpy.ops.authalic.landmark_add(source_vertex=1, target_vertex=1)


def test_jump_selects_the_vertex(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.add(20, 30)
    pairing.add(21, 31)
    source, target = heads
    bpy.ops.authalic.landmark_jump(index=0, side="TARGET")
    assert source.authalic_landmark_index == 0
    assert [v.index for v in target.data.vertices if v.select] == [30]
    meshes.edit(source)
    bpy.ops.authalic.landmark_jump(index=1)
    edit = bmesh.from_edit_mesh(source.data)
    assert [v.index for v in edit.verts if v.select] == [21]
    assert edit.select_history.active.index == 21 and not any(f.select for f in edit.faces)


def test_markers(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    pairing.add(20, 30)
    pairing.add(21, 31)
    pairing.in_edit_mode(source, 20, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    markers = part("overlay.points")
    expected = [
        ("Head B", 30, "1", "target", False, True),
        ("Head A", 20, "2", "source", True, False),
        ("Head B", 31, "2", "target", True, False),
    ]
    meshes.select(source)
    assert [tuple(marker) for marker in markers.shown(bpy.context)] == expected
    meshes.select(target)
    assert len(markers.shown(bpy.context)) == 3
    meshes.select(meshes.add_grid("Other"))
    assert markers.shown(bpy.context) == []
    meshes.select(source)
    bpy.context.scene.authalic_show_landmarks = False
    assert markers.shown(bpy.context) == []
    markers._draw()  # without a window nothing is drawn


def test_markers_ride_on_what_is_seen(heads: tuple[MeshObject, MeshObject]) -> None:
    source, _ = heads
    source.shape_key_add(name="Basis")
    key = source.shape_key_add(name="Up")
    key.points[20].co.z += 2
    key.value = 0.5
    source.location = (0, 0, 5)
    source.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    flat = pairing.position(source, 20)
    place = part("blender.vertex_positions").in_world
    point, normal = place(source, 20, bpy.context.evaluated_depsgraph_get())
    assert np.allclose(point, 2 * (flat + np.array([0, 0, 1])) + np.array([0, 0, 5]), atol=1e-5)
    assert abs(normal.length - 1) < 1e-5
    modifier = source.modifiers.new("Subdivision", "SUBSURF")
    bpy.context.view_layer.update()
    smooth, _ = place(source, 20, bpy.context.evaluated_depsgraph_get())
    assert 0.01 < (smooth - point).length < 1.5
    modifier.show_viewport = False
    source.modifiers.new("Decimate", "DECIMATE").ratio = 0.3
    bpy.context.view_layer.update()
    point, _ = place(source, 20, bpy.context.evaluated_depsgraph_get())
    assert np.allclose(point, 2 * flat + [0, 0, 5], atol=1e-5)


def test_the_list_shows_the_errors_that_are_known(heads: tuple[MeshObject, MeshObject]) -> None:
    source, _ = heads
    pairing.add(20, 30)
    pairing.add(21, 31)
    pairing.add(22, 32)
    source.authalic_landmarks[0].error = 0.125
    source.authalic_landmarks[2].error = 0.0
    dots = []
    for row in drawing.rows("ui.landmarks", "AUTHALIC_UL_landmarks", source.authalic_landmarks):
        number, (dot, chosen) = row.labels[0], row.operators[0]
        dots.append((number, row.icons[-1], chosen.index, drawing.tooltip(dot, chosen)))
    words = "Select the vertex of a landmark and bring it into view"
    assert dots == [
        (
            *("1", "COLORSET_09_VEC", 0),
            f"{words}.\nVertex 20 of Head A, vertex 30 of Head B.\nMissed by 0.125 % of the target's size",
        ),
        ("2", "DOT", 1, f"{words}.\nVertex 21 of Head A, vertex 31 of Head B"),
        (
            *("3", "COLORSET_03_VEC", 2),
            f"{words}.\nVertex 22 of Head A, vertex 32 of Head B.\nMissed by 0.000 % of the target's size",
        ),
    ]


def test_picking_without_a_window_adds_numbers(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.refused("needs a window", bpy.ops.authalic.landmark_pick)
    bpy.ops.authalic.landmark_pick("INVOKE_DEFAULT", source_vertex=3, target_vertex=4)
    assert pairing.listed() == [("Landmark 1", 3, 4, None)]


def test_everything_has_words() -> None:
    for name in ("add", "pick", "remove", "clear", "jump", "export", "import"):
        operator = getattr(bpy.ops.authalic, f"landmark_{name}").get_rna_type()
        assert operator.description and not operator.description.endswith(".")
        described = [p for p in operator.properties if p.identifier in ("index", "side", "source_vertex")]
        assert all(p.name and p.description and not p.description.endswith(".") for p in described)


def test_unregistering_leaves_nothing(extension: str) -> None:
    names = ("authalic_landmarks", "authalic_target", "authalic_landmark_index")
    assert all(hasattr(bpy.types.Object, name) for name in names)
    bpy.ops.preferences.addon_disable(module=extension)
    assert not any(hasattr(bpy.types.Object, name) for name in names)
    assert not hasattr(bpy.types.Scene, "authalic_show_landmarks")
    bpy.ops.preferences.addon_enable(module=extension)
