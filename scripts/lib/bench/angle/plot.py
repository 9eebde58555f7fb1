# SPDX-License-Identifier: MIT OR Apache-2.0
"""The plots of areas against angles: one panel for each mesh."""

from bench import plots

OURS, BLENDER = "#b3263e", "#4f8f4a"
FRONTS = {"sliding": "#2b5f8f", "arc_length": "#d1883a", "free": OURS, "sphere": OURS}
"""The colors of the boundaries."""


def draw(path, title, curves, others):
    """The curves {mesh: points}, and the points of Blender's methods {mesh: points}."""
    figure, axes = plots.panels(title, curves)
    for axis, (mesh, curve) in zip(axes, curves.items()):
        draw_curve(axis, [point for point in curve if not point.folds])
        for point in others.get(mesh, ()):
            if not point.folds:
                draw_point(axis, point)
        axis.set(yscale="log", xlabel="σ₁/σ₂, mean by area")
        axis.grid(alpha=0.25, which="major")
        axis.legend(frameon=False, fontsize=8)
    for axis in plots.leftmost(axes):
        axis.set_ylabel("SD of the area ratio")
    plots.save(figure, path)


def draw_curve(axis, points):
    """A line through all points, each with its weight."""
    angles, deviations = [point.angle for point in points], [point.deviation for point in points]
    axis.plot(angles, deviations, "o-", color=OURS, markersize=4, label="authalic, by angle_weight")
    for point in points:
        place = point.angle, point.deviation
        axis.annotate(f"{point.weight:g}", place, (4, 2), textcoords="offset points", fontsize=7, color="0.4")


def draw_point(axis, point):
    """One of Blender's maps."""
    axis.plot(point.angle, point.deviation, "s", color=BLENDER, markersize=4)
    place = point.angle, point.deviation
    axis.annotate(point.label, place, (4, -8), textcoords="offset points", fontsize=7, color=BLENDER)


def draw_fronts(path, title, fronts):
    """The fronts {mesh: {boundary: (weight, SD, σ₁/σ₂) of each map}}, each a line with all its weights."""
    figure, axes = plots.panels(title, fronts)
    for axis, by_boundary in zip(axes, fronts.values()):
        for boundary, maps in by_boundary.items():
            weights, deviations, angles = zip(*maps)
            axis.plot(angles, deviations, "o-", color=FRONTS[boundary], markersize=3, label=boundary)
        for weight, *place in zip(weights, angles, deviations):
            axis.annotate(f"{weight:g}", place, (4, 2), textcoords="offset points", fontsize=6, color="0.4")
        axis.set(yscale="log", xlabel="σ₁/σ₂, mean")
        axis.grid(alpha=0.25, which="major")
        axis.legend(frameon=False, fontsize=8)
    for axis in plots.leftmost(axes):
        axis.set_ylabel("SD of the area ratio")
    plots.save(figure, path)
