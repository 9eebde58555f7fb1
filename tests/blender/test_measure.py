# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.measure against independent formulas in numpy."""

import re
from pathlib import Path
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
from installed import part
from meshes import Array, MeshObject

ATTRIBUTE = "authalic_log2_area_ratio"


def figures() -> dict[str, float]:
    """The numbers in the figures that the panel shows, by name."""
    lines = bpy.context.window_manager.authalic_figures
    number = r"(-?[\d.]+(?:e[+-]?\d+)?)"
    pattern = (
        rf"mean {number}\narea ratio SD {number}\nlog2 area ratio {number} to {number}\n"
        rf"(\d+) flips?\nangle distortion {number}"
        r"(?:\n(\d+) triangles? without area)?"
    )
    keys = ("mean", "deviation", "low", "high", "flips", "angle", "left_out")
    return dict(zip(keys, (float(x or 0) for x in re.search(pattern, lines).groups()), strict=True))


def attribute(obj: MeshObject) -> Array:
    return np.array([item.value for item in obj.data.attributes[ATTRIBUTE].data])


def stretched_grid() -> MeshObject:
    obj = meshes.add_grid()
    obj.data.uv_layers.new(name="UVMap")
    corner = [loop.vertex_index for loop in obj.data.loops]
    flat = np.array([obj.data.vertices[v].co.xy for v in corner])
    meshes.set_uv(obj, 0.5 + 0.4 * flat + 0.08 * np.sin(2 * flat))
    return obj


def fold(obj: MeshObject, vertex: int, place: tuple[float, float]) -> None:
    """Moves the UVs of a vertex, at all corners at once."""
    uv, corner = meshes.uv(obj), np.array([loop.vertex_index for loop in obj.data.loops])
    uv[corner == vertex] = place
    meshes.set_uv(obj, uv)


def sigma_ratio(points: Array, image: Array) -> Any:
    """σ₁/σ₂ of each triangle by numpy's own singular values."""
    a, b = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    x = np.linalg.norm(a, axis=1)
    u = (a * b).sum(axis=1) / x
    v = np.linalg.norm(np.cross(a, b), axis=1) / x
    rest = np.stack([np.stack([x, u], -1), np.stack([0 * x, v], -1)], -2)
    target = np.stack([image[:, 1] - image[:, 0], image[:, 2] - image[:, 0]], -1)
    sigma = np.linalg.svd(target @ np.linalg.inv(rest), compute_uv=False)
    return sigma[:, 0] / sigma[:, 1]


def test_figures_and_attribute() -> None:
    obj = stretched_grid()
    assert bpy.ops.authalic.measure() == {"FINISHED"}
    ratios, reported = meshes.area_ratios(obj), figures()
    corners, polygons, points = meshes.triangles(obj)
    assert reported["mean"] == pytest.approx(ratios.mean(), abs=6e-4)
    assert reported["deviation"] == pytest.approx(ratios.std(), rel=6e-3)
    assert reported["low"] == pytest.approx(np.log2(ratios).min(), abs=6e-3)
    assert reported["high"] == pytest.approx(np.log2(ratios).max(), abs=6e-3)
    assert reported["flips"] == 0
    angle = sigma_ratio(points, meshes.uv(obj)[corners].astype(float)).mean()
    assert reported["angle"] == pytest.approx(angle, abs=6e-3)
    area = meshes.surface_areas(points)
    expected = np.log2(np.bincount(polygons, ratios * area) / np.bincount(polygons, area))
    np.testing.assert_allclose(attribute(obj), expected, atol=1e-4)
    kind = obj.data.attributes[ATTRIBUTE]
    assert (kind.domain, kind.data_type) == ("FACE", "FLOAT")


def test_folded_face_has_a_finite_extreme() -> None:
    obj = stretched_grid()
    fold(obj, 8, (1.2, 1.2))  # an inner vertex, far out
    bpy.ops.authalic.measure()
    ratios = meshes.area_ratios(obj)
    assert figures()["flips"] == (ratios < 0).sum() > 0
    folded = np.unique(meshes.triangles(obj)[1][ratios < 0])
    is_marked = attribute(obj) == -20
    np.testing.assert_array_equal(np.flatnonzero(is_marked), folded)
    assert (np.abs(attribute(obj)[~is_marked]) < 19).all()


