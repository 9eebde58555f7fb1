# SPDX-License-Identifier: GPL-3.0-or-later
"""Areas against angles: presets, outlines, slider, tolerance, and the islands that result."""

from collections.abc import Callable
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
from installed import part
from meshes import Array, MeshObject

PRESETS = ("CIRCLE", "EVEN", "BALANCED", "SOFT")


def report_of(**solver: Any) -> Any:
    """The report of a job on the selected meshes."""
    unwrap, bridge = part("jobs.unwrap"), part("bridge")
    settings = unwrap.Settings(mapping=bridge.UnwrapSettings(solver=bridge.Solver(**solver)))
    return unwrap.job(bpy.context, settings).execute()


def seamed_suzanne(levels: int = 2) -> MeshObject:
    """Suzanne with the seams of her own UV map."""
    obj = meshes.suzanne(0)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.select_all(action="SELECT")
    bpy.ops.uv.seams_from_islands()
    bpy.ops.object.mode_set(mode="OBJECT")
    return meshes.subdivided(obj, levels)


def figures_of(**options: Any) -> Any:
    """The measured area ratio SD and angle distortion of an unwrap that a script calls."""
    assert bpy.ops.authalic.unwrap(**options) == {"FINISHED"}
    figures = part("jobs.measure").job(bpy.context).execute().figures
    assert figures.flips == 0
    return figures.deviation, figures.angle


def test_presets_trade_areas_for_angles(capfd: pytest.CaptureFixture[str]) -> None:
    obj = seamed_suzanne()
    figures = {name: figures_of(angle_preset=name) for name in PRESETS}
    assert (meshes.area_ratios(obj) > 0).all()
    said = capfd.readouterr().out
    assert "Warning" not in said and said.count("Info: Unwrapped") == len(PRESETS)
    deviations, angles = zip(*figures.values(), strict=True)
    assert deviations[0] <= 0.005 and deviations[1] < 0.01 and deviations[2] < 0.05 and deviations[3] < 0.1
    assert list(deviations[1:]) == sorted(deviations[1:]) and list(angles) == sorted(angles, reverse=True)
    assert angles[3] < 1.4 < angles[2] < 1.5 < angles[1] < 1.7 and angles[0] > 3
    assert figures_of() == figures["EVEN"]


def test_flat_islands_keep_their_shape() -> None:
    # The circle bends them: corners with both edges on the boundary collapse (SD .503).
    points = [(0, 0), (1, 0), (0.5, 0.9), (0.5, -0.5), (1.4, -0.9), (-0.4, -0.9), (-0.65, -0.25)]
    vertices = [(x, y, 0) for x, y in points]
    meshes.add(vertices, [(0, 1, 2), (1, 0, 3), (1, 3, 4), (3, 0, 5), (5, 0, 6)])
    deviation, angle = figures_of()
    assert deviation < 1e-3 and angle == pytest.approx(1, abs=1e-3)


@pytest.mark.skipif(bpy.app.version < (4, 3), reason="Minimum Stretch came with Blender 4.3")
def test_the_whole_slider_beats_minimum_stretch() -> None:
    seamed_suzanne()
    authalic = report_of(angle_weight=1.0).figures
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.unwrap(method="MINIMUM_STRETCH", fill_holes=True, iterations=10, margin=0.001)
    bpy.ops.object.mode_set(mode="OBJECT")
    blender = part("jobs.measure").job(bpy.context).execute().figures
    assert authalic.flips == 0
    assert authalic.angle < blender.angle and authalic.deviation < blender.deviation


def test_islands_with_outlines_of_their_own_are_packed_apart() -> None:
    obj = meshes.suzanne(1)
    report_of(angle_weight=0.8)
    uv = meshes.uv(obj)
    assert uv.min() >= 0 and uv.max() <= 1 and np.ptp(uv, axis=0).max() > 0.9
    label, (corners, _, _) = meshes.islands(obj), meshes.triangles(obj)
    covered = [meshes.coverage(uv[corners[label == island]], 800) > 0 for island in range(label.max() + 1)]
    assert len(covered) > 1 and np.sum(covered, axis=0).max() == 1


