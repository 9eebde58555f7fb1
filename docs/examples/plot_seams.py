# SPDX-License-Identifier: MIT OR Apache-2.0
"""
Seams and shear
===============

``unwrap`` cuts any surface open. ``target`` is the shear that is wanted, the mean of σ₁/σ₂ of maps that
keep areas: less shear takes longer seams.
"""

import matplotlib.pyplot as plt
from pictures import draw_map, draw_surface, ring, star

import authalic

bodies = {"a ring": ring(), "a star": star(arms=4, width=0.5)}

# %%
# The colors show σ₁/σ₂ of each face, red lines are seams. Nothing overlaps, and all islands have one scale.

figure, panels = plt.subplots(2, 4, figsize=(13, 6.5), layout="constrained")
for row, (name, (vertices, faces)) in zip(panels, bodies.items(), strict=True):
    for pair, target in ((row[:2], 1.4), (row[2:], 1.2)):
        result = authalic.unwrap((vertices, faces), target=target)
        figures = authalic.distortion(vertices[result.vertex_of], result.faces, result.uv)
        draw_surface(pair[0], vertices, faces, lines=result.edges, view=(-70, 50))
        shown = draw_map(
            pair[1],
            result.uv,
            result.faces,
            figures.angle_distortion,
            cmap="magma_r",
            limits=(1, 3),
            edges=False,
        )
        pair[0].set_title(f"{name}, target={target}\nseams {result.length:.2f} √area")
        islands = "1 island" if result.islands == 1 else f"{result.islands} islands"
        pair[1].set_title(f"mean σ₁/σ₂ {result.shear:.2f}, SD {result.area_ratio_std:.4f}\n{islands}")
figure.colorbar(shown, ax=panels, label="σ₁/σ₂", shrink=0.5)
plt.show()
