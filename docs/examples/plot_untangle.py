# SPDX-License-Identifier: MIT OR Apache-2.0
"""
Folds taken out
===============

``untangle`` mends a map that another tool made, or a hand moved: only vertices near folded faces move, the
outline and all vertices given as ``fixed`` stay bit for bit.
"""

import matplotlib.pyplot as plt
import numpy as np
from pictures import draw_map, hills

import authalic

surface = authalic.Surface(*hills(900))
uv = authalic.disk_map(surface).uv.copy()
near = np.linalg.norm(uv - [0.2, 0.1], axis=1) < 0.25
uv[near] += np.random.default_rng(1).normal(0, 0.1, (near.sum(), 2))

result = authalic.untangle(surface, uv)
print(len(result.folded_before), "folded faces;", len(result.moved), "of", len(uv), "vertices moved")

# %%
figure, panels = plt.subplots(1, 2, figsize=(9, 4.4), layout="constrained")
is_folded = np.isin(np.arange(len(surface.faces)), result.folded_before)
colors = np.where(is_folded[:, None], [0.84, 0.2, 0.2], [0.93, 0.93, 0.9])
for panel, image, name in ((panels[0], uv, "before"), (panels[1], result.image, "after")):
    draw_map(panel, image, surface.faces, colors)
    panel.set(title=name, xlim=(-0.2, 0.6), ylim=(-0.3, 0.5))
plt.show()
