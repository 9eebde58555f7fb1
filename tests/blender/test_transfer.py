# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.transfer: the layers that it copies from the target, and the data that it leaves alone."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import bases
import bpy
import linking
import meshes
import numpy as np
import pairs
import pytest
from installed import part
from mathutils import Matrix
from meshes import Array, MeshObject
from numpy.typing import ArrayLike
from pairs import TILTED

KINDS = ("uv_maps", "vertex_groups", "colour_attributes", "shape_keys")


def transfer(**options: Any) -> set[str]:
    return bpy.ops.authalic.transfer(**options)


def only(kind: str, **options: Any) -> set[str]:
    return transfer(**{name: name == kind for name in KINDS}, **options)


def copies(matrix: Matrix | None = None) -> tuple[MeshObject, MeshObject]:
    """A bumpy grid and its copy, tied by landmarks."""
    source = meshes.add_grid("Sheet", n=8)
    target = pairs.twin(source, matrix)
    return pairs.pair(source, target, pairs.nearest(source, [(0.4, 0.4, 0), (-0.4, 0, 0), (0.1, -0.6, 0)]))


def coarse_and_fine(more: Sequence[Any] = ()) -> tuple[MeshObject, MeshObject]:
    """Two grids of one shape, the target with three times as many vertices along a side."""
    source, target = meshes.add_grid("Sheet", n=10), meshes.add_grid("Twin", n=30)
    spots = [(0.4, 0.4, 0.4), (-0.4, 0, 0.4), (0.2, -0.6, 0), (-0.6, 0.6, 0), *more]
    ends = zip(pairs.nearest(source, spots), pairs.nearest(target, spots), strict=True)
    return pairs.pair(source, target, {f"Spot {number}": both for number, both in enumerate(ends)})


def random_uv(obj: MeshObject, name: str, seed: int = 1) -> Array:
    obj.data.uv_layers.new(name=name)
    values = np.random.default_rng(seed).random((len(obj.data.loops), 2))
    meshes.set_uv(obj, values, name)
    return values


def colors(obj: MeshObject, name: str) -> Array:
    values = np.empty(4 * len(obj.data.color_attributes[name].data), np.float32)
    obj.data.color_attributes[name].data.foreach_get("color", values)
    return values.reshape(-1, 4)


def add_colors(obj: MeshObject, name: str, kind: str, domain: str) -> Array:
    attribute = obj.data.color_attributes.new(name, kind, domain)
    values = np.random.default_rng(2).random((len(attribute.data), 4), np.float32)
    attribute.data.foreach_set("color", values.ravel())
    return colors(obj, name)


def weights(obj: MeshObject, name: str) -> Array:
    group = obj.vertex_groups[name].index
    values = np.full(len(obj.data.vertices), np.nan)
    for vertex in obj.data.vertices:
        for entry in vertex.groups:
            if entry.group == group:
                values[vertex.index] = entry.weight
    return values


def add_group(obj: MeshObject, name: str, values: Any) -> None:
    group = obj.vertex_groups.new(name=name)
    for vertex, weight in enumerate(values):
        if weight > 0:
            group.add([vertex], float(weight), "REPLACE")


def add_key(obj: MeshObject, name: str, displacement: ArrayLike, relative_to: str | None = None) -> Any:
    if obj.data.shape_keys is None:
        obj.shape_key_add(name="Basis", from_mix=False)
    key = obj.shape_key_add(name=name, from_mix=False)
    base = pairs.positions(obj, relative_to or "Basis")
    key.points.foreach_set("co", (base + displacement).astype(np.float32).ravel())
    key.relative_key = obj.data.shape_keys.key_blocks[relative_to or "Basis"]
    return key


