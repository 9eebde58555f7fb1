# SPDX-License-Identifier: MIT OR Apache-2.0
"""The pictures of the bench: a checkerboard in space on the target, pulled onto the source, and strains."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np

from bench import plots
from bench.seams import raster
from bench.seams.pictures import brightness
from bench.wrap.methods import AREA, SURFACE, ZOOMOUT

COLORS = {SURFACE: "#b3263e", AREA: "#2b5f8f", ZOOMOUT: "#d1883a"}
SIZE = 360
"""The side of a picture in pixels."""
CELLS = 16
"""The cells of the checkerboard along the longest side of the target."""
DARK = 0.65
"""The brightness of the dark cells."""
TURN, TILT = np.radians(25), np.radians(15)
"""The eye stands a little to the side of the long axes and above them."""
BINS = np.linspace(0, 1.5, 76)
"""Of log10 of the strain."""


def draw_pairs(path, title, rows):
    """A row for each (pair, {method: placed}): the target, and the source by each method."""
    methods = list(dict.fromkeys(method for _, maps in rows for method in maps))
    shape = len(rows), 1 + len(methods)
    size = (3.2 * shape[1], 2.8 * shape[0] + 0.4)
    figure, axes = plt.subplots(*shape, figsize=size, squeeze=False, layout="constrained")
    figure.suptitle(title, fontsize=11)
    for axis in axes.ravel():
        axis.axis("off")
    for line, (pair, maps) in zip(axes, rows):
        draw_row(line, pair, maps, methods)
    plots.save(figure, path)


def draw_row(axes, pair, maps, methods):
    """The target from its own side, and the source as the first map turns it."""
    target, source = pair.target, pair.source
    view = side_view(target.vertices)
    axes[0].imshow(picture(target, target.vertices, target.vertices, view))
    axes[0].set_title(target.name, fontsize=9)
    turned = view
    for axis, method in zip(axes[1:], methods):
        if method in maps:
            image = placed_points(target, maps[method])
            turned = view @ rotation(source.vertices, image) if method == next(iter(maps)) else turned
            axis.imshow(picture(source, image, target.vertices, turned))
            axis.set_title(f"{source.name}: {method}", fontsize=9)


def placed_points(target, placed):
    """The points of the target on which the source's vertices lie."""
    return np.einsum("ik,ikx->ix", placed.barycentric, target.vertices[target.faces[placed.triangles]])


def side_view(vertices):
    """The rotation (3, 3) of which the rows are right, up and towards the eye: along the principal axes.

    Most of the vertices are above: legs hang down.
    """
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    axes = np.linalg.svd(vertices - vertices.mean(axis=0), full_matrices=False)[2]
    axes[1] *= np.sign((vertices.mean(axis=0) - middle) @ axes[1]) or 1
    axes[2] = np.cross(axes[0], axes[1])
    right, front = axes[0], np.cos(TURN) * axes[2] + np.sin(TURN) * axes[0]
    right = np.cross(axes[1], front)
    front = np.cos(TILT) * front + np.sin(TILT) * axes[1]
    return np.stack([right, np.cross(front, right), front])


def rotation(points, images):
    """The rotation that best takes points to their images."""
    first, second = (each - each.mean(axis=0) for each in (points, images))
    left, _, right = np.linalg.svd(second.T @ first)
    return left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right


def picture(surface, images, target, view):
    """The surface in the colors of the images' places in the box of the target, (SIZE, SIZE, 3)."""
    seen = (surface.vertices - (surface.vertices.min(axis=0) + surface.vertices.max(axis=0)) / 2) @ view.T
    seen = seen * (0.47 * SIZE / np.abs(seen[:, :2]).max()) + [SIZE / 2, SIZE / 2, 0]
    triangles = seen[surface.faces]
    triangle, column, row = raster.spans(triangles[:, :, :2]).points()
    inside = (np.minimum(column, row) >= 0) & (np.maximum(column, row) < SIZE)
    triangle, column, row = triangle[inside], column[inside], row[inside]
    weights = raster.barycentric(triangles[triangle][:, :, :2], np.stack([column, row], axis=1) + 0.5)
    depth = np.einsum("pk,pk->p", weights, triangles[triangle][:, :, 2])
    points = np.einsum("pk,pkx->px", weights, images[surface.faces[triangle]])
    colors = checkered(points, target) * brightness(triangles)[triangle, None]
    nearest = np.argsort(depth, kind="stable")  # later points cover earlier ones
    canvas = np.ones((SIZE, SIZE, 3))
    canvas[row[nearest], column[nearest]] = colors[nearest]
    return canvas[::-1]


def checkered(points, target):
    """Colors (p, 3) by the place in the target's box, with every other cube of it darker."""
    low, high = target.min(axis=0), target.max(axis=0)
    share = ((points - low) / np.maximum(high - low, 1e-300)).clip(0, 1)
    dark = np.floor((points - low) * CELLS / (high - low).max()).sum(axis=1) % 2 == 1
    return (0.25 + 0.75 * share) * np.where(dark, DARK, 1.0)[:, None]


def draw_strains(path, title, strains):
    """Histograms over the faces of {collection: {method: strains of all its pairs}}."""
    figure, axes = plots.panels(title, strains)
    for axis, by_method in zip(axes, strains.values()):
        axis.title.set_fontsize(8.5)
        for method, values in by_method.items():
            level = np.log10(values).clip(0, BINS[-1])
            weights = np.full(len(level), 1 / len(level))
            label = f"{method}: median {np.median(values):.3f}"
            axis.hist(level, BINS, weights=weights, histtype="step", label=label, color=COLORS[method])
        axis.set_xticks(np.log10([1, 2, 5, 10, 30]), ["1", "2", "5", "10", "30"])
        axis.set_xlabel("strain of a face (last bin: and beyond)", fontsize=9)
        axis.set_yscale("log")
        axis.legend(frameon=False, fontsize=7.5, loc="upper right")
    plots.save(figure, path)
