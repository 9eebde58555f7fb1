# SPDX-License-Identifier: MIT OR Apache-2.0
"""Authalic beside the papers' methods and beside other tools, in one run, in Markdown with plots.

Usage: python -m bench.peers.main TARGET_FILE [--parts disk sphere] [--meshes NAME ...] [--methods WORD ...]
           [--timeout SECONDS] [--blender PYTHON] [--absent PACKAGE=MESSAGE ...]

The plots go beside the target.
"""

import argparse
import inspect
import time
from pathlib import Path

import authalic
from bench import meshes
from bench.peers import methods, plot
from bench.peers.run import Starter
from bench.report import Report, machine, scientific

TITLES = {"disk": "Meshes with one boundary", "sphere": "Closed meshes of genus 0"}
COLUMNS = (
    "mesh", "V", "method", "SD", "E_A", "folds", "σ₁/σ₂ mean", "σ₁/σ₂ p99", "s", "MiB", "remark",
)  # fmt: skip
BEST_COLUMNS = (
    "mesh", "authalic: SD", "s", "the papers' methods, best: SD", "s", "method",
    "other tools, best: SD", "s", "method",
)  # fmt: skip
NOTE = """\
Every figure is `authalic.distortion`'s, whichever tool made the map. SD and E_A are of the areas, with the
image scaled to the area of the unit disk or sphere; folds are exact, a chart that is mirrored as a whole has
none; σ₁/σ₂ is the angle distortion per face (1 preserves angles), over the faces that are not folded. "s" is
the call with its start map, without imports and reading the mesh, with as many threads as the tool takes.
"MiB" is the peak of resident memory of the process, which does nothing else; the interpreter with the tool's
code is part of it (just before the call: {before}).

`authalic` is the default, {defaults}. The papers' methods are this package's: on disks on a fixed arc-
length boundary with 50 iterations, and with its repair of folded faces. SLIM, ARAP and Blender's methods
have a free boundary; libigl's start from the harmonic map to the circle, or where that folds from Tutte's,
with the surface scaled to the disk's area. Blender's are the operator on the whole mesh with `fill_holes`;
its UVs have single precision. Numbers behind names are iterations. A method that takes more than {limit:g}
s for everything is stopped."""


def main(arguments=None):
    """Measures every method on every mesh, one part after the other."""
    options = parsed(arguments)
    began = time.perf_counter()
    report = Report(options.target)
    start = Starter(options.target.parent / "peers", options.timeout, options.blender, dict(options.absent))
    report.line(f"# Authalic and its peers\n\nauthalic {authalic.__version__}, {machine()}.")
    rows = []
    for kind, named in chosen_meshes(options).items():
        rows += write_part(report, start, kind, named, methods.of_kind(kind, options.methods))
    report.line("\n" + NOTE.format(limit=options.timeout, before=before(rows), defaults=defaults()))
    report.line(f"\nThe whole took {time.perf_counter() - began:.0f} s.")


def parsed(arguments=None):
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", type=Path)
    parser.add_argument("--parts", nargs="+", choices=TITLES, default=list(TITLES))
    parser.add_argument("--meshes", nargs="+", default=[])
    parser.add_argument("--methods", nargs="+", default=[])
    parser.add_argument("--timeout", type=float, default=120.0)
    parser.add_argument("--blender", default="")
    parser.add_argument("--absent", nargs="+", default=[], type=lambda text: text.split("=", 1))
    options = parser.parse_args(arguments)
    unknown = [word for word in options.methods if not methods.called(word)]
    if unknown:
        names = ", ".join(dict.fromkeys(method.name for method in methods.METHODS))
        parser.error(f"no method {', '.join(unknown)}; there are: {names}")
    return options


def chosen_meshes(options):
    """{part: {name: mesh}}, without the parts that have none of the chosen meshes."""
    known = {"disk": meshes.disks(), "sphere": meshes.spheres()}
    meshes.check_names(options.meshes, [name for kind in options.parts for name in known[kind]])
    chosen = {kind: meshes.only(options.meshes, known[kind]) for kind in options.parts}
    return {kind: named for kind, named in chosen.items() if named}


def write_part(report, start, kind, named_meshes, chosen_methods):
    """The table, the best of each group and the plot of one kind of meshes; returns the rows."""
    report.section(TITLES[kind], "Every method on every mesh, each in a process of its own.")
    report.columns(COLUMNS)
    rows = []
    for name, mesh in named_meshes.items():
        for method in chosen_methods:
            rows.append(start(kind, name, mesh, method))
            report.row(cells(rows[-1]))
    write_best(report, rows)
    if any(row.figures for row in rows):
        path = report.target.parent / f"{report.target.stem}-{kind}.png"
        plot.draw(path, TITLES[kind], rows)
        report.figure(path, "SD of the area ratio against seconds")
    return rows


def cells(row):
    """The cells of a row of the big table."""
    head, remark = (row.mesh, row.vertices, row.method.name), in_a_cell(row.remark)
    figures = row.figures
    if figures is None:
        return (*head, *("–",) * 7, remark)
    return (
        *head, f"{figures.deviation:.4f}", scientific(figures.energy), figures.folds,
        f"{figures.angle_mean:.3f}", f"{figures.angle_p99:.2f}", f"{row.seconds:.2f}", f"{row.peak:.0f}",
        remark,
    )  # fmt: skip


def in_a_cell(text, longest=200):
    """A text as one line that does not break the table."""
    text = " ".join(text.replace("|", "/").split())
    return text if len(text) <= longest else text[: longest - 1] + "…"


def write_best(report, rows):
    """For each mesh the smallest SD without a fold: ours, the papers' methods' and the other tools'."""
    report.line("\nThe smallest SD among the maps of the whole mesh, in one piece, without a fold:\n")
    report.columns(BEST_COLUMNS)
    for mesh in dict.fromkeys(row.mesh for row in rows):
        of_mesh = [row for row in rows if row.mesh == mesh]
        ours = best(row for row in of_mesh if row.method.family == "ours")
        papers = best(row for row in of_mesh if row.method.family == "the papers' methods")
        others = best(row for row in of_mesh if row.method.package != "authalic" and not row.cut)
        report.row((mesh, *brief(ours), *brief(papers), name_of(papers), *brief(others), name_of(others)))


def best(rows):
    """The row with the smallest SD that has no fold, or None."""
    sound = [row for row in rows if row.figures and not row.figures.folds]
    return min(sound, key=lambda row: row.figures.deviation, default=None)


def brief(row):
    """SD and seconds."""
    return (f"{row.figures.deviation:.4f}", f"{row.seconds:.2f}") if row else ("–", "–")


def name_of(row):
    """The method's name."""
    return row.method.name if row else "none"


def defaults():
    """The names of the default methods."""
    signatures = [inspect.signature(function) for function in (authalic.disk_map, authalic.sphere_map)]
    return " and ".join(
        dict.fromkeys(f"`{signature.parameters['method'].default}`" for signature in signatures)
    )


def before(rows):
    """The memory of the processes before the call, by package."""
    by_package = {row.method.package: row.before for row in rows if row.figures}
    return ", ".join(f"{package} {size:.0f}" for package, size in by_package.items()) or "nothing ran"


if __name__ == "__main__":
    main()
