# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of landmarks: added, listed, kept through edits and undo, told where they are lost; and files."""

import importlib
import json

import bmesh
import bpy
import conftest
import meshes
import numpy as np
import pytest


def part(name):
    return importlib.import_module(f"{conftest.MODULE}.{name}")


@pytest.fixture
def heads():
    """Two grids of which the active one has the other for a target."""
    source, target = meshes.add_grid("Head A"), meshes.add_grid("Head B", n=8)
    target.location.x = 3
    source.authalic_target = target
    meshes.select(source, target)
    return source, target


def add(source_vertex, target_vertex, **options):
    options.update(source_vertex=source_vertex, target_vertex=target_vertex)
    assert bpy.ops.authalic.landmark_add(**options) == {"FINISHED"}


def listed(obj=None):
    return [tuple(pair) for pair in part("landmarks").pairs(obj or bpy.data.objects["Head A"])]


def refused(words, call, **options):
    before = listed()
    with pytest.raises(RuntimeError, match=words):
        call(**options)
    assert listed() == before


def select_vertices(obj, *vertices):
    edit = bmesh.from_edit_mesh(obj.data)
    for number, vertex in enumerate(edit.verts):
        vertex.select_set(number in vertices)
    edit.select_flush_mode()
    bmesh.update_edit_mesh(obj.data)


def position(obj, vertex):
    return np.array(obj.data.vertices[vertex].co)


def in_edit_mode(obj, *vertices, do):
    """Does something to some selected vertices of an object and returns to object mode."""
    meshes.edit(obj)
    select_vertices(obj, *vertices)
    do()
    bpy.ops.object.mode_set(mode="OBJECT")


def test_add_by_numbers(heads):
    add(3, 5)
    add(7, 9, name="Nose")
    add(8, 10)
    assert listed() == [("Landmark 1", 3, 5, None), ("Nose", 7, 9, None), ("Landmark 3", 8, 10, None)]
    stored = heads[0].authalic_landmarks
    assert [(p.name, p.source_vertex, p.target_vertex, p.error) for p in stored][1] == ("Nose", 7, 9, -1)
    assert heads[0].authalic_landmark_index == 2


def test_numbers_are_not_remembered_for_the_next_use(heads):
    add(3, 5, name="Nose")
    refused("not in Edit Mode", bpy.ops.authalic.landmark_add)


def test_add_the_selected_vertices_in_edit_mode(heads):
    meshes.edit(*heads)
    for vertices in ((4, 60), (5, 61)):
        for obj, vertex in zip(heads, vertices, strict=True):
            select_vertices(obj, vertex)
        assert bpy.ops.authalic.landmark_add() == {"FINISHED"}
    assert listed() == [("Landmark 1", 4, 60, None), ("Landmark 2", 5, 61, None)]
    bpy.ops.object.mode_set(mode="OBJECT")
    assert listed() == [("Landmark 1", 4, 60, None), ("Landmark 2", 5, 61, None)]


def test_the_source_is_known_from_its_target_too(heads):
    """In edit mode of both, whichever of them was made active last."""
    meshes.edit(heads[1], heads[0])
    select_vertices(heads[0], 4)
    select_vertices(heads[1], 60)
    bpy.ops.authalic.landmark_add()
    assert listed() == [("Landmark 1", 4, 60, None)] and not heads[1].authalic_landmarks


@pytest.mark.parametrize("count", [0, 2])
def test_one_vertex_must_be_selected(heads, count):
    meshes.edit(*heads)
    select_vertices(heads[0], 1)
    select_vertices(heads[1], *range(count))
    words = f"exactly one vertex of Head B, not {count or 'none'}"
    refused(words, bpy.ops.authalic.landmark_add)


@pytest.mark.parametrize("in_edit", [False, True])
def test_refusals(heads, in_edit):
    if in_edit:
        meshes.edit(*heads)
    add(3, 5)
    call = bpy.ops.authalic.landmark_add
    refused('vertex 3 of Head A is in the pair "Landmark 1"', call, source_vertex=3, target_vertex=6)
    refused('vertex 5 of Head B is in the pair "Landmark 1"', call, source_vertex=4, target_vertex=5)
    refused("Head A has no vertex 49, its 49 vertices are 0 to 48", call, source_vertex=49, target_vertex=6)
    refused("Head B has no vertex 81", call, source_vertex=4, target_vertex=81)
    refused("has no pair 1, its 1", bpy.ops.authalic.landmark_remove, index=1)
    refused("has no pair 7", bpy.ops.authalic.landmark_jump, index=7)
    heads[0].authalic_target = None
    with pytest.raises(RuntimeError, match="no target object"):
        call(source_vertex=1, target_vertex=1)