def test_faces_without_area_are_left_out() -> None:
    vertices, faces = meshes.grid()
    obj = meshes.add([*vertices, (5, 0, 0), (6, 0, 0), (7, 0, 0)], [*faces, [49, 50, 51]])
    obj.data.uv_layers.new(name="UVMap")
    assert bpy.ops.authalic.measure() == {"FINISHED"}
    assert figures()["left_out"] == 1
    assert attribute(obj)[36] == 0 and np.isfinite(attribute(obj)).all()


def test_several_objects_share_one_scale() -> None:
    first, second = stretched_grid(), stretched_grid()
    meshes.set_uv(second, meshes.uv(second) / 2)
    meshes.select(first, second)
    bpy.ops.authalic.measure()
    np.testing.assert_allclose(attribute(first) - attribute(second), 2, atol=1e-5)


def test_edit_mode_gives_the_same() -> None:
    obj = stretched_grid()
    bpy.ops.authalic.measure()
    bpy.context.view_layer.update()
    line, values = bpy.context.window_manager.authalic_figures, attribute(obj)
    obj.data.attributes.remove(obj.data.attributes[ATTRIBUTE])
    meshes.edit(obj)
    assert bpy.ops.authalic.measure() == {"FINISHED"}
    assert bpy.context.window_manager.authalic_figures == line
    bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_array_equal(attribute(obj), values)


def test_measuring_twice_keeps_one_attribute() -> None:
    obj = stretched_grid()
    bpy.ops.authalic.measure()
    bpy.ops.authalic.measure()
    assert [a.name for a in obj.data.attributes].count(ATTRIBUTE) == 1


def test_uvs_in_one_point_and_no_uvs() -> None:
    obj = meshes.add_grid()
    with pytest.raises(RuntimeError, match="have no UV map"):
        bpy.ops.authalic.measure()
    obj.data.uv_layers.new(name="UVMap")
    meshes.set_uv(obj, np.zeros((len(obj.data.loops), 2)))
    with pytest.raises(RuntimeError, match="all UVs lie in one point"):
        bpy.ops.authalic.measure()
    assert ATTRIBUTE not in obj.data.attributes


@pytest.mark.parametrize("reverse", [1, 3])
def test_unwrap_and_measure_agree_where_normals_differ(reverse: bool) -> None:
    vertices, faces = meshes.grid()
    faces[::reverse] = faces[::reverse, ::-1]
    meshes.add(vertices, faces)
    unwrap = part("jobs.unwrap")
    measure = part("jobs.measure")
    report = unwrap.job(bpy.context, unwrap.Settings()).execute()
    again = measure.job(bpy.context).execute()
    again = again.figures
    assert again.flips == 0 and measure.phrases(report.figures) == measure.phrases(again)
    for name in ("triangles", "mean", "deviation", "log2_min", "log2_max", "angle"):
        assert getattr(report.figures, name) == getattr(again, name)


def unwrapped_pair() -> MeshObject:
    """Two grids in one mesh, with even UVs and an island each; the second has the corners from 144 on."""
    obj = meshes.add(*meshes.together(meshes.grid(), meshes.grid(n=4, offset=(4, 0, 0))))
    bpy.ops.authalic.unwrap()
    return obj


def test_mirrored_island_is_no_flip() -> None:
    obj = unwrapped_pair()
    measure = part("jobs.measure")
    before = measure.job(bpy.context).execute().figures
    uv = meshes.uv(obj)
    uv[144:, 0] = 1 - uv[144:, 0]
    meshes.set_uv(obj, uv)
    report = measure.job(bpy.context).execute()
    assert report.figures.flips == 0 and report.figures.mirrored == 1
    assert "none flipped, 1 mirrored island" in report.sentence
    assert report.figures.deviation == pytest.approx(before.deviation, rel=1e-4)
    assert report.figures.angle == pytest.approx(before.angle, rel=1e-6)
    fold(obj, 49 + 6, uv[144])  # an inner vertex of it, beyond its corner
    again = measure.job(bpy.context).execute().figures
    areas = meshes.uv_areas(meshes.uv(obj)[meshes.triangles(obj)[0]])[72:]
    assert again.flips == (areas >= 0).sum() > 0 and again.mirrored == 1


