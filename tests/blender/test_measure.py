# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.measure against independent formulas in numpy."""

import re
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
        r"(?:\n(\d+) triangles without area)?"
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
    uv = meshes.uv(obj)
    uv[:4] = uv[3::-1]
    meshes.set_uv(obj, uv)
    bpy.ops.authalic.measure()
    assert figures()["flips"] == 2
    assert attribute(obj)[0] == -20 and (np.abs(attribute(obj)[1:]) < 19).all()


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
    line, values = bpy.context.window_manager.authalic_figures, attribute(obj)
    obj.data.attributes.remove(obj.data.attributes[ATTRIBUTE])
    meshes.edit(obj)
    assert bpy.ops.authalic.measure() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.context.window_manager.authalic_figures == line
    np.testing.assert_array_equal(attribute(obj), values)


def test_measuring_twice_keeps_one_attribute() -> None:
    obj = stretched_grid()
    bpy.ops.authalic.measure()
    bpy.ops.authalic.measure()
    assert [a.name for a in obj.data.attributes].count(ATTRIBUTE) == 1


def test_uvs_in_one_point_and_no_uvs() -> None:
    obj = meshes.add_grid()
    with pytest.raises(RuntimeError, match="no faces with a UV map"):
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
    assert again.flips == 0 and measure.phrases(report.figures) == measure.phrases(again)
    for name in ("triangles", "mean", "deviation", "log2_min", "log2_max", "angle"):
        assert getattr(report.figures, name) == getattr(again, name)


def test_mirrored_island_counts_as_flipped() -> None:
    obj = meshes.add(*meshes.together(meshes.grid(), meshes.grid(n=4, offset=(4, 0, 0))))
    bpy.ops.authalic.unwrap()
    uv = meshes.uv(obj)
    uv[144:, 0] = 1 - uv[144:, 0]
    meshes.set_uv(obj, uv)
    bpy.ops.authalic.measure()
    assert figures()["flips"] == 2 * 16


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
