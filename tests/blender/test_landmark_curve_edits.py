# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmark curves survive edits of the meshes, undo, saving and files; breaks are reported."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import bpy
import curving
import meshes
import numpy as np
import pairing
import pytest
from curving import LOOP, LOOP_B, OTHER, OTHER_B, ROW, ROW_B
from installed import part
from meshes import MeshObject

call = bpy.ops.authalic


@pytest.fixture
def heads() -> tuple[MeshObject, MeshObject]:
    return pairing.heads()


def edited(obj: MeshObject, *vertices: int, do: Callable[[], Any]) -> None:
    pairing.in_edit_mode(obj, *vertices, do=do)


def delete() -> Any:
    return bpy.ops.mesh.delete(type="VERT")


def places(obj: MeshObject, path: Sequence[int]) -> Any:
    return np.array([obj.data.vertices[vertex].co for vertex in path])


def test_paths_are_followed_when_vertices_are_deleted(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    curving.add(ROW, ROW_B)
    curving.add(LOOP, LOOP_B)
    before = places(source, LOOP), places(target, ROW_B)
    edited(source, 0, 1, 2, do=delete)
    edited(target, 80, 79, 0, do=delete)
    (_, row, row_b, problem), (_, loop, loop_b, loop_problem) = curving.listed()
    assert (row, row_b) == (tuple(v - 3 for v in ROW), tuple(v - 1 for v in ROW_B)) and problem is None
    assert loop == tuple(v - 3 for v in LOOP) and len(loop_b) == 9 and loop_problem is None
    np.testing.assert_allclose(places(source, loop), before[0])
    np.testing.assert_allclose(places(target, row_b), before[1])


@pytest.mark.parametrize("cuts", [1, 3])
def test_subdividing_divides_paths(heads: tuple[MeshObject, MeshObject], cuts: int) -> None:
    source, _ = heads
    curving.add(ROW[::-1], ROW_B)
    curving.add(LOOP, LOOP_B)
    edited(source, *range(49), do=lambda: bpy.ops.mesh.subdivide(number_cuts=cuts))
    (_, row, _, problem), (_, loop, _, loop_problem) = curving.listed()
    assert problem is None and loop_problem is None
    assert row[:: cuts + 1] == ROW[::-1] and len(row) == 3 * (cuts + 1) + 1
    assert set(loop[:: cuts + 1]) == set(LOOP) and len(loop) == 8 * (cuts + 1) + 1 and loop[0] == LOOP[0]


def test_an_applied_subdivision_surface_divides_paths(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(ROW, ROW_B)
    meshes.select(heads[0])
    meshes.subdivided(heads[0], 2)
    (_, row, _, problem) = curving.listed()[0]
    assert problem is None and row[::4] == ROW


@pytest.mark.parametrize(
    ("vertex", "problem"),
    [
        (11, "has edges that make up 2 pieces on Head B"),
        (10, "has lost its start on Head B"),
        (15, "has lost its end on Head B"),
    ],
)
def test_a_broken_path_is_told_and_can_be_set_again(
    heads: tuple[MeshObject, MeshObject], vertex: int, problem: str
) -> None:
    path = (10, 11, 12, 13, 14, 15) if vertex != 11 else (9, 10, 11, 12, 13)
    source, target = heads
    curving.add(ROW, path)
    edited(target, vertex, do=delete)
    assert curving.listed() == [("Curve 1", ROW, (), problem)]
    meshes.select(source)
    call.landmark_curve_select(side="TARGET")
    left = curving.selected_edges(target)
    assert len(left) == (2 if vertex == 11 else 4)
    curving.refused("Curve 1: has", call.landmark_curve_reverse)
    if vertex == 11:
        return
    meshes.edit(source, target)
    curving.select_path(source)
    bpy.ops.object.mode_set(mode="OBJECT")
    meshes.edit(source, target)
    assert curving.selected_edges(target) == left
    call.landmark_curve_add()
    (name, row, partner, fine) = curving.listed()[0]
    assert (name, row, fine) == ("Curve 1", ROW, None) and len(partner) == 5
    assert len(curving.listed()) == 1


def test_a_path_without_both_ends_is_told(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add((7, 8, 9, 10, 11, 12), ROW_B)
    edited(heads[0], 7, 12, do=delete)
    assert curving.listed()[0][3] == "has lost its start and its end on Head A"


def test_a_deleted_path_is_told(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(ROW, ROW_B)
    edited(heads[0], *ROW, do=delete)
    assert curving.listed() == [("Curve 1", (), ROW_B, "has no edges on Head A")]


def test_a_copied_path_is_told(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(ROW, ROW_B)
    edited(heads[0], *ROW, do=bpy.ops.mesh.duplicate)
    assert curving.listed()[0][3] == "has edges that make up 2 pieces on Head A"


def test_merging_can_make_curves_meet(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add((8, 9, 10), ROW_B)
    curving.add((12, 11, 18), OTHER_B)
    edited(heads[0], 10, 11, do=lambda: bpy.ops.mesh.merge(type="CENTER"))
    assert any(problem is not None for *_, problem in curving.listed())


def test_edits_are_noticed_while_drawing(heads: tuple[MeshObject, MeshObject]) -> None:
    source, _ = heads
    curving.add(ROW, ROW_B)
    find = part("landmarks.curves").pairs
    meshes.edit(source)
    assert find(source, drawing=True)[0].source.vertices == ROW
    pairing.select_vertices(source, 0, 1)
    delete()
    assert find(source, drawing=True)[0].source.vertices == tuple(v - 2 for v in ROW)
    call.landmark_curve_reverse(side="SOURCE")
    assert find(source, drawing=True)[0].source.vertices == tuple(v - 2 for v in ROW[::-1])


def test_drawing_does_not_search_again(
    heads: tuple[MeshObject, MeshObject], monkeypatch: pytest.MonkeyPatch
) -> None:
    source, _ = heads
    curving.add(ROW)  # nothing on the target
    module, find = part("landmarks.curve_marks"), part("landmarks.curves").pairs
    find(source, drawing=True)
    monkeypatch.setattr(module, "_search", None)
    assert find(source, drawing=True)[0].source.vertices == ROW


def test_undo_and_redo(heads: tuple[MeshObject, MeshObject]) -> None:
    pairing.step("start")
    curving.add(ROW, ROW_B)
    pairing.step("first")
    curving.add(LOOP, LOOP_B)
    pairing.step("second")
    call.landmark_curve_reverse(index=0)
    pairing.step("reversed")
    first, second = ("Curve 1", ROW, ROW_B, None), ("Curve 2", LOOP, LOOP_B, None)
    bpy.ops.ed.undo()
    assert curving.listed() == [first, second]
    bpy.ops.ed.undo()
    assert curving.listed() == [first]
    bpy.ops.ed.undo()
    assert curving.listed() == []
    for _ in range(3):
        bpy.ops.ed.redo()
    assert curving.listed() == [("Curve 1", ROW, ROW_B[::-1], None), second]


def both() -> Any:
    return bpy.data.objects["Head A"], bpy.data.objects["Head B"]


def edit(with_target: bool = True) -> None:
    pairing.step("objects")
    meshes.edit(*(both() if with_target else both()[:1]))
    pairing.step("edit mode")


@pytest.mark.parametrize("with_target", [True, False])
def test_undo_of_adding_in_edit_mode(heads: tuple[MeshObject, MeshObject], with_target: bool) -> None:
    edit(with_target)
    curving.add(ROW)
    pairing.step("source")
    curving.add(target=ROW_B, index=0)
    pairing.step("target")
    states = [[], [("Curve 1", ROW, (), "has no edges on Head B")], [("Curve 1", ROW, ROW_B, None)]]
    bpy.ops.ed.undo()
    if with_target:  # else the target is not a part of the step, as Blender has it
        assert curving.listed() == states[1]
    bpy.ops.ed.undo()
    if with_target:
        assert curving.listed() == states[0]
    bpy.ops.ed.redo()
    bpy.ops.ed.redo()
    assert curving.listed() == states[2] and bpy.context.mode == "EDIT_MESH"


@pytest.mark.parametrize("with_target", [True, False])
def test_undo_of_removing_in_edit_mode(heads: tuple[MeshObject, MeshObject], with_target: bool) -> None:
    curving.add(ROW, ROW_B, name="Brow")
    curving.add(LOOP, LOOP_B)
    expected = [("Brow", ROW, ROW_B, None), ("Curve 2", LOOP, LOOP_B, None)]
    edit(with_target)
    call.landmark_curve_remove(index=0)
    pairing.step("removed")
    call.landmark_curve_clear()
    pairing.step("cleared")
    bpy.ops.ed.undo()
    assert curving.listed() == expected[1:]
    bpy.ops.ed.undo()
    assert curving.listed() == expected
    bpy.ops.ed.redo()
    bpy.ops.ed.redo()
    assert curving.listed() == []
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    assert curving.listed() == expected


def test_undo_of_reversing_and_replacing_in_edit_mode(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(ROW, ROW_B)
    edit()
    call.landmark_curve_reverse(side="SOURCE")
    pairing.step("reversed")
    curving.add(OTHER, index=0)
    pairing.step("replaced")
    assert curving.listed()[0][1] == OTHER
    bpy.ops.ed.undo()
    assert curving.listed()[0][1] == ROW[::-1]
    bpy.ops.ed.undo()
    assert curving.listed() == [("Curve 1", ROW, ROW_B, None)]
    bpy.ops.ed.redo()
    assert curving.listed()[0][1] == ROW[::-1]


def test_undo_of_deleting_in_edit_mode(heads: tuple[MeshObject, MeshObject]) -> None:
    edit()
    curving.add(ROW, ROW_B)
    pairing.step("added")
    for obj, vertices in zip(both(), (ROW[1:2], []), strict=True):
        pairing.select_vertices(obj, *vertices)
    pairing.step("selected")
    delete()
    pairing.step("deleted")
    assert curving.listed()[0][3] is not None
    bpy.ops.ed.undo()
    assert curving.listed() == [("Curve 1", ROW, ROW_B, None)]
    bpy.ops.ed.redo()
    assert len(curving.listed()) == 1 and curving.listed()[0][3] is not None
    for _ in range(3):
        bpy.ops.ed.undo()
    assert curving.listed() == []


def test_undo_back_into_edit_mode(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(ROW, ROW_B)
    edit()
    curving.add(OTHER, OTHER_B)
    pairing.step("added")
    call.landmark_curve_remove(index=0)
    pairing.step("removed")
    bpy.ops.object.mode_set(mode="OBJECT")
    pairing.step("object mode")
    first, second = ("Curve 1", ROW, ROW_B, None), ("Curve 2", OTHER, OTHER_B, None)
    for expected in ([second], [first, second], [first]):
        bpy.ops.ed.undo()
        assert curving.listed() == expected and bpy.context.mode == "EDIT_MESH"
    bpy.ops.ed.undo()
    assert curving.listed() == [first] and bpy.context.mode == "OBJECT"
    for expected in ([first], [first, second], [second], [second]):
        bpy.ops.ed.redo()
        assert curving.listed() == expected
    assert bpy.context.mode == "OBJECT"


def test_the_first_curve_made_in_edit_mode_survives_undo_back_into_it(
    heads: tuple[MeshObject, MeshObject],
) -> None:
    edit()
    curving.add(ROW, ROW_B)
    pairing.step("added")
    bpy.ops.object.mode_set(mode="OBJECT")
    pairing.step("object mode")
    bpy.ops.ed.undo()
    assert curving.listed() == [("Curve 1", ROW, ROW_B, None)]


def test_saved_with_the_file(heads: tuple[MeshObject, MeshObject], tmp_path: Path) -> None:
    curving.add(ROW, ROW_B[::-1], name="Brow")
    curving.add(LOOP, LOOP_B)
    path = str(tmp_path / "heads.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert curving.listed() == [("Brow", ROW, ROW_B[::-1], None), ("Curve 2", LOOP, LOOP_B, None)]


def test_export_and_import(heads: tuple[MeshObject, MeshObject], tmp_path: Path) -> None:
    curving.add(ROW, ROW_B, name="Brow [1,2]")
    curving.add(LOOP, LOOP_B)
    curving.add((36, 37, 38))  # not whole
    pairing.add(40, 50)
    path = tmp_path / "pairs.json"
    call.landmark_export(filepath=str(path))
    text = path.read_text(encoding="utf-8")
    assert json.loads(text)["curves"] == [
        {"name": "Brow [1,2]", "source": list(ROW), "target": list(ROW_B)},
        {"name": "Curve 2", "source": list(LOOP), "target": list(LOOP_B)},
    ]
    assert '"source": [8, 9, 10, 11],' in text
    call.landmark_curve_clear()
    call.landmark_clear()
    heads[0].authalic_target = None
    call.landmark_import(filepath=str(path))
    expected = [("Brow [1,2]", ROW, ROW_B, None), ("Curve 2", LOOP, LOOP_B, None)]
    assert curving.listed() == expected and pairing.listed() == [("Landmark 1", 40, 50, None)]
    call.landmark_import(filepath=str(path))
    assert curving.listed() == expected


@pytest.mark.parametrize("in_edit", [False, True])
def test_import_on_a_copy_of_the_source(
    heads: tuple[MeshObject, MeshObject], tmp_path: Path, in_edit: bool
) -> None:
    source, target = heads
    curving.add(ROW, ROW_B)
    pairing.add(40, 50)
    path = str(tmp_path / "landmarks.json")
    call.landmark_export(filepath=path)
    before = curving.listed()
    meshes.select(source)
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    if in_edit:
        meshes.edit(copy, target)
        with pytest.raises(RuntimeError, match=r'landmarks.json: .* of the curve "Curve 1" of Head A too'):
            call.landmark_import(filepath=path)
    else:
        assert call.landmark_import(filepath=path) == {"FINISHED"}
        call.landmark_curve_reverse()
        assert curving.listed(copy) == [("Curve 1", ROW, ROW_B[::-1], None)]
        call.landmark_curve_reverse()
    assert curving.listed(copy) == before and curving.listed(source) == before
    assert len(pairing.listed(copy)) == 1


def test_a_file_without_curves_leaves_them_alone(
    heads: tuple[MeshObject, MeshObject], tmp_path: Path
) -> None:
    curving.add(ROW, ROW_B)
    path = tmp_path / "pairs.json"
    content = {"format": "authalic-landmarks", "version": 1, "pairs": [{"source": 1, "target": 2}]}
    path.write_text(json.dumps(content))
    call.landmark_import(filepath=str(path))
    assert len(curving.listed()) == 1
    path.write_text(json.dumps(content | {"curves": []}))
    call.landmark_import(filepath=str(path))
    assert curving.listed() == []


@pytest.mark.parametrize(
    ("curves", "words"),
    [
        (7, '"curves" is not a list'),
        ([7], "curve 1 is 7"),
        ([{"source": [1, 2, 3]}], 'curve 1 has no "target"'),
        ([{"source": [1, 2, "x"], "target": [1, 2, 3]}], 'the source of curve 1 has "x"'),
        ([{"source": [1, 2, None], "target": [1, 2, 3]}], "the source of curve 1 has null"),
        ([{"source": 3, "target": [1, 2, 3]}], "the source of curve 1 is 3, not a list"),
        ([{"source": [], "target": [1, 2, 3]}], "a curve has no vertices on Head A"),
        ([{"source": [1, 2, 99], "target": [1, 2, 3]}], "Head A has no vertex 99"),
        ([{"source": [1, 2, 4], "target": [1, 2, 3]}], "no edge joins vertices 2 and 4"),
        (
            [{"source": [1, 2, 3], "target": [1, 2, 3]}, {"source": [3, 4, 5], "target": [5, 6, 7]}],
            'the curves "Curve 1" and "Curve 2" meet at vertex 3 of Head A',
        ),
    ],
)
def test_a_bad_file_changes_nothing(
    heads: tuple[MeshObject, MeshObject], tmp_path: Path, curves: Any, words: str
) -> None:
    curving.add(ROW, ROW_B)
    pairing.add(40, 50)
    path = tmp_path / "pairs.json"
    content = {"format": "authalic-landmarks", "version": 1, "pairs": [], "curves": curves}
    path.write_text(json.dumps(content))
    pairing.refused(words, call.landmark_import, filepath=str(path))
    assert curving.listed() == [("Curve 1", ROW, ROW_B, None)]


@pytest.mark.parametrize("in_edit", [False, True])
def test_drawing_looks_again_only_after_changes(
    heads: tuple[MeshObject, MeshObject], monkeypatch: pytest.MonkeyPatch, in_edit: bool
) -> None:
    source, _ = heads
    curving.add(ROW, ROW_B)
    if in_edit:
        meshes.edit(*heads)
    module, find = part("landmarks.curve_marks"), part("landmarks.curves").pairs
    find(source, drawing=True)
    looked, holds = [], module._holds
    monkeypatch.setattr(module, "_holds", lambda *given: looked.append(1) or holds(*given))
    find(source, drawing=True)
    source.location.x += 1
    bpy.context.view_layer.update()
    find(source, drawing=True)
    assert not looked
    if in_edit:
        bpy.ops.transform.translate(value=(0, 0, 1))
    else:
        source.data.vertices[0].co.z += 1
        source.data.update()
    bpy.context.view_layer.update()
    assert find(source, drawing=True)[0].source.vertices == ROW and looked
