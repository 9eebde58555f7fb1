# SPDX-License-Identifier: MIT OR Apache-2.0
"""Spheres: both line searches, and the fixed-point iteration with both stopping rules.

Sutti & Yueh, Tables 1, 2 and 5, Figures 5 and 6.
"""

import math

import numpy as np

import authalic
from bench import plots
from bench.published import FIXED_POINT, LINE_SEARCHES, NONE
from bench.report import fixed, plain, scientific
from bench.tables.disk import label

SEARCHES = ("bounded", "interpolation")
LENGTHS = (10, 100)
SEARCH_COLUMNS = (
    "mesh", "V", "line search", "iterations", "SD/mean", "E_A", "folds", "folds, corrected", "E_A, corrected",
    "s", "published SD/mean", "published E_A", "published folds", "published s",
)  # fmt: skip
SEARCH_NOTE = """\
Sutti & Yueh, Tables 1 (`bounded`: fminbnd) and 2 (`interpolation`: quadratic/cubic): iterations of
Riemannian gradient descent, after up to ten steps of the fixed-point iteration, which are not counted
here. SD/mean is of the area ratios; as in the paper it and E_A take the areas of folded faces as
positive. "s" and the figures up to "folds" are those of the call without the correction for bijectivity;
if it leaves folds, the call is repeated with the correction, for "folds, corrected" and
"E_A, corrected"."""
RULES = {
    "energy rises": {"tolerance": 0.0, "max_iterations": 1000},
    "100 iterations": {"tolerance": -math.inf, "max_iterations": 100},
}
FIXED_POINT_COLUMNS = (
    "mesh", "V", "stopped when", "iterations", "SD/mean", "E_A", "folds", "s", "published iterations",
    "published SD/mean", "published E_A", "published folds", "published s",
)  # fmt: skip
FIXED_POINT_NOTE = """\
Sutti & Yueh, Table 5, without the correction for bijectivity. "energy rises": the best map until the
stretch energy no longer falls. "100 iterations": no stopping rule, the last map."""


def descended(bench, name, mesh, search, iterations, unfold=False):
    """The outcome of gradient descent on one mesh."""
    options = {"method": "gradient_descent", "line_search": search, "max_iterations": iterations}
    return bench.run(authalic.sphere_map, name, mesh, **options, unfold=unfold)


def corrected(bench, name, mesh, outcome, search, iterations):
    """The outcome with the correction for bijectivity; unchanged if nothing folds."""
    if outcome.error or not len(outcome.result.distortion.folded):
        return outcome
    return descended(bench, name, mesh, search, iterations, unfold=True)


def fixed_point(bench, name, mesh, rule):
    """The outcome of the fixed-point iteration with one of the stopping rules."""
    options = {"method": "fixed_point", "unfold": False, **RULES[rule]}
    return bench.run(authalic.sphere_map, name, mesh, **options)


def evenness(mesh, outcome):
    """(SD/mean of the area ratios, E_A) as in the papers, which count areas of folded faces as positive."""
    surface, image = areas(*mesh), areas(outcome.result.positions, mesh[1])
    ratio = image / (surface * (image.sum() / surface.sum()))
    return ratio.std() / ratio.mean(), (image * (ratio - 1)).sum()


def areas(vertices, faces):
    """The areas of the faces, (m,)."""
    return np.linalg.norm(face_normals(vertices, faces), axis=1)


def face_normals(vertices, faces):
    """Normals of the faces, as long as their areas, (m, 3)."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a) / 2


def folds(outcome):
    """The number of folded faces, or why there is no map."""
    return outcome.error or len(outcome.result.distortion.folded)


def write_line_searches(bench):
    """The table of both line searches, the convergence curves and the histograms."""
    bench.report.section("Spheres: line searches of gradient descent", SEARCH_NOTE)
    bench.report.columns(SEARCH_COLUMNS)
    for name, mesh in bench.spheres.items():
        for search in SEARCHES:
            for iterations in LENGTHS:
                bench.report.row(_search_cells(bench, name, mesh, search, iterations))
    if bench.spheres:
        _draw(bench)


def write_fixed_point(bench):
    """The table of the fixed-point iteration."""
    bench.report.section("Spheres: fixed-point iteration", FIXED_POINT_NOTE)
    bench.report.columns(FIXED_POINT_COLUMNS)
    for name, mesh in bench.spheres.items():
        for rule in RULES:
            bench.report.row(_fixed_point_cells(bench, name, mesh, rule))


def _search_cells(bench, name, mesh, search, iterations):
    outcome = descended(bench, name, mesh, search, iterations)
    published = LINE_SEARCHES.get((name, search, iterations), NONE)
    after = corrected(bench, name, mesh, outcome, search, iterations)
    return (
        label(name), len(mesh[0]), search, iterations, *_quality(mesh, outcome), folds(after),
        _energy(mesh, after), f"{outcome.seconds:.2f}",
        fixed(published.deviation, 4), scientific(published.energy), plain(published.folds),
        fixed(published.seconds, 2),
    )  # fmt: skip


def _quality(mesh, outcome):
    if outcome.error:
        return (outcome.error, "", "")
    even, energy = evenness(mesh, outcome)
    return (fixed(even, 4), scientific(energy), folds(outcome))


def _energy(mesh, outcome):
    return "" if outcome.error else scientific(evenness(mesh, outcome)[1])


def _fixed_point_cells(bench, name, mesh, rule):
    outcome = fixed_point(bench, name, mesh, rule)
    published = FIXED_POINT.get((name, rule), NONE)
    iterations = "" if outcome.error else outcome.result.iterations
    return (
        label(name), len(mesh[0]), rule, iterations, *_quality(mesh, outcome), f"{outcome.seconds:.2f}",
        plain(published.iterations), fixed(published.deviation, 4), scientific(published.energy),
        plain(published.folds), fixed(published.seconds, 2),
    )  # fmt: skip


def _draw(bench):
    curves, ratios, dots = {}, {}, {}
    for name, mesh in bench.spheres.items():
        searches = {search: descended(bench, name, mesh, search, LENGTHS[-1]) for search in SEARCHES}
        endless = {"fixed point, 100 iterations": fixed_point(bench, name, mesh, "100 iterations")}
        curves[name] = plots.histories({**endless, **searches})
        ratios[name] = plots.area_ratios(_before_and_after(bench, name, mesh))
        start = _first_steps(searches["interpolation"])
        dots[name] = [
            (start + iterations, LINE_SEARCHES[name, "interpolation", iterations].energy)
            for iterations in LENGTHS
            if (name, "interpolation", iterations) in LINE_SEARCHES
        ]
    path = bench.folder / "tables-sphere-convergence.png"
    plots.draw_convergence(path, "Sphere maps without correction for bijectivity", curves, dots)
    bench.report.figure(path, "Authalic energy of the sphere maps against the iteration")
    path = bench.folder / "tables-sphere-histogram.png"
    plots.draw_histograms(path, "Sphere maps without correction for bijectivity", ratios)
    bench.report.figure(path, "Area ratios of the sphere maps before and after")


def _first_steps(outcome):
    """The fixed-point steps before gradient descent, which the histories count."""
    return 0 if outcome.error else max(0, outcome.result.iterations - LENGTHS[-1])


def _before_and_after(bench, name, mesh):
    options = {"method": "fixed_point", "max_iterations": 0, "unfold": False}
    return {
        "conformal start": bench.run(authalic.sphere_map, name, mesh, **options),
        "fixed point": fixed_point(bench, name, mesh, "energy rises"),
        "gradient descent": descended(bench, name, mesh, "interpolation", LENGTHS[-1]),
    }
