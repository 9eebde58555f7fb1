# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs inside Blender (bpy): unwraps meshes in several ways and leaves a scene, a picture and figures.

Usage: python demo_scene.py OUT_FOLDER [MESH_FILE ...]
"""

import json
import os
import sys
import traceback
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

import demo_measure as measure
import demo_meshes
import demo_stage as stage
import demo_unwrap

PIXELS_PER_CELL = 380
SAMPLES = 24


def main(out, files):
    """Makes everything the demo leaves, except for the figures that need matplotlib."""
    bpy.ops.wm.read_homefile(use_empty=True)
    install_extension()
    methods = demo_unwrap.available()
    sources = [demo_meshes.suzanne(), demo_meshes.cut_sphere(), *map(demo_meshes.from_file, files)]
    materials = stage.checker_material(), stage.heat_material()
    report = []
    for index, source in enumerate(sources):
        row = 2 * index
        stage.label(source.name, -0.56, row, 0.2, "RIGHT")
        stage.label("area ratio", -0.56, row + 1, 0.15, "RIGHT", 0.1)
        for column, method in enumerate(methods):
            report.append(one_cell(out, source, method, (column, row), materials))
        bpy.data.objects.remove(source)
    write_report(out, report)
    finish(out, [method.name for method in methods], len(sources), materials[1])


def install_extension():
    """Installs the zip that scripts/demo names into the current profile, as a person would."""
    archive = os.environ.get("AUTHALIC_EXTENSION_ZIP")
    if archive:
        bpy.ops.extensions.package_install_files(
            filepath=archive, repo="user_default", enable_on_install=True
        )


def one_cell(out, source, method, place, materials):
    """Unwraps a copy of a mesh, measures it, puts it on the wall twice; returns its entry in the report."""
    entry = {"mesh": source.name, "method": method.name}
    triangles = len(measure.layout_of(source.data).uv)
    if method.limit is not None and triangles > method.limit:
        stage.label("left out: takes minutes", *place, 0.15)
        print(f"  {source.name} ({triangles} triangles): {method.name} left out, it takes minutes")
        return entry | {"left_out": f"more than {method.limit} triangles"}
    shape = copy_of(source, f"{source.name} - {method.name}")
    seconds, problem = demo_unwrap.timed(shape, method)
    layout = measure.layout_of(shape.data)
    entry |= {"seconds": round(seconds, 3), "problem": problem} | measure.summary(layout)
    keep(out, entry, layout)
    show(shape, layout, place, materials)
    stage.label(caption(entry), place[0], place[1] + 1.47, 0.125)
    print("  " + sentence(entry), flush=True)
    return entry


def copy_of(source, name):
    """A copy of an object with a mesh of its own, in the scene."""
    shape = source.copy()
    shape.data = source.data.copy()
    shape.name = name
    bpy.context.scene.collection.objects.link(shape)
    return shape


def keep(out, entry, layout):
    """Writes what the figures need, in the order of the report."""
    number = len(list((out / "data").iterdir()))
    names = {key: entry[key] for key in ("mesh", "method")}
    ratio = measure.area_ratio(layout)
    np.savez_compressed(out / "data" / f"{number:03}.npz", uv=layout.uv, area_ratio=ratio, **names)


def show(shape, layout, place, materials):
    """The same mesh twice: with the checker, and below it with the heat map."""
    column, row = place
    surface, signed = measure.areas(layout)
    density = float(np.sqrt(surface.sum() / max(np.abs(signed).sum(), 1e-300)))
    shape["checker_scale"] = density / stage.CHECKER_SIZE
    stage.write_ratio(shape.data, measure.polygon_log2_ratio(layout, len(shape.data.polygons)))
    below = shape.copy()
    below.name = f"{shape.name} - area ratio"
    bpy.context.scene.collection.objects.link(below)
    stage.place(shape, materials[0], column, row)
    stage.place(below, materials[1], column, row + 1)


def finish(out, names, meshes, heat):
    """Headings, legend, light and camera; writes the .blend and the picture."""
    for column, name in enumerate(names):
        stage.label(name, column, -0.62, 0.22)
    last = 2 * meshes - 0.5
    stage.heat_legend(heat, (len(names) - 1) / 2, last + 0.3)
    stage.light_and_camera((-1.4, len(names) - 0.42), (-0.8, last + 0.52), PIXELS_PER_CELL)
    bpy.ops.wm.save_as_mainfile(filepath=str(out / "demo.blend"), check_existing=False)
    print("rendering the comparison ...", flush=True)
    stage.render(out / "comparison.png", SAMPLES)


def write_report(out, results):
    """report.json: what the figures mean, and one entry for each mesh and method."""
    report = {
        "blender": bpy.app.version_string,
        "seconds": "one operator call in edit mode, single run",
        "area_ratio": "share of the UV area over share of the surface, per triangle; one scale per object",
        "flipped_triangles": "triangles of non-positive signed area in the UV plane",
        "angle_distortion": "sigma1 / sigma2 per triangle; 1 keeps angles",
        "results": results,
    }
    (out / "report.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")


def caption(entry):
    """The line below a pair of meshes."""
    parts = [
        f"SD {entry['area_ratio_std']:.3g}",
        f"{entry['flipped_triangles']} flipped",
        f"σ₁/σ₂ {entry['angle_distortion_mean']:.2f}",
        f"{entry['seconds']:.2f} s",
    ]
    return "     ".join(["failed", *parts] if entry["problem"] else parts)


def sentence(entry):
    """The line in the terminal."""
    text = (
        f"{entry['mesh']:<18} {entry['method']:<21} {entry['seconds']:7.2f} s   area ratio SD "
        f"{entry['area_ratio_std']:<9.3g} flipped {entry['flipped_triangles']:<5} "
        f"mean σ₁/σ₂ {entry['angle_distortion_mean']:.3g}"
    )
    return text + (f"\n    problem: {entry['problem']}" if entry["problem"] else "")


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
