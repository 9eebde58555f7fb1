# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.unwrap in object mode: its UVs, measured by numpy alone."""

from collections.abc import Sequence
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
from meshes import MeshObject


def unwrap(**options: Any) -> set[str]:
    return bpy.ops.authalic.unwrap(**options)


def assert_sound(obj: MeshObject, deviation: float = 0.1, layer: str | None = None) -> None:
    """UVs in the unit square, without flips, with areas as even as a coarse mesh allows."""
    uv, ratios = meshes.uv(obj, layer), meshes.area_ratios(obj, layer)
    assert np.isfinite(uv).all() and uv.min() >= 0 and uv.max() <= 1
    assert (ratios > 0).all()
    assert ratios.std() <= deviation


def assert_no_overlap(*objects: MeshObject, resolution: int = 512) -> None:
    """No pixel center of the unit square lies strictly inside triangles of two islands."""
    covered = np.zeros((resolution, resolution), int)
    for obj in objects:
        corners, _, _ = meshes.triangles(obj)
        image, label = meshes.uv(obj)[corners].astype(float), meshes.islands(obj)
        for island in range(label.max() + 1):
            covered += meshes.coverage(image[label == island], resolution) > 0
    assert covered.max() == 1


def test_suzanne_reaches_the_bar() -> None:
    obj = meshes.suzanne()
    assert unwrap() == {"FINISHED"}
    assert_sound(obj, deviation=0.03)
    assert meshes.islands(obj).max() == 2
    density = meshes.densities(obj)
    assert density.max() / density.min() == pytest.approx(1, abs=1e-4)
    assert_no_overlap(obj)


def test_seam_cut_sphere() -> None:
    obj = meshes.seam_sphere()
    assert unwrap() == {"FINISHED"}
    assert_sound(obj)
    assert meshes.islands(obj).max() == 0


@pytest.mark.parametrize("fill", ["NOTHING", "NGON", "TRIFAN"])
def test_ngons_and_fans(fill: Any) -> None:
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, end_fill_type=fill)
    obj = bpy.context.object
    edge: Any
    for edge in obj.data.edges:  # the rims, and one line down the side
        z = [obj.data.vertices[vertex].co.z for vertex in edge.vertices]
        vertical = z[0] * z[1] < 0
        rim = not vertical and all(np.hypot(*obj.data.vertices[v].co.xy) > 0.5 for v in edge.vertices)
        edge.use_seam = rim or (vertical and obj.data.vertices[edge.vertices[0]].co.y > 0.999)
    assert unwrap() == {"FINISHED"}
    assert_sound(obj, deviation=0.2)
    density = meshes.densities(obj)
    assert len(density) == (1 if fill == "NOTHING" else 3)
    assert density.max() / density.min() == pytest.approx(1, abs=1e-4)
    assert_no_overlap(obj)


def test_ngon_with_corners_in_a_line() -> None:
    outline = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0), (3, 1, 0), (2, 1, 0), (0, 1, 0)]
    obj = meshes.add([*outline, (0, 2, 0), (3, 2, 0)], [range(7), [6, 5, 4, 8, 7]])
    assert unwrap() == {"FINISHED"}
    uv = meshes.uv(obj)
    assert len(np.unique(uv, axis=0)) == 9 and meshes.uv_areas(uv[None, :7]).item() > 0


def test_quads_that_share_a_diagonal_stay_whole() -> None:
    # Two quads with two common edges: if split in one way, their diagonals coincide.
    vertices = [(0, 0, 0), (1, -1, 0.2), (2, 0, 0), (1, 0.3, 0), (1, 1, 0.2)]
    obj = meshes.add(vertices, [[0, 1, 2, 3], [0, 3, 2, 4]])
    assert unwrap() == {"FINISHED"}
    assert len(np.unique(meshes.uv(obj), axis=0)) == 5


def test_a_bow_of_quads_over_one_diagonal() -> None:
    # Both quads can only be split along 0-2, which is also an edge of the triangle.
    vertices = [(0, 0, 0), (1, -1, 0), (2, 0, 0), (1, -0.1, 0), (1, 1, 0)]
    obj = meshes.add(vertices, [[0, 1, 2, 3], [0, 3, 2, 4]])
    assert unwrap() == {"FINISHED"}
    corner = [loop.vertex_index for loop in obj.data.loops]
    uv = meshes.uv(obj)
    for vertex in range(5):
        assert len({tuple(uv[i]) for i in range(8) if corner[i] == vertex}) == 1


