# SPDX-License-Identifier: MIT OR Apache-2.0
"""
Areas and angles
================

One piece of ground, mapped onto the disk twice. A map that keeps angles shrinks the hills: on their tops,
faces get a small fraction of the area that is theirs. A map that keeps areas gives every face its share,
and shears some of them in return. The colors show log₂ of the area ratio: white is right, blue is too
small, red too large.
"""

import matplotlib.pyplot as plt
from pictures import draw_map, draw_surface, hills

import authalic

surface = vertices, faces = hills()
angles = authalic.disk_map(*surface, angle_weight=100)
areas = authalic.disk_map(*surface)

# %%
# Both maps are certified: no face of either is folded over.

for name, result in (("angles", angles), ("areas", areas)):
    figures = result.distortion
    print(
        f"{name}: SD of the area ratio {figures.area_ratio_std:.4f}, "
        f"mean σ₁/σ₂ {figures.angle_distortion_mean:.2f}, {len(figures.folded)} folds"
    )

# %%
figure, panels = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
draw_surface(panels[0], vertices, faces)
for panel, name, result in ((panels[1], "angles kept", angles), (panels[2], "areas kept", areas)):
    shown = draw_map(panel, result.uv, faces, result.distortion.log2_area_ratio, limits=(-2, 2))
    panel.set_title(name)
figure.colorbar(shown, ax=panels, label="log₂ of the area ratio", shrink=0.7)
plt.show()
