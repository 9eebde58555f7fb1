# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.mark_seams: seams on edges of the mesh, and what stays."""

import time
from collections.abc import Callable
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
import seaming
from installed import part
from meshes import MeshObject
from seaming import characteristics, marked

Pairs = set[tuple[int, int]]


def mark(draft: bool = True, **options: Any) -> set[str]:
    """Marks quick seams, unless others are asked for."""
    return bpy.ops.authalic.mark_seams(draft=draft, **options)


def group(obj: MeshObject, name: str, weight: float, chosen: Callable[[Any], bool]) -> set[int]:
    """Adds a vertex group of the vertices for whose positions `chosen` holds."""
    members = [vertex.index for vertex in obj.data.vertices if chosen(vertex.co)]
    obj.vertex_groups.new(name=name).add(members, weight, "REPLACE")
    return set(members)


def touched(pairs: Pairs) -> set[int]:
    return {vertex for pair in pairs for vertex in pair}


def length(obj: MeshObject, pairs: Pairs) -> float:
    position = [vertex.co for vertex in obj.data.vertices]
    return sum((position[first] - position[second]).length for first, second in pairs)


CLOSED: dict[str, Callable[[], MeshObject]] = {
    "triangles": lambda: meshes.icosphere(2),
    "quads": lambda: meshes.cube_sphere(2),
    "fans and quads": lambda: meshes.uv_sphere(12, 8),
    "n-gons": lambda: meshes.closed_suzanne(0),
    "a handle": meshes.torus,
    "two handles": seaming.two_handles,
}


@pytest.mark.parametrize("make", CLOSED.values(), ids=CLOSED.keys())
def test_closed_meshes_become_disks(make: Callable[[], MeshObject]) -> None:
    obj = make()
    edges = len(obj.data.edges)
    assert mark() == {"FINISHED"}
    assert set(characteristics(obj)) == {1}
    assert len(obj.data.edges) == edges and not obj.data.uv_layers.get("Authalic")


