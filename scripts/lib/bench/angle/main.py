# SPDX-License-Identifier: MIT OR Apache-2.0
"""Areas against angles: the curve over `angle_weight`, the front for every boundary, and Minimum Stretch.

Usage: python -m bench.angle.main TARGET_FILE [--meshes NAME ...] [--blender PYTHON] [--absent bpy=MESSAGE]

The plots go beside the target.
"""

import argparse
import os
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import authalic
from bench import meshes
from bench.angle import front, plot
from bench.peers import run
from bench.report import Report, machine, scientific
from shell import PYTHONPATH

WEIGHTS = (3, 1, 0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 1e-5, 0)
STIFFER = (1000, 300, 100, 30, 10)
"""Further weights for the islands, so that the curve reaches the angles of Minimum Stretch."""
MODELS = ("spot_2930", "david_10671", "chineselion_17334")
SUZANNE = "suzanne"
ISLANDS = {"fill_holes": True, "boundary": "free"}
"""The options of the islands' maps, without the weight."""
COLUMNS = ("mesh", "V", "angle_weight", "SD", "E_A", "folds", "σ₁/σ₂", "σ₁/σ₂ p99", "s", "remark")
BESIDE_COLUMNS = (
    "island", "faces", "Blender", "SD", "σ₁/σ₂", "folds", "authalic's SD at that σ₁/σ₂", "angle_weight",
    "authalic's SD / Blender's",
)  # fmt: skip
NOTE = """\
SD is of the area ratio; σ₁/σ₂ is the angle distortion, its mean weighted by the areas of the surface. The
weights are `angle_weight`; 0 is the authalic map. All figures are `authalic.distortion`'s. Maps start anew
for every weight."""
BESIDE_NOTE = """\
Suzanne, subdivided twice, with the seams of her own UV map, unwrapped by Blender's operator (seconds for
all islands together: {seconds}). Her islands are mapped by `disk_map`, holes filled. Between two weights
the curve is interpolated: log SD over σ₁/σ₂. The boundary is free in both."""


@dataclass(frozen=True)
class Point:
    """A map, by how it distorts areas and angles."""

    label: str
    weight: float
    deviation: float
    energy: float
    angle: float
    """The mean of σ₁/σ₂, weighted by area; infinite if a face is folded."""
    angle_p99: float
    folds: int
    seconds: float
    remark: str = ""


def main(arguments=None):
    """Writes the curves and the fronts of the models, then the islands of Suzanne beside Blender."""
    options = parsed(arguments)
    report = Report(options.target)
    report.line(f"# Areas against angles\n\nauthalic {authalic.__version__}, {machine()}.")
    if models := chosen_models(options.meshes, MODELS):
        write_models(report, models)
    if models := chosen_models(options.meshes, front.MODELS):
        front.write(report, models)
    if not options.meshes or SUZANNE in options.meshes:
        beside_blender(report, options)


def parsed(arguments=None):
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", type=Path)
    parser.add_argument("--meshes", nargs="+", default=[])
    parser.add_argument("--blender", default="")
    parser.add_argument("--absent", nargs="+", default=[], type=lambda text: text.split("=", 1))
    return parser.parse_args(arguments)


def chosen_models(names, usual):
    """{name: (mesh, function)}: the named meshes, else the usual ones, else all."""
    disks, spheres = meshes.disks(), meshes.spheres()
    known = {name: (mesh, authalic.sphere_map) for name, mesh in spheres.items()}
    known |= {name: (mesh, authalic.disk_map) for name, mesh in disks.items()}
    meshes.check_names(names, [*known, SUZANNE])
    chosen = names or [name for name in usual if name in known] or list(known)
    return {name: known[name] for name in chosen if name != SUZANNE}


def write_models(report, models):
    """The table and the plot of the models."""
    report.section("The curve", NOTE)
    report.columns(COLUMNS)
    curves = {}
    for name, (mesh, call) in models.items():
        curves[name] = write_curve(report, name, mesh, call, WEIGHTS)
    draw(report, "curve", "Areas against angles", curves, {})


def write_curve(report, name, mesh, call, weights, **options):
    """The rows of one mesh; returns its points."""
    points = []
    for weight in weights:
        points.append(mapped(mesh, call, weight, **options))
        report.row((name, len(mesh[0]), *cells(points[-1])))
    return [point for point in points if np.isfinite(point.deviation)]


def mapped(mesh, call, weight, **options):
    """The point of one weight; without a map, its remark says why."""
    began = time.perf_counter()
    try:
        result = call(*mesh, angle_weight=float(weight), **options)
    except (authalic.SolverError, ValueError) as problem:
        nothing = (np.nan,) * 4
        return Point("authalic", weight, *nothing, 0, 0.0, f"{type(problem).__name__}: {problem}")
    seconds = time.perf_counter() - began
    image = result.uv if call is authalic.disk_map else result.positions
    return measured(
        "authalic", weight, mesh, image, seconds, f"{result.status}, {result.iterations} iterations"
    )


