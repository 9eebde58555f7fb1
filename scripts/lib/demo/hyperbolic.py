# SPDX-License-Identifier: MIT OR Apache-2.0
"""The demo's picture of a hyperbolic structure: universal cover, hexagons, and pants curves on the surface.

Usage: python -m demo.hyperbolic OUT_FOLDER (in an environment with the package authalic)

The surface is a brain if the folder AUTHALIC_DATA (or ../shared/data) has one, else a bumpy ball.
"""

import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

import authalic
from shell import DATA

CURVES, COPIES = 6, 400
PANTS, HUES = plt.get_cmap("tab10"), plt.get_cmap("twilight_shifted")
BOUNDARY, ARC = "#7a1024", "white"
SMALLEST = 0.004
"""Copies of the domain that look smaller than this in the unit disk are left out."""


def surface():
    """(name, vertices, faces, curves, directions from which to look at it)."""
    path = DATA / "brain" / "fsaverage5_left_10242.npz"
    if not path.is_file():
        return "a bumpy ball", *bumpy_ball(), ([1, 0.3, 0.3], [-1, -0.3, 0.3])
    curves = json.loads((path.parent / "fsaverage5_curves.json").read_text(encoding="utf-8"))["left"]
    with np.load(path) as file:
        vertices, faces = file["V_infl"].astype(float), file["F"].astype(np.int64)
    return "an inflated left hemisphere", vertices, faces, curves[:CURVES], ([-1, 0, 0.2], [1, 0, -0.1])


def bumpy_ball(stacks=60, slices=90):
    """Vertices, faces and curves of a ball of parallels and meridians, slit along parts of some meridians."""
    polar, angle = np.meshgrid(
        np.pi * np.arange(1, stacks) / stacks, 2 * np.pi * np.arange(slices) / slices, indexing="ij"
    )
    radius = 1 + 0.15 * np.sin(3 * polar) * np.cos(3 * angle)
    around = radius * np.sin(polar)
    rings = np.stack(
        [around * np.cos(angle), around * np.sin(angle), radius * np.cos(polar)], axis=-1
    ).reshape(-1, 3)
    a = np.arange(len(rings)).reshape(-1, slices)
    b = np.roll(a, -1, axis=1)
    quads = [[a[:-1], a[1:], b[1:]], [a[:-1], b[1:], b[:-1]]]
    north, south = (np.full(slices, len(rings) + k) for k in (0, 1))
    caps = [[north, a[0], b[0]], [south, b[-1], a[-1]]]
    faces = np.concatenate([np.stack(corners, axis=-1).reshape(-1, 3) for corners in quads + caps])
    slits = [a[12 + 8 * (k % 3) :: 1, slices * k // CURVES][:17] for k in range(CURVES)]
    return np.vstack([rings, [[0, 0, 1], [0, 0, -1]]]), faces, slits


def moved(isometry, z):
    """Points under the isometry (a, b) of the Poincaré disk."""
    a, b = isometry
    return (a * z + b) / (np.conj(b) * z + np.conj(a))


def flat(z):
    return np.stack([z.real, z.imag], axis=-1)


def draw_cover(axis, structure):
    """The fundamental domain and its copies in the Poincaré disk."""
    z = structure.positions @ [1, 1j]
    outline = z[np.concatenate(_around(structure))]
    words, motions = structure.cover(COPIES)
    copies = [moved(motion, outline) for motion in motions]
    shown = [k for k, copy in enumerate(copies) if np.ptp(copy.real) + np.ptp(copy.imag) > SMALLEST]
    letters = 2 * len(structure.generators)
    colors = [_color(words[k], letters) for k in shown]
    axis.add_collection(
        PolyCollection([flat(copies[k]) for k in shown], facecolors=colors, edgecolors="none")
    )
    for sides, color, width in ((structure.arcs, ARC, 0.5), (structure.banks, BOUNDARY, 0.8)):
        lines = [flat(moved(motions[k], z[side])) for k in shown for pair in sides for side in pair]
        axis.add_collection(LineCollection(lines, colors=color, linewidths=width))
    axis.add_collection(
        LineCollection(
            [flat(moved(motions[0], z[side])) for banks in structure.banks for side in banks],
            colors=BOUNDARY,
            linewidths=2,
        )
    )
    for k, (a, b) in enumerate(structure.generators[1:-1]):
        axis.plot(*flat(_axis(a, b)).T, color=PANTS(k), linewidth=1.6, linestyle="--")
    _unit_disk(axis, "fundamental domain and its copies, Poincaré disk")


def _around(structure):
    """The vertices of the disk's boundary in order: a list of banks and arcs."""
    left, right = (
        [
            pair[side]
            for pairs in zip(structure.banks, [*structure.arcs, None], strict=True)
            for pair in pairs
            if pair is not None
        ]
        for side in (0, 1)
    )
    return [*left, *(side[::-1] for side in right[::-1])]


def _color(word, letters):
    if not word:
        return "#f3d9a4"
    first, depth = word[0], len(word)
    place = (2 * abs(first) - (first > 0) - 0.5) / letters
    color = np.array(HUES(0.12 + 0.76 * place)[:3])
    return tuple(color + (1 - color) * (0.25 + 0.2 * (depth % 3)))


def _axis(a, b):
    """Points on the axis of a translation of the Poincaré disk."""
    root = np.sqrt(a.real**2 - 1)
    ends = [(sign * root + 1j * a.imag) / np.conj(b) for sign in (-1, 1)]
    t = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, 400)[1:-1])
    chord = (1 - t) * ends[0] + t * ends[1]
    return chord / (1 + np.sqrt(np.maximum(1 - np.abs(chord) ** 2, 0)))


