# SPDX-License-Identifier: GPL-3.0-or-later
"""The heat map: what it draws, where, in which colors, and that it follows the meshes."""

import time
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
from installed import part
from meshes import Array, MeshObject

GRAY, BLUE, RED = (0.55, 0.55, 0.55), (0.1, 0.35, 1.0), (0.95, 0.25, 0.1)


def settings() -> Any:
    return bpy.context.window_manager.authalic_heat_map


def settle() -> None:
    """What the timer does in a window."""
    operator = part("operators.heat_map")
    bpy.context.view_layer.update()
    for _ in range(400):
        operator.tick(bpy.context)
        if operator.is_settled(bpy.context):
            return
        time.sleep(0.01)
    raise AssertionError("the heat map does not settle")


def drawn() -> list[Any]:
    settle()
    return part("overlay.heat_map").shown()


def show(*objects: MeshObject, **options: Any) -> list[Any]:
    meshes.select(*objects)
    for name, value in ({"show": True, "quantity": "AREA", "area_end": 2.0} | options).items():
        setattr(settings(), name, value)
    return drawn()


@pytest.fixture(autouse=True)
def hidden_again() -> Any:
    yield
    settings().show = False
    part("operators.heat_map").tick(bpy.context)


def strips(shares: Array) -> MeshObject:
    """Unit quads in a row, whose UV areas are in proportion to `shares`, each quad an island of its own."""
    count = len(shares)
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    vertices = np.concatenate([np.c_[corners + np.array([2 * k, 0]), np.zeros(4)] for k in range(count)])
    obj = meshes.add(vertices, np.arange(4 * count).reshape(-1, 4))
    obj.data.uv_layers.new(name="UVMap")
    sides = np.sqrt(shares)
    meshes.set_uv(obj, np.concatenate([corners * side + (3 * k, 0) for k, side in enumerate(sides)]))
    return obj


def face_colors(painted: Any, faces: int) -> Array:
    """The color of each of some quads, of which every corner must have the same one."""
    colors = painted.colors.reshape(faces, 6, 4)
    assert (colors == colors[:, :1]).all()
    return colors[:, 0]


def test_colors_of_areas() -> None:
    shares = np.array([0.2, 0.5, 1.0, 2.0, 1.3]) / 1.0
    obj = strips(shares / shares.mean())
    (layer,) = show(obj, opacity=0.5)
    octaves = np.clip(np.log2(shares / shares.mean()), -1, 1)[:, None]
    end = np.where(octaves > 0, RED, BLUE)
    expected = GRAY + (np.array(end) - GRAY) * np.abs(octaves)
    for painted in (layer.in_space, layer.in_plane):
        np.testing.assert_allclose(face_colors(painted, 5)[:, :3], expected, atol=1e-5)
        assert (painted.colors[:, 3] == 0.5).all()
    corner = [loop.vertex_index for loop in obj.data.loops]
    order = meshes.triangles(obj)[0].ravel()
    positions = np.array([vertex.co for vertex in obj.data.vertices])[corner]
    np.testing.assert_array_equal(layer.in_space.points, positions[order].astype(np.float32))
    np.testing.assert_array_equal(layer.in_plane.points[:, :2], meshes.uv(obj)[order])
    settings().area_end = 16.0
    (wider,) = drawn()
    amount = np.abs(np.log2(shares / shares.mean()))[:, None] / 4
    expected = GRAY + (np.array(end) - GRAY) * amount
    np.testing.assert_allclose(face_colors(wider.in_space, 5)[:, :3], expected, atol=1e-5)


def test_colors_of_shear_and_the_legend() -> None:
    obj = strips(np.ones(2))
    uv = meshes.uv(obj)
    uv[4:] *= (2, 1)
    meshes.set_uv(obj, uv)
    (layer,) = show(obj, quantity="SHEAR", shear_end=3.0)
    colors = face_colors(layer.in_space, 2)
    np.testing.assert_allclose(colors[0, :3], GRAY, atol=1e-6)
    np.testing.assert_allclose(colors[1, :3], (np.array(GRAY) + RED) / 2, atol=1e-6)
    overlay = part("overlay.heat_map")
    assert overlay.legend().ticks() == [(0.0, "1"), (0.5, "2"), (1.0, "3")]
    settings().quantity = "AREA"
    drawn()
    assert [text for _, text in overlay.legend().ticks()] == ["0.5", "0.707", "1", "1.41", "2"]
    settings().legend = False
    assert overlay.legend() is None
    settings().legend = True


