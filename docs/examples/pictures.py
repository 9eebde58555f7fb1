# SPDX-License-Identifier: MIT OR Apache-2.0
"""The surfaces and the drawing of the gallery; copy it beside an example to run that one elsewhere.

Surfaces are pairs of vertices (n, 3) and triangles (m, 3). Pictures need nothing but numpy and matplotlib.
"""

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.tri import Triangulation

CLAY = "#d9c7a6"
AREAS = "RdBu_r"
"""The colors of log2 area ratios: blue is too small, red too large."""
LIGHT = np.array([-0.4, 0.7, 0.6])
"""Where the light comes from: right, up, toward the viewer."""


def hills(points=2500):
    """A round piece of ground with three hills."""
    k = np.arange(points)
    radius = np.sqrt((k + 0.5) / points)
    angle = k * np.pi * (3 - np.sqrt(5))  # sunflower seeds
    rim = np.linspace(0, 2 * np.pi, int(3 * np.sqrt(points)), endpoint=False)
    inner = radius < 1 - 1 / np.sqrt(points)
    x = np.concatenate([(radius * np.cos(angle))[inner], np.cos(rim)])
    y = np.concatenate([(radius * np.sin(angle))[inner], np.sin(rim)])
    z = np.zeros_like(x)
    for height, u, v, width in ((0.9, 0.25, 0.2, 0.22), (0.6, -0.45, 0.1, 0.2), (0.5, 0.0, -0.5, 0.18)):
        z += height * np.exp(-((x - u) ** 2 + (y - v) ** 2) / width**2)
    return np.stack([x, y, z], axis=1), Triangulation(x, y).triangles.astype(np.int64)


def icosphere(level=4):
    """A sphere of triangles: the icosahedron, each face split into four `level` times."""
    golden = (1 + np.sqrt(5)) / 2
    corners = [(-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0)]
    points = np.array([np.roll(corner, shift) for shift in range(3) for corner in corners], dtype=float)
    distances = np.linalg.norm(points[:, None] - points[None], axis=2)
    near = distances < 2.1
    faces = [
        (a, b, c) if np.linalg.det(points[[a, b, c]]) > 0 else (a, c, b)
        for a in range(12) for b in range(a) for c in range(b)
        if near[a, b] and near[b, c] and near[a, c]
    ]  # fmt: skip
    faces = np.array(faces)
    for _ in range(level):
        points, faces = split(points, faces)
    return points / np.linalg.norm(points, axis=1, keepdims=True), faces


def split(vertices, faces):
    """Every face in four, at the middles of its sides."""
    sides = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, side = np.unique(sides, axis=0, return_inverse=True)
    ab, bc, ca = side.reshape(-1, 3).T + len(vertices)
    a, b, c = faces.T
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    finer = np.concatenate([np.stack(part, axis=1) for part in parts])
    return np.concatenate([vertices, vertices[edges].mean(axis=1)]), finer


def star(arms=5, length=1.0, width=0.42, level=4):
    """A closed body with arms around it and a dome on top."""
    directions, faces = icosphere(level)
    angles = 2 * np.pi * np.arange(arms) / arms
    tips = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    away = np.arccos(np.clip(directions @ tips.T, -1, 1))
    radius = 0.5 + length * np.exp(-((away / width) ** 2)).sum(axis=1)
    radius += 0.25 * np.exp(-((np.arccos(directions[:, 2].clip(-1, 1)) / 0.5) ** 2))
    return directions * radius[:, None], faces


def ring(radius=0.45, around=72, across=32):
    """A torus: a closed surface with one handle."""
    u, v = np.meshgrid(*(2 * np.pi * np.arange(n) / n for n in (around, across)), indexing="ij")
    x, y = (1 + radius * np.cos(v)) * np.cos(u), (1 + radius * np.cos(v)) * np.sin(u)
    vertices = np.stack([x, y, radius * np.sin(v)], axis=-1).reshape(-1, 3)
    a = np.arange(around * across).reshape(around, across)
    b, c = np.roll(a, -1, axis=0), np.roll(a, -1, axis=1)
    d = np.roll(b, -1, axis=1)
    faces = [np.stack(corners, axis=-1).reshape(-1, 3) for corners in ((a, b, d), (a, d, c))]
    return vertices, np.concatenate(faces)