def test_a_long_island_lies_along_the_square() -> None:
    side, rows = np.linspace(0, 8, 41), np.linspace(0, 1, 6)
    x, y = (a.ravel() for a in np.meshgrid(side, rows))
    first = (np.arange(5)[:, None] * 41 + np.arange(40)).ravel()
    faces = np.stack([first, first + 1, first + 42, first + 41], axis=1)
    turn = np.array([[0.8, 0.6], [-0.6, 0.8]])
    obj = meshes.add(np.column_stack([np.stack([x, y], axis=1) @ turn, 0 * x]), faces)
    report_of(angle_weight=0.8)
    width, height = np.ptp(meshes.uv(obj), axis=0)
    assert width == pytest.approx(1, abs=0.02) and height == pytest.approx(1 / 8, abs=0.02)
    assert report_of(angle_weight=0.8).figures.angle < 1.05


@pytest.mark.parametrize("aspect", [1, 1.7, 5])
def test_upright_finds_the_smallest_box(aspect: float) -> None:
    rng = np.random.default_rng(5)
    points = np.concatenate([rng.random((3000, 2)), [[0, 0], [1, 0], [1, 1], [0, 1]]]) * [1, aspect]
    for angle in rng.uniform(0, 2 * np.pi, 5):
        cosine, sine = np.cos(angle), np.sin(angle)
        turned = part("surfaces.islands").upright(points @ np.array([[cosine, sine], [-sine, cosine]]))
        np.testing.assert_allclose(np.ptp(turned, axis=0), [aspect, 1], rtol=3e-3)
        sides = np.linalg.norm(np.diff(points, axis=0), axis=1)
        np.testing.assert_allclose(np.linalg.norm(np.diff(turned, axis=0), axis=1), sides)
        (a, b, c), (p, q, r) = points[:3], turned[:3]
        before, after = (
            np.linalg.det([two - one, three - one]) for one, two, three in ((a, b, c), (p, q, r))
        )
        assert before == pytest.approx(after)


def test_spheres_take_the_slider_too() -> None:
    obj = meshes.bumpy(meshes.icosphere(4))
    even, soft = (report_of(angle_weight=weight).figures for weight in (0.0, 0.9))
    assert soft.angle < even.angle - 0.5 and soft.flips == 0
    assert (meshes.area_ratios(obj) > 0).all()
    key = part("jobs.sphere_shape_key")
    shapes = [
        key.job(bpy.context, key.Settings(part("bridge").Solver(angle_weight=weight))).execute().shapes[0][1]
        for weight in (0.0, 0.9)
    ]
    assert shapes[0].deviation < 0.01 < shapes[1].deviation and shapes[1].angle < shapes[0].angle
    assert shapes[0].flips == shapes[1].flips == 0


@pytest.mark.parametrize("method", ["GRADIENT_DESCENT", "FIXED_POINT"])
@pytest.mark.parametrize("make", [meshes.add_grid, lambda: meshes.bumpy(meshes.icosphere(3))])
def test_other_methods_leave_angles_alone(
    make: Callable[[], tuple[MeshObject, MeshObject]], method: str
) -> None:
    obj = make()
    assert bpy.ops.authalic.unwrap(method=method, angle_weight=0.9) == {"FINISHED"}
    weighed = meshes.uv(obj)
    assert bpy.ops.authalic.unwrap(method=method) == {"FINISHED"}
    assert (meshes.uv(obj) == weighed).all()


def test_iterations_limit_every_method() -> None:
    meshes.suzanne(1)
    for method in ("GAUSS_NEWTON", "GRADIENT_DESCENT", "FIXED_POINT"):
        options = {"method": method, "outline": "CIRCLE", "angle_weight": 0.0}
        few, all_ = (report_of(**options, iterations=n).figures.deviation for n in (1, 0))
        assert all_ < 0.7 * few


# The preset of the redo panel, which follows the slider


def operator_properties() -> Any:
    """The operator's properties, as the redo panel and the sidebar show them."""
    return bpy.context.window_manager.operator_properties_last("authalic.unwrap")


def test_choosing_a_preset_sets_the_slider() -> None:
    properties, solver = operator_properties(), part("bridge.solver")
    for name in (*PRESETS, *reversed(PRESETS)):
        properties.angle_preset = name
        assert properties.angle_preset == name
        assert properties.angle_weight == pytest.approx(solver.PRESETS[name])
    properties.angle_weight = 0.5
    assert properties.angle_preset == "CUSTOM"
    properties.angle_preset = "CUSTOM"
    assert properties.angle_weight == 0.5
    properties.angle_preset = "EVEN"