def test_there_must_be_landmarks_and_meshes(heads):
    for name in ("remove", "clear", "jump"):
        refused("no landmarks", getattr(bpy.ops.authalic, f"landmark_{name}"))
    bpy.ops.object.camera_add()
    for name in ("add", "pick", "import"):
        refused("mesh object", getattr(bpy.ops.authalic, f"landmark_{name}"))


def test_an_object_is_no_target_of_itself(heads):
    source, _ = heads
    source.authalic_target = source  # a script can, the panel does not offer it
    with pytest.raises(RuntimeError, match="Head A cannot be the target"):
        bpy.ops.authalic.landmark_add(source_vertex=1, target_vertex=2)


def test_remove_and_clear(heads):
    for k in range(4):
        add(k, k + 10)
    bpy.ops.authalic.landmark_remove(index=1)
    assert [pair[1:3] for pair in listed()] == [(0, 10), (2, 12), (3, 13)]
    bpy.ops.authalic.landmark_remove()
    assert [pair[1:3] for pair in listed()] == [(0, 10), (2, 12)]
    add(1, 11)
    assert listed()[2] == ("Landmark 4", 1, 11, None) or listed()[2][1:3] == (1, 11)
    bpy.ops.authalic.landmark_clear()
    assert listed() == []
    for obj in heads:
        values = np.empty(len(obj.data.vertices), np.int32)
        obj.data.attributes["authalic_landmark"].data.foreach_get("value", values)
        assert not values.any()


def test_renaming_keeps_the_pair(heads):
    add(3, 5)
    heads[0].authalic_landmarks[0].name = "Nose"
    assert listed() == [("Nose", 3, 5, None)]


def test_scripts_may_write_the_list_itself(heads):
    source, target = heads
    source.authalic_target = None
    pair = source.authalic_landmarks.add()
    pair.name, pair.source_vertex, pair.target_vertex = "Nose", 3, 5
    assert (pair.source_vertex, pair.target_vertex) == (3, 5)
    assert "no target" in listed()[0][3]
    source.authalic_target = target
    assert listed() == [("Nose", 3, 5, None)]
    pair.source_vertex = 1000
    assert listed()[0][1] == -1 and "is gone" in listed()[0][3]
    pair.source_vertex = 4
    other = source.authalic_landmarks.add()
    other.source_vertex, other.target_vertex = 4, 6
    assert listed()[1][3] == 'has vertex 4 of Head A, as "Nose" has'


