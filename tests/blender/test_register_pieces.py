# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.register on meshes of several pieces and with masks: what is matched, and what follows."""

from typing import Any

import bases
import bpy
import meshes
import numpy as np
import pairs
import pytest
import spheres
from installed import part
from mathutils import Vector
from mathutils.bvhtree import BVHTree
from meshes import MeshObject
from pairs import TILTED

KEY = "Morph → Twin"
ONTO_SCAN = "Morph → Scan"


def register(**options: Any) -> set[str]:
    return bpy.ops.authalic.register(**options)


def refusal(pattern: str, **options: Any) -> None:
    with pytest.raises(RuntimeError, match=pattern):
        register(**options)
    assert bpy.context.object.data.shape_keys is None


def figure(holes: bool = False) -> tuple[MeshObject, MeshObject, list[slice]]:
    """A base mesh of four pieces with landmarks on a scan, and the vertices of the pieces."""
    target = bases.scan()
    body, pieces = bases.base(holes)
    pairs.pair(body, target, bases.landmarks(body, target, pieces[0]))
    return body, target, pieces


def moons(radius: float = 0.2) -> tuple[MeshObject, MeshObject]:
    """A bumpy ball with small ones inside and outside, and a moved copy; the landmarks are on the first."""
    ball = meshes.bumpy(meshes.icosphere(3))
    meshes.join(ball, *(_ball(radius, place) for place in ((0.2, 0.1, 0.3), (1.8, 0, 0))))
    corners = [(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0), (0, 0, 1)]
    return pairs.pair(ball, pairs.twin(ball, TILTED), pairs.nearest(ball, corners))


def _ball(radius: float, place: tuple[float, ...]) -> MeshObject:
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=radius, location=place)
    bpy.ops.object.transform_apply()
    return bpy.context.object


@pytest.mark.parametrize("holes", [False, True])
def test_a_base_mesh_of_four_pieces_is_wrapped_onto_a_scan(
    holes: bool, capfd: pytest.CaptureFixture[str]
) -> None:
    body, target, pieces = figure(holes)
    before = pairs.positions(body)
    bpy.ops.ed.undo_push(message="Start")
    assert register() == {"FINISHED"}
    followers = len(before) - pieces[0].stop
    said = capfd.readouterr().out
    assert f"3 other pieces of Body followed ({followers} vertices)" in said and said.startswith("Info: ")
    assert ("4 holes of Body were filled for the map" in said) == holes
    after = pairs.positions(body, ONTO_SCAN)
    assert np.isfinite(after).all() and (pairs.positions(body) == before).all()
    size = pairs.size(pairs.positions(target))
    tree = BVHTree.FromObject(target, bpy.context.evaluated_depsgraph_get())
    assert max(tree.find_nearest(Vector(point))[3] for point in after[pieces[0]]) < 1e-5 * size
    for eye, where in zip(bases.EYES, pieces[1:3], strict=True):
        center, radius, apart = bases.best_ball(after[where])
        assert apart < 1e-4
        assert radius == pytest.approx(2.5 * bases.EYE_RADIUS, rel=0.3)
        assert np.linalg.norm(center - bases.bent(bases.eye_center(eye)[None])[0]) < 0.05 * size
    inside = after[pieces[0].stop :]
    assert (bases.windings(inside, target) > 0.9).all()
    bpy.ops.ed.undo_push(message="Wrap")
    bpy.ops.ed.undo()
    body = bpy.data.objects["Body"]
    assert body.data.shape_keys is None and (pairs.positions(body) == before).all()


@pytest.mark.parametrize("align", [False, True])
def test_pieces_of_a_copy_are_found_again(align: bool, capfd: pytest.CaptureFixture[str]) -> None:
    source, target = moons()
    before = pairs.positions(source)
    assert register(align=align) == {"FINISHED"}
    expected = before if align else pairs.moved(pairs.positions(target), target.matrix_world)
    np.testing.assert_allclose(pairs.positions(source, KEY), expected, atol=1e-5 * pairs.size(expected))
    said = capfd.readouterr().out
    assert "2 other pieces of Icosphere followed (84 vertices)" in said
    assert "2 other pieces of Twin left out (84 vertices)" in said


