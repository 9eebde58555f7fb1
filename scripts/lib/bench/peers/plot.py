# SPDX-License-Identifier: MIT OR Apache-2.0
"""The plots of the comparison: SD of the area ratio against seconds, one panel for each mesh."""

from bench import plots

COLORS = {
    "ours": "#b3263e",
    "the papers' methods": "#d1883a",
    "libigl": "#2b5f8f",
    "Blender": "#4f8f4a",
    "lapy": "#7b5aa6",
    "xatlas": "0.45",
}
MARKERS = "oDsv^<>P*X"
"""The markers of the methods of one family, in their order."""


def draw(path, title, rows):
    """Every map of every mesh; maps with folded faces are hollow."""
    maps = [row for row in rows if row.figures]
    by_mesh = {
        mesh: [row for row in maps if row.mesh == mesh] for mesh in dict.fromkeys(r.mesh for r in maps)
    }
    figure, axes = plots.panels(title, by_mesh)
    styles = styles_of(maps)
    for axis, of_mesh in zip(axes, by_mesh.values()):
        for row in of_mesh:
            draw_point(axis, row, *styles[row.method.name])
        axis.set(xscale="log", yscale="log", xlabel="seconds")
        axis.grid(alpha=0.25, which="major")
    for axis in plots.leftmost(axes):
        axis.set_ylabel("SD of the area ratio")
    add_legend(figure, styles)
    plots.save(figure, path)


def styles_of(rows):
    """{method: (color, marker)}."""
    styles, used = {}, {}
    for method in dict.fromkeys(row.method for row in rows):
        used[method.family] = used.get(method.family, -1) + 1
        marker = MARKERS[used[method.family] % len(MARKERS)]
        styles[method.name] = COLORS[method.family], marker
    return styles


def draw_point(axis, row, color, marker):
    """One map."""
    inside = "none" if row.figures.folds else color
    place = max(row.seconds, 1e-3), max(row.figures.deviation, 1e-9)
    size = 80 if row.method.family == "ours" else 42
    axis.scatter(*place, size, marker=marker, facecolors=inside, edgecolors=color, linewidths=1.4, zorder=3)


def add_legend(figure, styles):
    """All methods, below the panels."""
    handles = [
        plots.plt.Line2D([], [], linestyle="", marker=marker, color=color, label=name)
        for name, (color, marker) in styles.items()
    ]
    note = "hollow: with folded faces"
    figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False, fontsize=8, title=note)
