# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own packer, on the bounding boxes of islands in a temporary scene.

The user's selection and mode stay untouched, and an island of a million faces packs as fast as one of ten.
Islands are disks, rectangles and squares: to follow their outlines would gain next to nothing, to turn them
little, and Blender's packer needs seconds for either.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Literal

import bpy
import numpy as np

from ..surfaces.arrays import Floats
from ..surfaces.islands import PlanarIsland, box


@dataclass
class PackSettings:
    """The options of Blender's Pack Islands that matter here."""

    margin_method: Literal["SCALED", "ADD", "FRACTION"] = "SCALED"
    margin: float = 0.001


def pack(islands: Sequence[PlanarIsland], settings: PackSettings) -> None:
    """Moves and scales the UVs of islands, all by one scale, into the unit square."""
    before = np.array([box(island.uv) for island in islands])
    after = _packed(before, settings)
    scale = np.ptp(after, axis=1).sum() / np.ptp(before, axis=1).sum()
    offsets = after.mean(axis=1) - scale * before.mean(axis=1)
    for island, offset in zip(islands, offsets, strict=True):
        island.uv = scale * island.uv + offset


def _packed(boxes: Floats, settings: PackSettings) -> Floats:
    """Boxes (b, 4, 2) where Blender puts them."""
    with _scratch_object(boxes) as (scene, obj):
        view = scene.view_layers[0]
        with bpy.context.temp_override(scene=scene, view_layer=view, active_object=obj, object=obj):
            bpy.ops.object.mode_set(mode="EDIT")
            with bpy.context.temp_override(edit_object=obj):
                bpy.ops.uv.pack_islands(
                    udim_source="ACTIVE_UDIM",
                    rotate=False,
                    scale=True,
                    margin_method=settings.margin_method,
                    margin=settings.margin,
                    shape_method="AABB",
                )
            bpy.ops.object.mode_set(mode="OBJECT")
        uv = np.empty(2 * len(obj.data.loops), np.float32)
        obj.data.uv_layers[0].uv.foreach_get("vector", uv)
    return uv.reshape(-1, 4, 2).astype(float)


@contextmanager
def _scratch_object(boxes: Floats) -> Iterator[tuple[bpy.types.Scene, Any]]:
    """A mesh with one selected face for each box, alone in a scene."""
    mesh = bpy.data.meshes.new(".authalic")
    obj = bpy.data.objects.new(".authalic", mesh)
    scene = bpy.data.scenes.new(".authalic")
    try:
        _fill(mesh, boxes)
        scene.collection.objects.link(obj)
        scene.view_layers[0].objects.active = obj
        obj.select_set(True, view_layer=scene.view_layers[0])
        scene.tool_settings.use_uv_select_sync = True
        yield scene, obj
    finally:
        bpy.data.scenes.remove(scene)
        bpy.data.objects.remove(obj)
        bpy.data.meshes.remove(mesh)


def _fill(mesh: bpy.types.Mesh, boxes: Floats) -> None:
    points = boxes.reshape(-1, 2)
    faces = np.arange(len(points)).reshape(-1, 4)
    mesh.from_pydata(np.pad(points, ((0, 0), (0, 1))).tolist(), [], faces.tolist())
    mesh.polygons.foreach_set("select", np.ones(len(faces), bool))
    layer = mesh.uv_layers.new(name="UVMap", do_init=False)
    layer.uv.foreach_set("vector", points.astype(np.float32).ravel())