def test_the_piece_with_the_landmarks_is_matched_though_another_is_larger() -> None:
    small, large = spheres.icosphere(2), spheres.icosphere(2)
    vertices, faces = meshes.together((large[0] * 3, large[1]), (small[0] + [7, 0, 0], small[1]))
    source = meshes.add(vertices, faces, "Two")
    target = meshes.add(small[0] * 2, small[1], "Twin")
    count = len(small[0])
    pairs.pair(source, target, {str(k): (count + k, k) for k in (0, 3, 50, 90)})
    assert register() == {"FINISHED"}
    expected = (vertices - [7, 0, 0]) * 2
    np.testing.assert_allclose(pairs.positions(source, KEY), expected, atol=1e-4)


def test_a_kept_registration_moves_pieces_as_they_are_now() -> None:
    source, target = moons()
    register()
    first = pairs.positions(source, KEY)
    moved = np.array([vertex.co for vertex in source.data.vertices])
    moved[-42:, 2] += 0.5
    source.data.shape_keys.key_blocks[0].points.foreach_set("co", moved.astype(np.float32).ravel())
    source.data.vertices.foreach_set("co", moved.astype(np.float32).ravel())
    register()
    second = pairs.positions(source, KEY)
    np.testing.assert_allclose(second[:-42], first[:-42], atol=1e-6)
    shift = np.array(target.matrix_world.to_3x3()) @ [0, 0, 0.5]
    np.testing.assert_allclose(second[-42:] - first[-42:], np.broadcast_to(shift, (42, 3)), atol=1e-4)


def test_landmarks_on_two_pieces_are_refused_by_name() -> None:
    source, _ = moons()
    part("landmarks.points").add(source, len(source.data.vertices) - 1, 7, "Moon")
    refusal('Landmark "Moon" is on another piece of Icosphere than most')


def test_a_piece_with_a_bad_coordinate_is_refused() -> None:
    source, _ = moons()
    source.data.vertices[-1].co.x = float("nan")
    refusal(rf"Icosphere: NaN or infinite coordinates at vertex {len(source.data.vertices) - 1}")


def test_large_pieces_bend_with_the_body() -> None:
    """A shell around a body that becomes longer; an ellipsoid is not similar to a ball."""
    ball = spheres.icosphere(3)
    shell = (ball[0] * 1.05, ball[1])
    source = meshes.add(*meshes.together(ball, shell), "Dressed")
    target = meshes.add(ball[0] * [1, 1, 1.5], ball[1], "Twin")
    tips = pairs.nearest(target, np.concatenate([np.eye(3), -np.eye(3)]) * [1, 1, 1.5])
    pairs.pair(source, target, tips)
    assert register() == {"FINISHED"}
    body, dress = np.split(pairs.positions(source, KEY), 2)
    gaps = np.linalg.norm(dress - body, axis=1)
    assert gaps.min() > 0.02 and gaps.max() < 0.12
    assert (bases.windings(dress, target) < 0.1).all()


@pytest.mark.parametrize(("followers", "is_round"), [("AUTO", True), ("RIGID", True), ("BEND", False)])
def test_pieces_bend_or_keep_their_shapes(followers: str, is_round: bool) -> None:
    """A small ball in one that becomes an ellipsoid."""
    ball = spheres.icosphere(3)
    small = spheres.icosphere(1)
    source = meshes.add(*meshes.together(ball, (small[0] * 0.2, small[1])), "Two")
    target = meshes.add(ball[0] * [1, 1, 1.5], ball[1], "Twin")
    pairs.pair(source, target, pairs.nearest(target, np.concatenate([np.eye(3), -np.eye(3)]) * [1, 1, 1.5]))
    assert register(followers=followers) == {"FINISHED"}
    apart = bases.best_ball(pairs.positions(source, KEY)[len(ball[0]) :])[2]
    assert (apart < 1e-5) == is_round


def masked(obj: MeshObject, vertices: Any, name: str = "Mask", weight: float = 1.0) -> None:
    group = obj.vertex_groups.new(name=name)
    group.add([int(vertex) for vertex in vertices], weight, "REPLACE")
    obj.authalic_mask = name


def cap(obj: MeshObject, height: float = 0.75) -> Any:
    return np.flatnonzero(pairs.positions(obj)[:, 2] > height)


def balls() -> tuple[MeshObject, MeshObject]:
    ball = meshes.icosphere(3)
    corners = [(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0), (0, 0, -1)]
    return pairs.pair(ball, pairs.twin(ball, TILTED), pairs.nearest(ball, corners))


