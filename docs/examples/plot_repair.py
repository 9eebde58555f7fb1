# SPDX-License-Identifier: MIT OR Apache-2.0
"""
A surface out of a soup of triangles
====================================

Files of scanners, printers and segmentations hold triangles, but seldom a surface: every face has corners
of its own, some are missing, some face inward, some appear twice. ``repair`` makes a surface of them and
says what it did. Every vertex and face knows where it came from.
"""

import matplotlib.pyplot as plt
import numpy as np
from pictures import draw_surface, star

import authalic

# %%
# A star, and what might be left of it in a file: corners that are not joined, a face here and there
# missing, turned around, or there twice.

vertices, faces = star()
chance = np.random.default_rng(3)
kept = faces[chance.random(len(faces)) > 0.005]
turned = chance.random(len(kept)) < 0.1
kept[turned] = kept[turned][:, ::-1]
kept = np.concatenate([kept, kept[:20]])
soup, triangles = vertices[kept].reshape(-1, 3), np.arange(3 * len(kept)).reshape(-1, 3)

# %%
repaired = authalic.repair(soup, triangles)
print(repaired.report)

# %%
# What was repaired is mapped like any other surface. Faces that were added close the pinholes; they are
# red.

sphere = authalic.sphere_map(repaired)
print(sphere)

added = repaired.face_of < 0
colors = np.where(added[:, None], [0.8, 0.15, 0.15], [0.85, 0.78, 0.65])
figure, panels = plt.subplots(1, 3, figsize=(11, 3.8), layout="constrained")
draw_surface(panels[0], soup, triangles, view=(-70, 50))
draw_surface(panels[1], repaired.vertices, repaired.faces, colors, view=(-70, 50))
draw_surface(panels[2], sphere.positions, sphere.faces, colors, view=(-70, 50))
for panel, name in zip(panels, ("as in the file", "repaired", "on the sphere"), strict=True):
    panel.set_title(name)
plt.show()