def test_two_equal_quads_one_mirrored() -> None:
    vertices = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (3, 0, 0), (3, 1, 0), (2, 1, 0)]
    obj = meshes.add(vertices, [(0, 1, 2, 3), (4, 5, 6, 7)], "Camel")
    obj.data.uv_layers.new(name="UVMap")
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) / 3
    meshes.set_uv(obj, np.concatenate([square, square * (-1, 1) + (0.9, 0)]))
    report = part("jobs.measure").job(bpy.context).execute()
    assert (report.figures.mean, report.figures.mirrored, report.figures.flips) == (pytest.approx(1), 1, 0)
    assert report.figures.deviation < 1e-6 and report.figures.angle == pytest.approx(1)
    flips = "none flipped, 1 mirrored island"
    assert report.sentence == f"Camel: 100 % of faces within ±10 % of their share, {flips}"


def test_non_uniform_scale_is_measured_in_the_world() -> None:
    bpy.ops.mesh.primitive_cube_add(rotation=(0.3, 0.2, 0.1), scale=(5, 1, 0.1))
    obj = bpy.context.object
    bpy.context.view_layer.update()
    expected = meshes.area_ratios(obj)
    bpy.ops.authalic.measure()
    assert expected.std() > 5 and figures()["deviation"] == pytest.approx(expected.std(), rel=6e-3)
    # the shear of a child that is turned in a scaled parent
    child = meshes.add_grid()
    child.parent, child.rotation_euler = obj, (0, 0, 0.5)
    child.data.uv_layers.new(name="UVMap")
    bpy.context.view_layer.update()
    meshes.select(child)
    bpy.ops.authalic.measure()
    expected = meshes.area_ratios(child)
    assert figures()["deviation"] == pytest.approx(expected.std(), rel=6e-3)
    _, _, points = meshes.triangles(child)
    corners = meshes.triangles(child)[0]
    angle = sigma_ratio(points, meshes.uv(child)[corners].astype(float)).mean()
    assert figures()["angle"] == pytest.approx(angle, abs=6e-3)


@pytest.mark.parametrize("offset", [1e6, 1e7])
def test_far_from_the_origin_all_triangles_count(offset: float) -> None:
    vertices, faces = meshes.grid(n=6, bump=0)
    obj = meshes.add(vertices * 12 + (offset, 0, 0), faces)
    obj.data.uv_layers.new(name="UVMap")
    corner = [loop.vertex_index for loop in obj.data.loops]
    meshes.set_uv(obj, vertices[corner][:, :2] / 2 + 0.5)
    bpy.ops.authalic.measure()
    assert figures()["left_out"] == 0 and figures()["deviation"] < 1e-6
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}
    assert meshes.area_ratios(obj).std() < 1e-3


def test_only_selected_faces_are_measured_in_edit_mode() -> None:
    obj = unwrapped_pair()
    uv = meshes.uv(obj)
    uv[144:] = uv[144:] * (0.5, 2) + np.sin(5 * uv[144:]) / 20
    meshes.set_uv(obj, uv)
    meshes.edit(obj)
    meshes.select_faces(obj, lambda face: face < 36)
    report = part("jobs.measure").job(bpy.context).execute()
    assert report.figures.triangles == 72 and report.figures.deviation < 0.02
    bpy.ops.object.mode_set(mode="OBJECT")
    values = attribute(obj)
    assert (values[:36] != 0).all() and (values[36:] == 0).all()
    meshes.edit(obj)
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="No faces are selected"):
        bpy.ops.authalic.measure()


