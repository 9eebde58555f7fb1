# SPDX-License-Identifier: GPL-3.0-or-later
"""Where islands come to lie, and how much of the texture they get."""

from typing import Any

import bmesh
import bpy
import meshes
import numpy as np
import pytest
from editors import uv_editor


def unwrap(**options: Any) -> Any:
    return bpy.ops.authalic.unwrap(**options)


def two_grids(name: str = "Mesh") -> Any:
    """Two islands with UVs, each in a corner of the square and turned."""
    obj = meshes.add(*meshes.together(meshes.grid(), meshes.grid(offset=(4, 0, 0))), name)
    layer = obj.data.uv_layers.new(name="UVMap")
    corners = np.array([loop.vertex_index for loop in obj.data.loops])
    points = np.array([vertex.co[:2] for vertex in obj.data.vertices])[corners]
    points[144:] -= [4, 0]
    turn = np.array([[np.cos(0.4), np.sin(0.4)], [-np.sin(0.4), np.cos(0.4)]])
    points = points @ turn * 0.1 + np.where(np.arange(288) < 144, 0.2, 0.7)[:, None]
    layer.uv.foreach_set("vector", points.astype(np.float32).ravel())
    return obj


def halves(obj: Any) -> list[Any]:
    """The UVs of the triangles of each of two grids."""
    corners, polygons, _ = meshes.triangles(obj)
    uv = meshes.uv(obj)[corners].astype(float)
    return [uv[polygons < 36], uv[polygons >= 36]]


def area(triangles: Any) -> float:
    return float(meshes.uv_areas(triangles).sum())


# Keep Position and Scale


def test_islands_keep_their_position_scale_and_direction() -> None:
    obj = two_grids()
    before = halves(obj)
    assert unwrap(keep_position=True) == {"FINISHED"}
    for old, new in zip(before, halves(obj), strict=True):
        assert area(new) == pytest.approx(area(old), rel=1e-5)
        np.testing.assert_allclose(new.mean(axis=(0, 1)), old.mean(axis=(0, 1)), atol=1e-5)
        assert np.abs(new - old).max() < 0.05  # the same way up
        assert np.abs(new - old).max() > 1e-4


def test_islands_without_uvs_are_packed() -> None:
    obj = two_grids()
    values = meshes.uv(obj)
    values[144:] = 0.5
    obj.data.uv_layers[0].uv.foreach_set("vector", values.ravel())
    before = halves(obj)
    assert unwrap(keep_position=True) == {"FINISHED"}
    first, second = halves(obj)
    assert area(first) == pytest.approx(area(before[0]), rel=1e-5)
    assert area(second) == pytest.approx(area(first), rel=0.01)


def test_a_new_uv_map_keeps_the_places_of_the_active_one() -> None:
    obj = two_grids()
    before = halves(obj)
    assert unwrap(keep_position=True, uv_layer="New") == {"FINISHED"}
    assert obj.data.uv_layers.active.name == "New"
    np.testing.assert_allclose(halves(obj)[1].mean(axis=(0, 1)), before[1].mean(axis=(0, 1)), atol=1e-5)


# Pins


def pin(obj: Any, corners: Any) -> None:
    mask = np.zeros(len(obj.data.loops), bool)
    mask[corners] = True
    obj.data.attributes.new(".pn.UVMap", "BOOLEAN", "CORNER").data.foreach_set("value", mask)


@pytest.mark.parametrize("vertices", [[0], [0, 6], [0, 6, 48], [0, 6, 42, 48, 24]])
def test_pinned_uvs_stay_and_the_rest_follows(vertices: list[int]) -> None:
    obj = two_grids()
    corner_vertex = np.array([loop.vertex_index for loop in obj.data.loops])
    corners = np.flatnonzero(np.isin(corner_vertex, vertices))
    values = meshes.uv(obj)
    values[corner_vertex == vertices[-1]] += 0.02
    obj.data.uv_layers[0].uv.foreach_set("vector", values.ravel())
    pin(obj, corners)
    before = halves(obj)
    assert unwrap() == {"FINISHED"}
    assert (meshes.uv(obj)[corners] == values[corners]).all()
    first, second = halves(obj)
    assert (meshes.uv_areas(first) > 0).all()
    assert 0.5 < area(first) / area(before[0]) < 2
    assert area(second) == pytest.approx(area(first), rel=0.01)  # packed, at the same density
    assert second.min() < 0.01 and second.max() < 0.5
    assert obj.data.attributes[".pn.UVMap"].data[int(corners[0])].value


def test_an_island_that_is_pinned_throughout_stays_bit_for_bit() -> None:
    obj = two_grids()
    pin(obj, np.arange(144))
    before = meshes.uv(obj)
    assert unwrap() == {"FINISHED"}
    assert (meshes.uv(obj)[:144] == before[:144]).all()


