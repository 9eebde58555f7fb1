# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.unwrap of islands that are flat or can be rolled out flat: they come out as they are."""

from collections.abc import Callable
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
import shears
from installed import part
from meshes import MeshObject

PRESETS = ("EVEN", "BALANCED", "SOFT")
SEVEN = [(0, 0), (1, 0), (0.5, 0.9), (0.5, -0.5), (1.4, -0.9), (-0.4, -0.9), (-0.65, -0.25)]
"""An outline in which some triangles have all corners on the boundary."""
CROSS = [(-1, -3), (1, -3), (1, -1), (3, -1), (3, 1), (1, 1), (1, 3), (-1, 3), (-1, 1), (-3, 1), (-3, -1)]
CROSS.append((-1, -1))


def flat(points: Any, faces: Any) -> MeshObject:
    return meshes.add([(x, y, 0) for x, y in points], faces)


def grid(across: int, up: int) -> MeshObject:
    points = [(x, y) for y in range(up + 1) for x in range(across + 1)]
    row = across + 1
    quads = [(row * y + x, row * y + x + 1, row * (y + 1) + x + 1, row * (y + 1) + x)
             for y in range(up) for x in range(across)]  # fmt: skip
    return flat(points, quads)


def frustum(lower: float, upper: float) -> MeshObject:
    """The side of a cone without its tip, or of a cylinder, cut open along one edge."""
    bpy.ops.mesh.primitive_cone_add(
        vertices=32, radius1=lower, radius2=upper, depth=2, end_fill_type="NOTHING"
    )
    obj = bpy.context.object
    upright = [
        edge for edge in obj.data.edges if np.ptp([obj.data.vertices[v].co.z for v in edge.vertices]) > 1
    ]
    upright[0].use_seam = True
    return obj


SHAPES: dict[str, Callable[[], MeshObject]] = {
    "seven": lambda: flat(SEVEN, [(0, 1, 2), (1, 0, 3), (1, 3, 4), (3, 0, 5), (5, 0, 6)]),
    "grid of 2": lambda: grid(2, 2),
    "grid of 8": lambda: grid(8, 8),
    "cross": lambda: flat(CROSS, [range(12)]),
    "strip": lambda: grid(100, 1),
    "cone": lambda: frustum(1, 0.5),
    "cylinder": lambda: frustum(1, 1),
}


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("name", SHAPES)
def test_what_is_flat_stays_flat(name: str, preset: str, capfd: pytest.CaptureFixture[str]) -> None:
    obj = SHAPES[name]()
    assert bpy.ops.authalic.unwrap(angle_preset=preset) == {"FINISHED"}
    # Blender keeps UVs in single precision: a quad of the strip is a hundredth of the square
    assert np.abs(meshes.area_ratios(obj) - 1).max() < 2e-5
    assert shears.of(obj).max() < 1 + 2e-5
    said = capfd.readouterr().out
    assert "Info: Unwrapped 1 island" in said and "Warning" not in said


@pytest.mark.parametrize("name", SHAPES)
def test_flat_islands_are_exact_before_they_are_rounded(name: str) -> None:
    surface = part("blender.meshes").read(SHAPES[name]())
    bridge = part("bridge")
    (island,) = bridge.unwrap([surface], bridge.UnwrapSettings()).islands
    areas = meshes.surface_areas(island.points[island.faces])
    ratios = meshes.uv_areas(island.uv[island.faces]) / areas
    assert ratios.std() / ratios.mean() < 1e-6


def test_a_circle_that_bends_a_flat_island_is_a_warning(capfd: pytest.CaptureFixture[str]) -> None:
    grid(2, 2)
    assert bpy.ops.authalic.unwrap(angle_preset="CIRCLE") == {"FINISHED"}
    said = capfd.readouterr().out
    assert "Warning" in said and "Mesh at face 0: uneven" in said


@pytest.mark.parametrize("preset", PRESETS)
def test_too_few_iterations_are_a_warning(preset: str, capfd: pytest.CaptureFixture[str]) -> None:
    meshes.suzanne(1)
    assert bpy.ops.authalic.unwrap(angle_preset=preset, iterations=1) == {"FINISHED"}
    said = capfd.readouterr().out
    assert "Warning" in said and "stopped at the iteration limit" in said


@pytest.mark.parametrize("sides", [4, 6, 10])
def test_a_long_spike_is_even_though_its_faces_must_be_sheared(sides: int) -> None:
    angle = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    rim = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    points = np.concatenate([[[0.3, 0, 30]], rim * [0.5, 0.5, 1] + [0, 0, 15], rim])
    k, after = np.arange(sides), (np.arange(sides) + 1) % sides
    tip = np.stack([0 * k, 1 + k, 1 + after], axis=1)
    side = np.stack([1 + k, 1 + sides + k, 1 + sides + after], axis=1)
    other = np.stack([1 + k, 1 + sides + after, 1 + after], axis=1)
    obj = meshes.add(points, np.concatenate([tip, side, other]))
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}
    ratios = meshes.area_ratios(obj)
    assert (ratios > 0).all()
    assert ratios.std() / ratios.mean() < 0.01
