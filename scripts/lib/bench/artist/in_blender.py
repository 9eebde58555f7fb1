# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs inside Blender (bpy): unwraps one model in every way, with the extension installed from its zip.

Usage: python -m bench.artist.in_blender RESULT.npz MODEL [FOLDER]

The environment names the zip and a scratch profile. RESULT.npz has `vertices` (n, 3), `faces` (m, 3) and
`loops` (m, 3) of the triangles, `island_of` (m,), −1 in islands without an outline or with handles, `is_disk`
for each island, and for each method `uv NAME` (corners, 2) and `seconds NAME`, or `error NAME`. The last
method has a tenth of the deviation of Minimum Stretch.
"""

import os
import sys
import time
from contextlib import suppress
from functools import partial

import bpy
import numpy as np

from bench import blender
from bench.artist import figures, models

OURS, TENTH, ABF, STRETCH = "authalic", "authalic, a tenth", "ABF", "Minimum Stretch 10"
METHODS = {
    ABF: lambda: bpy.ops.uv.unwrap(method="ANGLE_BASED"),
    STRETCH: lambda: bpy.ops.uv.unwrap(method="MINIMUM_STRETCH", no_flip=True, iterations=10),
    OURS: lambda: bpy.ops.authalic.unwrap(),
}
SHARE = 0.1
"""The deviation of the last method, over that of Minimum Stretch."""
LEAST = 1e-3
"""The least tolerance that is asked for."""
TRIES = 3
"""How often its tolerance is corrected."""


def main(target, name, folder=""):
    """Unwraps the model and writes what the methods make of it."""
    install()
    warm_up()
    shape = models.load(name, folder)
    arrays = triangles(shape.data)
    arrays["island_of"], arrays["is_disk"] = islands(arrays)
    for method, call in METHODS.items():
        arrays |= unwrapped(shape, arrays, method, call)
    if f"uv {STRETCH}" in arrays and arrays["is_disk"].size:
        arrays |= at_a_tenth(shape, arrays)
    np.savez(target, **arrays)


def at_a_tenth(shape, arrays):
    """The UVs by the operator of least shear whose deviation is a tenth of that of Minimum Stretch."""
    tolerance = wanted = max(SHARE * deviation(arrays, arrays, STRETCH), LEAST)
    for _ in range(TRIES):
        result = unwrapped(
            shape, arrays, TENTH, partial(bpy.ops.authalic.unwrap, area_tolerance=float(tolerance))
        )
        found = deviation(arrays, result, TENTH) if f"uv {TENTH}" in result else 0.0
        if found == 0.0 or 0.95 * wanted <= found <= 1.0001 * wanted:
            break
        tolerance *= np.clip(0.98 * wanted / found, 0.5, 2.0)
    return result


def deviation(arrays, result, method):
    """The standard deviation of the area ratio of a result."""
    faces = arrays["island_of"] >= 0
    corners = result[f"uv {method}"][arrays["loops"][faces]]
    triangles = arrays["vertices"][arrays["faces"][faces]]
    return figures.measured(triangles, corners, arrays["island_of"][faces]).deviation


def install():
    """Installs the extension as a person would."""
    archive = os.environ["AUTHALIC_EXTENSION_ZIP"]
    bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)


def warm_up():
    """Calls every operator once, so that no method is charged for what is loaded on the first call."""
    shape = models.load("icosphere", None)
    models.open_in_edit_mode(shape)
    bpy.ops.mesh.select_all(action="SELECT")
    for call in METHODS.values():
        with suppress(RuntimeError, TypeError):
            call()


def triangles(mesh):
    """The vertices and triangles of a mesh, and its seams."""
    mesh.calc_loop_triangles()
    vertices, loops, faces = (
        np.empty(3 * len(mesh.vertices)), *np.empty((2, 3 * len(mesh.loop_triangles)), np.int32)
    )  # fmt: skip
    mesh.vertices.foreach_get("co", vertices)
    mesh.loop_triangles.foreach_get("loops", loops)
    mesh.loop_triangles.foreach_get("vertices", faces)
    polygon = np.empty(len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("polygon_index", polygon)
    seams = np.array([edge.vertices for edge in mesh.edges if edge.use_seam], np.int64).reshape(-1, 2)
    return {
        "vertices": vertices.reshape(-1, 3), "faces": faces.reshape(-1, 3), "loops": loops.reshape(-1, 3),
        "polygon": polygon, "seams": seams,
    }  # fmt: skip


def islands(arrays):
    """The island of each triangle, −1 where it cannot be laid flat, and whether each island is a disk."""
    import authalic  # comes with the extension

    patches = authalic.cut(arrays["vertices"], arrays["faces"], seams=arrays["seams"])
    flat = [patch for patch in patches if not patch.is_closed and patch.genus == 0]
    island_of = np.full(len(arrays["faces"]), -1)
    for number, patch in enumerate(flat):
        island_of[patch.face_of] = number
    return island_of, np.array([patch.is_disk for patch in flat], bool)


def unwrapped(shape, arrays, method, call):
    """The UVs by an operator of the islands that can be laid flat, or its error."""
    mesh = shape.data
    chosen = np.zeros(len(mesh.polygons), bool)
    chosen[arrays["polygon"][arrays["island_of"] >= 0]] = True
    while mesh.uv_layers:
        mesh.uv_layers.remove(mesh.uv_layers[0])
    mesh.uv_layers.new()
    models.open_in_edit_mode(shape)
    bpy.ops.mesh.select_mode(type="FACE")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    mesh.polygons.foreach_set("select", chosen)
    bpy.ops.object.mode_set(mode="EDIT")
    began = time.perf_counter()
    try:
        call()
    except (RuntimeError, TypeError) as problem:  # an error of the operator; no such method in this Blender
        return {f"error {method}": " ".join(str(problem).split())}
    finally:
        seconds = time.perf_counter() - began
        bpy.ops.object.mode_set(mode="OBJECT")
    return {f"uv {method}": blender.corner_uvs(mesh), f"seconds {method}": seconds}


if __name__ == "__main__":
    main(*sys.argv[1:])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)  # Blender has been seen to hang at a normal exit