def test_choosing_a_preset_sets_outline_and_tolerance_too() -> None:
    properties = operator_properties()
    for name, outline in (("CIRCLE", "CIRCLE"), ("SOFT", "FREE"), ("CIRCLE", "CIRCLE"), ("EVEN", "FREE")):
        properties.angle_preset = name
        assert properties.outline == outline
        properties.area_tolerance = 0.02
        assert properties.angle_preset == "CUSTOM" and properties.outline == outline
        properties.angle_preset = name
        assert properties.area_tolerance == 0 and properties.angle_preset == name
    properties.outline = "RECTANGLE"
    assert properties.angle_preset == "CUSTOM"
    properties.outline = "FREE"
    assert properties.angle_preset == "EVEN"


def test_the_former_name_of_a_preset_still_counts() -> None:
    obj = seamed_suzanne(0)
    for options in ({}, {"angle_weight": 0.0}):
        figures_of(angle_preset="AUTHALIC", **options)
        former = meshes.uv(obj)
        figures_of(angle_preset="CIRCLE")
        assert (meshes.uv(obj) == former).all()
    properties = operator_properties()
    properties.angle_preset = "AUTHALIC"
    assert (properties.outline, properties.angle_weight) == ("CIRCLE", 0)
    properties.angle_preset = "EVEN"
    # the numbers that key maps keep
    items = bpy.ops.authalic.unwrap.get_rna_type().properties["angle_preset"].enum_items
    assert [items[name].value for name in ("AUTHALIC", "BALANCED", "SOFT", "CUSTOM")] == [0, 1, 2, 3]


@pytest.mark.parametrize("name", ["unwrap", "sphere_shape_key"])
def test_scripts_may_name_a_preset(name: str) -> None:
    obj = meshes.bumpy(meshes.icosphere(3))
    operator = getattr(bpy.ops.authalic, name)

    def written() -> Any:
        if name == "unwrap":
            return meshes.uv(obj)
        points = np.empty(3 * len(obj.data.vertices), np.float32)
        obj.data.shape_keys.key_blocks["Authalic Sphere"].points.foreach_get("co", points)
        return points

    operator(angle_preset="SOFT")
    by_name = written()
    operator(angle_weight=part("bridge.solver").PRESETS["SOFT"])
    assert (written() == by_name).all()
    operator(angle_weight=part("bridge.solver").PRESETS["SOFT"], angle_preset="CUSTOM")
    assert (written() == by_name).all()
    operator(angle_weight=part("bridge.solver").PRESETS["SOFT"], angle_preset="EVEN")
    assert (written() == by_name).all()
    operator()
    assert (written() != by_name).any()


def test_the_slider_spans_the_useful_weights() -> None:
    solver = part("bridge.solver")
    assert solver.weight(0) == 0
    assert solver.weight(solver.PRESETS["EVEN"]) == pytest.approx(0.001, rel=1e-6)
    assert solver.weight(solver.PRESETS["BALANCED"]) == pytest.approx(0.03, rel=0.01)
    assert solver.weight(solver.PRESETS["SOFT"]) == pytest.approx(0.3, rel=0.01)
    weights = [solver.weight(slider) for slider in np.linspace(0, 1, 20)]
    assert weights == sorted(weights) and weights[1] < 1e-4 and weights[-1] > 3


@pytest.mark.parametrize("options", [{}, {"angle_preset": "CIRCLE"}, {"angle_weight": 0.5}])
def test_what_it_says_has_the_angles(options: dict[str, Any], capfd: pytest.CaptureFixture[str]) -> None:
    meshes.suzanne(1)
    bpy.ops.authalic.unwrap(**options)
    said = capfd.readouterr().out
    assert "Info: Unwrapped 3 islands, area ratio SD 0." in said and "0 flips, angle distortion " in said


# Outlines