def globe(rings=40, slices=48, bumps=0.12):
    """A bumpy ball of parallels and meridians, and four of its meridians in part, as paths along edges."""
    polar = np.pi * np.arange(1, rings) / rings
    angle = 2 * np.pi * np.arange(slices) / slices
    polar, angle = np.meshgrid(polar, angle, indexing="ij")
    radius = 1 + bumps * np.sin(3 * polar) * np.cos(3 * angle)
    x, y = radius * np.sin(polar) * np.cos(angle), radius * np.sin(polar) * np.sin(angle)
    vertices = np.stack([x, y, radius * np.cos(polar)], axis=-1).reshape(-1, 3)
    a = np.arange(len(vertices)).reshape(-1, slices)
    b = np.roll(a, -1, axis=1)
    north, south = (np.full(slices, len(vertices) + k) for k in (0, 1))
    corners = [(a[:-1], a[1:], b[1:]), (a[:-1], b[1:], b[:-1]), (north, a[0], b[0]), (south, b[-1], a[-1])]
    faces = np.concatenate([np.stack(three, axis=-1).reshape(-1, 3) for three in corners])
    first = [rings // 5, rings // 3, rings // 4, rings // 2]
    curves = [a[first[k] : first[k] + rings // 3, slices * k // 4] for k in range(4)]
    return np.concatenate([vertices, [[0, 0, 1], [0, 0, -1]]]), faces, curves


def draw_surface(
    axes, vertices, faces, values=None, *, view=(-60, 25), cmap=AREAS, limits=(-1, 1), lines=None
):
    """Draws a surface as seen from far away.

    `values` has a number or a color for each face; `view` the azimuth and elevation of the viewer in degrees;
    `lines` pairs of vertices that are drawn on top. Returns what a color bar needs.
    """
    right, up, toward = viewer(*view)
    places = np.stack([vertices @ right, vertices @ up], axis=1)
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-300
    shown = np.flatnonzero(normals @ toward > 0)
    shown = shown[np.argsort((vertices[faces[shown]] @ toward).mean(axis=1))]
    light = LIGHT / np.linalg.norm(LIGHT)
    shade = 0.55 + 0.45 * np.clip(normals @ (light[0] * right + light[1] * up + light[2] * toward), 0, 1)
    collection = PolyCollection(places[faces[shown]], linewidths=0.2)
    colors = face_colors(collection, values, len(faces), cmap, limits)
    colors = np.clip(colors[shown, :3] * shade[shown, None], 0, 1)
    collection.set(facecolors=colors, edgecolors=colors)
    axes.add_collection(collection)
    if lines is not None:
        draw_lines(axes, vertices, faces, normals @ toward, places, lines)
    finish(axes)
    return collection


def draw_lines(axes, vertices, faces, facing, places, lines):
    """Edges that have a face toward the viewer; faces in front of them do not hide them."""
    seen = np.zeros(len(vertices), dtype=bool)
    seen[faces[facing > 0]] = True
    lines = np.asarray(lines)
    axes.add_collection(
        LineCollection(places[lines[seen[lines].all(axis=1)]], colors="#b2182b", linewidths=1.6)
    )


def draw_map(axes, uv, faces, values=None, *, cmap=AREAS, limits=(-1, 1), edges=True):
    """Draws a map in the plane, its faces colored by a number or a color each."""
    collection = PolyCollection(uv[faces], linewidths=0.15 if edges else 0.2)
    colors = face_colors(collection, values, len(faces), cmap, limits)
    collection.set(facecolors=colors, edgecolors="#00000055" if edges else colors)
    axes.add_collection(collection)
    finish(axes)
    return collection


def face_colors(collection, values, count, cmap, limits):
    """Colors of all faces; numbers are noted on the collection for its color bar."""
    if values is None:
        return np.tile(rgb(CLAY), (count, 1))
    values = np.asarray(values)
    if values.ndim == 2:
        return values
    collection.set(cmap=cmap, clim=limits)
    return collection.to_rgba(values)


def rgb(color):
    return np.array([int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)])


def checkers(uv, faces, squares=16):
    """A surface split finely, and the colors of a checkerboard that its map lays onto it.

    Returns a function that splits an array of the vertices, the split faces, and the color of each.
    """
    points, parts = np.asarray(uv, dtype=float), faces
    for _ in range(2):
        points, parts = split(points, parts)
    cells = np.floor(points[parts].mean(axis=1) * squares).astype(int)
    dark = cells.sum(axis=1) % 2 == 0
    colors = np.where(dark[:, None], rgb("#3b6ea5"), rgb("#f2efe6"))

    def finer(values):
        for_faces = faces
        for _ in range(2):
            values, for_faces = split(values, for_faces)
        return values

    return finer, parts, colors


def viewer(azimuth, elevation):
    """The directions right, up and toward the viewer."""
    a, e = np.radians([azimuth, elevation])
    toward = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0])
    return right, np.cross(toward, right), toward


def finish(axes):
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_axis_off()
