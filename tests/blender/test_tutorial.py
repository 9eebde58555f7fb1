# SPDX-License-Identifier: GPL-3.0-or-later
"""The steps of docs/tutorials/artist.md, and the figures and labels that it promises."""

import ast
import re
from pathlib import Path

import bpy
import meshes
import numpy as np
import pairs
import pytest
import shears
from meshes import MeshObject

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "docs" / "tutorials" / "artist.md").read_text(encoding="utf-8")
OF_BLENDER = {
    "Add > Mesh > Monkey",
    "Angle Based",
    "Shear",
    "Subdivision Surface",
    "UV > Seams from Islands",
}


@pytest.fixture
def monkey() -> MeshObject:
    """Steps 1 and 2: Suzanne with the seams of her own UV map, subdivided twice."""
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.select_all(action="SELECT")
    bpy.ops.uv.seams_from_islands()
    bpy.ops.object.mode_set(mode="OBJECT")
    return meshes.subdivided(bpy.context.object, 2)


@pytest.mark.parametrize("preset", ["EVEN", "BALANCED", "SOFT"])
def test_the_presets_have_the_figures_of_the_table(monkey: MeshObject, preset: str) -> None:
    row = re.search(rf"(?m)^\| \*{preset.capitalize()}\* \| ([\d.]+) \| ([\d.]+) \|$", TEXT)
    assert row
    assert bpy.ops.authalic.unwrap(angle_preset=preset) == {"FINISHED"}
    assert meshes.area_ratios(monkey).std() == pytest.approx(float(row[1]), rel=0.25)
    assert shears.of(monkey).mean() == pytest.approx(float(row[2]), rel=0.03)


def test_seams_find_themselves(monkey: MeshObject) -> None:
    assert bpy.ops.authalic.unwrap(seams="AUTOMATIC") == {"FINISHED"}
    assert any(edge.use_seam for edge in monkey.data.edges)
    areas = meshes.surface_areas(meshes.triangles(monkey)[2])
    assert np.average(shears.of(monkey), weights=areas) < 1.42


def test_a_morph_and_a_transfer(monkey: MeshObject) -> None:
    bpy.ops.mesh.primitive_uv_sphere_add(location=(3, 0, 0))
    ball = bpy.context.object
    spots = [(0, -1, 0), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, 0, 1)]
    ends = zip(pairs.nearest(monkey, spots), pairs.nearest(ball, spots), strict=True)
    pairs.pair(monkey, ball, {f"Spot {number}": both for number, both in enumerate(ends)})
    assert bpy.ops.authalic.register() == {"FINISHED"}
    assert any(key.name.startswith("Morph") for key in monkey.data.shape_keys.key_blocks)
    assert bpy.ops.authalic.transfer() == {"FINISHED"}


def test_labels_are_those_of_the_extension() -> None:
    sources = [ast.parse(file.read_text(encoding="utf-8")) for file in (ROOT / "addon").rglob("*.py")]
    nodes = [node for tree in sources for node in ast.walk(tree)]
    known = {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    words = re.findall(r"(?<!\*)\*([^*]+)\*(?!\*)", TEXT)
    labels = {label for word in words for label in re.sub(r"\s+", " ", word).split(": ")}
    assert len(labels) > 20
    assert labels - OF_BLENDER <= known
