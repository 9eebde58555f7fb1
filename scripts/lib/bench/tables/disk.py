# SPDX-License-Identifier: MIT OR Apache-2.0
"""Disks: the fixed-point iteration beside conjugate gradients (Liu & Yueh, Table 1, Figures 4 and 5)."""

import authalic
from bench import plots
from bench.published import DISKS, MODELS, NONE
from bench.report import fixed, plain, scientific

METHODS = {"fixed_point": "fixed point", "conjugate_gradient": "conjugate gradients"}
ITERATIONS = 50
FIRST_STEPS = {"fixed_point": 0, "conjugate_gradient": 5}
"""Steps of the fixed point before the iterations of the method."""
COLUMNS = (
    "mesh", "V", "method", "mean", "SD", "E_A", "folds", "iterations", "E_A before mending", "s",
    "published SD", "published E_A", "published folds", "published s",
)  # fmt: skip
NOTE = f"""\
Liu & Yueh, Table 1: {ITERATIONS} iterations, boundary by arc length; conjugate gradients begin with 5
steps of the fixed point, which are counted. Mean and SD are of the area ratios (published mean: 1.00).
If faces fold or nearly fold then, they are mended, and the descent continues for up to {ITERATIONS}
more iterations of conjugate gradients: such rows show more iterations, their figures are those of the
mended map, and "E_A before mending" is the energy of the method alone."""


def write(bench):
    """The table, the convergence curves and the histograms."""
    bench.report.section("Disks: fixed point and conjugate gradients", NOTE)
    bench.report.columns(COLUMNS)
    for name, mesh in bench.disks.items():
        for method in METHODS:
            bench.report.row(_cells(bench, name, mesh, method))
    if bench.disks:
        _draw(bench)


def mapped(bench, name, mesh, method, iterations=ITERATIONS):
    """The outcome of one method on one mesh."""
    options = {"method": method, "boundary": "arc_length", "max_iterations": iterations}
    return bench.run(authalic.disk_map, name, mesh, **options)


def _cells(bench, name, mesh, method):
    outcome = mapped(bench, name, mesh, method)
    published = DISKS.get((name, method), NONE)
    return (
        label(name), len(mesh[0]), METHODS[method], *_figures(outcome, method), fixed(published.deviation, 4),
        scientific(published.energy), plain(published.folds), fixed(published.seconds, 2),
    )  # fmt: skip


def _figures(outcome, method):
    if outcome.error:
        return (outcome.error, *[""] * 6)
    figures = outcome.result.distortion
    return (
        fixed(figures.area_ratio_mean, 2), fixed(figures.area_ratio_std, 4),
        scientific(figures.authalic_energy), len(figures.folded), outcome.result.iterations,
        scientific(_before_mending(outcome.result, method)), fixed(outcome.seconds, 2),
    )  # fmt: skip


def _before_mending(result, method):
    """The energy after the published iterations, if more followed."""
    published = ITERATIONS + FIRST_STEPS[method]
    if result.iterations <= published:
        return None
    return result.history["authalic_energy"][published]


def label(name):
    """A mesh's name, with the model's name in the papers if it is one of theirs."""
    return f"{name}: {MODELS[name]}" if name in MODELS else name


def _draw(bench):
    curves, ratios, dots = {}, {}, {}
    for name, mesh in bench.disks.items():
        outcomes = {METHODS[method]: mapped(bench, name, mesh, method) for method in METHODS}
        start = {"harmonic start": mapped(bench, name, mesh, "fixed_point", 0)}
        curves[name] = plots.histories(outcomes)
        ratios[name] = plots.area_ratios({**start, **outcomes})
        dots[name] = [
            (ITERATIONS + FIRST_STEPS[method], DISKS[name, method].energy)
            for method in METHODS
            if (name, method) in DISKS
        ]
    path = bench.folder / "tables-disk-convergence.png"
    plots.draw_convergence(path, "Disk maps with an arc-length boundary", curves, dots)
    bench.report.figure(path, "Authalic energy of the disk maps against the iteration")
    path = bench.folder / "tables-disk-histogram.png"
    plots.draw_histograms(path, "Disk maps with an arc-length boundary", ratios)
    bench.report.figure(path, "Area ratios of the disk maps before and after")
