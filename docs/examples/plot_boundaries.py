# SPDX-License-Identifier: MIT OR Apache-2.0
"""
Four boundaries
===============

``boundary`` says where the boundary of a disk goes. All four maps keep areas. This piece of ground is long
and narrow: on a circle or a rectangle it is sheared, a free outline suits it.
"""

import matplotlib.pyplot as plt
from pictures import draw_map, hills

import authalic

vertices, faces = hills()
surface = authalic.Surface(vertices * [2.5, 1, 1], faces)

# %%
figure, panels = plt.subplots(1, 4, figsize=(12, 3.6), layout="constrained")
for panel, boundary in zip(panels, ("arc_length", "sliding", "rectangle", "free"), strict=True):
    result = authalic.disk_map(surface, boundary=boundary, angle_weight=1e-3)
    figures = result.distortion
    shown = draw_map(panel, result.uv, result.faces, figures.angle_distortion, cmap="magma_r", limits=(1, 5))
    panel.set_title(
        f'"{boundary}"\nSD {figures.area_ratio_std:.4f}, mean σ₁/σ₂ {figures.angle_distortion_mean:.2f}'
    )
figure.colorbar(shown, ax=panels, label="σ₁/σ₂", shrink=0.7)
plt.show()