def test_one_density_over_objects_in_the_world() -> None:
    first, second = meshes.add_grid("First"), meshes.add_grid("Second", n=5, bump=0.3, offset=(4, 0, 0))
    second.scale = (3, 3, 3)
    bpy.context.view_layer.update()
    meshes.select(first, second)
    assert unwrap() == {"FINISHED"}
    density = meshes.densities(first, second)
    assert density[0] == pytest.approx(density[1], rel=1e-4)
    assert_no_overlap(first, second)


def test_shared_mesh_is_unwrapped_once() -> None:
    first = meshes.add_grid()
    second = bpy.data.objects.new("Second", first.data)
    bpy.context.collection.objects.link(second)
    meshes.select(first, second)
    assert unwrap() == {"FINISHED"}
    uv = meshes.uv(first)
    # One island alone: a disk that fills the square.
    assert np.ptp(uv, axis=0).min() > 0.95


@pytest.mark.parametrize("scale", [(-1, 1, 1), (-2, -2, -2)])
def test_mirrored_object_is_not_flipped(scale: Sequence[float]) -> None:
    obj = meshes.add_grid()
    obj.scale = scale
    bpy.context.view_layer.update()
    assert unwrap() == {"FINISHED"}
    assert_sound(obj)


def test_new_layer_is_added_and_active() -> None:
    obj = meshes.add_grid()
    obj.data.uv_layers.new(name="Old")
    before = meshes.uv(obj, "Old")
    assert unwrap(uv_layer="New") == {"FINISHED"}
    assert [layer.name for layer in obj.data.uv_layers] == ["Old", "New"]
    assert obj.data.uv_layers.active.name == "New"
    assert [layer.active_render for layer in obj.data.uv_layers] == [True, False]
    assert (meshes.uv(obj, "Old") == before).all()
    assert_sound(obj, layer="New")


def test_named_layer_is_written_again() -> None:
    obj = meshes.add_grid()
    for name in ("First", "Second"):
        obj.data.uv_layers.new(name=name)
    before = meshes.uv(obj, "First")
    assert unwrap(uv_layer="Second") == {"FINISHED"}
    assert len(obj.data.uv_layers) == 2 and (meshes.uv(obj, "First") == before).all()
    assert_sound(obj, layer="Second")


def test_layer_is_added_where_there_is_none() -> None:
    obj = meshes.add_grid()
    assert unwrap() == {"FINISHED"}
    assert [layer.name for layer in obj.data.uv_layers] == ["UVMap"]


def test_long_layer_name_is_found_again() -> None:
    obj, name = meshes.add_grid(), "é" * 40
    unwrap(uv_layer=name)
    unwrap(uv_layer=name)
    assert len(obj.data.uv_layers) == 1


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_ninth_layer_is_refused(mode: str) -> None:
    obj = meshes.add_grid()
    for index in range(8):
        obj.data.uv_layers.new(name=f"Layer {index}")
    before = [meshes.uv(obj, layer.name) for layer in obj.data.uv_layers]
    bpy.ops.object.mode_set(mode=mode)
    with pytest.raises(RuntimeError, match=r"8 UV maps.*Ninth"):
        unwrap(uv_layer="Ninth")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(obj.data.uv_layers) == 8
    assert all((meshes.uv(obj, f"Layer {i}") == before[i]).all() for i in range(8))


def test_holes_need_fill_holes() -> None:
    bpy.ops.mesh.primitive_cylinder_add(vertices=12, end_fill_type="NOTHING")
    with pytest.raises(RuntimeError, match="2 boundaries; turn on Fill Holes"):
        unwrap(fill_holes=False)
    assert unwrap(fill_holes=True) == {"FINISHED"}
    assert_sound(bpy.context.object)


def refused_with_others() -> Any:
    """An object of a grid (36 quads), and of two tori (16 quads each)."""
    parts = [meshes.grid(), meshes.ring((4, 0, 0)), meshes.ring((0, 5, 0))]
    obj = meshes.add(*meshes.together(*parts), "Mixed")
    obj.data.uv_layers.new(name="UVMap")
    meshes.set_uv(obj, np.random.default_rng(1).random((len(obj.data.loops), 2)))
    return obj


