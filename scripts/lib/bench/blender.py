# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs inside Blender (bpy): its own unwrapping of a mesh, as one operator call.

`bench.peers.worker` and `bench.angle.suzanne` use it.
"""

import time

import bpy
import numpy as np


def unwrapped(vertices, faces, method, **options):
    """Blender's UVs of a triangle mesh without seams, (n, 2), and seconds; RuntimeError if there are none."""
    shape = object_of(vertices, faces)
    corner_uv, seconds = operated(shape, method, **options)
    image = np.zeros((len(vertices), 2))
    image[faces.ravel()] = corner_uv
    if not np.array_equal(image[faces.ravel()], corner_uv):
        raise RuntimeError("Blender left the mesh without a map: the corners of a vertex have different UVs")
    return image, seconds


def object_of(vertices, faces):
    """A new object of these triangles."""
    mesh = bpy.data.meshes.new("mesh")
    mesh.from_pydata(vertices.tolist(), [], faces.tolist())
    shape = bpy.data.objects.new("mesh", mesh)
    bpy.context.collection.objects.link(shape)
    mesh.uv_layers.new()
    return shape


def operated(shape, method, **options):
    """The UVs of the corners of an object after `uv.unwrap`, and the seconds of the call."""
    known = bpy.ops.uv.unwrap.get_rna_type().properties["method"].enum_items.keys()
    if method not in known:
        raise RuntimeError(f"Blender {bpy.app.version_string} has no unwrap method {method}")
    bpy.ops.object.select_all(action="DESELECT")
    shape.select_set(True)
    bpy.context.view_layer.objects.active = shape
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    began = time.perf_counter()
    bpy.ops.uv.unwrap(method=method, fill_holes=True, margin=0.0, **options)
    seconds = time.perf_counter() - began
    bpy.ops.object.mode_set(mode="OBJECT")
    return corner_uvs(shape.data), seconds


def corner_uvs(mesh):
    """The active UV map, (corners, 2) float64."""
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers.active.uv.foreach_get("vector", uv)
    return uv.reshape(-1, 2).astype(float)