def test_uv_maps_of_a_copy(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = copies()
    first, second = random_uv(target, "First", 1), random_uv(target, "Second", 2)
    assert only("uv_maps") == {"FINISHED"}
    assert [layer.name for layer in source.data.uv_layers] == ["First", "Second"]
    # Every corner has a value of its own: all edges are seams.
    np.testing.assert_allclose(meshes.uv(source, "First"), first, atol=1e-5)
    np.testing.assert_allclose(meshes.uv(source, "Second"), second, atol=1e-5)
    said = capfd.readouterr().out
    assert "Transferred 2 UV maps (First; Second) from Twin to Sheet" in said


def test_only_the_active_uv_map() -> None:
    source, target = copies()
    random_uv(target, "First")
    random_uv(target, "Second")
    target.data.uv_layers.active = target.data.uv_layers["Second"]
    only("uv_maps", active_uv_only=True)
    assert [layer.name for layer in source.data.uv_layers] == ["Second"]


def test_an_existing_map_is_replaced_and_others_stay() -> None:
    source, target = copies()
    own, _ = random_uv(source, "Own", 5), random_uv(source, "Shared", 6)
    wanted = random_uv(target, "Shared", 7)
    source.data.uv_layers.active = source.data.uv_layers["Own"]
    only("uv_maps")
    assert [layer.name for layer in source.data.uv_layers] == ["Own", "Shared"]
    np.testing.assert_allclose(meshes.uv(source, "Shared"), wanted, atol=1e-5)
    assert (meshes.uv(source, "Own") == own.astype(np.float32)).all()
    assert source.data.uv_layers.active.name == "Own"


def test_linear_uvs_between_tessellations() -> None:
    """The UVs are the registered positions seen from above, near the true ones at landmarks."""
    source, target = coarse_and_fine([(0.8, 0.8, 0), (-0.8, 0.8, 0), (0.8, -0.8, 0), (-0.8, -0.8, 0)])
    angles = {"angle_weight": 0.545}
    bpy.ops.authalic.register(**angles)
    target.data.uv_layers.new(name="Plan")
    corner = [loop.vertex_index for loop in target.data.loops]
    meshes.set_uv(target, pairs.positions(target)[corner, :2], "Plan")
    only("uv_maps", **angles)
    corner = [loop.vertex_index for loop in source.data.loops]
    uv = meshes.uv(source, "Plan")
    np.testing.assert_allclose(uv, pairs.positions(source, "Morph → Twin")[corner, :2], atol=1e-4)
    np.testing.assert_allclose(uv, pairs.positions(source)[corner, :2], atol=0.12)


def test_a_seam_stays_a_seam() -> None:
    """The halves of a sheet lie 5 apart: no face of the source has corners on both sides."""
    source, target = copies()
    target.data.uv_layers.new(name="Halves")
    where = pairs.positions(target)[[loop.vertex_index for loop in target.data.loops]]
    right = np.repeat(
        [where[face.loop_start : face.loop_start + 4, 0].mean() > 0 for face in target.data.polygons], 4
    )
    meshes.set_uv(target, where[:, :2] + np.outer(right, [5, 0]), "Halves")
    only("uv_maps")
    spread = np.ptp(meshes.uv(source, "Halves")[:, 0].reshape(-1, 4), axis=1)
    assert spread.max() < 0.3


@pytest.mark.parametrize("cut", ["halves", "slit"])
def test_faces_across_a_seam_stay_on_one_side(cut: str) -> None:
    """The target's UVs jump by 5 along a line that runs through faces of the source."""
    source, target = coarse_and_fine()
    target.data.uv_layers.new(name="Map")
    where = pairs.positions(target)[[loop.vertex_index for loop in target.data.loops]]
    middle = where.reshape(-1, 4, 3).mean(axis=1)
    beyond = middle[:, 0] > 0.05
    shift = 5.0 * beyond if cut == "halves" else np.where(beyond, 4 * np.maximum(middle[:, 1], 0), 0)
    if cut == "slit":
        shift = np.where(where[:, 0] > 0.05, 4 * np.maximum(where[:, 1], 0), 0).reshape(-1, 4)
        shift[~beyond] = 0
    shift = np.broadcast_to(np.asarray(shift).reshape(len(beyond), -1), (len(beyond), 4)).ravel()
    meshes.set_uv(target, where[:, :2] + np.column_stack([shift, 0 * shift]), "Map")
    only("uv_maps")
    corners = meshes.uv(source, "Map").reshape(-1, 4, 2)
    side = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max()
    assert side < (0.5 if cut == "halves" else 1.2)
    assert np.ptp(corners[..., 0]) > 5


@pytest.mark.parametrize("matrix", [None, TILTED])
def test_vertex_groups(matrix: Matrix | None) -> None:
    source, target = copies(matrix)
    values = np.clip(pairs.positions(target)[:, 0], 0, 1)
    add_group(target, "Right", values)
    add_group(target, "Empty", [])
    add_group(source, "Before", [0.5])
    add_group(source, "Right", np.full(len(values), 0.25))
    assert only("vertex_groups") == {"FINISHED"}
    assert [group.name for group in source.vertex_groups] == ["Before", "Right", "Empty"]
    transferred = weights(source, "Right")
    np.testing.assert_allclose(np.nan_to_num(transferred), values, atol=1e-5 if matrix is None else 0.05)
    assert np.isnan(transferred).sum() > len(values) / 4 and np.isnan(weights(source, "Empty")).all()
    assert weights(source, "Before")[0] == 0.5


@pytest.mark.parametrize("kind", ["FLOAT_COLOR", "BYTE_COLOR"])
@pytest.mark.parametrize("domain", ["POINT", "CORNER"])
def test_colors(kind: str, domain: str) -> None:
    source, target = copies()
    wanted = add_colors(target, "Paint", kind, domain)
    assert only("colour_attributes") == {"FINISHED"}
    attribute = source.data.color_attributes["Paint"]
    assert (attribute.data_type, attribute.domain) == (kind, domain)
    np.testing.assert_allclose(colors(source, "Paint"), wanted, atol=1e-5 if kind == "FLOAT_COLOR" else 0.01)


def test_colors_of_another_kind_are_replaced() -> None:
    source, target = copies()
    wanted = add_colors(target, "Paint", "FLOAT_COLOR", "CORNER")
    add_colors(source, "Paint", "BYTE_COLOR", "POINT")
    only("colour_attributes")
    np.testing.assert_allclose(colors(source, "Paint"), wanted, atol=1e-5)


def test_shape_keys_turn_with_the_spaces() -> None:
    source, target = copies(TILTED)
    source.matrix_world = Matrix.Rotation(0.7, 4, "X")
    bpy.context.view_layer.update()
    smile = np.outer(pairs.positions(target)[:, 0], [0, 0.1, 0.5])
    key = add_key(target, "Smile", smile)
    key.slider_min, key.slider_max, key.value = -0.5, 2.0, 0.7
    key.interpolation = "KEY_BSPLINE"
    assert only("shape_keys", offsets="WORLD") == {"FINISHED"}
    blocks = source.data.shape_keys.key_blocks
    assert [block.name for block in blocks] == ["Basis", "Smile"]
    displacements = pairs.positions(source, "Smile") - pairs.positions(source)
    linear = np.array(source.matrix_world.inverted() @ target.matrix_world)[:3, :3]
    np.testing.assert_allclose(displacements, smile @ linear.T, atol=0.05)
    assert (blocks["Smile"].slider_min, blocks["Smile"].slider_max) == (-0.5, 2)
    assert blocks["Smile"].value == pytest.approx(0.7)
    assert blocks["Smile"].interpolation == "KEY_BSPLINE"


@pytest.mark.parametrize("offsets", ["ALIGN", "SURFACE"])
def test_shape_keys_keep_their_direction_on_a_surface_that_is_turned(offsets: str) -> None:
    source, target = copies(TILTED)
    smile = np.outer(pairs.positions(target)[:, 0], [0, 0.1, 0.5])
    add_key(target, "Smile", smile)
    only("shape_keys", offsets=offsets)
    np.testing.assert_allclose(pairs.positions(source, "Smile") - pairs.positions(source), smile, atol=0.03)


@pytest.mark.parametrize("matrix", [None, TILTED])
def test_shape_keys_turn_with_the_part_of_the_surface(matrix: Matrix | None) -> None:
    """Half of the target stands upright: what rises from it rises from the flat sheet too."""
    source = meshes.add_grid("Sheet", n=24)
    flat = pairs.positions(source) * [1, 1, 0]
    source.data.vertices.foreach_set("co", flat.astype(np.float32).ravel())
    target = pairs.twin(source, matrix)
    x, y, z = pairs.positions(source).T
    right = np.maximum(x, 0)
    bent = np.column_stack([np.minimum(x, 0), y, z + right])
    target.data.vertices.foreach_set("co", bent.astype(np.float32).ravel())
    spots = [(a, b, 0) for a in (-0.8, -0.4, 0, 0.4, 0.8) for b in (-0.8, 0, 0.8)]
    pairs.pair(source, target, pairs.nearest(source, spots))
    normal = np.where((x > 0)[:, None], [-1.0, 0, 0], [0, 0, 1.0])
    add_key(target, "Rise", 0.1 * normal)
    only("shape_keys")
    rise = pairs.positions(source, "Rise") - pairs.positions(source)
    away = np.abs(x) > 0.45
    np.testing.assert_allclose(rise[away], np.tile([0, 0, 0.1], (away.sum(), 1)), atol=0.02)
    only("shape_keys", offsets="ALIGN")
    rise = pairs.positions(source, "Rise") - pairs.positions(source)
    assert np.abs(rise[away] - [0, 0, 0.1]).max() > 0.05


def test_absolute_shape_keys_are_named(capfd: pytest.CaptureFixture[str]) -> None:
    _, target = copies()
    add_key(target, "Later", np.ones(3))
    target.data.shape_keys.use_relative = False
    add_group(target, "Group", [1.0])
    assert transfer() == {"FINISHED"}
    assert "shape keys: those of Twin are absolute; turn on Relative" in capfd.readouterr().out


def test_keys_relative_to_other_keys_and_other_keys_stay() -> None:
    source, target = copies()
    add_key(target, "Wide", np.full(3, 0.25))
    add_key(target, "Wider", np.full(3, 0.5), "Wide")
    add_key(source, "Own", np.full(3, 2.0))
    add_key(source, "Wide", np.full(3, 9.0))
    source.active_shape_key_index = 1
    only("shape_keys")
    assert [key.name for key in source.data.shape_keys.key_blocks] == ["Basis", "Own", "Wide", "Wider"]
    for name, by in (("Own", 2.0), ("Wide", 0.25), ("Wider", 0.75)):
        np.testing.assert_allclose(pairs.positions(source, name) - pairs.positions(source), by, atol=1e-5)
    assert source.data.shape_keys.key_blocks["Wider"].relative_key.name == "Wide"
    assert source.active_shape_key_index == 1


def test_keys_stay_relative_masked_muted() -> None:
    source, target = copies()
    left = pairs.positions(target)[:, 0] < 0
    add_group(target, "Left", left.astype(float))
    add_key(target, "Wider", np.full(3, 0.5))
    add_key(target, "Wide", np.full(3, 0.25)).mute = True
    blocks = target.data.shape_keys.key_blocks
    blocks["Wider"].relative_key = blocks["Wide"]  # which comes later
    blocks["Wider"].vertex_group = "Left"
    assert transfer() == {"FINISHED"}
    copied = source.data.shape_keys.key_blocks
    assert copied["Wider"].relative_key == copied["Wide"]
    assert copied["Wide"].relative_key == copied["Basis"]
    assert copied["Wider"].vertex_group == "Left" and not copied["Wide"].vertex_group
    assert copied["Wide"].mute and not copied["Wider"].mute
    # Two sliders at one: what Blender itself makes of the keys, on both objects alike.
    for obj in (source, target):
        for key in obj.data.shape_keys.key_blocks[1:]:
            key.mute, key.value = False, 1.0
    np.testing.assert_allclose(shown(source), shown(target), atol=1e-4)


def shown(obj: MeshObject) -> Array:
    """The displacements (n, 3) that the shape keys in use make."""
    bpy.context.view_layer.update()
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return np.array([vertex.co for vertex in mesh.vertices]) - pairs.positions(obj)


@pytest.mark.parametrize("has_own", [False, True])
def test_the_group_of_a_mask_comes_along(has_own: bool) -> None:
    source, target = copies()
    half = (pairs.positions(target)[:, 0] < 0).astype(float)
    add_group(target, "Left", half)
    add_group(target, "Other", half)
    add_key(target, "Smile", np.ones(3)).vertex_group = "Left"
    if has_own:
        add_group(source, "Left", 1 - half)
    only("shape_keys")
    assert source.data.shape_keys.key_blocks["Smile"].vertex_group == "Left"
    assert source.vertex_groups.keys() == ["Left"]
    wanted = 1 - half if has_own else half
    np.testing.assert_allclose(np.nan_to_num(weights(source, "Left")), wanted, atol=1e-4)


def test_relations_that_cannot_be_kept_are_named(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = copies()
    add_key(target, "One", np.full(3, 0.25))
    add_key(target, "Two", np.full(3, 0.5))
    add_key(target, "Morph → Sheet", np.zeros(3))
    add_key(target, "Three", np.full(3, 0.75), "Morph → Sheet")
    blocks = target.data.shape_keys.key_blocks
    blocks["One"].relative_key, blocks["Two"].relative_key = blocks["Two"], blocks["One"]
    only("shape_keys")
    said = capfd.readouterr().out
    for name, by in (("One", -0.25), ("Two", 0.25), ("Three", 0.75)):
        assert f"shape key {name} is relative to the first key here" in said
        np.testing.assert_allclose(pairs.positions(source, name) - pairs.positions(source), by, atol=1e-5)


def test_drivers_are_copied_and_named(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = copies()
    add_key(target, 'Smile "a"', np.ones(3))
    add_key(target, "Fix", np.ones(3))
    bone = bpy.data.objects.new("Bone", None)
    bpy.context.collection.objects.link(bone)
    keys = target.data.shape_keys
    driven(keys.key_blocks['Smile "a"'], bone, "location.x")
    driven(keys.key_blocks["Fix"], keys, keys.key_blocks['Smile "a"'].path_from_id("value"))
    add_key(source, "Fix", np.ones(3))
    driven(source.data.shape_keys.key_blocks["Fix"], target, "location.y")
    for _ in range(2):  # a second transfer replaces the drivers of the first
        only("shape_keys")
    assert len(source.data.shape_keys.animation_data.drivers) == 2
    said = capfd.readouterr().out
    assert '2 shape keys (Smile "a"; Fix), drivers of Smile "a", Fix, which follow Bone from Twin' in said
    bone.location.x = 0.75
    keys.key_blocks["Fix"].driver_remove("value")
    keys.key_blocks['Smile "a"'].driver_remove("value")
    keys.key_blocks['Smile "a"'].value = 0.1
    bpy.context.view_layer.update()
    copied = source.data.shape_keys.key_blocks
    assert copied['Smile "a"'].value == pytest.approx(0.75)
    assert copied["Fix"].value == pytest.approx(0.75), "it follows the key of its own mesh"


def test_all_of_a_driver_is_copied_and_looks_at_its_own_object() -> None:
    source, target = copies()
    add_key(target, "Smile", np.ones(3))
    armature = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.collection.objects.link(armature)
    for obj in (source, target):
        obj["strength"] = 1.0
    target["only here"] = 2.0
    curve = target.data.shape_keys.key_blocks["Smile"].driver_add("value")
    for modifier in list(curve.modifiers):
        curve.modifiers.remove(modifier)
    for frame, value in ((0.0, 0.0), (1.0, 0.25), (2.0, 1.0)):
        curve.keyframe_points.insert(frame, value).interpolation = "LINEAR"
    curve.extrapolation = "LINEAR"
    limits = curve.modifiers.new("LIMITS")
    limits.use_max_y, limits.max_y = True, 0.75
    driver = curve.driver
    driver.type = "SCRIPTED"
    for name, kind, of, path in (
        ("own", "SINGLE_PROP", target, '["strength"]'),
        ("other", "SINGLE_PROP", target, '["only here"]'),
        ("place", "TRANSFORMS", target, ""),
        ("rig", "TRANSFORMS", armature, ""),
    ):
        variable = driver.variables.new()
        variable.name, variable.type = name, kind
        variable.targets[0].id = of
        if path:
            variable.targets[0].data_path = path
        else:
            variable.targets[0].transform_type = "LOC_Z"
            variable.targets[0].transform_space = "LOCAL_SPACE"
    driver.expression = "own + other + place + rig - 2"
    target.data.shape_keys.key_blocks["Smile"].driver_add("mute").driver.expression = "0"
    only("shape_keys")
    copied = {each.data_path: each for each in source.data.shape_keys.animation_data.drivers}
    assert set(copied) == {'key_blocks["Smile"].value', 'key_blocks["Smile"].mute'}
    curve = copied['key_blocks["Smile"].value']
    assert [tuple(point.co) for point in curve.keyframe_points] == [(0, 0), (1, 0.25), (2, 1)]
    assert curve.extrapolation == "LINEAR" and curve.modifiers[0].max_y == 0.75
    assert curve.driver.expression == "own + other + place + rig - 2"
    looks = {variable.name: variable.targets[0] for variable in curve.driver.variables}
    assert [looks[name].id.name for name in ("own", "other", "place", "rig")] == [
        "Sheet",
        "Twin",
        "Sheet",
        "Rig",
    ]
    assert looks["rig"].transform_type == "LOC_Z" and looks["rig"].transform_space == "LOCAL_SPACE"
    source["strength"], armature.location.z = 0.5, 0.5
    source.update_tag()
    bpy.context.view_layer.update()
    assert source.data.shape_keys.key_blocks["Smile"].value == pytest.approx(0.25)
    armature.location.z = 9
    bpy.context.view_layer.update()
    assert source.data.shape_keys.key_blocks["Smile"].value == pytest.approx(0.75)


def test_a_driver_without_a_target_is_named(capfd: pytest.CaptureFixture[str]) -> None:
    _, target = copies()
    add_key(target, "Smile", np.ones(3))
    driver = target.data.shape_keys.key_blocks["Smile"].driver_add("value").driver
    driver.variables.new()
    only("shape_keys")
    said = capfd.readouterr().out
    assert "Warning: " in said and "driver of shape key Smile: a variable has no target" in said


def test_key_frames_are_copied_whole(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = copies()
    for name in ("Smile", "Frown", "Still"):
        add_key(target, name, np.ones(3))
    keys = target.data.shape_keys.key_blocks
    for frame, value, ease in ((1.5, 0.2, "BEZIER"), (10, 0.9, "BOUNCE"), (20, 0.1, "CONSTANT")):
        keys["Smile"].value = value
        keys["Smile"].keyframe_insert("value", frame=frame)
        curve_of(target, "Smile").keyframe_points[-1].interpolation = ease
    curve = curve_of(target, "Smile")
    curve.keyframe_points[0].handle_right_type = "FREE"
    curve.keyframe_points[0].handle_right = (4, 0.8)
    curve.modifiers.new("CYCLES").mode_after = "MIRROR"
    curve.modifiers.new("NOISE").strength = 0.05
    keys["Frown"].keyframe_insert("mute", frame=5)
    add_key(source, "Smile", np.ones(3)).keyframe_insert("value", frame=77)
    add_key(source, "Own", np.ones(3)).keyframe_insert("value", frame=3)
    for _ in range(2):  # a second transfer replaces the key frames of the first
        only("shape_keys")
    said = capfd.readouterr().out
    assert "3 shape keys (Smile; Frown; Still), key frames of Smile, Frown from Twin" in said
    copied = source.data.shape_keys
    paths = [each.data_path for each in part("blender.animation")._all(copied)]
    wanted = ["Frown", "Own", "Smile"]
    assert sorted(paths) == [f'key_blocks["{n}"].{"mute" if n == "Frown" else "value"}' for n in wanted]
    assert copied.animation_data.action != target.data.shape_keys.animation_data.action
    for frame in (0, 1.5, 3, 7, 12, 15, 20, 25, 40, 90):
        bpy.context.scene.frame_set(int(frame), subframe=frame % 1)
        assert copied.key_blocks["Smile"].value == pytest.approx(keys["Smile"].value, abs=1e-6)
    assert [point.co.x for point in curve_of(source, "Own").keyframe_points] == [3]


def test_key_frames_that_cannot_be_copied_are_named(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = copies()
    add_key(target, "Smile", np.ones(3)).keyframe_insert("value", frame=1)
    add_key(target, "Frown", np.ones(3)).keyframe_insert("value", frame=1)
    curve_of(target, "Frown").convert_to_samples(1, 10)
    animation = target.data.shape_keys.animation_data
    animation.nla_tracks.new().strips.new("Old", 1, bpy.data.actions.new("Old"))
    only("shape_keys")
    said = capfd.readouterr().out
    assert "key frames of Smile from Twin" in said
    assert "key frames of shape key Frown: they are baked" in said and "NLA strips of" in said
    copied = part("blender.animation")._all(source.data.shape_keys)
    assert [each.data_path for each in copied] == ['key_blocks["Smile"].value']


def test_key_frames_do_not_go_into_a_linked_action(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    source, target = copies()
    add_key(source, "Own", np.ones(3)).keyframe_insert("value", frame=3)
    action = linking.linked_action(tmp_path, source)
    add_key(target, "Smile", np.ones(3)).keyframe_insert("value", frame=1)
    only("shape_keys")
    said = capfd.readouterr().out
    assert f'left out: key frames: the action "{action.name}" of its shape keys is linked' in said
    assert "Smile" in source.data.shape_keys.key_blocks
    paths = [each.data_path for each in part("blender.animation")._all(source.data.shape_keys)]
    assert paths == ['key_blocks["Own"].value']


def test_keys_that_share_their_key_frames_keep_them() -> None:
    source, target = copies()
    add_key(target, "Smile", np.ones(3)).keyframe_insert("value", frame=4)
    add_key(source, "Smile", np.ones(3)).keyframe_insert("value", frame=9)
    ours, theirs = (obj.data.shape_keys.animation_data for obj in (source, target))
    ours.action = theirs.action
    if hasattr(ours, "action_slot"):
        ours.action_slot = theirs.action_slot
    only("shape_keys")
    assert [point.co.x for point in curve_of(target, "Smile").keyframe_points] == [4]
    assert ours.action == theirs.action


def curve_of(obj: MeshObject, key: str) -> Any:
    """The F-curve of the value of a shape key."""
    return part("blender.animation")._curve(obj.data.shape_keys, f'key_blocks["{key}"].value')


def driven(key: Any, by: Any, path: str) -> None:
    """Makes a property drive the value of a shape key."""
    driver = key.driver_add("value").driver
    variable = driver.variables.new()
    if isinstance(by, bpy.types.Key):
        variable.targets[0].id_type = "KEY"
    variable.targets[0].id, variable.targets[0].data_path = by, path
    driver.expression = variable.name


def test_a_reopened_file_transfers_as_before(tmp_path: Path) -> None:
    """By the settings of the last registration, which the object keeps."""
    _, target = coarse_and_fine()
    target.location.z = 0.5
    random_uv(target, "Map")
    x = pairs.positions(target)[:, :2]
    meshes.set_uv(target, x[[loop.vertex_index for loop in target.data.loops]], "Map")
    bpy.ops.authalic.register(angle_weight=0.7, weight=3.0, domain="DISK")
    path = str(tmp_path / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    values = []
    for _ in range(2):
        only("uv_maps")
        values.append(meshes.uv(bpy.data.objects["Sheet"], "Map"))
        part("bridge.registrations")._registrations._found.clear()
        bpy.ops.wm.open_mainfile(filepath=path)
    np.testing.assert_array_equal(values[0], values[1])


def test_another_target_forgets_the_settings() -> None:
    source, target = copies()
    bpy.ops.authalic.register(angle_weight=0.7)
    last = part("jobs.last_registration")
    assert last.settings(source).angle_weight == pytest.approx(0.7)
    source.authalic_target = pairs.twin(target, name="Other")
    assert last.settings(source) is None


def test_morphs_between_the_two_are_left_out() -> None:
    source, target = copies()
    add_key(target, "Morph → Sheet", np.ones(3))
    add_key(target, "Smile", np.ones(3))
    only("shape_keys")
    assert [key.name for key in source.data.shape_keys.key_blocks] == ["Basis", "Smile"]


def test_everything_at_once_and_closed(capfd: pytest.CaptureFixture[str]) -> None:
    source = meshes.bumpy(meshes.cube_sphere(2))
    target = pairs.twin(source)
    while target.data.uv_layers:
        target.data.uv_layers.remove(target.data.uv_layers[0])
    pairs.pair(source, target, pairs.nearest(source, [(1, 1, 1), (-1, 1, 0), (0, -1, 0), (1, 0, -1)]))
    wanted = random_uv(target, "Map")
    add_group(target, "Group", np.full(len(target.data.vertices), 0.5))
    paint = add_colors(target, "Paint", "FLOAT_COLOR", "POINT")
    add_key(target, "Key", np.ones(3))
    assert transfer() == {"FINISHED"}
    np.testing.assert_allclose(meshes.uv(source, "Map"), wanted, atol=1e-4)
    np.testing.assert_allclose(weights(source, "Group"), 0.5, atol=1e-6)
    np.testing.assert_allclose(colors(source, "Paint"), paint, atol=1e-4)
    assert "1 UV map (Map), 1 vertex group (Group), 1 color attribute (Paint), 1 shape key (Key)" in (
        capfd.readouterr().out
    )


def test_n_gons_and_loose_vertices() -> None:
    """Polygons that are divided from their center, on both sides."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=12)
    cylinder = bpy.context.object
    faces = [list(face.vertices) for face in cylinder.data.polygons]
    target = meshes.add([*pairs.positions(cylinder), (9, 9, 9)], faces, "Twin")
    source = pairs.twin(target, name="Can")
    pairs.pair(source, target, [0, 9, 16])
    wanted = random_uv(target, "Map")
    values = np.linspace(0.1, 1, 25)
    add_group(target, "Group", values)
    add_group(source, "Group", np.full(25, 0.5))
    transfer()
    np.testing.assert_allclose(meshes.uv(source, "Map"), wanted, atol=1e-4)
    np.testing.assert_allclose(weights(source, "Group")[:24], values[:24], atol=1e-4)
    assert weights(source, "Group")[24] == 0.5


def test_what_cannot_be_written_is_named(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = copies()
    for number in range(8):
        source.data.uv_layers.new(name=f"Map {number}")
    random_uv(target, "More")
    random_uv(target, "Map 3")
    add_group(target, "Map 4", [1.0])
    assert transfer() == {"FINISHED"}
    said = capfd.readouterr().out
    assert "Warning: Transferred 1 UV map (Map 3)" in said
    assert "UV map More: Sheet has no room for more UV maps" in said
    assert "vertex group Map 4: Sheet has another attribute of this name; rename that" in said


def layers(obj: MeshObject) -> list[list[str]]:
    data = obj.data
    return [
        [layer.name for layer in kind] for kind in (data.uv_layers, obj.vertex_groups, data.color_attributes)
    ]


def test_color_and_group_of_one_name_on_the_target(capfd: pytest.CaptureFixture[str]) -> None:
    """A group may take a color attribute's name, but not the reverse: the second is refused by name."""
    source, target = copies()
    random_uv(target, "Map")
    add_colors(target, "Col", "FLOAT_COLOR", "POINT")
    add_group(target, "Col", [1.0])
    assert layers(target) == [["Map"], ["Col"], ["Col"]]
    assert transfer() == {"FINISHED"}
    assert layers(source) == [["Map"], ["Col"], []]
    said = capfd.readouterr().out
    assert "1 UV map (Map), 1 vertex group (Col) from" in said
    assert "color attribute Col: Sheet gets a vertex group of this name; rename one of them on" in said


@pytest.mark.parametrize("kind", ["FLOAT_COLOR", "BYTE_COLOR"])
def test_color_and_group_of_one_name_on_both(kind: str, capfd: pytest.CaptureFixture[str]) -> None:
    """An existing layer is overwritten, but not by one of another type."""
    source, target = copies()
    wanted = add_colors(target, "Col", "FLOAT_COLOR", "POINT")
    before = add_colors(source, "Col", kind, "POINT")
    for obj in (source, target):
        add_group(obj, "Col", [1.0])
    assert transfer() == {"FINISHED"}
    assert layers(source) == [[], ["Col"], ["Col"]]
    is_alike = kind == "FLOAT_COLOR"
    np.testing.assert_allclose(colors(source, "Col"), wanted if is_alike else before, atol=1e-5)
    assert ("color attribute Col: Sheet has another attribute" in capfd.readouterr().out) != is_alike


@pytest.mark.parametrize("kind", ["UV map", "vertex group", "color attribute"])
def test_what_blender_names_otherwise_is_left_out_whole(
    kind: str, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """If a name turns out to be taken only when a layer is added, the object keeps its layers."""
    source, target = copies()
    random_uv(target, "Map")
    if kind == "UV map":
        random_uv(target, "Col")
    if kind == "vertex group":
        add_group(target, "Col", [1.0])
    if kind == "color attribute":
        add_colors(target, "Col", "FLOAT_COLOR", "POINT")
        before = add_colors(source, "Col", "BYTE_COLOR", "CORNER")
    module = part("blender.layers")
    really = module._added

    def elsewhere(layers: Any, item: Any, **options: Any) -> Any:
        if item.name == "Col":
            layers.new(name=item.name, **options)  # takes the name
            made = really(layers, item, **options)
            layers.remove(layers[item.name])
            return made
        return really(layers, item, **options)

    monkeypatch.setattr(module, "_added", elsewhere)
    expected = layers(source)
    expected[0] = ["Map"]
    assert transfer() == {"FINISHED"}
    assert layers(source) == expected
    assert f"{kind} Col: Blender adds no layer of this name to Sheet" in capfd.readouterr().out
    if kind == "color attribute":
        assert (colors(source, "Col") == before).all()


def test_nothing_to_transfer(capfd: pytest.CaptureFixture[str]) -> None:
    source, _ = copies()
    assert transfer() == {"CANCELLED"}
    assert "Twin has no layers of the chosen kinds" in capfd.readouterr().out
    assert source.data.shape_keys is None


def test_the_registration_is_used_again(monkeypatch: pytest.MonkeyPatch) -> None:
    source, target = copies()
    random_uv(target, "Map")
    bpy.ops.authalic.register(energy="AREA", angle_weight=0.8)
    registrations, made = part("bridge.registrations"), []
    register = registrations._registered_by_points
    noted = lambda *given: made.append(given[2]) or register(*given)  # noqa: E731
    monkeypatch.setattr(registrations, "_registered_by_points", noted)
    only("uv_maps")
    only("uv_maps", energy="AREA", angle_weight=0.8)
    assert not made
    only("uv_maps", energy="AREA", angle_weight=0.4)
    assert [settings.angle_weight for settings in made] == [pytest.approx(0.4)]
    part("landmarks.points").remove(source, 0)
    only("uv_maps")
    assert len(made) == 2 and made[1].angle_weight == pytest.approx(0.4)


def test_problems_are_those_of_registration() -> None:
    source, target = copies()
    random_uv(target, "Map")
    part("landmarks.points").clear(source)
    with pytest.raises(RuntimeError, match="Sheet needs a landmark pair"):
        transfer(method="POINTS")
    source.authalic_target = None
    with pytest.raises(RuntimeError, match="there is no target object"):
        transfer()
    assert not source.data.uv_layers


def test_cancelled_writes_nothing() -> None:
    source, target = copies()
    random_uv(target, "Map")
    job = part("jobs.transfer").job(bpy.context, part("jobs.transfer").Settings()).start()
    job.cancel()
    with pytest.raises(part("jobs.job").Cancelled):
        job.apply()
    assert not source.data.uv_layers


# Smooth


def fine_and_coarse() -> tuple[MeshObject, MeshObject]:
    """A fine sphere and a coarse one as its target."""
    source, target = (meshes.bumpy(meshes.cube_sphere(level), 0) for level in (5, 3))
    source.name, target.name = "Fine", "Coarse"
    spots = [(1, 1, 1), (-1, 1, 0), (0, -1, 0), (1, 0, -1), (-1, -1, 1), (0, 0.3, 1)]
    ends = zip(pairs.nearest(source, spots), pairs.nearest(target, spots), strict=True)
    return pairs.pair(source, target, {f"Spot {number}": both for number, both in enumerate(ends)})


def roughness(obj: MeshObject, values: Array) -> float:
    """The mean square of the differences to the mean of the neighbors, over the variance."""
    ends = np.empty((len(obj.data.edges), 2), np.int32)
    obj.data.edges.foreach_get("vertices", ends.ravel())
    count = np.bincount(ends.ravel(), minlength=len(values))
    around = np.zeros(len(values))
    np.add.at(around, ends[:, 0], values[ends[:, 1]])
    np.add.at(around, ends[:, 1], values[ends[:, 0]])
    return float(np.mean((values - around / count) ** 2) / values.var())


def test_weights_of_a_coarse_mesh_have_no_facets(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = fine_and_coarse()
    z = pairs.positions(target)[:, 2]
    share = np.clip(0.5 + 0.8 * z, 0, 1)
    for name, values in (("Upper", share), ("Lower", 1 - share)):
        add_group(target, name, values)
    rough = {}
    for smooth in ("OFF", "ON", "AUTO"):
        only("vertex_groups", smooth=smooth)
        upper, lower = (np.nan_to_num(weights(source, name)) for name in ("Upper", "Lower"))
        for values in (upper, lower):
            assert values.min() >= 0 and values.max() <= 1
        np.testing.assert_allclose(upper + lower, 1, atol=1e-5)
        rough[smooth] = roughness(source, upper)
    assert rough["ON"] < 0.7 * rough["OFF"]
    assert rough["AUTO"] == rough["ON"]
    assert capfd.readouterr().out.count("by landmark points, smoothly") == 2


@pytest.mark.parametrize("domain", ["POINT", "CORNER"])
def test_colors_of_a_coarse_mesh_have_no_facets(domain: str) -> None:
    source, target = fine_and_coarse()
    attribute = target.data.color_attributes.new("Paint", "FLOAT_COLOR", domain)
    shade = 0.5 + 0.4 * np.sin(3 * pairs.positions(target))
    if domain == "CORNER":
        shade = shade[[loop.vertex_index for loop in target.data.loops]]
    values = np.column_stack([shade, np.ones(len(shade))]).astype(np.float32)
    attribute.data.foreach_set("color", values.ravel())
    rough = []
    for smooth in ("OFF", "ON"):
        only("colour_attributes", smooth=smooth)
        painted = colors(source, "Paint")
        assert (painted.min(axis=0) >= values.min(axis=0) - 1e-6).all()
        assert (painted.max(axis=0) <= values.max(axis=0) + 1e-6).all()
        if domain == "CORNER":
            vertex = [loop.vertex_index for loop in source.data.loops]
            by_vertex = np.empty((len(source.data.vertices), 4))
            by_vertex[vertex] = painted
            np.testing.assert_allclose(by_vertex[vertex], painted, atol=1e-5)
            painted = by_vertex
        rough.append(roughness(source, painted[:, 2].astype(float)))
    assert rough[1] < 0.7 * rough[0]


def test_bones_share_out_weights_beside_other_groups() -> None:
    """The sums of the groups of bones stay, whatever a mask does."""
    source, target = fine_and_coarse()
    data = bpy.data.armatures.new("Rig")
    rig = bpy.data.objects.new("Rig", data)
    bpy.context.collection.objects.link(rig)
    meshes.select(rig)
    bpy.ops.object.mode_set(mode="EDIT")
    for name in ("Upper", "Lower"):
        data.edit_bones.new(name).tail = (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    target.modifiers.new("Rig", "ARMATURE").object = rig
    meshes.select(source)
    z = pairs.positions(target)[:, 2]
    share = np.clip(0.5 + 2 * z, 0, 1)
    for name, values in (("Upper", share), ("Lower", 1 - share), ("Mask", (z > 0.2).astype(float))):
        add_group(target, name, values)
    only("vertex_groups")
    upper, lower, mask = (np.nan_to_num(weights(source, name)) for name in ("Upper", "Lower", "Mask"))
    np.testing.assert_allclose(upper + lower, 1, atol=1e-5)
    assert mask.min() >= 0 and mask.max() == pytest.approx(1)


def test_a_mesh_that_is_as_fine_is_taken_as_it_is(capfd: pytest.CaptureFixture[str]) -> None:
    _, target = copies()
    add_group(target, "Group", [0.5])
    only("vertex_groups")
    assert "smoothly" not in capfd.readouterr().out


def test_pieces_that_are_not_matched_are_named(capfd: pytest.CaptureFixture[str]) -> None:
    target = bases.scan()
    body, pieces = bases.base()
    pairs.pair(body, target, bases.landmarks(body, target, pieces[0]))
    add_group(target, "Front", (pairs.positions(target)[:, 0] > 0).astype(float))
    add_key(target, "Taller", pairs.positions(target) * 0.1)
    add_group(body, "Front", np.full(len(body.data.vertices), 0.25))
    assert transfer() == {"FINISHED"}
    assert "3 other pieces of Body got nothing" in capfd.readouterr().out
    for piece in pieces[1:]:
        np.testing.assert_array_equal(weights(body, "Front")[piece], 0.25)
        np.testing.assert_array_equal(pairs.positions(body, "Taller")[piece], pairs.positions(body)[piece])
    moved = np.linalg.norm(pairs.positions(body, "Taller") - pairs.positions(body), axis=1)
    assert moved[pieces[0]].min() > 0.01


# Several objects


def flock() -> tuple[list[MeshObject], MeshObject]:
    """Three sheets with the same target, all selected, the first one active."""
    first, target = copies()
    others = [pairs.twin(first, Matrix.Translation((4 * n, 0, 0)), f"Sheet {n}") for n in (2, 3)]
    marks = pairs.nearest(first, [(0.4, 0.4, 0), (-0.4, 0, 0), (0.1, -0.6, 0)])
    for obj in others:
        pairs.pair(obj, target, marks)
    meshes.select(first)
    for obj in others:
        obj.select_set(True)
    return [first, *others], target


@pytest.mark.parametrize("target_is_active", [False, True])
def test_all_selected_objects_with_the_target_get_its_layers(
    target_is_active: bool, capfd: pytest.CaptureFixture[str]
) -> None:
    sources, target = flock()
    bystander = meshes.add_grid("Bystander", n=3)
    first = target if target_is_active else sources[0]
    meshes.select(first, *sources, target, bystander)
    wanted = random_uv(target, "Map")
    add_key(target, "Smile", np.full(3, 0.25))
    assert transfer() == {"FINISHED"}
    for obj in sources:
        np.testing.assert_allclose(meshes.uv(obj, "Map"), wanted, atol=1e-4)
        rise = pairs.positions(obj, "Smile") - pairs.positions(obj)
        np.testing.assert_allclose(rise, 0.25, atol=0.02)
    assert bystander.data.shape_keys is None
    said = capfd.readouterr().out
    for obj in sources:
        assert f"(Smile) from Twin to {obj.name} by landmark points" in said


def test_one_object_that_cannot_does_not_stop_the_others(capfd: pytest.CaptureFixture[str]) -> None:
    sources, target = flock()
    part("landmarks.points").clear(sources[1])
    random_uv(target, "Map")
    assert transfer(method="POINTS") == {"FINISHED"}
    assert [bool(obj.data.uv_layers) for obj in sources] == [True, False, True]
    said = capfd.readouterr().out
    assert "Warning: Transfer from Target: Sheet 2 needs a landmark pair" in said
    for obj in (sources[0], sources[2]):
        part("landmarks.points").clear(obj)
    with pytest.raises(RuntimeError, match=r"Sheet needs a landmark pair.*; Sheet 2 needs"):
        transfer(method="POINTS")


def test_without_landmarks_they_are_asked_for() -> None:
    """Also where one of the two is open, as boundaries alone would tell where both were."""
    source, target = meshes.add_grid("Sheet", n=8), meshes.icosphere(2)
    source.authalic_target = target
    add_group(target, "Top", np.ones(len(target.data.vertices)))
    meshes.select(source)
    with pytest.raises(RuntimeError, match="Sheet needs at least two landmark pairs"):
        transfer()


def test_several_objects_are_one_step_of_undo() -> None:
    _, target = flock()
    random_uv(target, "Map")
    bpy.ops.ed.undo_push(message="Start")
    bpy.ops.authalic.transfer("EXEC_DEFAULT", True)
    names = ("Sheet", "Sheet 2", "Sheet 3")
    assert all(bpy.data.objects[name].data.uv_layers for name in names)
    bpy.ops.ed.undo()
    assert not any(bpy.data.objects[name].data.uv_layers for name in names)


def test_objects_that_share_a_mesh_get_layers_once(capfd: pytest.CaptureFixture[str]) -> None:
    sources, target = flock()
    sources[1].data = sources[0].data
    random_uv(target, "Map")
    transfer()
    said = capfd.readouterr().out
    assert said.count("Transferred") == 2 and "to Sheet 2" not in said


def test_undo() -> None:
    source, target = copies()
    random_uv(target, "Map")
    before = random_uv(source, "Map", 9)
    add_group(target, "Group", [1.0])
    bpy.ops.ed.undo_push(message="Start")
    bpy.ops.authalic.transfer("EXEC_DEFAULT", True)
    assert "Group" in source.vertex_groups
    bpy.ops.ed.undo()
    source = bpy.data.objects["Sheet"]
    assert not source.vertex_groups
    assert (meshes.uv(source, "Map") == before.astype(np.float32)).all()
