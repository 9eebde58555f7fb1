# SPDX-License-Identifier: MIT OR Apache-2.0
"""Registration by landmark curves of cortices: the paper's measures, beside two methods by points.

Usage: python -m bench.hyperbolic.main TARGET_FILE [--parts pairs cuts curves solvers large] [--timeout 900]

The pictures go beside the target.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import authalic
from bench.hyperbolic import pairs, plots, solvers
from bench.hyperbolic.measures import measured
from bench.hyperbolic.methods import HARMONIC, HYPERBOLIC, METHODS, SPHERES
from bench.peers.worker import message
from bench.report import Report, machine
from shell import PYTHONPATH

COUNTS = (4, 6, 10, 12)
TIMES = 2
"""The subdivisions of the pair of the part "large", which gives it 163,842 vertices."""
WORKER = ("-m", "bench.hyperbolic.worker")
MISSING = """\
Not measured: neither ../shared/data nor the folder AUTHALIC_DATA has brain/ with the hemispheres and curves
of fsaverage5 (fsaverage5_left_10242.npz, fsaverage5_right_10242.npz, fsaverage5_curves.json)."""
COLUMNS = (
    "pair", "V", "method", "flipped, % of area", "turned over, %", "curve variation, mm", "sulc, r",
    "sulc, mean difference", "curv, mean difference", "area distortion", "50 %", "90 %", "99 %", "s",
    "remark",
)  # fmt: skip
NOTE = f"""\
Three registrations of the same pairs. "{HYPERBOLIC}" is `authalic.register_hyperbolic`. "{HARMONIC}" is the
conventional method of the paper: both surfaces opened along the first curve, the target flattened by a
harmonic map onto the round disk, the source by a Euclidean harmonic map into it, with every vertex of every
curve pinned to its place (numpy and scipy, in scripts/lib). "{SPHERES}" is `authalic.register_spheres`,
which preserves areas, with up to five points on each curve. Right hemispheres are mirrored.

*Flipped* are faces that the method's own domain shows the wrong way round: the hyperbolic metric, the disk,
the sphere. *Turned over* are those whose images, as straight triangles, are turned over on the sphere that
comes with the target; a few are no folds but faces whose images are curved. *Curve variation* is the paper's
equation 3 between image and partner, points against polylines; with curves exactly in place, the chords of
the image's polyline remain. *Differences* are between the source's values and the target's where
they are mapped, weighted by area. *Area distortion* is max(J, 1/J) of the faces, at most 10: mean and
percentiles."""
RATIO_COLUMNS = ("pair", "method", "sulc difference", "area distortion − 1", "seconds")
RATIO_NOTE = f"Figures over those of {HYPERBOLIC}: above 1, {HYPERBOLIC} is better."
CUT_COLUMNS = (
    "pair", "cuts", "flipped, % of area", "sulc, r", "sulc, mean difference", "area distortion",
)  # fmt: skip
CUT_NOTE = f"""\
"{HARMONIC}" depends on the curve along which the surfaces are opened, in the tables above the first one: the
least, the median and the greatest figure over all open curves."""
COUNT_COLUMNS = (*COLUMNS[2:4], *COLUMNS[4:8], *COLUMNS[9:])
LARGE_COLUMNS = (
    "method", "V", "s", "peak memory, MiB", "before the call, MiB", "flipped, % of area",
    "sulc, mean difference", "area distortion", "remark",
)  # fmt: skip


def main(arguments=None):
    """Writes the chosen parts, all by default."""
    options = parsed(arguments)
    report = Report(options.target)
    report.line(f"# Registration by landmark curves\n\nauthalic {authalic.__version__}, {machine()}.")
    if not pairs.available():
        report.line(f"\n{MISSING}")
        return
    for part in options.parts:
        PARTS[part](report, options)


def parsed(arguments=None):
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", type=Path)
    parser.add_argument("--parts", nargs="+", default=list(PARTS), choices=PARTS)
    parser.add_argument("--timeout", type=float, default=900)
    return parser.parse_args(arguments)


def write_pairs(report, options):
    """The main table, the ratios and the pictures."""
    report.section("The paper's measures", NOTE)
    report.columns(COLUMNS)
    results = {}
    for pair in pairs.standard():
        measures = {}
        for name, figures, row in compared(pair):
            report.row((pair.name, *row))
            if figures:
                measures[name] = figures
        results[pair.name] = pair, measures
    write_ratios(report, {name: measures for name, (_, measures) in results.items()})
    draw(report, results)


def compared(pair):
    """For each method its name, its measures (None without a map) and the cells of its row."""
    for name, method in METHODS.items():
        head = len(pair.source.vertices), name
        try:
            registered = method(pair)
        except (authalic.MeshError, authalic.SolverError) as problem:
            yield name, None, (*head, *("–",) * 11, message(problem).replace("|", "/"))
            continue
        figures = measured(pair, registered)
        yield name, figures, (*head, *cells(figures))


def cells(figures):
    """The cells of the main table, from the flipped area on."""
    curv = figures.difference.get("curv")
    return (
        f"{figures.flipped:.4f}", f"{figures.turned:.4f}", f"{figures.variation:.3f}",
        f"{figures.correlation:.3f}", f"{figures.difference['sulc']:.4f}",
        "" if curv is None else f"{curv:.4f}", f"{figures.areas.mean():.3f}",
        *(f"{value:.2f}" for value in figures.percentiles), f"{figures.seconds:.1f}", figures.remark,
    )  # fmt: skip


def write_ratios(report, results):
    """The figures of the other methods over those of the registration by curves."""
    report.section("Ratios", RATIO_NOTE)
    report.columns(RATIO_COLUMNS)
    for pair, measures in results.items():
        ours = measures.get(HYPERBOLIC)
        for name, figures in measures.items():
            if ours and name != HYPERBOLIC:
                report.row((pair, name, *(f"{ratio:.2f}" for ratio in ratios(figures, ours))))


def write_cuts(report, options):
    """The conventional method, opened along each of the curves."""
    report.section("The conventional method by the curve that is opened", CUT_NOTE)
    report.columns(CUT_COLUMNS)
    for pair in pairs.standard():
        cuts = []
        for first in pairs.open_curves(pair):
            opened = pairs.begun_with(pair, first)
            cuts.append(measured(opened, METHODS[HARMONIC](opened)))
        figures = [[cut.flipped for cut in cuts], [cut.correlation for cut in cuts]]
        figures += [[cut.difference["sulc"] for cut in cuts], [cut.areas.mean() for cut in cuts]]
        report.row((pair.name, len(cuts), *map(spread, figures)))


def spread(values):
    """The least, the median and the greatest."""
    return " / ".join(f"{value:.3f}" for value in np.quantile(values, (0, 0.5, 1)))


def ratios(figures, ours):
    return (
        figures.difference["sulc"] / ours.difference["sulc"],
        (figures.areas.mean() - 1) / (ours.areas.mean() - 1),
        figures.seconds / ours.seconds,
    )


def draw(report, results):
    """The paper's histograms, and the fsaverage5 pair of pial surfaces in colors."""
    measures = {pair: by_method for pair, (_, by_method) in results.items()}
    pair, by_method = list(results.values())[min(1, len(results) - 1)]
    pictures = {
        "flipped": ("Flipped area", plots.draw_flipped, (measures,)),
        "curvature": ("Differences of sulc", plots.draw_differences, (measures,)),
        "areas": ("Area distortion", plots.draw_areas, (measures,)),
        "brains-areas": (
            f"Area distortion, {pair.name}", plots.brain_areas, (pair, by_method),
        ),
        "brains-sulc": (
            f"Differences of sulc, {pair.name}", plots.brain_differences, (pair, by_method),
        ),
    }  # fmt: skip
    for name, (caption, function, arguments) in pictures.items():
        path = picture(report, name)
        function(path, caption, *arguments)
        report.figure(path, caption)


