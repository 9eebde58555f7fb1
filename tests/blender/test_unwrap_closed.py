# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.unwrap of small closed shapes without seams: the better layout, else seams, at once."""

import time
from collections.abc import Callable
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
import shears
from installed import part
from meshes import MeshObject

LAYOUTS = ("LAMBERT", "OCTAHEDRAL")
CUT = "cut open by seams, which are not marked"


def unwrap(**options: Any) -> set[str]:
    return bpy.ops.authalic.unwrap(**options)


def box(*sides: float) -> MeshObject:
    bpy.ops.mesh.primitive_cube_add(size=1)
    obj = bpy.context.object
    for vertex in obj.data.vertices:
        vertex.co = [x * side for x, side in zip(vertex.co, sides, strict=True)]
    return obj


def cylinder(around: int) -> MeshObject:
    bpy.ops.mesh.primitive_cylinder_add(vertices=around)
    return bpy.context.object


def cone(top: float) -> MeshObject:
    bpy.ops.mesh.primitive_cone_add(vertices=32, radius1=1, radius2=top, depth=2)
    return bpy.context.object


SHAPES: dict[str, Callable[[], MeshObject]] = {
    "tetrahedron": lambda: meshes.add(*meshes.tetrahedron()),
    "prism": lambda: cylinder(3),
    "cube": lambda: box(1, 1, 1),
    "plank": lambda: box(10, 1, 0.1),
    "plate": lambda: box(10, 10, 0.1),
    "cylinder": lambda: cylinder(32),
    "cone": lambda: cone(0),
    "frustum": lambda: cone(0.5),
}


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("name", SHAPES)
def test_small_closed_shapes_are_unwrapped(name: str, layout: str, capfd: pytest.CaptureFixture[str]) -> None:
    obj = SHAPES[name]()
    assert unwrap(sphere_layout=layout) == {"FINISHED"}
    ratios = meshes.area_ratios(obj)
    assert ratios.min() > 0 and ratios.std() < 0.12
    assert shears.of(obj).mean() < 3.5
    # what the layout that was not taken would be does not count
    assert "uneven" not in capfd.readouterr().out.replace("it would be uneven", "")
    assert not any(edge.use_seam for edge in obj.data.edges)


def test_the_better_layout_is_taken_and_named(capfd: pytest.CaptureFixture[str]) -> None:
    obj = box(10, 10, 0.1)
    assert unwrap(sphere_layout="LAMBERT") == {"FINISHED"}
    assert meshes.area_ratios(obj).std() < 0.01
    # the square with the pole in its middle
    assert np.ptp(meshes.uv(obj), axis=0).min() > 0.9
    said = capfd.readouterr().out
    assert "Cube at face 0: laid out as Octahedral, because it would be" in said
    assert "as Lambert Cylindrical" in said and CUT not in said


def test_the_wanted_layout_is_kept_where_it_is_good(capfd: pytest.CaptureFixture[str]) -> None:
    box(1, 1, 1)
    assert unwrap(sphere_layout="LAMBERT") == {"FINISHED"}
    said = capfd.readouterr().out
    assert "laid out as" not in said and CUT not in said


def test_a_tetrahedron_is_cut_open_to_its_net(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.add(*meshes.tetrahedron())
    assert unwrap() == {"FINISHED"}
    assert meshes.area_ratios(obj) == pytest.approx(1, abs=1e-5)
    assert shears.of(obj) == pytest.approx(1, abs=1e-5)
    assert f"Mesh at face 0: {CUT}" in capfd.readouterr().out


def test_many_small_shapes_are_named_once(capfd: pytest.CaptureFixture[str]) -> None:
    shapes = [meshes.tetrahedron((4 * k, 0, 0)) for k in range(12)]
    obj = meshes.add(*meshes.together(*shapes))
    assert unwrap() == {"FINISHED"}
    assert meshes.area_ratios(obj) == pytest.approx(1, abs=1e-4)
    said = capfd.readouterr().out
    assert said.count(CUT) == 1 and "(and 11 more)" in said


def test_other_presets_fall_back_too() -> None:
    obj = meshes.add(*meshes.tetrahedron())
    assert unwrap(angle_preset="SOFT") == {"FINISHED"}
    assert meshes.area_ratios(obj) == pytest.approx(1, abs=1e-4)


@pytest.mark.parametrize("preset", ["EVEN", "BALANCED", "SOFT"])
@pytest.mark.parametrize("name", ["cone", "cylinder", "frustum"])
def test_low_poly_shapes_have_shapes_whatever_the_preset(name: str, preset: str) -> None:
    obj = SHAPES[name]()
    assert unwrap(angle_preset=preset) == {"FINISHED"}
    assert meshes.area_ratios(obj).std() < 0.3 and shears.of(obj).mean() < 3.5


def test_a_sphere_that_is_asked_for_is_not_cut_open() -> None:
    meshes.add(*meshes.tetrahedron())
    with pytest.raises(RuntimeError, match="would fold over"):
        unwrap(domain="SPHERE")


def test_esc_is_heard_while_seams_are_sought_in_place_of_a_layout() -> None:
    obj = cylinder(256)
    unwrap_job = part("jobs.unwrap")
    job = unwrap_job.job(bpy.context, unwrap_job.Settings()).start()
    while "seams" not in job.poll()[2]:
        assert job.poll()[0], "the search is over before it could be cancelled"
        time.sleep(0.02)
    before = meshes.uv(obj)
    job.cancel()
    with pytest.raises(part("jobs.job").Cancelled):
        job.apply()
    job._thread.join(5)
    assert not job._thread.is_alive()
    assert (meshes.uv(obj) == before).all()