def test_flipped_faces_have_stripes_and_lie_on_top() -> None:
    obj = meshes.add_grid(bump=0)
    uv_of_plan(obj)
    corner = np.array([loop.vertex_index for loop in obj.data.loops])
    uv = meshes.uv(obj)
    uv[corner == 8] = (1.2, 1.2)
    meshes.set_uv(obj, uv)
    (layer,) = show(obj)
    corners, polygons, _ = meshes.triangles(obj)
    is_flipped = np.isin(polygons, polygons[meshes.uv_areas(uv[corners]) < 0])
    plain = 3 * np.count_nonzero(~is_flipped)
    stripes = np.unique(layer.in_space.colors[plain:, :3], axis=0)
    assert (
        len(stripes) == 2 and not (stripes[:, None] == layer.in_space.colors[None, :plain, :3]).all(-1).any()
    )
    # the stripes cover their triangles once
    for painted, points in ((layer.in_plane, uv[corners[is_flipped]]),):
        image = painted.points[plain:, :2].reshape(-1, 3, 2)
        total = np.abs(meshes.uv_areas(image)).sum()
        assert total == pytest.approx(np.abs(meshes.uv_areas(points)).sum(), rel=1e-5)


def uv_of_plan(obj: MeshObject) -> None:
    """UVs as seen from above."""
    obj.data.uv_layers.new(name="UVMap")
    corner = [loop.vertex_index for loop in obj.data.loops]
    flat = np.array([obj.data.vertices[vertex].co.xy for vertex in corner])
    meshes.set_uv(obj, flat / 2 + 0.5)


def test_it_follows_uvs_selection_and_undo() -> None:
    obj, other = meshes.add_grid("First"), meshes.add_grid("Second", offset=(3, 0, 0))
    uv_of_plan(obj)
    uv_of_plan(other)
    assert [layer.object_name for layer in show(obj, other)] == ["First", "Second"]
    bpy.ops.ed.undo_push(message="before")
    meshes.select(obj)
    (layer,) = drawn()
    before = layer.in_space.colors.copy()
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}
    (layer,) = drawn()
    assert np.abs(layer.in_space.colors - before).max() > 0.01
    assert np.abs(layer.in_space.colors[:, :3] - GRAY).max() < 0.02  # even
    bpy.ops.ed.undo_push(message="unwrapped")
    bpy.ops.ed.undo()
    meshes.select(bpy.data.objects["First"])
    (layer,) = drawn()
    np.testing.assert_array_equal(layer.in_space.colors, before)
    meshes.select(bpy.data.objects["Second"])
    assert [layer.object_name for layer in drawn()] == ["Second"]
    bpy.data.objects.remove(bpy.data.objects["Second"])
    assert drawn() == []


def test_it_lies_where_modifiers_and_shape_keys_move_the_mesh() -> None:
    obj = meshes.add_grid()
    uv_of_plan(obj)
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Up")
    for point in key.data:
        point.co.z += 5
    key.value = 1.0
    (layer,) = show(obj)
    assert layer.in_space.points[:, 2].min() == pytest.approx(5, abs=0.05)
    bent = obj.modifiers.new("Displace", "DISPLACE")
    bent.direction, bent.strength, bent.mid_level = "X", 2.0, 0.0
    (layer,) = drawn()
    assert layer.in_space.points[:, 0].min() == pytest.approx(1, abs=1e-5)
    assert len(layer.in_space.points) == 6 * 36


