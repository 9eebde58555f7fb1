# SPDX-License-Identifier: MIT OR Apache-2.0
"""Artists' models: the operator with its defaults beside ABF and Minimum Stretch, on the same islands.

Usage: python -m bench.artist.main TARGET_FILE [--meshes NAME ...] [--timeout SECONDS] --blender PYTHON
           --extension ZIP --profile FOLDER [--absent bpy=MESSAGE]
"""

import argparse
import os
from pathlib import Path

import numpy as np

import authalic
from bench import meshes
from bench.artist.figures import measured
from bench.peers import run
from bench.report import Report, machine

WORKER = ("-m", "bench.artist.in_blender")
FILES = (".glb", ".obj")
BUILT = (
    "plane", "grid", "circle", "cube", "cylinder", "cone", "cone frustum", "UV sphere", "icosphere", "torus",
    "Suzanne", "Suzanne ×2",
)  # fmt: skip
"""The models that Blender itself makes."""
OURS, TENTH, ABF, STRETCH = "authalic", "authalic, a tenth", "ABF", "Minimum Stretch 10"
COLUMNS = ("model", "faces", "islands", "method", "SD", "σ₁/σ₂", "flips", "s", "misses")
EVEN, SHEARED, SHARE, SLOWER = 0.01, 1.15, 0.1, 1.5
"""Bounds: of the SD of disks; of shear, SD and time over Minimum Stretch's."""
ROUNDING = 2e-4
"""Deviations below this are single precision, which takes no part in the comparison."""
QUICK = 0.1
"""Seconds below which nobody waits, whatever the others take."""
NOTE = f"""\
Every method is an operator with its defaults (Minimum Stretch with 10 iterations and without flips) on the
islands that have an outline and no handles, selected in Edit Mode; seams are the borders of the islands of
the model's own UV map. SD is of the area ratio and σ₁/σ₂ the angle distortion, over the triangles; the bench
computes both from the UVs, without the package. *Misses* names what the operator should reach and does not:
SD no larger than ABF's, at most {EVEN:g} on disks and {SHARE:g} of Minimum Stretch's, no flips, and at most
{SLOWER:g} times its seconds (or {QUICK:g} s). *A tenth* is the operator with the area tolerance at which SD
is a tenth of Minimum Stretch's, where σ₁/σ₂ should be at most {SHEARED:g} times its σ₁/σ₂."""


def main(arguments=None):
    """Measures every method on every model, then lists the islands that miss a bound."""
    options = parsed(arguments)
    report = Report(options.target)
    report.line(f"# Artists' models\n\nauthalic {authalic.__version__}, {machine()}, single runs.")
    problem = dict(options.absent).get("bpy") or (
        "" if options.blender else "there is no Blender (--blender)"
    )
    if problem:
        report.line(f"\nNot measured: {problem}")
        return
    report.section("Models", NOTE)
    report.columns(COLUMNS)
    missed = []
    for name in chosen(options.meshes):
        arrays, problem = unwrapped(options, name)
        if problem:
            report.row((name, *("–",) * (len(COLUMNS) - 2), problem))
            continue
        missed += write_model(report, name, arrays)
    if missed:
        report.section("Islands that miss a bound", "Each island by itself, the worst of a model first.")
        report.columns(("model", "island", "faces", "method", "SD", "σ₁/σ₂", "flips", "misses"))
        for row in missed:
            report.row(row)


def parsed(arguments=None):
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", type=Path)
    parser.add_argument("--meshes", nargs="+", default=[])
    parser.add_argument("--timeout", type=float, default=300.0)
    parser.add_argument("--blender", default="")
    parser.add_argument("--extension", default="")
    parser.add_argument("--profile", type=Path)
    parser.add_argument("--absent", nargs="+", default=[], type=lambda text: text.split("=", 1))
    return parser.parse_args(arguments)


def chosen(names):
    """The named models, or all."""
    folder = meshes.data_folder("artist")
    files = sorted(path.stem for path in folder.iterdir() if path.suffix in FILES) if folder else []
    known = [*BUILT, *files]
    meshes.check_names(names, known)
    return [name for name in known if not names or name in names]


