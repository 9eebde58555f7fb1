# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks that are mirrored over X in both objects."""

import bpy
import meshes
import numpy as np
import pairing
import pairs
import pytest
from installed import part
from mathutils import Matrix
from meshes import Array, MeshObject

MIRROR = np.array([-1.0, 1.0, 1.0])
EAR, BROW, NOSE = (1.36, 0.4, 0.1), (0.4, -0.6, 0.6), (0.0, -0.75, -0.3)


def monkeys() -> tuple[MeshObject, MeshObject]:
    """Suzanne, and a finer one that is turned, moved and scaled as an object; both symmetric."""
    bpy.ops.mesh.primitive_monkey_add()
    target = bpy.context.object
    target.name = "Fine"
    modifier = target.modifiers.new("Subdivision", "SUBSURF")
    bpy.ops.object.modifier_apply(modifier=modifier.name)
    target.matrix_world = pairs.TILTED
    bpy.ops.mesh.primitive_monkey_add()
    source = bpy.context.object
    source.authalic_target = target
    meshes.select(source, target)
    bpy.context.view_layer.update()
    return source, target


def add(source: MeshObject, name: str, place: tuple[float, float, float]) -> None:
    vertices = [pairs.nearest(obj, [place])[0] for obj in (source, source.authalic_target)]
    part("landmarks.points").add(source, *vertices, name)


def places(source: MeshObject) -> dict[str, tuple[Array, Array]]:
    """{name: its places on both objects}."""
    own, other = pairs.positions(source), pairs.positions(source.authalic_target)
    return {name: (own[a], other[b]) for name, a, b, problem in pairing.listed(source) if problem is None}


def mirror(**options: float) -> set[str]:
    return bpy.ops.authalic.landmark_mirror(**options)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_pairs_of_one_half_appear_on_the_other(mode: str, capfd: pytest.CaptureFixture[str]) -> None:
    source, target = monkeys()
    for name, place in (("Ear.L", EAR), ("Left Brow", BROW), ("Nose", NOSE)):
        add(source, name, place)
    if mode == "EDIT":
        meshes.edit(source, target)
    assert mirror() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    found = places(source)
    assert list(found) == ["Ear.L", "Left Brow", "Nose", "Ear.R", "Right Brow"]
    for given, new in (("Ear.L", "Ear.R"), ("Left Brow", "Right Brow")):
        np.testing.assert_allclose(found[new], np.array(found[given]) * MIRROR, atol=1e-6)
    assert "Mirrored 2 landmarks; 1 on the mirror plane" in capfd.readouterr().out


def test_twice_is_once(capfd: pytest.CaptureFixture[str]) -> None:
    source, _ = monkeys()
    add(source, "Ear.L", EAR)
    mirror()
    before = pairing.listed(source)
    assert mirror() == {"CANCELLED"}
    assert pairing.listed(source) == before
    assert "Mirrored 0 landmarks; 2 mirrored already" in capfd.readouterr().out


def test_a_pair_picked_by_hand_near_the_mirrored_place_counts() -> None:
    """But not the mirrored pair of a neighbor."""
    source, _ = monkeys()
    add(source, "A", EAR)
    add(source, "B", (-1.30, 0.4, 0.1))  # nearly the mirrored A
    add(source, "C", BROW)
    add(source, "D", (0.45, -0.6, 0.65))  # near C, and C is mirrored by hand
    vertices = [pairs.nearest(obj, [np.array(BROW) * MIRROR])[0] for obj in (source, source.authalic_target)]
    part("landmarks.points").add(source, *vertices, "E")
    count = len(pairing.listed(source))
    mirror(tolerance=0.1)
    (_, a, b, problem), *more = pairing.listed(source)[count:]
    assert not more and problem is None
    d = places(source)["D"]
    np.testing.assert_allclose(pairs.positions(source)[a], d[0] * MIRROR, atol=1e-6)
    np.testing.assert_allclose(pairs.positions(source.authalic_target)[b], d[1] * MIRROR, atol=1e-6)


def test_names_without_a_side_are_numbered() -> None:
    source, _ = monkeys()
    add(source, "", EAR)
    mirror()
    assert [name for name, *_ in pairing.listed(source)] == ["Landmark 1", "Landmark 2"]


def test_where_no_vertex_is_near_nothing_is_added(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = monkeys()
    add(source, "Ear.L", EAR)
    add(source, "Brow.L", BROW)
    moved = pairs.positions(target)
    moved[moved[:, 0] < -1] += 0.5  # no ear on the right any more
    target.data.vertices.foreach_set("co", moved.astype(np.float32).ravel())
    target.data.update()
    assert mirror() == {"FINISHED"}
    assert [name for name, *_ in pairing.listed(source)] == ["Ear.L", "Brow.L", "Brow.R"]
    said = capfd.readouterr().out
    assert 'Mirrored 1 landmark; no free vertex near the mirrored place of "Ear.L" on Suzanne or Fine' in said


def test_a_shape_key_and_a_modifier_make_no_difference() -> None:
    source, target = monkeys()
    key = [target.shape_key_add(name=name, from_mix=False) for name in ("Basis", "Bent")][1]
    bent = pairs.positions(target) + np.array([3, 0, 0])
    key.points.foreach_set("co", bent.astype(np.float32).ravel())
    key.value = 1.0
    source.modifiers.new("Subdivision", "SUBSURF")
    add(source, "Ear.L", EAR)
    mirror()
    found = places(source)
    np.testing.assert_allclose(found["Ear.R"], np.array(found["Ear.L"]) * MIRROR, atol=1e-6)


def test_it_needs_landmarks_and_is_one_step_of_undo() -> None:
    source, _ = monkeys()
    with pytest.raises(RuntimeError, match="no landmarks yet"):
        mirror()
    add(source, "Ear.L", EAR)
    source.matrix_world = Matrix.Identity(4)
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.authalic.landmark_mirror("EXEC_DEFAULT", True)
    assert len(pairing.listed(bpy.data.objects["Suzanne"])) == 2
    bpy.ops.ed.undo()
    assert [name for name, *_ in pairing.listed(bpy.data.objects["Suzanne"])] == ["Ear.L"]