def test_exact_seams_are_shorter_than_quick_ones_or_nearly(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.add(*meshes.ring(n=6))
    assert mark(draft=False) == {"FINISHED"}
    said = capfd.readouterr().out
    assert f"Marked {len(marked(obj))} edges: 1 island, length of new seams" in said
    assert "predicted shear 1." in said
    exact = length(obj, marked(obj))
    assert set(characteristics(obj)) == {1}
    mark(clear=True)
    assert exact < 1.3 * length(obj, marked(obj))


def test_open_meshes_need_no_seams(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.add_grid(bump=0.2)
    assert mark(draft=False) == {"FINISHED"}
    assert not marked(obj)
    assert "Marked 0 edges: 1 island" in capfd.readouterr().out


def test_seams_are_added_to_and_cleared_only_if_asked() -> None:
    obj = meshes.icosphere(2)
    mark()
    alone = marked(obj)
    given = {pair for pair in seaming.edges(obj) if pair not in alone and 3 in pair}
    seaming.mark(obj, given)
    mark()
    assert given < marked(obj) and set(characteristics(obj)) == {1}
    mark(clear=True)
    assert marked(obj) == alone


def test_seams_do_not_enter_a_group_to_keep_off() -> None:
    obj = meshes.icosphere(3)
    face = group(obj, "Face", 1.0, lambda point: point.y < 0.2)
    mark()
    assert touched(marked(obj)) & face
    mark(clear=True, keep_off="Face")
    assert marked(obj) and not touched(marked(obj)) & face
    assert set(characteristics(obj)) == {1}


def test_a_handle_is_cut_even_where_all_of_it_is_to_be_kept_off(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.torus()
    group(obj, "All", 1.0, lambda point: True)
    assert mark(keep_off="All") == {"FINISHED"}
    assert "seams cross what they are to be kept off" in capfd.readouterr().out
    assert set(characteristics(obj)) == {1}


def test_seams_follow_a_preferred_group() -> None:
    obj = meshes.icosphere(3)
    group(obj, "Back", 1.0, lambda point: point.x > 0)
    mark(symmetry="OFF")
    share = share_of(obj, "Back")
    mark(symmetry="OFF", clear=True, prefer="Back")
    assert share_of(obj, "Back") > share


def share_of(obj: MeshObject, name: str) -> float:
    """The share of the seams' length in a vertex group."""
    number = obj.vertex_groups[name].index
    inside = {v.index for v in obj.data.vertices if any(entry.group == number for entry in v.groups)}
    return length(obj, {pair for pair in marked(obj) if set(pair) <= inside}) / length(obj, marked(obj))


def test_a_group_that_nobody_has_is_refused() -> None:
    meshes.icosphere(1)
    with pytest.raises(RuntimeError, match='No selected object has the vertex group "Nose"; choose another'):
        mark(keep_off="Nose")


def test_groups_count_in_edit_mode_too() -> None:
    obj = meshes.icosphere(3)
    face = group(obj, "Face", 1.0, lambda point: point.y < 0.2)
    group(obj, "Other", 1.0, lambda point: True)
    meshes.edit(obj)
    bpy.ops.mesh.select_all(action="SELECT")
    assert mark(keep_off="Face") == {"FINISHED"}
    assert marked(obj) and not touched(marked(obj)) & face


def test_the_front_is_spared() -> None:
    def in_front() -> float:
        position = [vertex.co for vertex in obj.data.vertices]
        return length(obj, {pair for pair in marked(obj) if sum(position[v].y for v in pair) < 0})

    obj = meshes.bumpy(meshes.icosphere(3))
    mark(symmetry="OFF")
    anywhere = in_front()
    mark(symmetry="OFF", clear=True, front="NEGATIVE_Y")
    assert in_front() < anywhere


def test_islands_are_limited(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.join(meshes.cube_sphere(2), meshes.torus())
    mark(max_islands=2)
    assert characteristics(obj) == [1, 1]
    assert "2 islands" in capfd.readouterr().out


def test_less_shear_takes_longer_seams() -> None:
    obj = meshes.bumpy(meshes.icosphere(3))
    lengths = {}
    for name, options in {
        "low": {"shear": 1.1},
        "default": {},
        "low shear": {"shear_preset": "LOW_SHEAR"},
        "few seams": {"shear_preset": "FEW_SEAMS"},
        "1.4": {"shear": 1.4},
        "custom": {"shear_preset": "CUSTOM", "shear": 1.4},
    }.items():
        mark(clear=True, **options)
        lengths[name] = length(obj, marked(obj))
    assert lengths["low"] > lengths["low shear"] == lengths["default"]
    assert lengths["default"] > lengths["few seams"] == lengths["1.4"] == lengths["custom"]


def test_presets_and_shear_follow_each_other() -> None:
    class Properties:
        shear, shear_preset = 1.25, "AUTO"

    seaming_, properties = part("operators.seaming"), Properties()
    properties.shear_preset = "FEW_SEAMS"
    seaming_._set_shear(properties, None)
    assert (properties.shear, properties.shear_preset) == (1.4, "FEW_SEAMS")
    for shear, preset in ((1.3, "CUSTOM"), (1.25, "LOW_SHEAR"), (1.4, "FEW_SEAMS")):
        properties.shear = shear
        seaming_._set_preset(properties, None)
        assert properties.shear_preset == preset


def test_scans_are_meshes_of_short_edges() -> None:
    costs, read = part("surfaces.seam_costs"), part("blender.meshes").read
    side = 2**0.5 / 0.008  # edges of a square grid that are .8 % of its diagonal
    for n, is_scan in ((int(side / 2) - 2, False), (int(side / 2) + 2, True)):
        obj = meshes.add_grid(n=n, bump=0.0)
        # the grid has 2 n edges along its diagonal, in units of its side
        assert costs.is_scan(read(obj)) == (n > 1 / (0.008 * 2**0.5)) == is_scan


@pytest.mark.parametrize("is_chosen", [True, False])
def test_edit_mode_cuts_selected_faces_or_all(is_chosen: bool) -> None:
    obj = meshes.add(*meshes.together(meshes.ring(n=6), meshes.ring((4, 0, 0), n=6)))
    meshes.edit(obj)
    meshes.select_faces(obj, lambda index: is_chosen and index < 36)
    assert mark() == {"FINISHED"}
    assert obj.mode == "EDIT"
    cut = {vertex // 36 for vertex in touched(marked(obj))}
    assert cut == ({0} if is_chosen else {0, 1})


def test_seams_in_edit_mode_are_those_of_object_mode() -> None:
    obj = meshes.torus()
    mark()
    expected = marked(obj)
    seaming.mark(obj, set())
    meshes.edit(obj)
    bpy.ops.mesh.select_all(action="SELECT")
    mark()
    assert marked(obj) == expected
    bpy.ops.object.mode_set(mode="OBJECT")
    assert marked(obj) == expected


def test_two_objects(capfd: pytest.CaptureFixture[str]) -> None:
    first, second = meshes.torus(), meshes.icosphere(1)
    meshes.select(first, second)
    assert mark() == {"FINISHED"}
    count = len(marked(first)) + len(marked(second))
    assert marked(first) and marked(second)
    assert f"Marked {count} edges: " in capfd.readouterr().out


def test_a_one_sided_part_is_cut_across_and_named(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.add(*meshes.together(meshes.ring(n=6), meshes.moebius(offset=(4, 0, 0))), "Mixed")
    assert mark(clear=True) == {"FINISHED"}
    across = [pair for pair in marked(obj) if max(pair) >= 36]
    assert across == [(36, 37)]  # the one edge at which windings clash
    assert "Mixed at face 36: one-sided, like a Moebius strip; cut across" in capfd.readouterr().out


def test_an_empty_mesh_is_a_warning(capfd: pytest.CaptureFixture[str]) -> None:
    meshes.add(np.empty((0, 3)), [])
    assert mark() == {"CANCELLED"}
    assert "The selected objects have no faces" in capfd.readouterr().out


def test_modifiers_do_not_count() -> None:
    obj = meshes.add(*meshes.tube(6, 8, closed=False))
    mark()
    alone = marked(obj)
    seaming.mark(obj, set())
    obj.modifiers.new("Mirror", "MIRROR").use_axis = (False, False, True)
    obj.modifiers.new("Subdivision", "SUBSURF")
    bpy.context.view_layer.update()
    assert mark() == {"FINISHED"}
    assert marked(obj) == alone and len(obj.modifiers) == 2


def test_the_rest_of_the_mesh_is_untouched() -> None:
    obj = meshes.torus()
    obj.shape_key_add(name="Basis")
    edge: Any = obj.data.edges[5]
    edge.use_edge_sharp = True
    part("blender.selection").select_edges(obj, [tuple(obj.data.edges[7].vertices)])
    position = [tuple(vertex.co) for vertex in obj.data.vertices]
    uv, selected = meshes.uv(obj), [edge.select for edge in obj.data.edges]
    mark()
    assert [tuple(vertex.co) for vertex in obj.data.vertices] == position
    assert (meshes.uv(obj) == uv).all() and [edge.select for edge in obj.data.edges] == selected
    assert [edge.index for edge in obj.data.edges if edge.use_edge_sharp] == [5]


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_undo_and_redo(mode: Any) -> None:
    name = meshes.torus().name
    seaming.mark(bpy.data.objects[name], set())
    bpy.ops.object.mode_set(mode=mode)
    bpy.ops.ed.undo_push(message="before")
    mark()
    after = marked(bpy.data.objects[name])
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert after and not marked(bpy.data.objects[name])
    bpy.ops.ed.redo()
    assert marked(bpy.data.objects[name]) == after


def exact_job(is_draft: bool = False) -> Any:
    marking = part("jobs.mark_seams")
    search = part("bridge").SeamSettings(is_draft=is_draft)
    return marking.job(bpy.context, marking.Settings(search=search))


def test_a_cancelled_search_marks_nothing() -> None:
    obj = meshes.icosphere(3)
    job = exact_job().start()
    time.sleep(0.2)
    job.cancel()
    with pytest.raises(part("jobs.job").Cancelled):
        job.apply()
    assert not marked(obj)


def test_a_search_that_ends_early_marks_quick_seams() -> None:
    obj = meshes.icosphere(3)
    job = exact_job()
    job.end_early()
    with pytest.raises(part("jobs.mark_seams").CannotMark, match="was not reached before the end"):
        job.execute()
    job = exact_job().start()
    time.sleep(0.2)
    job.end_early()
    assert "stopped early; a longer run finds shorter seams" in str(job.apply())
    early = marked(obj)
    mark(clear=True)
    assert early == marked(obj)


def test_a_mesh_that_changed_meanwhile_is_left_alone() -> None:
    obj = meshes.torus()
    job = exact_job(is_draft=True).start()
    job._thread.join()
    meshes.subdivided(obj, 1)
    with pytest.raises(part("jobs.mark_seams").CannotMark, match="Torus has changed meanwhile"):
        job.apply()
    assert not marked(obj)


def test_without_a_window_invoke_runs_to_the_end() -> None:
    obj = meshes.torus()
    assert bpy.ops.authalic.mark_seams("INVOKE_DEFAULT", draft=True) == {"FINISHED"}
    assert marked(obj)