def outline_distances(obj: MeshObject) -> Array:
    """The distances of the UVs on the boundary from the middle of all, over the largest."""
    corners, _, _ = meshes.triangles(obj)
    vertices = np.array([loop.vertex_index for loop in obj.data.loops])[corners]
    edges = np.sort(np.stack([vertices, np.roll(vertices, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    found, count = np.unique(edges, axis=0, return_counts=True)
    boundary = np.isin(vertices, found[count == 1])
    uv = meshes.uv(obj)[corners[boundary]]
    distances = np.linalg.norm(uv - (uv.min(axis=0) + uv.max(axis=0)) / 2, axis=1)
    return distances / distances.max()


@pytest.mark.parametrize("options", [{"angle_preset": "CIRCLE"}, {"outline": "CIRCLE"}])
def test_circles_are_round(options: Any) -> None:
    obj = meshes.add_grid(n=8)
    figures_of(**options)
    assert outline_distances(obj).min() > 0.999
    figures_of()
    assert outline_distances(obj).min() < 0.8


def test_the_circle_takes_the_slider_too() -> None:
    meshes.add_grid(n=8, bump=1.5)
    even, soft = (figures_of(outline="CIRCLE", angle_weight=weight) for weight in (0.0, 0.8))
    assert even[0] < soft[0] and soft[1] < even[1]


def test_rectangles_are_upright_and_full() -> None:
    obj = meshes.add_grid(n=8)
    figures_of(outline="RECTANGLE")
    uv = meshes.uv(obj)
    size = np.ptp(uv, axis=0)
    corners, _, _ = meshes.triangles(obj)
    assert meshes.uv_areas(uv[corners]).sum() == pytest.approx(size.prod(), rel=1e-5)
    assert size.max() > 0.99


def test_overlap_is_no_flip() -> None:
    meshes.add_grid(n=8, bump=1.5)
    deviation, _ = figures_of(allow_overlap=True)
    assert deviation < 0.1


@pytest.mark.parametrize("method", ["GRADIENT_DESCENT", "FIXED_POINT"])
def test_other_methods_know_circles_only(method: str) -> None:
    obj = meshes.add_grid(n=8)
    figures_of(method=method, outline="RECTANGLE", area_tolerance=0.1)
    assert outline_distances(obj).min() > 0.999


# The area tolerance


def test_area_tolerance_is_kept_and_spares_shapes() -> None:
    seamed_suzanne(1)
    figures = {tolerance: figures_of(area_tolerance=tolerance) for tolerance in (0.01, 0.05, 0.2)}
    assert all(deviation < 1.5 * tolerance for tolerance, (deviation, _) in figures.items())
    angles = [angle for _, angle in figures.values()]
    assert angles == sorted(angles, reverse=True) and angles[-1] < 0.9 * angles[0]
    # The slider does not count then.
    assert figures_of(area_tolerance=0.05, angle_weight=0.9) == figures[0.05]


def test_area_tolerance_of_closed_meshes() -> None:
    meshes.bumpy(meshes.icosphere(4))
    close, loose = (figures_of(area_tolerance=tolerance) for tolerance in (0.01, 0.3))
    assert close[0] < loose[0] and loose[1] < close[1]
    key = part("jobs.sphere_shape_key")
    solver = part("bridge").Solver(area_tolerance=0.1)
    ((_, shape),) = key.job(bpy.context, key.Settings(solver)).execute().shapes
    assert 0.01 < shape.deviation < 0.15


# Warnings


def test_what_has_not_converged_is_said_whatever_the_preset(capfd: pytest.CaptureFixture[str]) -> None:
    obj = seamed_suzanne()
    for name in PRESETS:
        figures_of(angle_preset=name, iterations=1)
        said = capfd.readouterr().out
        assert "Warning: Unwrapped" in said and f"{obj.name} at face" in said
        assert "stopped at the iteration limit (area ratio SD 0." in said and "angle distortion " in said
    meshes.bumpy(meshes.icosphere(4))
    bpy.ops.authalic.sphere_shape_key(iterations=1)
    said = capfd.readouterr().out
    assert "Warning: Authalic Sphere on" in said and "stopped at the iteration limit (area" in said


@pytest.mark.parametrize("name", PRESETS)
def test_bad_figures_are_said_whatever_the_preset(name: str, capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.add(*meshes.tube(100, 3, closed=True), "Tube")
    try:
        bpy.ops.authalic.unwrap(angle_preset=name)
    except RuntimeError as refusal:
        assert "Tube at face 0" in str(refusal)
        return
    ratios = meshes.area_ratios(obj)
    said = capfd.readouterr().out
    assert "Warning" in said or ratios.std() < 0.5
    assert "angle distortion" in said