def test_vertices_are_followed_when_others_are_deleted(heads):
    add(20, 30)
    add(40, 50)
    source, target = heads
    places = [position(source, 20), position(target, 50)]
    in_edit_mode(source, 0, 1, 2, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    in_edit_mode(target, 0, 1, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    assert listed() == [("Landmark 1", 17, 28, None), ("Landmark 2", 37, 48, None)]
    assert np.allclose([position(source, 17), position(target, 48)], places)
    assert [pair.source_vertex for pair in source.authalic_landmarks] == [17, 37]


def test_a_deleted_vertex_is_told(heads):
    add(20, 30)
    add(40, 50)
    in_edit_mode(heads[0], 20, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    assert listed() == [
        ("Landmark 1", -1, 30, "its vertex on Head A is gone"),
        ("Landmark 2", 39, 50, None),
    ]
    with pytest.raises(RuntimeError, match="Landmark 1: its vertex on Head A is gone"):
        bpy.ops.authalic.landmark_jump(index=0)


def test_a_copied_vertex_is_told(heads):
    add(20, 30)
    in_edit_mode(heads[0], 20, do=bpy.ops.mesh.duplicate)
    ((_, vertex, goal, problem),) = listed()
    assert (vertex, goal) == (-1, 30) and problem == "2 vertices of Head A are copies of the chosen one"


def test_subdividing_keeps_the_vertices(heads):
    for k in range(8):
        add(5 * k, 6 * k)
    source = heads[0]
    before = [position(source, 5 * k) for k in range(8)]
    in_edit_mode(source, *range(49), do=lambda: bpy.ops.mesh.subdivide(number_cuts=3))
    assert len(source.data.vertices) > 400
    assert all(problem is None for *_, problem in listed())
    assert np.allclose([position(source, pair[1]) for pair in listed()], before)


def test_edits_are_noticed_before_edit_mode_is_left(heads):
    add(20, 30)
    source, find = heads[0], part("landmarks").pairs
    meshes.edit(source)
    assert find(source, drawing=True)[0][1:] == (20, 30, None)
    select_vertices(source, 0, 1)
    bpy.ops.mesh.delete(type="VERT")
    assert find(source, drawing=True)[0][1:] == (18, 30, None) and listed()[0][1:] == (18, 30, None)
    select_vertices(source, 18)
    bpy.ops.mesh.duplicate()
    assert find(source, drawing=True)[0].problem.startswith("2 vertices")


def test_another_target_has_not_the_vertices_of_the_first(heads):
    source, target = heads
    add(20, 30)
    other = meshes.add_grid("Other")
    other.authalic_target = target
    bpy.ops.authalic.landmark_add(source_vertex=7, target_vertex=30)
    meshes.select(source)
    source.authalic_target = other
    assert listed() == [("Landmark 1", 20, -1, "its vertex on Other is gone")]
    source.authalic_target = target
    assert listed() == [("Landmark 1", 20, 30, None)]
    bpy.ops.authalic.landmark_clear()
    assert listed(other) == [("Landmark 1", 7, 30, None)]


def test_two_objects_aim_at_each_other_and_share_a_mesh():
    first = meshes.add_grid("Head A")
    second = bpy.data.objects.new("Second", first.data)
    bpy.context.collection.objects.link(second)
    first.authalic_target, second.authalic_target = second, first
    for obj in (first, second):
        meshes.select(obj)
        add(3, 4)
        add(4, 3)
    assert listed(first) == listed(second) == [("Landmark 1", 3, 4, None), ("Landmark 2", 4, 3, None)]
    bpy.ops.authalic.landmark_remove(index=0)
    assert listed(first)[0] == ("Landmark 1", 3, 4, None) and listed(second)[0][1:3] == (4, 3)


def test_a_copy_of_the_source_has_landmarks_of_its_own(heads):
    add(20, 30)
    meshes.select(heads[0])
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    in_edit_mode(copy, 0, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    assert listed(copy) == [("Landmark 1", 19, 30, None)] and listed() == [("Landmark 1", 20, 30, None)]


def test_a_deleted_target_is_told(heads):
    add(20, 30)
    bpy.data.objects.remove(heads[1])
    bpy.context.view_layer.update()
    assert listed() == [("Landmark 1", 20, -1, "there is no target object, choose one")]


def test_a_target_that_left_the_scene_is_told(heads):
    add(20, 30)
    meshes.select(heads[1])
    bpy.ops.object.delete()
    meshes.select(heads[0])
    assert listed()[0][2] == -1 and listed()[0][3] is not None
    with pytest.raises(RuntimeError, match="target"):
        bpy.ops.authalic.landmark_add(source_vertex=1, target_vertex=1)


def test_saved_with_the_file(heads, tmp_path):
    add(20, 30, name="Nose")
    add(21, 31)
    path = str(tmp_path / "heads.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert listed() == [("Nose", 20, 30, None), ("Landmark 2", 21, 31, None)]
    assert bpy.data.objects["Head A"].authalic_target == bpy.data.objects["Head B"]


def step(message):
    bpy.ops.ed.undo_push(message=message)


def test_undo_and_redo(heads):
    step("start")
    add(20, 30)
    step("first")
    add(21, 31)
    step("second")
    bpy.ops.ed.undo()
    assert listed() == [("Landmark 1", 20, 30, None)]
    bpy.ops.ed.undo()
    assert listed() == []
    bpy.ops.ed.redo()
    bpy.ops.ed.redo()
    assert listed() == [("Landmark 1", 20, 30, None), ("Landmark 2", 21, 31, None)]
    in_edit_mode(bpy.data.objects["Head A"], 20, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    step("deleted")
    assert listed()[0][1] == -1
    bpy.ops.ed.undo()
    assert listed()[0] == ("Landmark 1", 20, 30, None)


def both():
    return bpy.data.objects["Head A"], bpy.data.objects["Head B"]


def edit_both():
    step("objects")
    meshes.edit(*both())
    step("edit mode")


@pytest.mark.parametrize("with_target", [True, False])
def test_undo_of_adding_in_edit_mode(heads, with_target):
    add(1, 2)
    step("objects")
    meshes.edit(*(both() if with_target else both()[:1]))
    step("edit mode")
    add(20, 30)
    step("added")
    bpy.ops.ed.undo()
    assert listed() == [("Landmark 1", 1, 2, None)]
    bpy.ops.ed.redo()
    assert listed() == [("Landmark 1", 1, 2, None), ("Landmark 2", 20, 30, None)]
    assert bpy.context.mode == "EDIT_MESH"


@pytest.mark.parametrize("with_target", [True, False])
def test_undo_of_removing_in_edit_mode(heads, with_target):
    add(1, 2, name="Nose")
    add(20, 30)
    step("objects")
    meshes.edit(*(both() if with_target else both()[:1]))
    step("edit mode")
    bpy.ops.authalic.landmark_clear()
    step("cleared")
    bpy.ops.ed.undo()
    assert listed() == [("Nose", 1, 2, None), ("Landmark 2", 20, 30, None)]
    bpy.ops.ed.redo()
    assert listed() == []
    bpy.ops.ed.undo()
    assert len(listed()) == 2


def test_undo_of_deleting_a_vertex_in_edit_mode(heads):
    edit_both()
    add(20, 30)
    step("added")
    for obj, vertices in zip(both(), ([20], []), strict=True):
        select_vertices(obj, *vertices)
    step("selected")
    bpy.ops.mesh.delete(type="VERT")
    step("deleted")
    assert listed()[0][1] == -1
    bpy.ops.ed.undo()
    assert listed() == [("Landmark 1", 20, 30, None)]
    bpy.ops.ed.redo()
    assert listed() == [("Landmark 1", -1, 30, "its vertex on Head A is gone")]
    for _ in range(3):
        bpy.ops.ed.undo()
    assert listed() == []


def test_undo_back_into_edit_mode(heads):
    """Blender then starts from the list as it was when edit mode was entered."""
    add(1, 2)
    add(3, 4)
    edit_both()
    add(20, 30)
    step("added")
    bpy.ops.authalic.landmark_remove(index=0)
    step("removed")
    bpy.ops.object.mode_set(mode="OBJECT")
    step("object mode")
    states = ([(3, 4), (20, 30)], [(3, 4), (20, 30)], [(1, 2), (3, 4), (20, 30)], [(1, 2), (3, 4)])
    for expected in states[1:]:
        bpy.ops.ed.undo()
        assert [pair[1:3] for pair in listed()] == expected and bpy.context.mode == "EDIT_MESH"
    bpy.ops.ed.undo()
    assert [pair[1:3] for pair in listed()] == states[-1] and bpy.context.mode == "OBJECT"
    for expected in (states[3], states[2], states[1], states[0]):
        bpy.ops.ed.redo()
        assert [pair[1:3] for pair in listed()] == expected
    assert bpy.context.mode == "OBJECT" and not any(problem for *_, problem in listed())


def test_jump_selects_the_vertex(heads):
    add(20, 30)
    add(21, 31)
    source, target = heads
    bpy.ops.authalic.landmark_jump(index=0, side="TARGET")
    assert source.authalic_landmark_index == 0
    assert [v.index for v in target.data.vertices if v.select] == [30]
    meshes.edit(source)
    bpy.ops.authalic.landmark_jump(index=1)
    edit = bmesh.from_edit_mesh(source.data)
    assert [v.index for v in edit.verts if v.select] == [21]
    assert edit.select_history.active.index == 21 and not any(f.select for f in edit.faces)


def test_export_and_import(heads, tmp_path):
    add(20, 30, name="Nase ü")
    add(21, 31)
    path = tmp_path / "pairs.json"
    bpy.ops.authalic.landmark_export(filepath=str(path))
    assert json.loads(path.read_text(encoding="utf-8")) == {
        "format": "authalic-landmarks",
        "version": 1,
        "source": "Head A",
        "target": "Head B",
        "pairs": [
            {"name": "Nase ü", "source": 20, "target": 30},
            {"name": "Landmark 2", "source": 21, "target": 31},
        ],
    }
    bpy.ops.authalic.landmark_clear()
    heads[0].authalic_target = None
    bpy.ops.authalic.landmark_import(filepath=str(path))
    assert listed() == [("Nase ü", 20, 30, None), ("Landmark 2", 21, 31, None)]
    assert heads[0].authalic_target == heads[1]


def test_export_leaves_out_what_is_lost(heads, tmp_path):
    add(20, 30)
    add(21, 31)
    in_edit_mode(heads[0], 20, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    path = tmp_path / "pairs.json"
    bpy.ops.authalic.landmark_export(filepath=str(path))
    assert [pair["source"] for pair in json.loads(path.read_text())["pairs"]] == [20]


GOOD = {"format": "authalic-landmarks", "version": 1, "source": "Head A", "target": "Head B"}


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("nonsense", "pairs.json: it is not JSON"),
        ([], "holds no landmarks"),
        ({**GOOD, "format": "other", "pairs": []}, "holds no landmarks"),
        ({**GOOD, "version": 2, "pairs": []}, "of version 2"),
        (GOOD, '"pairs" is missing'),
        ({**GOOD, "pairs": [7]}, "pair 1 is 7"),
        ({**GOOD, "pairs": [{"source": 1, "target": 2}, {"source": 1}]}, 'pair 2 has no "target"'),
        ({**GOOD, "pairs": [{"source": 1.5, "target": 2}]}, "the source of pair 1 is 1.5"),
        ({**GOOD, "pairs": [{"source": True, "target": 2}]}, "the source of pair 1 is true"),
        ({**GOOD, "pairs": [{"source": 1, "target": -2}]}, "the target of pair 1 is -2"),
        ({**GOOD, "pairs": [{"source": 1, "target": 2, "name": 3}]}, "the name of pair 1 is 3"),
        ({**GOOD, "pairs": [{"source": 1, "target": 2}, {"source": 99, "target": 3}]}, "no vertex 99"),
        (
            {
                **GOOD,
                "pairs": [{"name": "A", "source": 1, "target": 2}, {"name": "A", "source": 1, "target": 3}],
            },
            'vertex 1 of Head A is in two pairs, "A", "A"',
        ),
    ],
)
def test_a_bad_file_changes_nothing(heads, tmp_path, content, words):
    add(20, 30)
    path = tmp_path / "pairs.json"
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    refused(words, bpy.ops.authalic.landmark_import, filepath=str(path))
    heads[0].authalic_target = None
    with pytest.raises(RuntimeError):
        bpy.ops.authalic.landmark_import(filepath=str(path))
    assert heads[0].authalic_target is None


def test_files_that_cannot_be_read_or_written(heads, tmp_path):
    add(20, 30)
    refused(
        "nothing.json: No such file",
        bpy.ops.authalic.landmark_import,
        filepath=str(tmp_path / "nothing.json"),
    )
    refused("No file is named", bpy.ops.authalic.landmark_import, filepath="")
    away = str(tmp_path / "no" / "folder.json")
    refused("folder.json: No such file", bpy.ops.authalic.landmark_export, filepath=away)
    binary = tmp_path / "binary.json"
    binary.write_bytes(b"\xff\xfe\x00\x81")
    refused("binary.json", bpy.ops.authalic.landmark_import, filepath=str(binary))


def test_markers(heads):
    source, target = heads
    add(20, 30)
    add(21, 31)
    in_edit_mode(source, 20, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    markers = part("markers")
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


def test_markers_ride_on_what_is_seen(heads):
    source, _ = heads
    source.shape_key_add(name="Basis")
    key = source.shape_key_add(name="Up")
    key.points[20].co.z += 2
    key.value = 0.5
    source.location = (0, 0, 5)
    source.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    flat = position(source, 20)
    place = part("vertex_points").in_world
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


def test_picking_without_a_window_adds_numbers(heads):
    refused("needs a window", bpy.ops.authalic.landmark_pick)
    bpy.ops.authalic.landmark_pick("INVOKE_DEFAULT", source_vertex=3, target_vertex=4)
    assert listed() == [("Landmark 1", 3, 4, None)]


def test_everything_has_words():
    for name in ("add", "pick", "remove", "clear", "jump", "export", "import"):
        operator = getattr(bpy.ops.authalic, f"landmark_{name}").get_rna_type()
        assert operator.description and not operator.description.endswith(".")
        own = [p for p in operator.properties if p.identifier in ("index", "side", "source_vertex")]
        assert all(p.name and p.description and not p.description.endswith(".") for p in own)


def test_unregistering_leaves_nothing(extension):
    names = ("authalic_landmarks", "authalic_target", "authalic_landmark_index")
    assert all(hasattr(bpy.types.Object, name) for name in names)
    bpy.ops.preferences.addon_disable(module=extension)
    assert not any(hasattr(bpy.types.Object, name) for name in names)
    assert not hasattr(bpy.types.Scene, "authalic_show_landmarks")
    bpy.ops.preferences.addon_enable(module=extension)
