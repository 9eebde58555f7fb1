# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs inside Blender (bpy): its automatic layout of a mesh, and its packer on given islands.

Usage: python -m bench.seams.in_blender unwrap|pack TASK.npz RESULT.npz

RESULT.npz has `corners` (m, 3, 2) and `seconds`, or only `error`.
"""

import os
import sys
import time

import bpy
import numpy as np

from bench import blender


def main(task, source, target):
    """Does a task and writes its result; an error of Blender is a result."""
    with np.load(source) as file:
        arrays = dict(file)
    bpy.ops.wm.read_homefile(use_empty=True)
    try:
        corners, seconds = TASKS[task](**arrays)
    except RuntimeError as problem:
        np.savez(target, error=" ".join(str(problem).split()))
        return
    np.savez(target, corners=corners.reshape(-1, 3, 2), seconds=seconds)


def unwrap(vertices, faces, iterations):
    """Smart UV Project by its defaults; its islands' borders as seams of Minimum Stretch."""
    shape = blender.object_of(vertices, faces)
    with_all_selected(shape)
    began = time.perf_counter()
    bpy.ops.uv.smart_project()
    bpy.ops.uv.select_all(action="SELECT")
    bpy.ops.uv.seams_from_islands()
    seconds = time.perf_counter() - began
    bpy.ops.object.mode_set(mode="OBJECT")
    corners, more = blender.operated(shape, "MINIMUM_STRETCH", iterations=int(iterations))
    return corners, seconds + more


def pack(vertices, faces, corners, margin):
    """The islands of a layout in the unit square, packed by their concave outlines."""
    shape = blender.object_of(vertices, faces)
    shape.data.uv_layers.active.uv.foreach_set("vector", corners.astype(np.float32).ravel())
    with_all_selected(shape)
    bpy.ops.uv.select_all(action="SELECT")
    began = time.perf_counter()
    bpy.ops.uv.pack_islands(
        udim_source="ACTIVE_UDIM", rotate=True, rotate_method="ANY", scale=True, margin_method="ADD",
        margin=float(margin), shape_method="CONCAVE",
    )  # fmt: skip
    seconds = time.perf_counter() - began
    bpy.ops.object.mode_set(mode="OBJECT")
    return blender.corner_uvs(shape.data), seconds


def with_all_selected(shape):
    """Opens an object in Edit Mode with all of its faces selected."""
    bpy.ops.object.select_all(action="DESELECT")
    shape.select_set(True)
    bpy.context.view_layer.objects.active = shape
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")


TASKS = {"unwrap": unwrap, "pack": pack}

if __name__ == "__main__":
    main(*sys.argv[1:])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)  # Blender has been seen to hang at a normal exit