def test_it_covers_what_modifiers_add() -> None:
    obj = meshes.add_grid()
    uv_of_plan(obj)
    obj.modifiers.new("Subdivision", "SUBSURF").levels = 2
    (layer,) = show(obj)
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert len(layer.in_space.points) == 6 * len(shown.polygons) == 6 * 36 * 16
    assert len(layer.in_plane.points) == 6 * 36
    places = {tuple(vertex.co) for vertex in shown.vertices}
    assert {tuple(point) for point in layer.in_space.points.tolist()} <= places


def test_edit_mode_shows_the_edited_mesh_without_hidden_faces() -> None:
    obj = meshes.add_grid()
    uv_of_plan(obj)
    (before,) = show(obj)
    meshes.edit(obj)
    (layer,) = drawn()
    np.testing.assert_array_equal(layer.in_space.colors, before.in_space.colors)
    meshes.select_faces(obj, lambda face: face == 0, hidden=range(30, 36))
    bpy.ops.transform.translate(value=(0, 0, 1))
    (layer,) = drawn()
    assert len(layer.in_space.points) == 6 * 30
    assert layer.in_space.points[:, 2].max() > 0.9
    meshes_before = len(bpy.data.meshes)
    for _ in range(3):
        settle()
        assert part("operators.heat_map").is_settled(bpy.context)  # reading is no change
    assert len(bpy.data.meshes) == meshes_before
    bpy.ops.mesh.reveal()
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.delete(type="ONLY_FACE")
    assert drawn() == []


def test_density_and_scale_count() -> None:
    obj = strips(np.array([1.0, 8.0]))
    obj.vertex_groups.new(name="Detail").add([4, 5, 6, 7], 1.0, "REPLACE")
    (layer,) = show(obj, density_source="Detail")
    np.testing.assert_allclose(layer.in_space.colors[:, :3], np.full((12, 3), 0.55), atol=1e-5)
    settings().density_source = ""
    (layer,) = drawn()
    assert np.abs(layer.in_space.colors[:, :3] - 0.55).max() > 0.3
    grid = meshes.seam_sphere()
    (layer,) = show(grid)
    before = layer.in_space.colors.copy()
    grid.scale = (1, 1, 4)
    (layer,) = drawn()
    assert np.abs(layer.in_space.colors - before).max() > 0.1


def test_meshes_without_uvs_and_uvs_in_a_point() -> None:
    obj = meshes.add_grid()
    assert show(obj) == []
    obj.data.uv_layers.new(name="UVMap")
    meshes.set_uv(obj, np.zeros((len(obj.data.loops), 2)))
    obj.data.update()
    assert drawn() == []
    uv = np.zeros((len(obj.data.loops), 2))
    uv[:4] = [(0, 0), (1, 0), (1, np.nan), (0, 1)]
    meshes.set_uv(obj, uv)
    obj.data.update()
    drawn()


def test_figures_follow_the_heat_map() -> None:
    obj = meshes.add_grid("Camel")
    uv_of_plan(obj)
    show(obj)
    operator = part("operators.heat_map")
    assert operator.current(bpy.context).sentence.startswith("Camel: ")
    obj.data.uv_layers.active.data[0].uv = (0.3, 0.3)
    bpy.context.view_layer.update()
    assert operator.current(bpy.context) is None
    drawn()
    assert operator.current(bpy.context) is not None
    settings().show = False
    assert not operator.tick(bpy.context)
    assert part("overlay.heat_map").shown() == [] and operator.current(bpy.context) is None


def test_the_operator_toggles() -> None:
    obj = meshes.add_grid()
    assert not bpy.ops.authalic.show_heat_map.poll()
    uv_of_plan(obj)
    assert bpy.ops.authalic.show_heat_map() == {"FINISHED"} and settings().show
    bpy.ops.object.select_all(action="DESELECT")
    assert bpy.ops.authalic.show_heat_map() == {"FINISHED"} and not settings().show


def test_a_million_triangles_take_the_main_thread_little() -> None:
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=707, y_subdivisions=707)
    bpy.context.view_layer.update()
    jobs = part("jobs.heat_map")
    began = time.thread_time()
    jobs.job(bpy.context)
    assert time.thread_time() - began < 1  # .15 s on a fast machine; other programs do not count
