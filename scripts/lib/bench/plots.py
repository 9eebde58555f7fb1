# SPDX-License-Identifier: MIT OR Apache-2.0
"""The plots of the tables: convergence curves and histograms of area ratios, one panel for each mesh."""

import math

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

COLORS = {
    "harmonic start": "0.55",
    "conformal start": "0.55",
    "fixed point": "#2b5f8f",
    "fixed point, 100 iterations": "#2b5f8f",
    "conjugate gradients": "#b3263e",
    "gradient descent": "#b3263e",
    "interpolation": "#b3263e",
    "bounded": "#d1883a",
}
WIDTHS = {"bounded": 3.0}
"""Lines that others cover are drawn wide."""
RANGE = 3.0
"""Histograms go from 2^-3 to 2^3."""


def histories(outcomes):
    """{label: (iterations, authalic energies)} of the outcomes that are maps."""
    return {
        label: (outcome.result.history["iteration"], outcome.result.history["authalic_energy"])
        for label, outcome in outcomes.items()
        if not outcome.error
    }


def area_ratios(outcomes):
    """{label: (log2 of the area ratio per face, SD of the area ratio)} of the outcomes that are maps."""
    figures = {label: outcome.result.distortion for label, outcome in outcomes.items() if not outcome.error}
    return {label: (figure.log2_area_ratio, figure.area_ratio_std) for label, figure in figures.items()}


def draw_convergence(path, title, curves, published):
    """Energies against iterations, both from the histories; `published` {mesh: [(iteration, energy)]}."""
    figure, axes = panels(title, curves)
    for axis, (mesh, by_label) in zip(axes, curves.items()):
        for label, (iterations, energies) in by_label.items():
            axis.plot(
                iterations, energies, label=label, color=COLORS.get(label), linewidth=WIDTHS.get(label, 1.4)
            )
        for index, dot in enumerate(published.get(mesh, ())):
            axis.plot(*dot, "k+", markersize=9, label=None if index else "published", zorder=3)
        axis.set_yscale("log")
        axis.set_xlabel("iteration")
        axis.grid(alpha=0.25, which="major")
        axis.legend(frameon=False, fontsize=8)
    for axis in leftmost(axes):
        axis.set_ylabel("authalic energy $E_A$")
    save(figure, path)


def draw_histograms(path, title, ratios):
    """The distribution of the faces over the area ratios; an area-preserving map is a spike at 1."""
    figure, axes = panels(title, ratios)
    bins = np.linspace(-RANGE, RANGE, 92)  # an odd number of bins: 1 is the middle of one
    for axis, by_label in zip(axes, ratios.values()):
        for label, (log2_ratio, deviation) in by_label.items():
            values = np.clip(np.nan_to_num(log2_ratio, nan=-RANGE), -RANGE, RANGE)
            text, color = f"{label}: SD {deviation:.3f}", COLORS.get(label)
            weights = np.full(len(values), 1 / len(values))
            axis.hist(values, bins, weights=weights, histtype="step", label=text, color=color, linewidth=1.3)
        axis.set_xticks([-3, -2, -1, 0, 1, 2, 3], ["1/8", "1/4", "1/2", "1", "2", "4", "8"])
        axis.set_xlabel("image area / fair share (end bins: and beyond)", fontsize=9)
        axis.set_yscale("log")
        axis.legend(frameon=False, fontsize=7.5, loc="upper left")
        axis.set_ylim(top=axis.get_ylim()[1] * 30)  # room for the legend
    for axis in leftmost(axes):
        axis.set_ylabel("share of the faces")
    save(figure, path)


def panels(title, meshes):
    """A figure with an axis for each mesh, four in a row."""
    columns = min(4, len(meshes))
    rows = math.ceil(len(meshes) / columns)
    size = (4.1 * columns, 3.3 * rows + 0.4)
    figure, axes = plt.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained")
    figure.suptitle(title, fontsize=13)
    axes = list(axes.ravel())
    for axis in axes[len(meshes) :]:
        axis.remove()
    for axis, mesh in zip(axes, meshes):
        axis.set_title(mesh, fontsize=11)
        axis.spines[["top", "right"]].set_visible(False)
    return figure, axes[: len(meshes)]


def leftmost(axes):
    return axes[::4]


def save(figure, path):
    figure.savefig(path, dpi=120)
    plt.close(figure)
