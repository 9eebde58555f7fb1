# SPDX-License-Identifier: MIT OR Apache-2.0
"""The sheet of pictures: a row for each mesh, with our seams on the surface and all layouts."""

import colorsys

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

from bench import plots
from bench.seams import raster, topology
from bench.seams.meshes import MODELS

SIZE = 320
"""The side of a picture in pixels."""
CELLS = 36
"""The cells of the checkerboard along the side of a square that has the area of the layout."""
DARK = 0.78
"""The brightness of the dark cells."""
LIGHT = np.array([-0.35, 0.45, 0.82])
SHADE = 0.45
"""The part of the brightness that depends on the light."""
TURN, TILT = np.radians(25), np.radians(15)
"""The eye stands a little to the side of the front and above it."""
COLORS = 192
"""The colors of the file, which is large without this limit."""
GOLDEN = (np.sqrt(5) - 1) / 2
WHITE, SEAM = (1.0, 1.0, 1.0), (0.75, 0.0, 0.05)


def draw(path, named_meshes, layouts):
    """A sheet of the meshes; `layouts` is {mesh: {method: (layout, figures)}}."""
    methods = list(dict.fromkeys(method for of_mesh in layouts.values() for method in of_mesh))
    rows, columns = len(named_meshes), 2 + len(methods)
    size = (2.3 * columns, 2.55 * rows)
    figure, axes = plt.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained")
    for axis in axes.ravel():
        axis.axis("off")
    for line, (name, mesh) in zip(axes, named_meshes.items()):
        draw_row(line, name, mesh, layouts[name], methods)
    path.parent.mkdir(parents=True, exist_ok=True)
    plots.save(figure, path)
    Image.open(path).convert("RGB").quantize(COLORS).save(path, optimize=True)


def draw_row(axes, name, mesh, of_mesh, methods):
    """The surface from the front and from the back by the first method, and the layouts."""
    if methods[0] in of_mesh:
        layout, _ = of_mesh[methods[0]]
        for axis, side in zip(axes, (1, -1)):
            axis.imshow(surface(*mesh, layout.corners, view(MODELS.get(name), side)))
    axes[0].set_title(name, fontsize=10, loc="left")
    for axis, method in zip(axes[2:], methods):
        if method in of_mesh:
            layout, figures = of_mesh[method]
            axis.imshow(plane(mesh[1], layout.corners))
            axis.set_title(f"{method}\n{caption(figures)}", fontsize=7)


def caption(figures):
    """The seams' length, the islands and the shear."""
    return f"seams {figures.length:.2f}, islands {figures.islands}, σ₁/σ₂ {figures.shear:.3f}"


def view(model, side):
    """The rotation (3, 3) whose rows are right, up and towards the eye; side -1 looks from behind."""
    up, front = axis_vector(model.up if model else "y"), side * axis_vector(model.front if model else "z")
    right = np.cross(up, front)
    front = np.cos(TURN) * front + np.sin(TURN) * right
    right = np.cross(up, front)
    front = np.cos(TILT) * front + np.sin(TILT) * up
    return np.stack([right, np.cross(front, right), front])


def axis_vector(name):
    """The unit vector of an axis such as "z" or "-y"."""
    return (-1 if name.startswith("-") else 1) * np.eye(3)["xyz".index(name[-1])]


def surface(vertices, faces, corners, turn):
    """The surface with the checkerboard of its layout and its seams, (SIZE, SIZE, 3)."""
    seen = (vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2) @ turn.T
    scale = 0.48 * SIZE / np.abs(seen[:, :2]).max()
    seen = seen * scale + [SIZE / 2, SIZE / 2, 0]
    islands = topology.islands(faces, corners)
    triangle, column, row = raster.spans(seen[faces][:, :, :2]).points()
    inside = np.stack([column, row], axis=1) + 0.5
    weights = raster.barycentric(seen[faces][triangle][:, :, :2], inside)
    depth = np.einsum("pk,pk->p", weights, seen[faces][triangle][:, :, 2])
    uv = np.einsum("pk,pkc->pc", weights, corners[triangle])
    colors = checkered(uv, corners, island_colors(islands.of_face)[triangle])
    colors *= brightness(seen[faces])[triangle, None]
    nearest = np.argsort(depth, kind="stable")  # later points cover earlier ones
    picture, front = np.ones((SIZE, SIZE, 3)), np.full((SIZE, SIZE), -np.inf)
    picture[row[nearest], column[nearest]] = colors[nearest]
    front[row[nearest], column[nearest]] = depth[nearest]
    draw_seams(picture, front, seen[islands.seams])
    return picture[::-1]


def brightness(triangles):
    """The light on each face, (m,), with both of its sides lit."""
    a, b, c = triangles.transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    return 1 - SHADE + SHADE * np.abs(normals @ (LIGHT / np.linalg.norm(LIGHT)))


def draw_seams(picture, front, segments):
    """Colors the points of seams (k, 2, 3) that no face hides, two pixels wide."""
    share = np.linspace(0, 1, 2 * int(np.abs(np.diff(segments, axis=1)).max(initial=0)) + 2)[:, None, None]
    points = ((1 - share) * segments[:, 0] + share * segments[:, 1]).reshape(-1, 3)
    column, row = (points[:, :2].T - 0.5).astype(int).clip(0, SIZE - 2)
    for right, up in ((0, 0), (0, 1), (1, 0), (1, 1)):
        visible = points[:, 2] > front[row + up, column + right] - SIZE / 100
        picture[row[visible] + up, column[visible] + right] = SEAM


def plane(faces, corners):
    """The layout with its checkerboard, an island in a color, (SIZE, SIZE, 3)."""
    islands = topology.islands(faces, corners)
    triangle, column, row = raster.spans(corners * SIZE).points()
    there = (np.minimum(column, row) >= 0) & (np.maximum(column, row) < SIZE)
    triangle, column, row = triangle[there], column[there], row[there]
    uv = (np.stack([column, row], axis=1) + 0.5) / SIZE
    picture = np.full((SIZE, SIZE, 3), 0.96)
    picture[row, column] = checkered(uv, corners, island_colors(islands.of_face)[triangle])
    return picture[::-1]


def checkered(uv, corners, colors):
    """Colors (p, 3) with every other cell of a checkerboard darker; all layouts have as many cells."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    cell = np.sqrt(np.abs(raster.cross(a, b)).sum() / 2) / CELLS
    dark = np.floor(uv / cell).sum(axis=1) % 2 == 1
    return colors * np.where(dark, DARK, 1.0)[:, None]


def island_colors(of_face):
    """The color of each face's island, (m, 3), the largest islands first in the order of colors."""
    size = np.bincount(of_face)
    rank = np.empty(len(size), int)
    rank[np.argsort(-size, kind="stable")] = np.arange(len(size))
    colors = [colorsys.hsv_to_rgb((0.58 + GOLDEN * k) % 1, 0.38, 1.0) for k in range(len(size))]
    return np.array(colors)[rank[of_face]]
