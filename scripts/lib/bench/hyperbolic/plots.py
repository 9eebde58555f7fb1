# SPDX-License-Identifier: MIT OR Apache-2.0
"""The pictures of the registrations by curves: the paper's histograms, energies, and cortices in colors."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

from bench import plots
from bench.hyperbolic.methods import HARMONIC, HYPERBOLIC, SPHERES

COLORS = {HYPERBOLIC: "#b3263e", HARMONIC: "#2b5f8f", SPHERES: "#d1883a"}
LIGHT = np.array([-0.3, 0.3, 0.9])
SHADE = 0.35
"""The part of a face's color that depends on the light."""


def draw_flipped(path, title, results):
    """Bars of flipped area for {pair: {method: measures}}."""
    figure, axis = plt.subplots(figsize=(7.5, 0.9 * len(results) + 1.6), layout="constrained")
    height = 0.8 / len(COLORS)
    for k, (method, color) in enumerate(COLORS.items()):
        values = [by[method].flipped if method in by else np.nan for by in results.values()]
        rows = np.arange(len(results)) + k * height
        axis.barh(rows, np.nan_to_num(values), height, color=color, label=method)
        for row, value in zip(rows, values):
            text = "no map" if np.isnan(value) else f" {value:.3f} %"
            axis.text(np.nan_to_num(value), row, text, va="center", fontsize=8)
    axis.set_yticks(np.arange(len(results)) + height, results)
    axis.invert_yaxis()
    axis.margins(x=0.15)
    axis.set(xlabel="flipped area, % of the source", title=title)
    axis.spines[["top", "right"]].set_visible(False)
    axis.legend(frameon=False, fontsize=8)
    plots.save(figure, path)


def draw_differences(path, title, results):
    """Histograms of the differences of sulc over the vertices."""
    measures = (measures for by in results.values() for measures in by.values())
    top = max(np.percentile(each.differences, 99.5) for each in measures)
    histograms(path, title, results, "differences", np.linspace(0, top, 61), "|sulc − sulc of the image|")


def draw_areas(path, title, results):
    """Histograms of the area distortions over the faces."""
    bins = np.linspace(1, 4, 61)
    histograms(path, title, results, "areas", bins, "area distortion max(J, 1/J) (last bin: and beyond)")


def histograms(path, title, results, name, bins, label):
    """A panel for each pair with a line for each method."""
    figure, axes = plots.panels(title, results)
    for axis, by_method in zip(axes, results.values()):
        axis.title.set_fontsize(8.5)
        for method, measures in by_method.items():
            values = np.clip(getattr(measures, name), bins[0], bins[-1])
            weights = np.full(len(values), 1 / len(values))
            text = f"{method}: mean {getattr(measures, name).mean():.3f}"
            axis.hist(values, bins, weights=weights, histtype="step", label=text, color=COLORS[method])
        axis.set_xlabel(label, fontsize=9)
        axis.set_yscale("log")
        axis.legend(frameon=False, fontsize=7.5, loc="upper right")
    plots.save(figure, path)


def draw_energies(path, title, solvers):
    """The energies of {solver: Solved} above the least one, over the steps."""
    figure, axis = plt.subplots(figsize=(6.5, 4.2), layout="constrained")
    least = min((solved.energies.min() for solved in solvers.values()), default=0)
    for name, solved in solvers.items():
        above, label = np.maximum(solved.energies - least, 1e-14), f"{name}, {solved.seconds:.1f} s"
        axis.plot(np.arange(len(above)) + 1, above, label=label, marker=".", markersize=4)
    axis.set(xscale="log", yscale="log", xlabel="step + 1", ylabel="energy − least energy", title=title)
    axis.grid(alpha=0.25)
    axis.legend(frameon=False)
    plots.save(figure, path)


def brain_areas(path, title, pair, by_method):
    """The source in the colors of its faces' area distortions."""
    values = {name: measures.areas for name, measures in by_method.items()}
    brains(path, title, pair, values, (1, 2), "area distortion max(J, 1/J)")


def brain_differences(path, title, pair, by_method):
    """The source in the colors of the differences of sulc."""
    faces = pair.source.faces
    values = {name: measures.differences[faces].mean(axis=1) for name, measures in by_method.items()}
    brains(path, title, pair, values, (0, 0.6), "|sulc − sulc of the image|")


def brains(path, title, pair, values, limits, label):
    """The inflated source from the left and from the right, a column for each method; from green to red."""
    size = (3.6 * len(values), 5.6)
    figure, axes = plt.subplots(2, len(values), figsize=size, squeeze=False, layout="constrained")
    figure.suptitle(title, fontsize=11)
    colors = plt.cm.ScalarMappable(plt.Normalize(*limits), "RdYlGn_r")
    for column, (name, of_faces) in zip(axes.T, values.items()):
        column[0].set_title(name, fontsize=10)
        for axis, side in zip(column, (-1, 1)):
            draw_brain(axis, pair.source, colors.to_rgba(of_faces), side)
    figure.colorbar(colors, ax=axes, location="bottom", shrink=0.4, aspect=30, label=label, extend="max")
    plots.save(figure, path)


def draw_brain(axis, surface, colors, side):
    """The surface seen along the x axis, with its curves."""
    turn = np.array([[0, side, 0], [0, 0, 1], [side, 0, 0]])
    seen = surface.inflated @ turn.T
    a, b, c = (seen[surface.faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    front = normals[:, 2] > 0
    order = np.flatnonzero(front)[np.argsort((a + b + c)[front, 2])]
    shade = 1 - SHADE + SHADE * (normals[order] @ (LIGHT / np.linalg.norm(LIGHT))).clip(0)
    shaded = np.column_stack([colors[order, :3] * shade[:, None], np.ones(len(order))])
    triangles = seen[surface.faces[order]][:, :, :2]
    axis.add_collection(PolyCollection(triangles, facecolors=shaded, edgecolors=shaded, linewidths=0.2))
    axis.add_collection(LineCollection(visible_curves(surface, seen, front), colors="black", linewidths=1.0))
    axis.autoscale_view()
    axis.set_aspect("equal")
    axis.axis("off")


def visible_curves(surface, seen, front):
    """The segments of the curves between vertices of faces that face the eye."""
    shown = np.zeros(len(seen), bool)
    shown[surface.faces[front]] = True
    segments = [np.stack([curve[:-1], curve[1:]], axis=1) for curve in surface.curves]
    segments = np.concatenate(segments)
    return seen[segments[shown[segments].all(axis=1)]][:, :, :2]
