# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.set_texel_density against areas in numpy."""

from typing import Any

import bpy
import meshes
import numpy as np
import pytest
from installed import part
from meshes import Array, MeshObject


def quads() -> MeshObject:
    """Two quads of 1 × 1 and 2 × 2 meters, whose UVs are squares of the sides .2 and .1."""
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    flat = np.concatenate([square, 2 * square + np.array((3, 0))])
    obj = meshes.add(np.c_[flat, np.zeros(8)], [(0, 1, 2, 3), (4, 5, 6, 7)])
    obj.data.uv_layers.new(name="UVMap")
    uv = np.concatenate([square * 0.2 + 0.3, square * 0.1 + np.array((0.7, 0.6))])
    meshes.set_uv(obj, uv)
    return obj


def texels(obj: MeshObject, pixels: float) -> Array:
    """The pixels per meter of each face."""
    corners, polygons, points = meshes.triangles(obj)
    area = np.bincount(polygons, meshes.surface_areas(points))
    image = np.bincount(polygons, np.abs(meshes.uv_areas(meshes.uv(obj)[corners])))
    return np.sqrt(image / area * pixels)


def centers(obj: MeshObject) -> Array:
    return meshes.uv(obj).reshape(2, 4, 2).mean(axis=1)


def set_density(**options: Any) -> None:
    assert bpy.ops.authalic.set_texel_density(**options) == {"FINISHED"}


def test_each_island_about_its_center() -> None:
    obj = quads()
    before = centers(obj)
    set_density(density=300, size=(2048, 512))
    np.testing.assert_allclose(texels(obj, 2048 * 512), 300, rtol=1e-5)
    np.testing.assert_allclose(centers(obj), before, atol=1e-6)
    set_density(density=600, size=(2048, 512), keep_position=False)
    np.testing.assert_allclose(texels(obj, 2048 * 512), 600, rtol=1e-5)
    np.testing.assert_allclose(centers(obj), 2 * before, rtol=1e-5)


def test_together_by_one_factor() -> None:
    obj = quads()
    before, uv = texels(obj, 1024**2), meshes.uv(obj)
    set_density(density=500, size=(1024, 1024), scale="TOGETHER")
    after = texels(obj, 1024**2)
    assert after[0] / after[1] == pytest.approx(before[0] / before[1], rel=1e-5)
    area = np.array([1.0, 4.0])
    assert np.sqrt((after**2 * area).sum() / area.sum()) == pytest.approx(500, rel=1e-5)
    now = meshes.uv(obj)
    middle = (uv.min(axis=0) + uv.max(axis=0)) / 2
    np.testing.assert_allclose((now.min(axis=0) + now.max(axis=0)) / 2, middle, atol=1e-6)


def test_world_scale_and_the_unit_of_length_count() -> None:
    obj = quads()
    obj.scale = (4, 1, 1)
    bpy.context.scene.unit_settings.scale_length = 0.01  # centimeters
    bpy.context.view_layer.update()
    set_density(density=5000, size=(1024, 1024))
    np.testing.assert_allclose(texels(obj, 1024**2) / 0.01, 5000, rtol=1e-5)


def test_edit_mode_scales_whole_islands_of_selected_faces() -> None:
    obj = meshes.add(*meshes.together(meshes.grid(bump=0), meshes.grid(n=4, offset=(4, 0, 0), bump=0)))
    bpy.ops.authalic.unwrap()
    uv = meshes.uv(obj)
    meshes.edit(obj)
    meshes.select_faces(obj, lambda face: face == 40)
    set_density(density=100, size=(1024, 1024))
    bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_array_equal(meshes.uv(obj)[:144], uv[:144])
    np.testing.assert_allclose(texels(obj, 1024**2)[36:].mean(), 100, rtol=1e-4)
    meshes.edit(obj)
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="No selected face has a UV map"):
        set_density()


def test_undo_and_islands_without_area() -> None:
    obj = quads()
    uv = meshes.uv(obj)
    uv[4:] = (0.5, 0.5)
    meshes.set_uv(obj, uv)
    bpy.ops.ed.undo_push(message="before")
    job = part("jobs.texel_density")
    report = job.set_density(bpy.context, job.Settings(256, (1024, 1024)))
    assert (report.islands, report.without_area) == (1, 1)
    assert "1 island without area left out" in str(report)
    np.testing.assert_array_equal(meshes.uv(obj)[4:], uv[4:])
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    np.testing.assert_array_equal(meshes.uv(bpy.context.view_layer.objects[0]), uv)
    meshes.select(bpy.context.view_layer.objects[0])
    meshes.set_uv(bpy.context.object, np.zeros((8, 2)))
    with pytest.raises(RuntimeError, match="their UVs lie in one point"):
        set_density()


def test_the_size_of_the_active_texture_counts() -> None:
    obj = quads()
    found = part("jobs.texel_density").size_of_image
    assert found(bpy.context) is None
    material = bpy.data.materials.new("Skin")
    if material.node_tree is None:  # Blender 5 always has one
        material.use_nodes = True
    obj.data.materials.append(material)
    nodes = material.node_tree.nodes
    for name, size in (("Small", 256), ("Large", 4096)):
        node = nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.new(name, size, size // 2)
    nodes.active = node
    assert found(bpy.context) == ("Large", (4096, 2048))
    set_density(density=700, size=(10, 10))
    np.testing.assert_allclose(texels(obj, 4096 * 2048), 700, rtol=1e-5)
    set_density(density=700, size=(1000, 1000), use_image=False)
    np.testing.assert_allclose(texels(obj, 1000**2), 700, rtol=1e-5)
    nodes.active = nodes[0]
    assert found(bpy.context)[0] == "Small"


def test_what_was_measured_is_shown_in_pixels() -> None:
    obj = quads()
    set_density(density=333, size=(1024, 512))
    bpy.ops.authalic.measure()
    operator, figures = part("operators.texel_density"), part("operators.measure").current(bpy.context)
    options = bpy.context.window_manager.operator_properties_last("authalic.set_texel_density")
    options.size = (1024, 512)
    assert operator.now(bpy.context, figures, options) == pytest.approx(333, rel=1e-5)
    assert obj.mode == "OBJECT"
