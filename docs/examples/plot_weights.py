# SPDX-License-Identifier: MIT OR Apache-2.0
"""
Areas against angles
====================

``angle_weight`` says how much angles count beside areas. Each weight has its own map; together they are the
curve of what is possible. Squares of a checkerboard show both: where they differ in size, areas are not
kept, where they lean, angles are not.
"""

import matplotlib.pyplot as plt
from pictures import checkers, draw_surface, hills

import authalic

vertices, faces = hills()
surface = authalic.Surface(vertices, faces)
weights = [10, 3, 1, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 0]
maps = {weight: authalic.disk_map(surface, boundary="free", angle_weight=weight) for weight in weights}

# %%
figure, panels = plt.subplots(1, 4, figsize=(13, 3.4), layout="constrained")
deviations = [maps[weight].distortion.area_ratio_std for weight in weights]
shears = [maps[weight].distortion.angle_distortion_mean for weight in weights]
panels[0].plot(deviations, shears, marker="o")
for weight in (1, 0.1, 0):
    place = weights.index(weight)
    panels[0].annotate(f"  {weight}", (deviations[place], shears[place]), va="bottom")
panels[0].set(xlabel="SD of the area ratio", ylabel="mean of σ₁/σ₂", title="one map for each weight")
for panel, weight in zip(panels[1:], (10, 0.1, 0), strict=True):
    uv = maps[weight].uv
    finer, parts, colors = checkers(uv / (uv.max() - uv.min()), faces, squares=24)
    draw_surface(panel, finer(vertices), parts, colors, view=(-60, 40))
    panel.set_title(f"angle_weight={weight}")
plt.show()
