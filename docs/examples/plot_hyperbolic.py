# SPDX-License-Identifier: MIT OR Apache-2.0
"""
Curves and the hyperbolic plane
===============================

A surface slit along curves has a hyperbolic metric in which all slits are geodesics. It lays the surface
out in the Poincaré disk. Copies of it, moved by isometries, lie side by side: together they are the
universal cover, a part of the disk that the slits bound. Between the slits, closed geodesics divide the
surface into pairs of pants. This is what stands behind ``register_hyperbolic``.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from pictures import draw_surface, finish, globe, viewer

import authalic

vertices, faces, curves = globe()
structure = authalic.hyperbolic_structure(vertices, faces, curves=curves)
print(structure)

# %%
# A row (a, b) of the isometries stands for z ↦ (a z + b) / (conj(b) z + conj(a)). The cut surface, around
# its outline: left banks and arcs forward, right ones back.

z = structure.positions @ [1, 1j]
left, right = ([], [])
for k, banks in enumerate(structure.banks):
    for side, chain in ((0, left), (1, right)):
        chain.append(banks[side])
        if k < len(structure.arcs):
            chain.append(structure.arcs[k][side])
outline = z[np.concatenate([*left, *(path[::-1] for path in right[::-1])])]
words, motions = structure.cover(150)


def moved(motion, points):
    a, b = motion
    image = (a * points + b) / (np.conj(b) * points + np.conj(a))
    return np.stack([image.real, image.imag], axis=-1)


# %%
# The colors of the copies say which isometry comes first. Dark red: landmark curves. Blue: geodesics
# between pants.

figure, panels = plt.subplots(1, 3, figsize=(13, 4.6), layout="constrained")
hues = plt.get_cmap("twilight")
first = [word[0] if word else 0 for word in words]
colors = [hues(0.15 + 0.1 * abs(k) + 0.05 * (k < 0)) if k else "#f3d9a4" for k in first]
panels[0].add_collection(
    PolyCollection(
        [moved(m, outline) for m in motions], facecolors=colors, edgecolors="white", linewidths=0.3
    )
)
banks = [moved(m, z[bank]) for m in motions for pair in structure.banks for bank in pair]
panels[0].add_collection(LineCollection(banks, colors="#7a1024", linewidths=1))
panels[0].add_patch(plt.Circle((0, 0), 1, fill=False, edgecolor="0.4"))
panels[0].set_title("fundamental domain and copies")
for pants, shift in zip(structure.pants, (-1.1, 1.1), strict=True):
    panels[1].add_patch(plt.Circle((shift, 0), 1, facecolor="0.96", edgecolor="0.4"))
    for corners, shade in zip(pants.hexagons, (0.8, 0.45), strict=True):
        panels[1].add_patch(
            plt.Polygon(corners + np.array([shift, 0]), facecolor="0.6", edgecolor="0.2", alpha=shade)
        )
panels[1].set_title("each pair of pants: two hexagons")
finish(panels[0])
finish(panels[1])

look = (25, 20)
draw_surface(panels[2], vertices, faces, view=look)
right, up, toward = viewer(*look)
for paths, color in (([vertices[curve] for curve in curves], "#7a1024"), (structure.pants_curves, "#2166ac")):
    for path in paths:
        front = np.where((path @ toward > 0)[:, None], np.stack([path @ right, path @ up], axis=1), np.nan)
        panels[2].plot(*front.T, color=color, linewidth=2)
panels[2].set_title("landmark curves and pants")
plt.show()
