# SPDX-License-Identifier: MIT OR Apache-2.0
"""The demo's reports of its maps: report.json, captions, lines in the terminal, arrays for the figures."""

import json

import bpy
import numpy as np

from demo import measure


def write(out, results):
    """Writes report.json: the meaning of the figures, and one entry for each mesh and method."""
    report = {
        "blender": bpy.app.version_string,
        "seconds": "one operator call, single run (in edit mode; the shape key in object mode)",
        "area_ratio": "share of the UV area over share of the surface, per triangle; one scale per object",
        "flipped_triangles": "triangles of non-positive signed area in the UV plane",
        "shape_key": 'the method "Authalic Sphere": areas and signs are those on the sphere',
        "angle_distortion": "sigma1 / sigma2 per triangle; 1 preserves angles",
        "results": results,
    }
    (out / "report.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")


def keep(folder, entry, layout):
    """Writes the arrays for the figures, numbered in the order of the report."""
    folder.mkdir(exist_ok=True)
    number = len(list(folder.glob("*.npz")))
    names = {key: entry[key] for key in ("mesh", "method")}
    ratio = measure.area_ratio(layout)
    np.savez_compressed(folder / f"{number:03}.npz", uv=layout.uv, area_ratio=ratio, **names)


def caption(entry):
    """The line below a mesh or a pair of meshes."""
    parts = [
        f"SD {entry['area_ratio_std']:.3g}",
        f"{entry['flipped_triangles']} flipped",
        f"σ₁/σ₂ {entry['angle_distortion_mean']:.2f}",
        f"{entry['seconds']:.2f} s",
    ]
    return "     ".join(["failed", *parts] if entry["problem"] else parts)


def sentence(entry):
    """The line in the terminal."""
    text = f"{entry['mesh']:<18} {entry['method']:<25} {entry['seconds']:7.2f} s"
    if "area_ratio_std" in entry:
        text += (
            f"   area ratio SD {entry['area_ratio_std']:<9.3g} flipped {entry['flipped_triangles']:<5} "
            f"mean σ₁/σ₂ {entry['angle_distortion_mean']:.3g}"
        )
    return text + (f"\n    problem: {entry['problem']}" if entry["problem"] else "")
