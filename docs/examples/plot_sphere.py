# SPDX-License-Identifier: MIT OR Apache-2.0
"""
A body on the sphere, and in the plane
======================================

A closed surface without handles is mapped onto the unit sphere. Its arms, which a conformal map would
shrink to points, get the area that is theirs. From there two projections that keep areas lay it out in the
plane.
"""

import matplotlib.pyplot as plt
import numpy as np
from pictures import draw_map, draw_surface, star

import authalic

vertices, faces = star()
result = authalic.sphere_map(vertices, faces)
print(result)

# %%
# Each face keeps one color through all pictures: its direction from the middle of the body.

colors = vertices[faces].mean(axis=1)
colors = 0.15 + 0.85 * (colors - colors.min(axis=0)) / np.ptp(colors, axis=0)

figure, panels = plt.subplots(1, 4, figsize=(14, 3.6), width_ratios=(1.2, 1, 1.9, 1), layout="constrained")
draw_surface(panels[0], vertices, faces, colors, view=(-70, 50))
draw_surface(panels[1], result.positions, result.faces, colors, view=(-70, 50))
for panel, kind in ((panels[2], "lambert"), (panels[3], "octahedral")):
    layout = result.layout(kind)
    draw_map(panel, layout.points, layout.faces, colors)
    panel.set_title(f'layout("{kind}")')
panels[1].set_title("sphere_map")
plt.show()