def picture(report, name):
    """The path of a picture."""
    return report.target.parent / f"{report.target.stem}-{name}.png"


def write_counts(report, options):
    """The measures by the number of curves."""
    report.section("More and fewer curves", "fsaverage5, pial, left → mirrored right.")
    report.columns(("curves", *COUNT_COLUMNS))
    for count in COUNTS:
        pair = pairs.across("pial", count)
        for _, _, row in compared(pair):
            report.row((count, *row[1:7], *row[8:]))


def write_solvers(report, options):
    """The paper's solvers beside Newton's method."""
    pair = pairs.across("pial", 10)
    report.section(f"The paper's solvers, {pair.name}", solvers.NOTE)
    report.columns(solvers.COLUMNS)
    solved = solvers.compared(pair, report.row)
    path = picture(report, "energy")
    same = {name: solved[name] for name in solvers.SAME_METRIC if name in solved}
    plots.draw_energies(path, "The harmonic energy above its minimum", same)
    report.figure(path, "Harmonic energy")


def write_large(report, options):
    """Time and memory at the size of the paper's cortices, each method in a process of its own."""
    note = "fsaverage5, pial, 10 curves, both hemispheres subdivided; each method in a process of its own."
    report.section("As many vertices as in the paper", note)
    report.columns(LARGE_COLUMNS)
    for name in METHODS:
        figures = in_process(name, options.timeout)
        if "error" in figures:
            report.row((name, *("–",) * 7, figures["error"].replace("|", "/")))
        else:
            report.row((name, *large_cells(figures)))


def in_process(name, limit):
    """The figures of one method on the large pair, or {"error": why there are none}."""
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "figures.json"
        command = [sys.executable, *WORKER, name, str(TIMES), target]
        try:
            done = subprocess.run(
                command, env={**os.environ, **PYTHONPATH}, capture_output=True, text=True, timeout=limit
            )
        except subprocess.TimeoutExpired:
            return {"error": f"stopped after {limit:g} s"}
        if done.returncode:
            return {"error": (done.stderr.strip().splitlines() or [f"ended with code {done.returncode}"])[-1]}
        return json.loads(target.read_text(encoding="utf-8"))


def large_cells(figures):
    return (
        figures["vertices"], f"{figures['seconds']:.1f}", f"{figures['peak']:.0f}",
        f"{figures['before']:.0f}", f"{figures['flipped']:.4f}", f"{figures['difference']:.4f}",
        f"{figures['areas']:.3f}", figures["remark"],
    )  # fmt: skip


PARTS = {
    "pairs": write_pairs,
    "cuts": write_cuts,
    "curves": write_counts,
    "solvers": write_solvers,
    "large": write_large,
}


if __name__ == "__main__":
    main()
