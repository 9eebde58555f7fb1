# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own packer, on the outlines of islands in a passing scene of their own.

Nothing of the user's is selected, entered or moved, so there is nothing to restore; and the outline of an
island of a million faces packs as fast as that of ten.
"""

from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from . import islands as shapes


@dataclass
class PackSettings:
    """The options of Blender's Pack Islands, but for `rotate`: the islands are turned upright before.

    Blender's own search for rotations takes seconds for a few disks, which gain nothing by it.
    """

    rotate: bool = True
    margin_method: str = "SCALED"
    margin: float = 0.001
    shape_method: str = "CONVEX"


def pack(islands, settings):
    """Moves, turns and scales the UVs of islands, all by one scale, into the unit square."""
    if settings.rotate:
        for island in islands:
            island.uv = shapes.moved(island.uv, shapes.upright(shapes.outline(island.uv)), 0)
    outlines = [shapes.outline(island.uv) for island in islands]
    for island, before, after in zip(islands, outlines, _packed(outlines, settings), strict=True):
        island.uv = shapes.moved(island.uv, *shapes.similarity(before, after))


def _packed(outlines, settings):
    with _scratch_object(outlines) as (scene, obj):
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
                    shape_method=settings.shape_method,
                )
            bpy.ops.object.mode_set(mode="OBJECT")
        uv = np.empty(2 * len(obj.data.loops), np.float32)
        obj.data.uv_layers[0].uv.foreach_get("vector", uv)
    ends = np.cumsum([len(outline) for outline in outlines])
    return np.split(uv.reshape(-1, 2).astype(float), ends[:-1])


@contextmanager
def _scratch_object(outlines):
    """A mesh with one selected face for each outline, alone in a scene."""
    mesh = bpy.data.meshes.new(".authalic")
    obj = bpy.data.objects.new(".authalic", mesh)
    scene = bpy.data.scenes.new(".authalic")
    try:
        _fill(mesh, outlines)
        scene.collection.objects.link(obj)
        scene.view_layers[0].objects.active = obj
        obj.select_set(True, view_layer=scene.view_layers[0])
        scene.tool_settings.use_uv_select_sync = True
        yield scene, obj
    finally:
        bpy.data.scenes.remove(scene)
        bpy.data.objects.remove(obj)
        bpy.data.meshes.remove(mesh)


def _fill(mesh, outlines):
    points = np.concatenate(outlines)
    ends = np.cumsum([len(outline) for outline in outlines]).tolist()
    faces = [range(end - len(outline), end) for end, outline in zip(ends, outlines, strict=True)]
    mesh.from_pydata(np.pad(points, ((0, 0), (0, 1))).tolist(), [], [list(face) for face in faces])
    mesh.polygons.foreach_set("select", np.ones(len(faces), bool))
    layer = mesh.uv_layers.new(name="UVMap", do_init=False)
    layer.uv.foreach_set("vector", points.astype(np.float32).ravel())