def test_figures_are_cleared_when_they_no_longer_apply() -> None:
    def shown() -> Any:
        bpy.context.view_layer.update()
        return part("operators.measure").current(bpy.context)

    obj, other = stretched_grid(), meshes.add_grid("Other")
    meshes.select(obj)
    bpy.ops.authalic.measure()
    assert shown().sentence.startswith("Grid: ")
    meshes.select(other)
    assert shown() is None and bpy.context.window_manager.authalic_figures == ""
    meshes.select(obj)
    bpy.ops.authalic.measure()
    obj.data.uv_layers.active.data[0].uv = (0.5, 0.5)
    assert shown() is None
    meshes.edit(obj)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.authalic.measure()
    assert shown() is not None
    meshes.select_faces(obj, lambda face: face < 5)
    assert shown() is None


def test_shares_of_the_smallest_and_the_largest_face() -> None:
    obj = stretched_grid()
    _, polygons, points = meshes.triangles(obj)
    ratios, area = meshes.area_ratios(obj), meshes.surface_areas(points)
    of_faces = np.bincount(polygons, ratios * area) / np.bincount(polygons, area)
    found = part("jobs.measure").job(bpy.context).execute().figures
    assert found.shares == pytest.approx((of_faces.min(), of_faces.max()), rel=1e-5)
    assert found.fair == pytest.approx((np.abs(of_faces - 1) <= 0.1).mean())


def painted(source: str) -> tuple[MeshObject, Array]:
    """A flat grid with even UVs, painted by x in a vertex group or a color; and the weights of its faces."""
    vertices, faces = meshes.grid(bump=0)
    obj = meshes.add(vertices, faces)
    obj.data.uv_layers.new(name="UVMap")
    corner = np.array([loop.vertex_index for loop in obj.data.loops])
    meshes.set_uv(obj, vertices[corner][:, :2] / 2 + 0.5)
    weight = vertices[:, 0] / 2 + 0.5
    if source == "group":
        group = obj.vertex_groups.new(name="Detail")
        for vertex, value in enumerate(weight):
            group.add([vertex], value, "REPLACE")
    else:
        color = obj.data.color_attributes.new("Detail", "FLOAT_COLOR", source)
        values = weight if source == "POINT" else weight[corner]
        for item, value in zip(color.data, values, strict=True):
            item.color = (value, value, value, 1)
    return obj, weight[faces].mean(axis=1)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("source", ["group", "POINT", "CORNER"])
def test_density_counts(source: str, mode: str) -> None:
    obj, weights = painted(source)
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.authalic.measure(density_source="Detail") == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    density = 1 + 7 * weights
    expected = np.log2(density.mean() / density)  # all faces have one area, in space and in the plane
    np.testing.assert_allclose(attribute(obj), expected, atol=1e-5)
    with pytest.raises(RuntimeError, match='No selected object has the vertex group or color "Nothing"'):
        bpy.ops.authalic.measure(density_source="Nothing")


def test_linked_meshes_are_measured_but_not_written(tmp_path: Path) -> None:
    obj = stretched_grid()
    bpy.ops.authalic.measure()
    expected = figures()
    obj.data.attributes.remove(obj.data.attributes[ATTRIBUTE])
    file = str(tmp_path / "library.blend")
    bpy.data.libraries.write(file, {obj})
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(file, link=True) as (source, target):
        target.objects = source.objects
    linked = target.objects[0]
    bpy.context.collection.objects.link(linked)
    meshes.select(linked)
    report = part("jobs.measure").job(bpy.context).execute()
    assert report.figures.deviation == pytest.approx(expected["deviation"], rel=6e-3)
    assert ATTRIBUTE not in linked.data.attributes and "gets no attribute: its mesh is linked" in str(report)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize(
    ("kind", "domain"), [("FLOAT_COLOR", "POINT"), ("INT", "FACE"), ("FLOAT", "EDGE"), ("FLOAT2", "POINT")]
)
def test_attribute_of_another_kind_is_replaced(mode: str, kind: str, domain: str) -> None:
    obj = stretched_grid()
    bpy.ops.authalic.measure()
    expected = attribute(obj)
    obj.data.attributes.remove(obj.data.attributes[ATTRIBUTE])
    obj.data.attributes.new(ATTRIBUTE, kind, domain)
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.authalic.measure() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    attribute_ = obj.data.attributes[ATTRIBUTE]
    assert (attribute_.domain, attribute_.data_type) == ("FACE", "FLOAT")
    np.testing.assert_array_equal(attribute(obj), expected)
