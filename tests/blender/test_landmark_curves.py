# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmark curves: added, refused, listed, reversed, selected, removed, and how they are drawn."""

from itertools import pairwise
from pathlib import Path
from typing import Any

import bmesh
import bpy
import curving
import drawing
import meshes
import pairing
import pytest
from curving import LOOP, LOOP_B, OTHER, OTHER_B, ROW, ROW_B
from installed import part
from meshes import MeshObject

call = bpy.ops.authalic


@pytest.fixture
def heads() -> tuple[MeshObject, MeshObject]:
    return pairing.heads()


def test_add_by_numbers(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(ROW, ROW_B)
    curving.add(OTHER, OTHER_B, name="Brow")
    assert curving.listed() == [("Curve 1", ROW, ROW_B, None), ("Brow", OTHER, OTHER_B, None)]
    stored = heads[0].authalic_landmark_curves
    assert [(c.source_vertices, c.error) for c in stored] == [("8 9 10 11", -1), ("22 23 24 25", -1)]
    assert stored[1].target_vertices == "38 39 40" and heads[0].authalic_landmark_curve_index == 1


def test_numbers_may_have_commas_and_are_not_remembered(heads: tuple[MeshObject, MeshObject]) -> None:
    call.landmark_curve_add(source_vertices="8, 9,10", target_vertices="10,11,  12", name="Brow")
    assert curving.listed() == [("Brow", (8, 9, 10), (10, 11, 12), None)]
    curving.refused("Select edges of Head A or of Head B in Edit Mode", call.landmark_curve_add)


def test_closed(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(LOOP, LOOP_B)
    assert curving.listed() == [("Curve 1", LOOP, LOOP_B, None)]
    assert part_curves(heads[0])[0].source.is_closed


def part_curves(obj: MeshObject) -> Any:
    return part("landmarks.curves").pairs(obj)


def test_one_side_after_the_other(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(ROW)
    assert curving.listed() == [("Curve 1", ROW, (), "has no edges on Head B")]
    curving.add(target=ROW_B, index=0)
    assert curving.listed() == [("Curve 1", ROW, ROW_B, None)]
    curving.add(OTHER, index=0)
    assert curving.listed() == [("Curve 1", OTHER, ROW_B, None)]


def test_one_side_after_the_other_without_an_index(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(ROW)
    curving.add(target=ROW_B, name="Brow")
    curving.add(target=OTHER_B)
    curving.add(OTHER, OTHER_B)
    assert curving.listed() == [("Brow", ROW, ROW_B, None), ("Curve 2", OTHER, OTHER_B, None)]


def test_a_name_is_set_when_selected_edges_complete_a_pair(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(ROW)
    meshes.edit(*heads)
    curving.select_path(heads[0])
    curving.select_path(heads[1], ROW_B)
    call.landmark_curve_add(name="Brow")
    assert curving.listed()[0][0] == "Brow" and len(curving.listed()) == 1


def test_add_selected_edges_of_both(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    meshes.edit(*heads)
    curving.select_path(source, ROW)
    curving.select_path(target, ROW_B)
    call.landmark_curve_add()
    curving.select_path(source, LOOP, active=25)
    curving.select_path(target, LOOP_B)
    call.landmark_curve_add()
    turned = (25, 32, 31, 30, 23, 16, 17, 18, 25)
    # the row has vertices 8 to 11, the loop does not touch it
    assert curving.listed()[0] == ("Curve 1", ROW, ROW_B, None)
    (_, source_path, target_path, problem) = curving.listed()[1]
    assert source_path in (turned, turned[::-1]) and set(target_path) == set(LOOP_B) and problem is None
    bpy.ops.object.mode_set(mode="OBJECT")
    assert curving.listed()[0] == ("Curve 1", ROW, ROW_B, None)


def test_selected_edges_complete_the_active_curve(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    meshes.edit(*heads)
    curving.select_path(source, ROW)
    curving.select_path(target)
    call.landmark_curve_add()
    curving.select_path(source, OTHER)
    call.landmark_curve_add()
    assert [curve[2] for curve in curving.listed()] == [(), ()] and source.authalic_landmark_curve_index == 1
    curving.select_path(source)
    curving.select_path(target, OTHER_B)
    call.landmark_curve_add()
    curving.select_path(target, ROW_B)
    call.landmark_curve_add()
    assert curving.listed() == [("Curve 1", ROW, ROW_B, None), ("Curve 2", OTHER, OTHER_B, None)]


def test_edges_that_are_selected_still_are_not_added_again(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    meshes.edit(*heads)
    curving.select_path(target)
    curving.select_path(source, ROW)
    call.landmark_curve_add()
    curving.select_path(target, ROW_B)
    call.landmark_curve_add()
    assert curving.listed() == [("Curve 1", ROW, ROW_B, None)]


def test_the_target_may_come_first(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    meshes.edit(target, source)
    curving.select_path(source)
    curving.select_path(target, ROW_B)
    call.landmark_curve_add()
    assert curving.listed(source) == [("Curve 1", (), ROW_B, "has no edges on Head A")]
    assert not target.authalic_landmark_curves
    bpy.ops.object.mode_set(mode="OBJECT")
    meshes.edit(source)
    curving.select_path(source, ROW)
    call.landmark_curve_add()
    assert curving.listed(source) == [("Curve 1", ROW, ROW_B, None)]


@pytest.mark.parametrize(
    ("active", "first"), [(None, 8), (8, 8), (11, 11), (10, 11), ((9, 8), 8), ((10, 11), 11), ((9, 10), 8)]
)
def test_where_a_path_starts(heads: tuple[MeshObject, MeshObject], active: Any, first: int) -> None:
    source, _ = heads
    meshes.edit(source)
    curving.select_path(source, ROW, active=active)
    call.landmark_curve_add()
    assert curving.listed()[0][1][0] == first


@pytest.mark.parametrize("turned", [False, True])
def test_a_path_without_an_active_end_runs_as_its_partner(
    heads: tuple[MeshObject, MeshObject], turned: bool
) -> None:
    source, target = heads
    curving.add(ROW[::-1])
    if turned:
        target.rotation_euler.z = 3.14
        bpy.context.view_layer.update()
    meshes.edit(*heads)
    curving.select_path(source)
    curving.select_path(target, ROW_B)
    call.landmark_curve_add()
    assert curving.listed(source)[0][2] == (ROW_B if turned else ROW_B[::-1])


@pytest.mark.parametrize(
    ("paths", "words"),
    [
        (
            [(8, 9, 10), (22, 23, 24)],
            "The 4 selected edges of Head A make up 2 pieces; select the edges",
        ),
        ([(8, 9, 10), (9, 16)], r"The 3 selected edges of Head A branch at 1 vertex \(9\)"),
        ([(8, 9, 10, 11), (2, 9, 16), (30, 31)], r"make up 2 pieces and branch at 1 vertex \(9\)"),
        ([(8, 9)], "The curve needs at least 2 edges, not 1, on Head A"),
    ],
)
def test_what_is_no_path(heads: tuple[MeshObject, MeshObject], paths: Any, words: str) -> None:
    meshes.edit(*heads)
    curving.select_path(heads[1])
    curving.select_path(heads[0], *paths)
    curving.refused(words, call.landmark_curve_add)


@pytest.mark.parametrize("in_edit", [False, True])
def test_refusals(heads: tuple[MeshObject, MeshObject], in_edit: bool) -> None:
    if in_edit:
        meshes.edit(*heads)
    curving.add(ROW, ROW_B)

    def refused(words: str, source: str = "22 23 24", target: str = "38 39 40", **options: Any) -> None:
        options |= {"source_vertices": source, "target_vertices": target}
        curving.refused(words, call.landmark_curve_add, **options)

    refused('The curve "Curve 1" has vertex 11 of Head A already; curves must not meet', source="4 11 18")
    refused('The curve "Curve 1" has 2 vertices .12, 13. of Head B already', target="21 12 13")
    refused("Head A has no vertex 49; its 49 vertices are 0 to 48", source="47 48 49")
    refused("Head A: no edge joins vertices 22 and 24", source="22 24 25")
    refused("The curve comes to vertex 23 twice on Head A", source="22 23 24 23")
    refused("The curve needs at least 2 edges, not 1,", source="22 23")
    refused("The curve needs at least 3 edges, not 2,", source="22 23 22")
    refused('"2x" is not the number of a vertex', source="2x 3")
    refused("Head A has no curve 7; its 1 are 0 to 0", index=7)
    for name in ("remove", "select", "reverse"):
        curving.refused("has no curve 1", getattr(call, f"landmark_curve_{name}"), index=1)
    heads[0].authalic_target = None
    with pytest.raises(RuntimeError, match="no target object"):
        call.landmark_curve_add(source_vertices="22 23 24")


def test_there_must_be_curves_and_meshes(heads: tuple[MeshObject, MeshObject]) -> None:
    for name in ("remove", "clear", "select", "reverse"):
        curving.refused("no landmark curves", getattr(call, f"landmark_curve_{name}"))
    bpy.ops.object.camera_add()
    curving.refused("mesh object", call.landmark_curve_add)


def test_open_and_closed_do_not_match(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(LOOP, ROW_B)
    curving.add(ROW, LOOP_B)
    said = [problem for *_, problem in curving.listed()]
    assert said[0] == "is closed on Head A and open on Head B; both must be open or both closed"
    assert said[1] == "is closed on Head B and open on Head A; both must be open or both closed"


def test_remove_and_clear(heads: tuple[MeshObject, MeshObject]) -> None:
    for source, target in ((ROW, ROW_B), (OTHER, OTHER_B), ((36, 37, 38), (64, 65, 66))):
        curving.add(source, target)
    call.landmark_curve_remove(index=1)
    assert [item[1] for item in curving.listed()] == [ROW, (36, 37, 38)]
    curving.add(OTHER, OTHER_B)
    assert curving.listed()[2] == ("Curve 4", OTHER, OTHER_B, None)
    call.landmark_curve_clear()
    assert curving.listed() == []
    for obj in heads:
        assert not [item.name for item in obj.data.attributes if "authalic" in item.name]


def test_reverse(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(ROW, ROW_B)
    call.landmark_curve_reverse()
    assert curving.listed() == [("Curve 1", ROW, ROW_B[::-1], None)]
    call.landmark_curve_reverse(side="SOURCE")
    assert curving.listed() == [("Curve 1", ROW[::-1], ROW_B[::-1], None)]
    curving.add(LOOP, LOOP_B)
    curving.refused("Curve 2 is closed and has no direction", call.landmark_curve_reverse)
    curving.add((36, 37, 38))
    curving.refused("Curve 3: has no edges on Head B", call.landmark_curve_reverse)
    heads[0].authalic_target = None
    curving.refused("Head A: there is no target object", call.landmark_curve_reverse)


def test_select(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    curving.add(ROW, ROW_B)
    curving.add(LOOP, LOOP_B)
    assert call.landmark_curve_select(index=0, side="TARGET") == {"FINISHED"}
    assert source.authalic_landmark_curve_index == 0
    assert curving.selected_edges(target) == [(10, 11), (11, 12), (12, 13), (13, 14)]
    meshes.edit(source)
    call.landmark_curve_select(index=1, side="SOURCE")
    pairs = pairwise(LOOP)
    assert curving.selected_edges(source) == sorted(tuple(sorted(pair)) for pair in pairs)
    assert not any(face.select for face in bmesh.from_edit_mesh(source.data).faces)


def test_select_leaves_chords_alone(heads: tuple[MeshObject, MeshObject]) -> None:
    source, _ = heads
    settings: Any = bpy.context.tool_settings
    settings.mesh_select_mode = True, False, False
    path = (8, 9, 16, 15, 22)  # 8 and 15 have an edge too
    curving.add(path, ROW_B)
    call.landmark_curve_select(index=0, side="SOURCE")
    meshes.edit(source)
    assert curving.selected_edges(source) == [(8, 9), (9, 16), (15, 16), (15, 22)]
    bpy.ops.object.mode_set(mode="OBJECT")
    assert curving.selected_edges(source) == [(8, 9), (9, 16), (15, 16), (15, 22)]


def test_two_sources_share_paths_of_one_target(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    curving.add(ROW, ROW_B)
    other = meshes.add_grid("Other")
    other.authalic_target = target
    meshes.select(other)
    curving.add(OTHER, ROW_B[::-1])
    assert curving.listed(source) == [("Curve 1", ROW, ROW_B, None)]
    assert curving.listed(other) == [("Curve 1", OTHER, ROW_B[::-1], None)]
    call.landmark_curve_clear()
    assert curving.listed(source) == [("Curve 1", ROW, ROW_B, None)]


def test_source_and_target_share_a_mesh() -> None:
    first = meshes.add_grid("Head A")
    second = bpy.data.objects.new("Second", first.data)
    bpy.context.collection.objects.link(second)
    first.authalic_target, second.authalic_target = second, first
    meshes.select(first)
    curving.add(ROW, ROW[::-1])
    meshes.select(second)
    curving.add(OTHER, ROW)
    assert curving.listed(first) == [("Curve 1", ROW, ROW[::-1], None)]
    assert curving.listed(second) == [("Curve 1", OTHER, ROW, None)]


def copy_of(source: MeshObject, linked: bool = False) -> MeshObject:
    meshes.select(source)
    bpy.ops.object.duplicate(linked=linked)
    return bpy.context.object


def marked(obj: MeshObject) -> Any:
    """The names of the mesh attributes of curves."""
    return [attribute.name for attribute in obj.data.attributes if "authalic_curve" in attribute.name]


@pytest.mark.parametrize("linked", [False, True])
def test_a_copy_of_the_source_goes_its_own_way(heads: tuple[MeshObject, MeshObject], linked: bool) -> None:
    source, target = heads
    curving.add(ROW, ROW_B)
    curving.add(LOOP, LOOP_B)
    copy = copy_of(source, linked)
    assert curving.listed(copy) == curving.listed(source)
    call.landmark_curve_reverse(index=0)
    call.landmark_curve_reverse(index=0, side="SOURCE")
    curving.add(target=(64, 65, 66), index=1)
    curving.add((22, 29, 36), (20, 29, 38))
    brow = ("Curve 1", ROW, ROW_B, None)
    assert curving.listed(source) == [brow, ("Curve 2", LOOP, LOOP_B, None)]
    assert curving.listed(copy)[0] == ("Curve 1", ROW[::-1], ROW_B[::-1], None)
    assert curving.listed(copy)[1][1:3] == (LOOP, (64, 65, 66))
    call.landmark_curve_clear()
    assert curving.listed(source) == [brow, ("Curve 2", LOOP, LOOP_B, None)]
    meshes.select(source)
    call.landmark_curve_clear()
    assert not [name for obj in (source, target, copy) for name in marked(obj)]


def test_a_curve_of_a_copy_takes_no_end_away(heads: tuple[MeshObject, MeshObject]) -> None:
    source, _ = heads
    curving.add(ROW, ROW_B)
    copy = copy_of(source)
    call.landmark_curve_remove()
    curving.add((22, 23, 24), (28, 19, 10))
    assert curving.listed(source) == [("Curve 1", ROW, ROW_B, None)]
    assert curving.listed(copy) == [("Curve 1", (22, 23, 24), (28, 19, 10), None)]


def test_in_edit_mode_a_copy_cannot_take_paths(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    curving.add(ROW, ROW_B)
    copy = copy_of(source)
    meshes.edit(copy, target)
    words = 'Edges or ends on Head B are those of the curve "Curve 1" of Head A too'
    with pytest.raises(RuntimeError, match=words):
        call.landmark_curve_add(index=0, target_vertices="38 39 40")
    with pytest.raises(RuntimeError, match="Head A has this path on Head B too; reverse it in Object Mode"):
        call.landmark_curve_reverse()
    call.landmark_curve_remove()
    with pytest.raises(RuntimeError, match=words):
        call.landmark_curve_add(target_vertices="28 19 10")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert curving.listed(source) == [("Curve 1", ROW, ROW_B, None)] and curving.listed(copy) == []


def test_undo_of_a_change_of_a_copy(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(ROW, ROW_B)
    copy_of(heads[0])
    pairing.step("Copied")
    call.landmark_curve_reverse("EXEC_DEFAULT", True)
    call.landmark_curve_clear("EXEC_DEFAULT", True)
    changed = ("Curve 1", ROW, ROW_B[::-1], None)
    for expected in ([changed], [("Curve 1", ROW, ROW_B, None)]):
        bpy.ops.ed.undo()
        assert curving.listed(bpy.data.objects["Head A.001"]) == expected
        assert curving.listed() == [("Curve 1", ROW, ROW_B, None)]
    bpy.ops.ed.redo()
    assert curving.listed(bpy.data.objects["Head A.001"]) == [changed]


def test_nothing_is_left_on_meshes(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    curving.add(ROW, ROW_B)
    meshes.edit(source)
    call.landmark_curve_clear()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert marked(target)  # for the sake of undo
    curving.add(ROW, ROW_B)
    third = source.authalic_target = meshes.add_grid("Third", n=8)
    meshes.select(source)
    curving.add(target=ROW_B, index=0)
    source.authalic_target = target
    assert curving.listed(source) == [("Curve 1", ROW, ROW_B, None)]
    call.landmark_curve_clear()
    assert not [name for obj in (source, target, third) for name in marked(obj)]


def test_a_linked_target_cannot_be_reversed(heads: tuple[MeshObject, MeshObject], tmp_path: Path) -> None:
    _, target = heads
    curving.add(ROW, ROW_B)
    path = str(tmp_path / "target.blend")
    bpy.data.libraries.write(path, {target.data})
    with bpy.data.libraries.load(path, link=True) as (there, chosen):
        chosen.meshes = there.meshes
    target.data = chosen.meshes[0]
    curving.refused("Head B: its mesh is linked from another file", call.landmark_curve_reverse)


def test_a_copy_with_its_own_curves_can_be_edited(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    curving.add(ROW, ROW_B)
    curving.add(OTHER, OTHER_B)
    copy = copy_of(source)
    call.landmark_curve_remove(index=0)
    meshes.edit(copy, target)
    curving.add((22, 15, 8), (28, 19, 10), index=0)
    assert curving.listed(copy) == [("Curve 2", (22, 15, 8), (28, 19, 10), None)]
    assert [curve[3] for curve in curving.listed(source)] == [None, None]


def test_a_deleted_target_is_told(heads: tuple[MeshObject, MeshObject]) -> None:
    curving.add(ROW, ROW_B)
    bpy.data.objects.remove(heads[1])
    bpy.context.view_layer.update()
    assert curving.listed() == [("Curve 1", ROW, (), "there is no target object; choose one")]
    assert call.landmark_curve_remove() == {"FINISHED"}


def test_lines(heads: tuple[MeshObject, MeshObject]) -> None:
    source, target = heads
    curving.add(ROW, ROW_B)
    curving.add(LOOP)
    markers = part("overlay.curves")
    meshes.select(target, source)
    lines = markers.shown(bpy.context)
    assert [(line.object_name, line.number, line.is_active, line.has_problem) for line in lines] == [
        ("Head A", 0, False, False),
        ("Head B", 0, False, False),
        ("Head A", 1, True, False),
    ]
    assert lines[0].edges == ((8, 9), (9, 10), (10, 11)) and lines[2].is_closed
    assert markers.icon(0) != markers.icon(1) and markers.icon(10) == markers.icon(0)
    icons = bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items
    assert all(markers.icon(number) in icons for number in range(10))
    assert all(len(markers._color(line, bpy.context)) == 3 for line in lines)
    bpy.context.scene.authalic_show_landmarks = False
    assert markers.shown(bpy.context) == []
    markers._draw_lines()  # without a window nothing is drawn
    markers._draw_ends()


def test_the_list_shows_edges_and_errors(heads: tuple[MeshObject, MeshObject]) -> None:
    source, _ = heads
    curving.add(ROW, ROW_B)
    curving.add(LOOP, LOOP_B)
    curving.add((36, 37, 38))
    source.authalic_landmark_curves[0].error = 1.25
    dots = []
    for row in drawing.rows("ui.curves", "AUTHALIC_UL_landmark_curves", source.authalic_landmark_curves):
        dot, chosen = row.operators[0]
        dots.append((row.labels[0], row.icons[-1], drawing.tooltip(dot, chosen).split(".\n")[1:]))
    assert dots == [
        (
            *("C1", "COLORSET_01_VEC"),
            [
                "3 edges of Head A from vertex 8 to 11, 4 edges of Head B from vertex 10 to 14",
                "Missed by 1.250 % of the target's size",
            ],
        ),
        ("C2", "DOT", ["A loop of 8 edges of Head A, a loop of 8 edges of Head B"]),
        ("C3", "ERROR", ["has no edges on Head B"]),
    ]
    panel = part("ui.curves")
    assert panel._problems(source) == [
        "Curve 3: has no edges on Head B; select its edges there in Edit Mode and add them"
    ]


def test_everything_has_words() -> None:
    for name in ("add", "remove", "clear", "select", "reverse"):
        operator = getattr(bpy.ops.authalic, f"landmark_curve_{name}").get_rna_type()
        assert operator.description and not operator.description.endswith(".")
        described = [p for p in operator.properties if p.identifier in ("index", "side", "source_vertices")]
        assert all(p.name and p.description and not p.description.endswith(".") for p in described)


def test_unregistering_leaves_nothing(extension: str) -> None:
    names = ("authalic_landmark_curves", "authalic_landmark_curve_index", "authalic_curve_key")
    assert all(hasattr(bpy.types.Object, name) for name in names)
    bpy.ops.preferences.addon_disable(module=extension)
    assert not any(hasattr(bpy.types.Object, name) for name in names)
    bpy.ops.preferences.addon_enable(module=extension)