def _unit_disk(axis, title):
    axis.add_patch(plt.Circle((0, 0), 1, fill=False, color="0.3", linewidth=0.8))
    axis.set(xlim=(-1.02, 1.02), ylim=(-1.02, 1.02), aspect="equal", title=title)
    axis.axis("off")


def draw_hexagons(axis, structure):
    """Every pair of pants as its two hexagons in Klein's model."""
    columns = int(np.ceil(np.sqrt(len(structure.pants))))
    for k, pants in enumerate(structure.pants):
        center = np.array([2.2 * (k % columns), -2.35 * (k // columns)])
        axis.add_patch(plt.Circle(center, 1, facecolor="0.97", edgecolor="0.4", linewidth=0.8))
        for corners, shade in zip(pants.hexagons + center, (0.75, 0.4), strict=True):
            axis.add_patch(plt.Polygon(corners, facecolor="0.6", alpha=shade, edgecolor="0.3", linewidth=0.6))
            for side, color in enumerate(_side_colors(k, len(structure.pants))):
                axis.plot(*corners[2 * side : 2 * side + 2].T, color=color, linewidth=2.4)
        lengths = ", ".join(f"{length:.2f}" for length in pants.boundary_lengths)
        axis.text(*(center - [0, 1.06]), f"lengths {lengths}", ha="center", va="top", fontsize=7.5)
    axis.autoscale_view()
    axis.set(aspect="equal", title="pants as two right-angled hexagons, Klein's model")
    axis.axis("off")


def _side_colors(k, count):
    """The colors of the boundaries of a pair of pants: one per pants curve, one for all landmark curves."""
    before = BOUNDARY if k == 0 else PANTS(k - 1)
    after = BOUNDARY if k == count - 1 else PANTS(k)
    return before, BOUNDARY, after


def draw_surface(axis, structure, curves, vertices, directions):
    """The surface from two sides, stacked, with landmark curves and pants curves."""
    lines = [(vertices[np.asarray(curve)], BOUNDARY) for curve in curves]
    lines += [(curve, PANTS(k)) for k, curve in enumerate(structure.pants_curves)]
    below = 0.0
    for direction in directions:
        frame = _frame(np.array(direction, float))
        polygons, colors, depths = _shaded(structure.vertices @ frame.T, structure.faces)
        width = 0.006 * np.ptp(vertices, axis=0).max()
        for points, color in lines:
            ribbon, depth = _ribbon(points @ frame.T, width)
            polygons, depths = [*polygons, *ribbon], np.append(depths, depth)
            colors = np.vstack([colors, np.tile(matplotlib.colors.to_rgb(color), (len(ribbon), 1))])
        order = np.argsort(depths)
        high = max(polygon[:, 1].max() for polygon in polygons)
        shift = [0, below - high]
        shown = [polygons[k] + shift for k in order]
        axis.add_collection(
            PolyCollection(shown, facecolors=colors[order], edgecolors="face", linewidths=0.15)
        )
        below = min(polygon[:, 1].min() for polygon in shown) - 0.05 * np.ptp(vertices, axis=0).max()
    axis.autoscale_view()
    axis.set(aspect="equal", title="landmark curves and pants curves")
    axis.axis("off")


def _frame(to_eye):
    """Rows: right, up and to the eye; the z axis points up."""
    to_eye /= np.linalg.norm(to_eye)
    right = np.cross([0, 0, 1], to_eye)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(to_eye, right), to_eye])


def _shaded(points, faces):
    """Triangles on the screen that face the eye, their colors, and how near they are."""
    a, b, c = np.moveaxis(points[faces], 1, 0)
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    light = np.array([-0.35, 0.5, 0.8]) / np.linalg.norm([-0.35, 0.5, 0.8])
    gray = 0.38 + 0.55 * np.clip(normal @ light, 0, 1)
    facing = normal[:, 2] > 0
    colors = gray[facing, None] * [1.0, 0.97, 0.93]
    triangles = points[faces[facing]]
    return list(triangles[:, :, :2]), colors, triangles[:, :, 2].mean(axis=1)


def _ribbon(points, width):
    """A line as quadrilaterals on the screen, and how near each is drawn, a little nearer than it is."""
    a, b = points[:-1], points[1:]
    step = (b - a)[:, :2]
    along = step / np.maximum(np.linalg.norm(step, axis=1), 1e-300)[:, None]
    side = 0.5 * width * np.stack([-along[:, 1], along[:, 0]], axis=1)
    end = 0.3 * width * along
    a2, b2 = a[:, :2] - end, b[:, :2] + end
    quads = np.stack([a2 + side, b2 + side, b2 - side, a2 - side], axis=1)
    return list(quads), 0.5 * (a + b)[:, 2] + 2 * width


def draw(path):
    """The whole picture."""
    name, vertices, faces, curves, directions = surface()
    structure = authalic.hyperbolic_structure(vertices, faces, curves=curves)
    figure, axes = plt.subplots(1, 3, figsize=(19, 7), layout="constrained", width_ratios=(1, 0.9, 0.8))
    draw_cover(axes[0], structure)
    draw_hexagons(axes[1], structure)
    draw_surface(axes[2], structure, curves, vertices, directions)
    figure.suptitle(f"The hyperbolic structure of {name} with {len(curves)} landmark curves")
    figure.savefig(path, dpi=120)
    plt.close(figure)


if __name__ == "__main__":
    draw(Path(sys.argv[1]) / "hyperbolic.png")
