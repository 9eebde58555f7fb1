# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks survive edits of the meshes and undo; lost ones are reported."""

from typing import Any

import bpy
import meshes
import numpy as np
import pairing
import pytest
from installed import part
from meshes import MeshObject


@pytest.fixture
def heads() -> tuple[MeshObject, MeshObject]:
    return pairing.heads()


def test_vertices_are_followed_when_others_are_deleted(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.add(20, 30)
    pairing.add(40, 50)
    source, target = heads
    places = [pairing.position(source, 20), pairing.position(target, 50)]
    pairing.in_edit_mode(source, 0, 1, 2, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    pairing.in_edit_mode(target, 0, 1, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    assert pairing.listed() == [("Landmark 1", 17, 28, None), ("Landmark 2", 37, 48, None)]
    assert np.allclose([pairing.position(source, 17), pairing.position(target, 48)], places)
    assert [pair.source_vertex for pair in source.authalic_landmarks] == [17, 37]


def test_a_deleted_vertex_is_told(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.add(20, 30)
    pairing.add(40, 50)
    pairing.in_edit_mode(heads[0], 20, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    assert pairing.listed() == [
        ("Landmark 1", -1, 30, "its vertex on Head A is gone"),
        ("Landmark 2", 39, 50, None),
    ]
    with pytest.raises(RuntimeError, match="Landmark 1: its vertex on Head A is gone"):
        bpy.ops.authalic.landmark_jump(index=0)


def test_a_copied_vertex_is_told(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.add(20, 30)
    pairing.in_edit_mode(heads[0], 20, do=bpy.ops.mesh.duplicate)
    ((_, vertex, goal, problem),) = pairing.listed()
    assert (vertex, goal) == (-1, 30) and problem == "2 vertices of Head A are copies of the chosen one"


def test_subdividing_keeps_the_vertices(heads: tuple[MeshObject, MeshObject]) -> None:
    for k in range(8):
        pairing.add(5 * k, 6 * k)
    source = heads[0]
    before = [pairing.position(source, 5 * k) for k in range(8)]
    pairing.in_edit_mode(source, *range(49), do=lambda: bpy.ops.mesh.subdivide(number_cuts=3))
    assert len(source.data.vertices) > 400
    assert all(problem is None for *_, problem in pairing.listed())
    assert np.allclose([pairing.position(source, pair[1]) for pair in pairing.listed()], before)


def test_edits_are_noticed_before_edit_mode_is_left(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.add(20, 30)
    source, find = heads[0], part("landmarks.points").pairs
    meshes.edit(source)
    assert find(source, drawing=True)[0][1:] == (20, 30, None)
    pairing.select_vertices(source, 0, 1)
    bpy.ops.mesh.delete(type="VERT")
    assert find(source, drawing=True)[0][1:] == (18, 30, None) and pairing.listed()[0][1:] == (18, 30, None)
    pairing.select_vertices(source, 18)
    bpy.ops.mesh.duplicate()
    assert find(source, drawing=True)[0].problem.startswith("2 vertices")


def test_a_copy_of_the_source_has_landmarks_of_its_own(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.add(20, 30)
    meshes.select(heads[0])
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    pairing.in_edit_mode(copy, 0, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    assert pairing.listed(copy) == [("Landmark 1", 19, 30, None)] and pairing.listed() == [
        ("Landmark 1", 20, 30, None)
    ]


def test_undo_and_redo(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.step("start")
    pairing.add(20, 30)
    pairing.step("first")
    pairing.add(21, 31)
    pairing.step("second")
    bpy.ops.ed.undo()
    assert pairing.listed() == [("Landmark 1", 20, 30, None)]
    bpy.ops.ed.undo()
    assert pairing.listed() == []
    bpy.ops.ed.redo()
    bpy.ops.ed.redo()
    assert pairing.listed() == [("Landmark 1", 20, 30, None), ("Landmark 2", 21, 31, None)]
    pairing.in_edit_mode(bpy.data.objects["Head A"], 20, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    pairing.step("deleted")
    assert pairing.listed()[0][1] == -1
    bpy.ops.ed.undo()
    assert pairing.listed()[0] == ("Landmark 1", 20, 30, None)


def both() -> Any:
    return bpy.data.objects["Head A"], bpy.data.objects["Head B"]


def edit_both() -> None:
    pairing.step("objects")
    meshes.edit(*both())
    pairing.step("edit mode")


@pytest.mark.parametrize("with_target", [True, False])
def test_undo_of_adding_in_edit_mode(heads: tuple[MeshObject, MeshObject], with_target: bool) -> None:
    pairing.add(1, 2)
    pairing.step("objects")
    meshes.edit(*(both() if with_target else both()[:1]))
    pairing.step("edit mode")
    pairing.add(20, 30)
    pairing.step("added")
    bpy.ops.ed.undo()
    assert pairing.listed() == [("Landmark 1", 1, 2, None)]
    bpy.ops.ed.redo()
    assert pairing.listed() == [("Landmark 1", 1, 2, None), ("Landmark 2", 20, 30, None)]
    assert bpy.context.mode == "EDIT_MESH"


@pytest.mark.parametrize("with_target", [True, False])
def test_undo_of_removing_in_edit_mode(heads: tuple[MeshObject, MeshObject], with_target: bool) -> None:
    pairing.add(1, 2, name="Nose")
    pairing.add(20, 30)
    pairing.step("objects")
    meshes.edit(*(both() if with_target else both()[:1]))
    pairing.step("edit mode")
    bpy.ops.authalic.landmark_clear()
    pairing.step("cleared")
    bpy.ops.ed.undo()
    assert pairing.listed() == [("Nose", 1, 2, None), ("Landmark 2", 20, 30, None)]
    bpy.ops.ed.redo()
    assert pairing.listed() == []
    bpy.ops.ed.undo()
    assert len(pairing.listed()) == 2


def test_undo_of_deleting_a_vertex_in_edit_mode(heads: tuple[MeshObject, MeshObject]) -> None:
    edit_both()
    pairing.add(20, 30)
    pairing.step("added")
    for obj, vertices in zip(both(), ([20], []), strict=True):
        pairing.select_vertices(obj, *vertices)
    pairing.step("selected")
    bpy.ops.mesh.delete(type="VERT")
    pairing.step("deleted")
    assert pairing.listed()[0][1] == -1
    bpy.ops.ed.undo()
    assert pairing.listed() == [("Landmark 1", 20, 30, None)]
    bpy.ops.ed.redo()
    assert pairing.listed() == [("Landmark 1", -1, 30, "its vertex on Head A is gone")]
    for _ in range(3):
        bpy.ops.ed.undo()
    assert pairing.listed() == []


def test_undo_back_into_edit_mode(heads: tuple[MeshObject, MeshObject]) -> None:
    """Blender then starts from the list as it was when edit mode was entered."""
    pairing.add(1, 2)
    pairing.add(3, 4)
    edit_both()
    pairing.add(20, 30)
    pairing.step("added")
    bpy.ops.authalic.landmark_remove(index=0)
    pairing.step("removed")
    bpy.ops.object.mode_set(mode="OBJECT")
    pairing.step("object mode")
    states = ([(3, 4), (20, 30)], [(3, 4), (20, 30)], [(1, 2), (3, 4), (20, 30)], [(1, 2), (3, 4)])
    for expected in states[1:]:
        bpy.ops.ed.undo()
        assert [pair[1:3] for pair in pairing.listed()] == expected and bpy.context.mode == "EDIT_MESH"
    bpy.ops.ed.undo()
    assert [pair[1:3] for pair in pairing.listed()] == states[-1] and bpy.context.mode == "OBJECT"
    for expected in (states[3], states[2], states[1], states[0]):
        bpy.ops.ed.redo()
        assert [pair[1:3] for pair in pairing.listed()] == expected
    assert bpy.context.mode == "OBJECT" and not any(problem for *_, problem in pairing.listed())