def test_refused_islands_are_named_and_left_alone(capfd: pytest.CaptureFixture[str]) -> None:
    obj = refused_with_others()
    before = meshes.uv(obj)
    assert unwrap() == {"FINISHED"}
    after = meshes.uv(obj)
    assert (before[144:] == after[144:]).all() and (before[:144] != after[:144]).any(axis=1).all()
    said = capfd.readouterr().out
    assert "Unwrapped 1 island" in said
    assert "Mixed at face 36: is closed and has a handle, like a torus; mark seams" in said
    assert "Mixed at face 52: is closed and has a handle" in said


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_refused_islands_lie_in_a_point_where_there_were_no_uvs(
    mode: str, capfd: pytest.CaptureFixture[str]
) -> None:
    obj = meshes.add(*meshes.together(meshes.grid(), meshes.ring((4, 0, 0))), "Mixed")
    bpy.ops.object.mode_set(mode=mode)
    assert unwrap() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    uv = meshes.uv(obj)
    assert (uv[144:] == 0).all() and np.ptp(uv[:144], axis=0).min() > 0.9
    assert "on a mesh without a UV map, these lie in the lower left corner" in capfd.readouterr().out


def test_island_with_a_bad_coordinate_is_left_alone(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.add(*meshes.together(meshes.grid(), meshes.grid(offset=(4, 0, 0))))
    obj.data.vertices[60].co.x = float("nan")
    assert unwrap() == {"FINISHED"}
    said = capfd.readouterr().out
    assert "face 36" in said and "vertex 60" in said


def test_branching_edge_acts_as_a_seam() -> None:
    vertices, faces = meshes.grid(n=2, bump=0)
    fin = [*vertices, (0, -1, 1), (0, 0, 1)]
    obj = meshes.add(fin, [*faces, [1, 4, 10, 9]])
    assert unwrap() == {"FINISHED"}
    assert np.isfinite(meshes.uv(obj)).all() and (meshes.area_ratios(obj) > 0).all()


def test_empty_mesh_and_no_mesh(capfd: pytest.CaptureFixture[str]) -> None:
    empty = meshes.add([], [], "Empty")
    assert unwrap() == {"CANCELLED"}
    assert "no faces" in capfd.readouterr().out
    meshes.select(meshes.add_grid(), empty)
    assert unwrap() == {"FINISHED"}
    bpy.ops.object.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match=r"poll.*Select at least one mesh object"):
        unwrap()


def test_other_data_is_untouched() -> None:
    obj = meshes.add_grid()
    mesh = obj.data
    mesh.uv_layers.new(name="First")
    mesh.uv_layers.new(name="Second")
    mesh.uv_layers["Second"].active_render = True
    mesh.uv_layers.active = mesh.uv_layers["First"]
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Key")
    key.data[3].co.z = 5
    normals = np.random.default_rng(2).normal(size=(len(mesh.loops), 3))
    mesh.normals_split_custom_set(normals / np.linalg.norm(normals, axis=1)[:, None])

    def state() -> Any:
        keys = [[tuple(point.co) for point in block.data] for block in mesh.shape_keys.key_blocks]
        corner = [tuple(normal.vector) for normal in mesh.corner_normals]
        return (
            keys,
            corner,
            meshes.uv(obj, "Second").tolist(),
            [layer.active_render for layer in mesh.uv_layers],
        )

    before = state()
    assert unwrap() == {"FINISHED"}
    assert state() == before and mesh.uv_layers.active.name == "First"
    assert_sound(obj, layer="First")


def test_scene_is_as_it_was() -> None:
    first, second = meshes.add_grid("First"), meshes.add_grid("Second")
    other = meshes.add_grid("Other")
    meshes.select(second, first)

    def state() -> Any:
        data = [
            sorted(block.name for block in getattr(bpy.data, kind))
            for kind in ("meshes", "objects", "scenes")
        ]
        tools = bpy.context.tool_settings
        return (
            *data,
            bpy.context.scene.name,
            bpy.context.mode,
            bpy.context.view_layer.objects.active,
            [obj.select_get() for obj in (first, second, other)],
            [[p.select for p in obj.data.polygons] for obj in (first, second)],
            tools.use_uv_select_sync,
        )

    before = state()
    unwrap()
    bpy.ops.authalic.measure()
    assert state() == before


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_undo(mode: str) -> None:
    obj = meshes.add_grid()
    obj.data.uv_layers.new(name="UVMap")
    bpy.ops.object.mode_set(mode=mode)
    if mode == "EDIT":
        meshes.select_faces(obj, lambda index: True)
    bpy.ops.ed.undo_push(message="Start")
    before = meshes.uv(obj)
    bpy.ops.authalic.unwrap("EXEC_DEFAULT", True)
    assert (meshes.uv(obj) != before).any()
    bpy.ops.ed.undo()
    assert bpy.context.object.mode == mode
    assert (meshes.uv(bpy.context.object) == before).all()