def test_pins_that_make_areas_uneven_are_told(capfd: pytest.CaptureFixture[str]) -> None:
    obj = two_grids()
    corner_vertex = np.array([loop.vertex_index for loop in obj.data.loops])
    values = meshes.uv(obj)
    rim = [v for v in range(49) if v % 7 in (0, 6) or v // 7 in (0, 6)]
    for vertex in rim:  # a narrow trapezoid
        column, row = vertex % 7, vertex // 7
        values[corner_vertex == vertex] = [0.3 + 0.05 * (column - 3) * (1 + row / 2) / 3, 0.2 + 0.05 * row]
    obj.data.uv_layers[0].uv.foreach_set("vector", values.ravel())
    pin(obj, np.flatnonzero(np.isin(corner_vertex, rim)))
    assert unwrap() == {"FINISHED"}
    said = capfd.readouterr().out
    assert "Warning" in said and "uneven" in said and "unpin some UVs" in said


def test_pins_that_would_fold_faces_leave_the_island_as_it_was(capfd: pytest.CaptureFixture[str]) -> None:
    obj = two_grids()
    corner_vertex = np.array([loop.vertex_index for loop in obj.data.loops])
    values = meshes.uv(obj)
    one, other = np.flatnonzero(corner_vertex == 24), np.flatnonzero(corner_vertex == 25)
    values[one], values[other] = values[other][0], values[one][0]
    for vertex in (16, 17, 18, 23, 26, 30, 31, 32, 33):
        assert (corner_vertex == vertex).any()
    obj.data.uv_layers[0].uv.foreach_set("vector", values.ravel())
    pin(obj, np.flatnonzero(corner_vertex < 49))
    assert unwrap() == {"FINISHED"}
    assert (meshes.uv(obj)[:144] == values[:144]).all()
    assert "would fold over between its pinned UVs" in capfd.readouterr().out


# The texture


def add_image(obj: Any, width: int, height: int, tiled: bool = False) -> Any:
    image = bpy.data.images.new("Texture", width, height, tiled=tiled)
    material = bpy.data.materials.new("Material")
    material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.nodes.active = node
    obj.data.materials.append(material)
    return image


def angle_distortion(obj: Any, stretch: Any) -> float:
    """Mean ratio of singular values of the triangles' maps onto the texture."""
    corners, _, points = meshes.triangles(obj)
    image = meshes.uv(obj)[corners] * stretch
    ratios = []
    for triangle, uv in zip(points, image, strict=True):
        a, b = triangle[1] - triangle[0], triangle[2] - triangle[0]
        x = a / np.linalg.norm(a)
        y = b - (b @ x) * x
        plane = np.array([[a @ x, b @ x], [0, b @ (y / np.linalg.norm(y))]])
        values = np.linalg.svd(np.array([uv[1] - uv[0], uv[2] - uv[0]]).T @ np.linalg.inv(plane))[1]
        ratios.append(values[0] / values[1])
    return float(np.mean(ratios))


@pytest.mark.parametrize("options", [{}, {"keep_position": True}])
def test_shapes_are_kept_on_an_image_that_is_not_square(options: dict[str, Any]) -> None:
    obj = two_grids()
    add_image(obj, 256, 64)
    assert unwrap(correct_aspect=False) == {"FINISHED"}
    square = angle_distortion(obj, [1, 1])
    assert unwrap(**options) == {"FINISHED"}
    assert angle_distortion(obj, [4, 1]) == pytest.approx(square, rel=1e-3)
    assert angle_distortion(obj, [1, 1]) > 2 * square
    assert np.abs(meshes.area_ratios(obj)).std() < 0.02
    assert options or (meshes.uv(obj).min() >= 0 and meshes.uv(obj).max() <= 1)


def test_islands_go_to_the_active_tile() -> None:
    obj = two_grids()
    image = add_image(obj, 64, 64, tiled=True)
    image.tiles.active = image.tiles.new(1012)
    assert unwrap() == {"FINISHED"}
    uv = meshes.uv(obj)
    assert (uv >= 1).all() and (uv <= 2).all()


@pytest.mark.parametrize("scale_length", [1.0, 0.01])
def test_texel_density_is_in_pixels_per_meter(scale_length: float) -> None:
    obj = two_grids()
    add_image(obj, 512, 256)
    bpy.context.scene.unit_settings.scale_length = scale_length
    assert unwrap(texel_density=100 / scale_length) == {"FINISHED"}
    corners, _, points = meshes.triangles(obj)
    pixels = meshes.uv_areas((meshes.uv(obj)[corners] * [512, 256]).astype(float)).sum()
    assert np.sqrt(pixels / meshes.surface_areas(points).sum()) == pytest.approx(100, rel=1e-4)


# Packing


def test_objects_share_the_texture_or_not() -> None:
    first, second = two_grids("First"), two_grids("Second")
    meshes.select(first, second)
    assert unwrap() == {"FINISHED"}
    assert max(area(np.concatenate(halves(obj))) for obj in (first, second)) < 0.5
    assert unwrap(pack_objects="EACH") == {"FINISHED"}
    for obj in (first, second):
        assert area(np.concatenate(halves(obj))) > 0.4 and np.ptp(meshes.uv(obj), axis=0).max() > 0.99


@pytest.mark.parametrize(
    ("margin", "reason"), [(0.5, "below 0.5"), (0.499, "leaves no room for the islands; make it smaller")]
)
def test_a_margin_without_room_for_islands_is_refused(margin: float, reason: str) -> None:
    obj = meshes.add(*meshes.together(*(meshes.grid(2, offset=(3 * k, 0, 0)) for k in range(9))))
    with pytest.raises(RuntimeError, match=reason):
        bpy.ops.authalic.unwrap(margin_method="FRACTION", margin=margin)
    assert not obj.data.uv_layers


@pytest.mark.parametrize("rotate_method", ["ANY", "AXIS_ALIGNED", "NONE"])
@pytest.mark.parametrize("margin", [0.0, 0.03])
def test_islands_keep_the_margin(rotate_method: str, margin: float) -> None:
    parts = [meshes.grid(offset=(4 * k, 0, 0)) for k in range(5)]
    obj = meshes.add(*meshes.together(*parts))
    assert unwrap(rotate_method=rotate_method, margin_method="FRACTION", margin=margin) == {"FINISHED"}
    islands = meshes.uv(obj).reshape(5, 144, 2).astype(float)
    assert islands.min() >= margin - 1e-6 and islands.max() <= 1 - margin + 1e-6
    for k in range(5):
        for other in range(k):
            gap = np.linalg.norm(islands[k][:, None] - islands[other][None], axis=2).min()
            assert gap >= margin - 1e-6


def test_an_island_alone_lies_level() -> None:
    obj = meshes.add(*meshes.grid(bump=0))
    assert unwrap() == {"FINISHED"}
    np.testing.assert_allclose(np.ptp(meshes.uv(obj), axis=0), np.ptp(meshes.uv(obj), axis=0)[0], rtol=1e-5)
    assert area(meshes.uv(obj)[meshes.triangles(obj)[0]].astype(float)) > 0.99


# Density


def test_faces_get_texture_by_a_vertex_group() -> None:
    obj = meshes.add(*meshes.grid(n=12))
    group = obj.vertex_groups.new(name="More")
    weights = np.clip([vertex.co.x for vertex in obj.data.vertices], 0, 1)
    for vertex, weight in enumerate(weights.tolist()):
        group.add((vertex,), weight, "REPLACE")
    assert unwrap(density_source="More") == {"FINISHED"}
    corners, polygons, points = meshes.triangles(obj)
    means = np.array([weights[list(polygon.vertices)].mean() for polygon in obj.data.polygons])
    wanted = 1 + 7 * means[polygons]
    ratios = meshes.uv_areas(meshes.uv(obj)[corners].astype(float)) / meshes.surface_areas(points) / wanted
    assert (ratios / ratios.mean()).std() < 0.02
    with pytest.raises(RuntimeError, match="Less"):
        unwrap(density_source="Less")


def test_areas_are_those_of_the_subdivided_surface() -> None:
    obj = meshes.add(*meshes.grid(n=4, bump=2))
    modifier = obj.modifiers.new("", "SUBSURF")
    modifier.levels = 1
    fine = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    wanted = np.array([polygon.area for polygon in fine.polygons]).reshape(-1, 4).sum(axis=1)
    deviations = []
    for use_subsurf_data in (False, True):
        assert unwrap(use_subsurf_data=use_subsurf_data) == {"FINISHED"}
        corners, polygons, _ = meshes.triangles(obj)
        areas = np.bincount(polygons, meshes.uv_areas(meshes.uv(obj)[corners].astype(float)))
        deviations.append((areas / wanted / (areas / wanted).mean()).std())
    assert deviations[1] < 0.02 < deviations[0]


# The selection in the UV editor


def select_uvs(obj: Any, faces: range) -> None:
    """Selects faces in the UV map, and all faces of the mesh."""
    edit = bmesh.from_edit_mesh(obj.data)
    layer = edit.loops.layers.uv.verify()
    for number, face in enumerate(edit.faces):
        face.select_set(True)
        chosen = number in faces
        if bpy.app.version >= (5, 0):
            face.uv_select = chosen
        for loop in face.loops:
            if bpy.app.version >= (5, 0):
                loop.uv_select_vert = loop.uv_select_edge = chosen
            else:
                loop[layer].select = loop[layer].select_edge = chosen
    bmesh.update_edit_mesh(obj.data)


@pytest.mark.parametrize("sync", [False, True])
def test_the_uv_editor_unwraps_what_is_selected_there(sync: bool) -> None:
    obj = two_grids()
    before = meshes.uv(obj)
    bpy.context.scene.tool_settings.use_uv_select_sync = sync
    bpy.ops.object.mode_set(mode="EDIT")
    select_uvs(obj, range(36))
    with uv_editor():
        assert unwrap() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    changed = (meshes.uv(obj) != before).any(axis=1)
    assert changed[:144].all()
    assert changed[144:].all() if sync else not changed[144:].any()


def test_the_3d_view_unwraps_what_is_selected_in_the_mesh() -> None:
    obj = two_grids()
    before = meshes.uv(obj)
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    bpy.ops.object.mode_set(mode="EDIT")
    select_uvs(obj, range(36))
    assert unwrap() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert (meshes.uv(obj) != before).any(axis=1).all()
