# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs inside Blender (bpy): unwraps meshes in several ways and leaves a scene, a picture and figures.

Usage: python -m demo.scene OUT_FOLDER [MESH_FILE ...]
"""

import os
import sys
import traceback
from pathlib import Path

import bpy

from demo import measure, meshes, morph, report, seams, sphere, stage, unwrap

PIXELS_PER_CELL = 380
SAMPLES = 24


def main(out, files):
    """Makes everything that the demo leaves but the figures that need matplotlib."""
    bpy.ops.wm.read_homefile(use_empty=True)
    install_extension()
    bpy.context.scene.name = "Comparison"
    methods = unwrap.available()
    sources = [meshes.suzanne(), meshes.cut_sphere(), *map(meshes.from_file, files)]
    closed = closed_meshes(sources[2:])
    heat = stage.heat_material()
    results = compare(out, sources, methods, heat)
    if hasattr(bpy.types, "AUTHALIC_OT_unwrap"):
        results += seams.show()
    if hasattr(bpy.types, "AUTHALIC_OT_sphere_shape_key"):
        results += sphere.show(out, closed, heat)
    if hasattr(bpy.types, "AUTHALIC_OT_register"):
        results.append(morph.show())
    report.write(out, results)
    finish(out)


def closed_meshes(sources):
    """The meshes of the second picture, {name: mesh}: a closed Suzanne and the closed given meshes."""
    chosen = [meshes.closed_suzanne()]
    for source in sources:
        if meshes.is_sphere(source.data):
            shape = meshes.copy_of(source, f"{source.name}, closed")
            chosen.append(meshes.without_seams(shape))
    closed = {shape.name: shape.data for shape in chosen}
    for shape in chosen:
        bpy.data.objects.remove(shape)
    return closed


def compare(out, sources, methods, heat):
    """The wall of the comparison: every mesh by every method; returns the entries of the report."""
    results, materials = [], (stage.checker_material(), heat)
    for index, source in enumerate(sources):
        row = 2 * index
        stage.label(source.name, -0.56, row, 0.2, "RIGHT")
        stage.label("area ratio", -0.56, row + 1, 0.15, "RIGHT", 0.1)
        for column, method in enumerate(methods):
            results.append(one_cell(out, source, method, (column, row), materials))
        bpy.data.objects.remove(source)
    frame_comparison([method.name for method in methods], len(sources), heat)
    return results


def install_extension():
    """Installs the zip that scripts/demo names into the current profile."""
    archive = os.environ.get("AUTHALIC_EXTENSION_ZIP")
    if archive:
        bpy.ops.extensions.package_install_files(
            filepath=archive, repo="user_default", enable_on_install=True
        )


def one_cell(out, source, method, place, materials):
    """Unwraps a copy of a mesh, measures it and shows it; returns its entry in the report."""
    entry = {"mesh": source.name, "method": method.name}
    triangles = len(measure.layout_of(source.data).uv)
    if method.limit is not None and triangles > method.limit:
        stage.label("left out: takes minutes", *place, 0.15)
        print(f"  {source.name} ({triangles} triangles): {method.name} left out, it takes minutes")
        return entry | {"left_out": f"more than {method.limit} triangles"}
    shape = meshes.copy_of(source, f"{source.name} - {method.name}")
    seconds, problem = unwrap.timed(shape, method)
    layout = measure.layout_of(shape.data)
    entry |= {"seconds": round(seconds, 3), "problem": problem} | measure.summary(layout)
    report.keep(out / "data", entry, layout)
    show(shape, layout, place, materials)
    stage.label(report.caption(entry), place[0], place[1] + 1.47, 0.125)
    print("  " + report.sentence(entry), flush=True)
    return entry


def show(shape, layout, place, materials):
    """Puts a mesh on the wall twice: with the checker, and below it with the heat map."""
    column, row = place
    surface, signed = measure.areas(layout)
    shape["checker_scale"] = stage.checker_scale(surface, signed)
    stage.write_ratio(shape.data, measure.polygon_log2_ratio(layout, len(shape.data.polygons)))
    below = shape.copy()
    below.name = f"{shape.name} - area ratio"
    bpy.context.scene.collection.objects.link(below)
    stage.place(shape, materials[0], column, row)
    stage.place(below, materials[1], column, row + 1)


def frame_comparison(names, mesh_count, heat):
    """Headings, legend, light and camera."""
    for column, name in enumerate(names):
        stage.label(name, column, -0.62, 0.22)
    last = 2 * mesh_count - 0.5
    stage.heat_legend(heat, (len(names) - 1) / 2, last + 0.3)
    stage.light_and_camera((-1.4, len(names) - 0.42), (-0.8, last + 0.52), PIXELS_PER_CELL)


def finish(out):
    """Writes the .blend and renders the pictures."""
    bpy.context.window.scene = bpy.data.scenes["Comparison"]
    bpy.ops.wm.save_as_mainfile(filepath=str(out / "demo.blend"), check_existing=False, compress=True)
    for name, picture, samples in (
        ("Comparison", "comparison.png", SAMPLES),
        ("Seams", "seams.png", seams.SAMPLES),
        ("Sphere", "sphere.png", sphere.SAMPLES),
        ("Registration", "morph.png", morph.SAMPLES),
    ):
        if name in bpy.data.scenes:
            print(f"rendering {picture} ...", flush=True)
            bpy.context.window.scene = bpy.data.scenes[name]
            stage.render(out / picture, samples)


if __name__ == "__main__":
    status = 1
    try:
        main(Path(sys.argv[1]), sys.argv[2:])
        status = 0
    except SystemExit as problem:
        print(problem)
    except Exception:
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # some versions hang at a normal exit