def measured(label, weight, mesh, image, seconds, remark=""):
    """The point of a map."""
    vertices, faces = mesh
    image = run.scaled(run.upright(image, faces), faces)
    figures = authalic.distortion(vertices, faces, image)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    angle = np.average(figures.angle_distortion, weights=areas)
    quality = figures.area_ratio_std, figures.authalic_energy, angle, figures.angle_distortion_p99
    return Point(label, weight, *quality, len(figures.folded), seconds, remark)


def cells(point):
    """The cells of the table of the curve, from the weight on."""
    if not np.isfinite(point.deviation):
        return (f"{point.weight:g}", *("–",) * 6, point.remark)
    return (
        f"{point.weight:g}", f"{point.deviation:.4f}", scientific(point.energy), point.folds,
        f"{point.angle:.3f}", f"{point.angle_p99:.2f}", f"{point.seconds:.2f}", point.remark,
    )  # fmt: skip


def beside_blender(report, options):
    """The islands of Suzanne: our curves, Blender's points, and the ratio at equal angles."""
    target = report.target.parent / "angle-suzanne.npz"
    problem = dict(options.absent).get("bpy") or unwrapped_in_blender(options.blender, target)
    if problem:
        report.section("Beside Blender", f"Not measured: {problem}")
        return
    with np.load(target) as file:
        arrays = dict(file)
    seconds = {name[8:]: float(arrays[name]) for name in arrays if name.startswith("seconds ")}
    text = ", ".join(f"{name} {value:.1f}" for name, value in seconds.items())
    report.section("Beside Blender", BESIDE_NOTE.format(seconds=text))
    report.columns(COLUMNS)
    curves, others, sizes = {}, {}, {}
    for name, (mesh, images) in islands(arrays).items():
        weights = (*STIFFER, *WEIGHTS)
        curves[name] = write_curve(report, name, mesh, authalic.disk_map, weights, **ISLANDS)
        others[name] = [measured(label, np.nan, mesh, image, np.nan) for label, image in images.items()]
        sizes[name] = len(mesh[1])
    report.line("\nAt equal angle distortion (below 1: ours preserves areas better):\n")
    report.columns(BESIDE_COLUMNS)
    for name, points in others.items():
        for point in points:
            report.row(beside_cells(name, sizes[name], point, curves[name]))
    draw(report, "suzanne", "The islands of Suzanne, subdivided twice", curves, others)


def unwrapped_in_blender(python, target):
    """Has Blender unwrap Suzanne; returns the problem, or an empty string."""
    if not python:
        return "there is no Blender (--blender)"
    target.unlink(missing_ok=True)
    command = [python, "-m", "bench.angle.suzanne", target]
    done = subprocess.run(command, env={**os.environ, **PYTHONPATH}, capture_output=True, text=True)
    if done.returncode or not target.exists():
        return (done.stderr.strip().splitlines() or ["no result"])[-1]
    return ""


def islands(arrays):
    """{name: (mesh, {Blender's method: image})}, largest first."""
    patches = authalic.cut(arrays["vertices"], arrays["faces"], seams=arrays["seams"])
    patches.sort(key=lambda patch: -len(patch.faces))
    named = {}
    for patch in patches:
        images = {name[3:]: image_of(patch, arrays, name) for name in arrays if name.startswith("uv ")}
        named[f"{SUZANNE}, island {len(named) + 1}"] = (patch.vertices, patch.faces), images
    return named


def image_of(patch, arrays, name):
    """Blender's UVs of an island, (n, 2)."""
    corners = arrays[name][arrays["loops"].ravel()[patch.corner_of]]
    image = np.zeros((len(patch.vertices), 2))
    image[patch.faces] = corners
    if not np.allclose(image[patch.faces], corners, atol=1e-5):
        raise SystemExit(f"{name}: Blender cut an island where there is no seam")
    return image


def beside_cells(name, faces, point, curve):
    """The cells of the table at equal angles."""
    head = (name, faces, point.label, f"{point.deviation:.4f}", f"{point.angle:.3f}", point.folds)
    angles = sorted(ours.angle for ours in curve if not ours.folds)
    if not angles:
        return (*head, "no map", "", "")
    if not angles[0] <= point.angle <= angles[-1]:
        return (*head, f"outside the curve, {angles[0]:.3f} to {angles[-1]:.3f}", "", "")
    deviation, weight = at_angle(curve, point.angle)
    return (*head, f"{deviation:.4f}", f"{weight:.2g}", f"{deviation / point.deviation:.3f}")


def at_angle(curve, angle):
    """The SD and the weight of a curve at an angle distortion, by log SD and log weight over σ₁/σ₂."""
    points = sorted((point for point in curve if not point.folds), key=lambda point: point.angle)
    angles = [point.angle for point in points]
    smallest = min((point.weight for point in points if point.weight > 0), default=1.0)
    weights = [max(point.weight, smallest / 10) for point in points]  # 0 has no logarithm
    deviation = np.exp(np.interp(angle, angles, np.log([point.deviation for point in points])))
    return deviation, np.exp(np.interp(angle, angles, np.log(weights)))


def draw(report, name, title, curves, others):
    """The plot of some curves, if there are any."""
    curves = {mesh: curve for mesh, curve in curves.items() if curve}
    if curves:
        path = report.target.parent / f"{report.target.stem}-{name}.png"
        plot.draw(path, title, curves, others)
        report.figure(path, title)


if __name__ == "__main__":
    main()