def unwrapped(options, name):
    """The arrays that Blender leaves of a model, or the problem."""
    folder = options.target.with_suffix("")
    folder.mkdir(parents=True, exist_ok=True)
    result = folder / "result.npz"
    result.unlink(missing_ok=True)
    os.environ |= {
        "BLENDER_USER_RESOURCES": str(options.profile), "AUTHALIC_EXTENSION_ZIP": str(options.extension)
    }  # fmt: skip
    data = meshes.data_folder("artist")
    command = [options.blender, *WORKER, result, name, *([data] if data else [])]
    problem = run.finished(command, options.timeout, folder / "log.txt")
    if problem:
        return None, problem
    with np.load(result) as file:
        return dict(file), ""


def write_model(report, name, arrays):
    """The rows of a model; returns those of its islands that miss a bound."""
    island_of, is_disk = arrays["island_of"], arrays["is_disk"]
    if not len(is_disk):
        report.row((name, len(island_of), 0, *("–",) * 5, "no island has an outline"))
        return []
    chosen_faces = island_of >= 0
    figures = {method: of_method(arrays, method, chosen_faces) for method in (ABF, STRETCH, OURS, TENTH)}
    seconds = {method: float(arrays.get(f"seconds {method}", np.nan)) for method in figures}
    for method, row in figures.items():
        cells = (name, np.count_nonzero(chosen_faces), len(is_disk), method)
        if row is None:
            if f"error {method}" in arrays:
                report.row((*cells, *("–",) * 4, str(arrays[f"error {method}"])))
            continue
        misses = misses_of(figures, is_disk.all()) if method == OURS else []
        if method == TENTH and row.shear > SHEARED * figures[STRETCH].shear + ROUNDING:
            misses.append(f"σ₁/σ₂ {row.shear / figures[STRETCH].shear:.2f} times")
        if method == OURS and seconds[OURS] > max(SLOWER * seconds[STRETCH], QUICK):
            misses.append("time")
        report.row((*cells, *quality(row), f"{seconds[method]:.3f}", ", ".join(misses)))
    return missing_islands(name, arrays) if figures[OURS] else []


def of_method(arrays, method, faces):
    """The figures of some faces by a method; None if it has no UVs."""
    if f"uv {method}" not in arrays:
        return None
    corners = arrays[f"uv {method}"][arrays["loops"][faces]]
    return measured(arrays["vertices"][arrays["faces"][faces]], corners, arrays["island_of"][faces])


def missing_islands(name, arrays):
    """The rows of the islands of a model that miss a bound by themselves."""
    rows = []
    for island, is_disk in enumerate(arrays["is_disk"]):
        faces = arrays["island_of"] == island
        figures = {method: of_method(arrays, method, faces) for method in (ABF, STRETCH, OURS)}
        misses = misses_of(figures, is_disk)
        if misses:
            rows += [
                (figures[OURS].deviation, name, island, np.count_nonzero(faces), method, *quality(row),
                 ", ".join(misses) if method == OURS else "")
                for method, row in figures.items() if row
            ]  # fmt: skip
    rows.sort(key=lambda row: -row[0])
    return [row[1:] for row in rows]


def misses_of(figures, is_disk):
    """The names of the bounds that the operator misses."""
    ours, abf, stretch = figures[OURS], figures[ABF], figures[STRETCH]
    misses = ["flips"] if ours.flips else []
    if abf and ours.deviation > max(abf.deviation, ROUNDING):
        misses.append("less even than ABF")
    if is_disk and ours.deviation > EVEN:
        misses.append(f"SD > {EVEN:g}")
    if stretch and ours.deviation > max(SHARE * stretch.deviation, ROUNDING):
        misses.append(f"SD > {SHARE:g} of Minimum Stretch's")
    return misses


def quality(row):
    """The cells of figures."""
    return f"{row.deviation:.5f}", f"{row.shear:.3f}", row.flips


if __name__ == "__main__":
    main()