def test_masks_on_both_are_left_out_and_follow(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = balls()
    ends = cap(source)
    for obj in (source, target):
        masked(obj, ends)
    # what is masked has no say
    for vertex in ends:
        target.data.vertices[vertex].co *= 1.5
    assert register() == {"FINISHED"}
    expected = pairs.moved(pairs.positions(source), target.matrix_world)
    np.testing.assert_allclose(pairs.positions(source, KEY), expected, atol=1e-4 * pairs.size(expected))
    said = capfd.readouterr().out
    assert f"{len(ends)} masked vertices of Icosphere followed" in said
    assert f"{len(ends)} masked vertices of Twin left out" in said


def test_light_weights_are_no_mask(capfd: pytest.CaptureFixture[str]) -> None:
    source, _ = balls()
    masked(source, cap(source), weight=0.49)
    assert register() == {"FINISHED"}
    assert "masked" not in capfd.readouterr().out


def test_a_mask_on_the_source_alone(capfd: pytest.CaptureFixture[str]) -> None:
    """Its hole is filled for the map onto the closed target."""
    source, target = balls()
    masked(source, cap(source, 0.9))
    assert register() == {"FINISHED"}
    assert "1 hole of Icosphere was filled for the map" in capfd.readouterr().out
    after = pairs.positions(source, KEY)
    expected = pairs.moved(pairs.positions(source), target.matrix_world)
    assert np.isfinite(after).all()
    assert np.linalg.norm(after - expected, axis=1).max() < 0.3 * pairs.size(expected)


def test_a_landmark_on_the_mask_is_refused() -> None:
    source, target = balls()
    for obj in (source, target):
        masked(obj, [source.authalic_landmarks[0].source_vertex])
    refusal('Landmark "Landmark 1" is on masked vertices of Icosphere; move it')


def test_a_mask_over_all_is_refused() -> None:
    source, _ = balls()
    masked(source, range(len(source.data.vertices)))
    refusal("Icosphere has no faces without masked vertices; paint a smaller mask")


def test_a_mask_whose_group_is_gone_is_refused() -> None:
    _, target = balls()
    masked(target, [0])
    target.vertex_groups.clear()
    refusal('Twin has no vertex group "Mask"; choose its mask again')


def test_a_transfer_goes_to_the_matched_piece_alone() -> None:
    source, target = moons()
    count = len(source.data.vertices)
    group = target.vertex_groups.new(name="Height")
    heights = pairs.positions(target)[:, 2]
    for vertex, height in enumerate(heights.tolist()):
        group.add([vertex], 0.5 + 0.2 * height, "REPLACE")
    vertices = np.array([loop.vertex_index for loop in target.data.loops])
    uv = pairs.positions(target)[vertices, :2]
    target.data.uv_layers.new(name="Map")
    meshes.set_uv(target, uv, "Map")
    assert bpy.ops.authalic.transfer() == {"FINISHED"}
    weights = part("blender.vertex_groups").weights(source, "Height")
    np.testing.assert_allclose(weights[:-84], 0.5 + 0.2 * heights[:-84], atol=1e-3)
    assert (weights[-84:] == 0).all() and len(weights) == count
    corners = vertices < count - 84
    np.testing.assert_allclose(meshes.uv(source, "Map")[corners], uv[corners], atol=1e-3)


def test_suzanne_with_eyes_is_wrapped_onto_one_without(capfd: pytest.CaptureFixture[str]) -> None:
    """Her sockets are open; those of the target are closed by n-gons."""
    target = meshes.closed_suzanne(1)
    target.name = "Twin"
    target.matrix_world = TILTED
    source = meshes.suzanne(1)
    source.name = "Monkey"
    points = pairs.positions(target)
    away = (
        np.linalg.norm(np.abs(points) - [0.35, 0.7, 0.25], axis=1) > 0.4
    )  # from eyes, and their mirror images
    chosen = np.flatnonzero(away)[::120]
    ends = zip(pairs.nearest(source, points[chosen]), chosen.tolist(), strict=True)
    pairs.pair(source, target, {str(number): both for number, both in enumerate(ends)})
    assert register() == {"FINISHED"}
    said = capfd.readouterr().out
    assert "2 other pieces of Monkey followed" in said and "2 holes of Monkey were filled" in said
    after = pairs.positions(source, KEY)
    expected = pairs.moved(pairs.positions(source), TILTED)
    assert np.isfinite(after).all()
    assert np.median(np.linalg.norm(after - expected, axis=1)) < 0.05 * pairs.size(expected)
