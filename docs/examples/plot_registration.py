# SPDX-License-Identifier: MIT OR Apache-2.0
"""
One body onto another
=====================

Five landmarks, the tips of the arms, say what belongs together. The registration takes each vertex of the
source to a place on the target, without a fold, and keeps shapes as well as it can. Data go both ways.
"""

import matplotlib.pyplot as plt
import numpy as np
from pictures import draw_surface, star

import authalic

source = star(length=0.7, width=0.5)
target = star(length=1.1, width=0.38)
turn = np.radians(25)  # the target is turned, larger, and bent
vertices = 1.3 * target[0] @ [[np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0], [0, 0, 1]]
vertices[:, 2] += 0.15 * (vertices[:, :2] ** 2).sum(axis=1)
target = vertices, target[1]


def tips(surface):
    """The vertices farthest out along the arms, in order."""
    angles = np.arange(5) * 2 * np.pi / 5
    unit = surface[0] / np.linalg.norm(surface[0], axis=1, keepdims=True)
    return (unit @ np.stack([np.cos(angles), np.sin(angles), 0 * angles])).argmax(axis=0)


landmarks = tips(star())  # both have the vertices of one sphere, in one order
registration = authalic.register_spheres(
    source, target, source_landmarks=landmarks, target_landmarks=landmarks
)
print(registration)
print("median strain", registration.strain.median)

# %%
# A pattern of the source on the source, and taken to the target; the morph halfway; the strain of each
# face, which is 1 where shapes are kept.

pattern = np.sin(7 * source[0]).prod(axis=1)
on_target = registration.inverse().pull(pattern)
halfway = authalic.homotopy(source[0], registration, 0.5)

figure, panels = plt.subplots(1, 4, figsize=(13, 3.4), layout="constrained")
look = {"view": (-70, 55)}
for panel, surface, values, name in (
    (panels[0], source, pattern, "source"),
    (panels[1], (halfway, source[1]), pattern, "halfway"),
    (panels[2], target, on_target, "target"),
):
    draw_surface(panel, *surface, values[surface[1]].mean(axis=1), cmap="PuOr", limits=(-0.7, 0.7), **look)
    panel.set_title(name)
shown = draw_surface(
    panels[3], *source, registration.strain.symmetric_dirichlet, cmap="magma_r", limits=(1, 2), **look
)
panels[3].set_title("strain")
figure.colorbar(shown, ax=panels[3], label="symmetric Dirichlet energy / 4", shrink=0.7)
plt.show()
