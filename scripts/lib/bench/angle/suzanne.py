# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs inside Blender (bpy): Suzanne, subdivided twice with her seams, and Blender's own UVs of her.

Usage: python -m bench.angle.suzanne RESULT.npz

RESULT.npz has `vertices` (n, 3), `faces` (m, 3), `loops` (m, 3), the polygon's corner at each corner of a
triangle, `seams` (k, 2), and for each way of unwrapping `uv NAME` (corners, 2) and `seconds NAME`.
"""

import os
import sys

import bpy
import numpy as np

from bench import blender
from demo import meshes

ITERATIONS = (1, 2, 5, 10, 50, 200)
WAYS = {"ABF": ("ANGLE_BASED", {})} | {
    f"Minimum Stretch {count}": ("MINIMUM_STRETCH", {"no_flip": True, "iterations": count})
    for count in ITERATIONS
}


def main(target):
    """Unwraps in every way; the operator does not look at older UVs."""
    bpy.ops.wm.read_homefile(use_empty=True)
    shape = meshes.suzanne()
    arrays = triangles(shape.data)
    for name, (method, options) in WAYS.items():
        try:
            arrays[f"uv {name}"], arrays[f"seconds {name}"] = blender.operated(shape, method, **options)
        except RuntimeError as problem:
            print(f"{name}: {problem}")
    np.savez(target, **arrays)


def triangles(mesh):
    """The arrays of the mesh, without UVs."""
    mesh.calc_loop_triangles()
    vertices = np.array([vertex.co for vertex in mesh.vertices], float)
    loops = np.array([triangle.loops for triangle in mesh.loop_triangles], np.int64)
    faces = np.array([triangle.vertices for triangle in mesh.loop_triangles], np.int64)
    seams = np.array([edge.vertices for edge in mesh.edges if edge.use_seam], np.int64).reshape(-1, 2)
    return {"vertices": vertices, "faces": faces, "loops": loops, "seams": seams}


if __name__ == "__main__":
    main(sys.argv[1])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)  # Blender has been seen to hang at a normal exit
