# SPDX-License-Identifier: MIT OR Apache-2.0
"""The demo's figures: the UV layouts, also those by way of the sphere, and the histograms of area ratios.

Usage: python -m demo.figures OUT_FOLDER (after demo.scene has written OUT_FOLDER/data)
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

COLORS = {
    "Blender ABF": "#d1883a",
    "Minimum Stretch, 10": "#6f9fc8",
    "Minimum Stretch, 200": "#2b5f8f",
    "Authalic": "#b3263e",
}
MOST_TRIANGLES_WITH_EDGES = 60_000
RANGE = 3.0
"""Histograms and colors go from 2^-3 to 2^3."""


def results(data):
    """The unwrapped meshes: {mesh: {method: arrays}}, in the order of the report."""
    maps = {}
    for path in sorted(data.glob("*.npz")):
        with np.load(path) as stored:
            arrays = dict(stored)
        maps.setdefault(str(arrays["mesh"]), {})[str(arrays["method"])] = arrays
    return maps


def draw_layouts(maps, path):
    """The UV triangles of every mesh and method, colored by their area ratio."""
    methods = list(dict.fromkeys(name for row in maps.values() for name in row))
    size = (3.1 * len(methods), 3.3 * len(maps))
    figure, axes = plt.subplots(len(maps), len(methods), figsize=size, squeeze=False, layout="constrained")
    for axis, method in zip(axes[0], methods, strict=True):
        axis.set_title(method, fontsize=12)
    for row, (mesh, by_method) in zip(axes, maps.items(), strict=True):
        row[0].set_ylabel(mesh, fontsize=12)
        for axis, method in zip(row, methods, strict=True):
            drawn = _draw_layout(axis, by_method.get(method))
    _color_bar(figure, axes, drawn)
    figure.savefig(path, dpi=130)
    plt.close(figure)


def draw_sphere_layouts(maps, path):
    """The UVs of closed meshes, all layouts at one height, with their figures below."""
    methods = list(dict.fromkeys(name for row in maps.values() for name in row))
    widths = [max(_aspect(row.get(name)) for row in maps.values()) for name in methods]
    size = (2.9 * sum(widths) + 0.5, 3.6 * len(maps) + 0.8)
    figure, axes = plt.subplots(
        len(maps), len(methods), figsize=size, squeeze=False, layout="constrained", width_ratios=widths
    )
    for row, (mesh, by_method) in zip(axes, maps.items(), strict=True):
        row[0].set_ylabel(mesh, fontsize=12)
        for axis, method in zip(row, methods, strict=True):
            drawn = _draw_layout(axis, by_method.get(method))
            axis.set_title(method, fontsize=12)
            axis.set_xlabel(_figures(by_method.get(method)), fontsize=10.5)
    _color_bar(figure, axes, drawn)
    figure.savefig(path, dpi=130)
    plt.close(figure)


def draw_histograms(maps, path):
    """The distribution of the triangles over the area ratios; an even map is a spike at 1."""
    size = (5.2 * len(maps), 4.2)
    figure, axes = plt.subplots(1, len(maps), figsize=size, squeeze=False, layout="constrained")
    bins = np.linspace(-RANGE, RANGE, 91)
    for axis, (mesh, by_method) in zip(axes[0], maps.items(), strict=True):
        for method, arrays in by_method.items():
            _draw_histogram(axis, method, arrays["area_ratio"], bins)
        axis.set_title(mesh, fontsize=11)
        axis.set_xticks([-3, -2, -1, 0, 1, 2, 3], ["1/8", "1/4", "1/2", "1", "2", "4", "8"])
        axis.set_xlabel("texture area / fair share, per triangle (end bins: and beyond)")
        axis.set_yscale("log")
        axis.legend(frameon=False, fontsize=8.5, loc="upper center", bbox_to_anchor=(0.5, -0.18), ncols=2)
        axis.spines[["top", "right"]].set_visible(False)
    axes[0][0].set_ylabel("share of the triangles")
    figure.savefig(path, dpi=130)
    plt.close(figure)


def _aspect(arrays):
    if arrays is None:
        return 0.5
    width, height = np.ptp(arrays["uv"].reshape(-1, 2), axis=0)
    return float(np.clip(width / max(height, 1e-12), 0.3, 4))


def _figures(arrays):
    if arrays is None:
        return ""
    (a, b, c), ratio = np.moveaxis(arrays["uv"], 1, 0), arrays["area_ratio"]
    flipped = int((np.linalg.det(np.stack([b - a, c - a], axis=1)) <= 0).sum())
    return f"area ratio SD {ratio.std():.3g}, {flipped} flipped"


def _color_bar(figure, axes, drawn):
    bar = figure.colorbar(drawn, ax=axes, location="bottom", shrink=0.35, aspect=30, ticks=[-2, -1, 0, 1, 2])
    bar.ax.set_xticklabels(["1/4", "1/2", "1", "2", "4"])
    bar.set_label("texture area / fair share")


def _draw_layout(axis, arrays):
    axis.set_xticks([])
    axis.set_yticks([])
    axis.set_aspect("equal")
    axis.spines[:].set_color("0.8")
    shown = PolyCollection(np.zeros((0, 3, 2)), cmap="RdBu_r")
    shown.set_clim(-2, 2)
    if arrays is None:
        axis.text(0.5, 0.5, "left out", ha="center", va="center", color="0.5", transform=axis.transAxes)
        return shown
    uv, ratio = arrays["uv"], arrays["area_ratio"]
    shown = PolyCollection(uv, array=np.log2(np.maximum(ratio, 1e-12)), cmap="RdBu_r", linewidth=0)
    shown.set_clim(-2, 2)
    axis.add_collection(shown)
    if len(uv) <= MOST_TRIANGLES_WITH_EDGES:
        lines = np.concatenate([uv[:, [0, 1]], uv[:, [1, 2]], uv[:, [2, 0]]])
        axis.add_collection(LineCollection(lines, colors="0.25", linewidths=0.08))
    axis.autoscale_view()
    return shown


def _draw_histogram(axis, method, ratio, bins):
    values = np.clip(np.log2(np.maximum(ratio, 1e-12)), bins[0], bins[-1])
    weights = np.full(len(values), 1 / len(values))
    label = f"{method}: SD {ratio.std():.3f}"
    color = COLORS.get(method, "0.3")
    axis.hist(values, bins, weights=weights, histtype="step", label=label, color=color, linewidth=1.4)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    unwrapped, spherical = results(folder / "data"), results(folder / "data" / "sphere")
    draw_layouts(unwrapped, folder / "layouts.png")
    draw_histograms(unwrapped, folder / "histogram.png")
    if spherical:
        draw_sphere_layouts(spherical, folder / "sphere_layouts.png")