def test_inconsistent_normals_are_no_folds(capfd: pytest.CaptureFixture[str]) -> None:
    vertices, faces = meshes.grid()
    faces[[3, 20]] = faces[[3, 20]][:, ::-1]
    obj = meshes.add(vertices, faces)
    assert unwrap() == {"FINISHED"}
    said = capfd.readouterr().out
    assert "0 flips" in said and "2 faces with inconsistent normals" in said
    corners, polygons, _ = meshes.triangles(obj)
    against = meshes.uv_areas(meshes.uv(obj)[corners]) < 0
    assert set(polygons[against]) == {3, 20}
    assert np.abs(meshes.area_ratios(obj)).std() < 0.1


def test_packing_options() -> None:
    obj = meshes.add(*meshes.together(meshes.grid(), meshes.grid(offset=(4, 0, 0))))
    fill = []
    for options in ({"margin": 0.0}, {"margin": 0.1}, {"margin": 0.1, "margin_method": "FRACTION"}):
        assert unwrap(**options) == {"FINISHED"}
        corners, _, _ = meshes.triangles(obj)
        fill.append(meshes.uv_areas(meshes.uv(obj)[corners]).sum())
    assert fill[0] > fill[1] and fill[0] > fill[2]


def test_areas_are_even_in_the_world() -> None:
    obj = meshes.add_grid()
    obj.scale, obj.rotation_euler = (1, 2, -0.5), (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    assert unwrap() == {"FINISHED"}
    assert np.abs(meshes.area_ratios(obj)).std() < 0.01


@pytest.mark.parametrize("taken", ["attribute", "vertex group"])
@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_layer_name_that_is_taken_is_refused(taken: str, mode: str) -> None:
    obj = meshes.add_grid()
    obj.data.uv_layers.new(name="Old")
    before = meshes.uv(obj)
    if taken == "attribute":
        obj.data.attributes.new("Taken", "FLOAT", "POINT")
    else:
        obj.vertex_groups.new(name="Taken")
    bpy.ops.object.mode_set(mode=mode)
    for _ in range(2):
        with pytest.raises(RuntimeError, match='Grid has an attribute or a vertex group "Taken"'):
            unwrap(uv_layer="Taken")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert [layer.name for layer in obj.data.uv_layers] == ["Old"]
    assert (meshes.uv(obj) == before).all()


@pytest.mark.parametrize(("rings", "around"), [(20, 8), (40, 8), (50, 8), (60, 8), (100, 6)])
@pytest.mark.parametrize("closed", [True, False])
def test_long_tubes_have_no_flips_or_are_refused(
    rings: int, around: int, closed: bool, capfd: pytest.CaptureFixture[str]
) -> None:
    obj = meshes.add(*meshes.tube(rings, around, closed), "Tube")
    try:
        unwrap()
    except RuntimeError as refusal:
        assert "seams" in str(refusal) or "remesh" in str(refusal)
        assert "Traceback" not in str(refusal) and not obj.data.uv_layers
        return
    said = capfd.readouterr().out
    flips = int(np.count_nonzero(meshes.area_ratios(obj) <= 0))
    assert flips == 0 and "0 flips" in said
    if meshes.area_ratios(obj).std() > 1:
        assert "Warning" in said and "Tube at face 0: uneven" in said


def test_good_island_beside_one_that_cannot_be_mapped() -> None:
    for rings in (39, 41, 60):
        parts = meshes.tube(rings, 3, False), meshes.grid(offset=(9, 0, 0))
        obj = meshes.add(*meshes.together(*parts))
        assert unwrap() == {"FINISHED"}
        corners, polygons, _ = meshes.triangles(obj)
        grid = polygons >= 3 * (rings - 1)
        assert (meshes.uv_areas(meshes.uv(obj)[corners[grid]]) > 0).all()
