# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panels draw, and the operators on the two objects of a registration."""

from typing import Any

import bpy
import drawing
import meshes
import numpy as np
import pairing
import pairs
import pytest
from installed import part
from mathutils import Matrix
from meshes import MeshObject

AUTHALIC = bpy.ops.authalic


def panels() -> list[str]:
    kinds: Any = bpy.types.Panel.__subclasses__()
    named = [getattr(kind, "bl_idname", "") or kind.__name__ for kind in kinds]
    return sorted({name for name in named if name.startswith("AUTHALIC_PT") and hasattr(bpy.types, name)})


def couple() -> tuple[MeshObject, MeshObject]:
    source, target = pairing.heads()
    for vertex in (16, 18, 32):
        pairing.add(vertex, vertex + 5)
    AUTHALIC.landmark_curve_add(source_vertices="36 37 38", target_vertices="36 37 38")
    return source, target


@pytest.mark.parametrize("has_objects", [False, True])
def test_all_panels_draw(has_objects: bool) -> None:
    """Without an error, whatever is selected; `Layout` finds operators and properties that are not there."""
    if has_objects:
        couple()
    assert len(panels()) > 8
    drawn = {name: drawing.draw_panel(name) for name in panels()}
    if has_objects:
        assert all(layout is not None and layout.labels for layout in drawn.values()), drawn


def test_parts_of_wrap_and_morph() -> None:
    parent: Any = bpy.types.AUTHALIC_PT_registration_view3d
    assert parent.bl_label == "Wrap and Morph"
    kinds: list[Any] = [getattr(bpy.types, name) for name in panels()]
    inner = [kind for kind in kinds if getattr(kind, "bl_parent_id", "") == "AUTHALIC_PT_registration_view3d"]
    closed = {kind.bl_label for kind in inner if "DEFAULT_CLOSED" in getattr(kind, "bl_options", ())}
    assert {kind.bl_label for kind in inner} == {"Landmarks", "Landmark Curves", "Wrap", "Transfer"}
    assert closed == {"Landmark Curves", "Transfer"}


def test_the_panel_says_how_many_objects_a_transfer_reaches() -> None:
    source, target = couple()
    assert not any("selected objects" in label for label in drawing.draw_panel("AUTHALIC_PT_transfer").labels)
    other = pairs.twin(source, name="Other")
    other.authalic_target = target
    meshes.select(source, other, target)
    assert "To 2 selected objects" in drawing.draw_panel("AUTHALIC_PT_transfer").labels


def test_the_slider_of_the_morph_is_in_the_panel() -> None:
    source, target = pairing.heads()
    for vertex in (16, 18, 32):
        pairing.add(vertex, vertex + 5)
    assert "Morph" not in drawing.draw_panel("AUTHALIC_PT_wrap").labels
    AUTHALIC.register()
    layout = drawing.draw_panel("AUTHALIC_PT_wrap")
    assert layout.labels[-2:] == ["Wrap onto Target", "Morph"] and layout.properties[-1] == "value"
    source.data.shape_keys.key_blocks["Morph → Head B"].name = "Mine"
    assert "Morph" not in drawing.draw_panel("AUTHALIC_PT_wrap").labels
    assert target.data.shape_keys is None


def test_swap() -> None:
    source, target = couple()
    before = pairing.listed(source)
    curves = part("landmarks.curves")
    path, other = [getattr(curves.pairs(source)[0], side).vertices for side in ("source", "target")]
    assert AUTHALIC.swap_target() == {"FINISHED"}
    assert bpy.context.object == target and target.authalic_target == source
    assert source.authalic_target is None and not source.authalic_landmarks
    assert not source.authalic_landmark_curves
    assert pairing.listed(target) == [(name, b, a, problem) for name, a, b, problem in before]
    (curve,) = curves.pairs(target)
    assert (curve.source.vertices, curve.target.vertices, curve.problem) == (other, path, None)
    names = {name for name in source.data.attributes.keys() if name.startswith("authalic")}  # noqa: SIM118
    assert len(names) == 3, "marks of the old direction are gone"
    AUTHALIC.swap_target()
    assert pairing.listed(source) == before and curves.pairs(source)[0].source.vertices == path


def test_swap_is_one_step_of_undo() -> None:
    source, target = couple()
    before = pairing.listed(source)
    bpy.ops.ed.undo_push(message="before")
    AUTHALIC.swap_target("EXEC_DEFAULT", True)
    bpy.ops.ed.undo()
    source, target = bpy.data.objects["Head A"], bpy.data.objects["Head B"]
    assert source.authalic_target == target and target.authalic_target is None
    assert pairing.listed(source) == before
    assert part("landmarks.curves").pairs(source)[0].problem is None


@pytest.mark.parametrize("why", ["landmarks", "target", "lost"])
def test_swap_is_refused_by_name_and_changes_nothing(why: str) -> None:
    source, target = couple()
    third = meshes.add_grid("Third")
    meshes.select(source)
    words = "Head B has a target of its own"
    if why == "target":
        target.authalic_target = third
    elif why == "landmarks":
        target.authalic_target = source
        part("landmarks.points").add(target, 3, 3)
        words = "Head B has 1 landmark of its own"
    else:
        pairing.in_edit_mode(source, 18, do=lambda: bpy.ops.mesh.delete(type="VERT"))
        words = "Landmark 2: its vertex on Head A is gone.*first"
    before = pairing.listed(source), pairing.listed(target), target.authalic_target
    with pytest.raises(RuntimeError, match=words):
        AUTHALIC.swap_target()
    assert (pairing.listed(source), pairing.listed(target), target.authalic_target) == before
    assert source.authalic_target == target


@pytest.mark.parametrize("has_parent", [False, True])
def test_side_by_side(has_parent: bool) -> None:
    source, target = pairing.heads()
    source.matrix_world = pairs.TILTED
    target.matrix_world = Matrix.Translation((0.5, 7, 3)) @ Matrix.Scale(2, 4) @ Matrix.Rotation(1, 4, "Z")
    if has_parent:
        parent = bpy.data.objects.new("Parent", None)
        bpy.context.collection.objects.link(parent)
        parent.matrix_world = pairs.SQUEEZED
        target.parent = parent
    bpy.context.view_layer.update()
    before = np.array(target.matrix_world)
    assert AUTHALIC.side_by_side() == {"FINISHED"}
    bpy.context.view_layer.update()
    own, other = (pairs.moved(pairs.positions(obj), obj.matrix_world) for obj in (source, target))
    gap = other[:, 0].min() - own[:, 0].max()
    widest = max(np.ptp(own[:, 0]), np.ptp(other[:, 0]))
    # Boxes about tilted boxes are larger than those about the vertices.
    assert 0.09 * widest < gap < 0.6 * widest
    np.testing.assert_allclose(np.array(target.matrix_world)[:3, :3], before[:3, :3], atol=1e-5)


def apart(has_parent: bool = False) -> tuple[MeshObject, MeshObject]:
    """Two heads with landmarks; the target is turned by more than one turn, and may have a parent."""
    source, target = couple()
    target.rotation_euler = (0.3, 7.0, -9.0)
    target.location = (0.1, 0.2, 0.3)
    if has_parent:
        parent = bpy.data.objects.new("Parent", None)
        bpy.context.collection.objects.link(parent)
        parent.matrix_world = pairs.SQUEEZED
        target.parent = parent
    bpy.context.view_layer.update()
    return source, target


@pytest.mark.parametrize("has_parent", [False, True])
def test_side_by_side_toggles_back(has_parent: bool) -> None:
    _, target = apart(has_parent)
    before: Any = [tuple(value) for value in (target.location, target.rotation_euler, target.scale)]
    world = np.array(target.matrix_world)
    places = part("blender.places")
    AUTHALIC.side_by_side()
    bpy.context.view_layer.update()
    assert places.is_beside(target) and tuple(target.location) != before[0]
    assert [tuple(value) for value in (target.rotation_euler, target.scale)] == before[1:]
    np.testing.assert_allclose(np.array(places.home(target)), world, atol=1e-5)
    AUTHALIC.side_by_side()
    bpy.context.view_layer.update()
    assert not places.is_beside(target)
    assert [tuple(value) for value in (target.location, target.rotation_euler, target.scale)] == before
    np.testing.assert_array_equal(np.array(target.matrix_world), world)
    assert np.array(places.home(target)).tolist() == world.tolist()


def test_a_target_that_is_moved_by_hand_stands_where_it_is() -> None:
    _, target = apart()
    AUTHALIC.side_by_side()
    target.location.z += 1
    bpy.context.view_layer.update()
    places = part("blender.places")
    assert not places.is_beside(target)
    np.testing.assert_array_equal(np.array(places.home(target)), np.array(target.matrix_world))
    moved: Any = tuple(target.location)
    AUTHALIC.side_by_side()
    AUTHALIC.side_by_side()
    assert tuple(target.location) == moved


@pytest.mark.parametrize("has_parent", [False, True])
def test_the_morph_ends_where_the_target_stood_before_it_was_put_aside(has_parent: bool) -> None:
    source, _ = apart(has_parent)
    AUTHALIC.register()
    before = pairs.positions(source, "Morph → Head B")
    AUTHALIC.side_by_side()
    bpy.context.view_layer.update()
    AUTHALIC.register()
    np.testing.assert_allclose(pairs.positions(source, "Morph → Head B"), before, atol=1e-4)


def test_side_by_side_is_one_step_of_undo() -> None:
    _, target = apart()
    before: Any = tuple(target.location)
    bpy.ops.ed.undo_push(message="before")
    AUTHALIC.side_by_side("EXEC_DEFAULT", True)
    bpy.ops.ed.undo()
    target = bpy.data.objects["Head B"]
    assert tuple(target.location) == before and not part("blender.places").is_beside(target)


def test_side_by_side_needs_a_target_that_can_move() -> None:
    meshes.add_grid("Alone")
    with pytest.raises(RuntimeError, match="There is no target object"):
        AUTHALIC.side_by_side()


SECTIONS = {
    "Closed Meshes": {"sphere_layout", "pole_axis", "seam_direction"},
    "Packing": {
        "pack_objects",
        "rotate_method",
        "margin_method",
        "margin",
        "texel_density",
        "correct_aspect",
    },
    "Advanced": {
        *("domain", "fill_holes", "angle_weight", "area_tolerance", "outline", "allow_overlap", "method"),
        *("iterations", "use_subsurf_data", "uv_layer"),
    },
}


@pytest.mark.parametrize("space", ["view3d", "image"])
def test_the_unwrap_has_few_options_and_closed_panels_with_the_rest(space: str) -> None:
    meshes.add_grid()
    layout = drawing.draw_panel(f"AUTHALIC_PT_unwrap_{space}")
    wanted = ["Authalic Unwrap", "Area ↔ Shape", "Even", "Balanced", "Soft", "Shape", "Live"]
    assert layout.labels[: len(wanted)] == wanted
    assert set(layout.properties) == {
        *("angle_preset", "angle_weight", "authalic_live", "seams", "density_source", "keep_position")
    }
    kinds: list[Any] = [getattr(bpy.types, name) for name in panels() if name.endswith(space)]
    inner = [kind for kind in kinds if getattr(kind, "bl_parent_id", "") == f"AUTHALIC_PT_unwrap_{space}"]
    assert {kind.bl_label for kind in inner} == SECTIONS.keys()
    for kind in inner:
        assert kind.bl_options == {"DEFAULT_CLOSED"}
        assert set(drawing.draw_panel(kind.__name__).properties) == SECTIONS[kind.bl_label]


def test_every_option_of_the_unwrap_is_in_its_panels_and_in_the_redo_panel() -> None:
    hidden = {"angle_preset", "shear_preset", "is_redo"}
    options = drawing.last("authalic.unwrap")
    every = {p.identifier for p in options.bl_rna.properties if not p.is_hidden} - hidden - {"rna_type"}
    drawn = set()
    try:
        for seams in ("GIVEN", "AUTOMATIC"):
            options.seams = seams
            layout = drawing.Layout()
            part("operators.unwrap").draw_options(layout, options)
            drawn |= set(layout.properties)
    finally:
        options.property_unset("seams")
    assert drawn - hidden == every


def test_what_a_report_names_can_be_selected_in_the_panel() -> None:
    meshes.add_grid()
    AUTHALIC.unwrap()
    assert "Select Worst" not in drawing.draw_panel("AUTHALIC_PT_unwrap_view3d").labels
    bpy.ops.mesh.primitive_torus_add(major_segments=12, minor_segments=6)
    with pytest.raises(RuntimeError, match="handle"):
        AUTHALIC.unwrap()
    layout = drawing.draw_panel("AUTHALIC_PT_unwrap_view3d")
    buttons = [(name, given.which) for name, given in layout.operators if name.endswith("select_reported")]
    assert buttons == [("authalic.select_reported", "WORST"), ("authalic.select_reported", "ALL")]
