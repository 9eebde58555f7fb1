# SPDX-License-Identifier: MIT OR Apache-2.0
"""
How the energy falls
====================

The authalic energy is a sum of squares whose least value is 0, or nearly so. The papers' methods come near
it; the Gauss–Newton descent, which is the default, reaches it in a few steps.
"""

import matplotlib.pyplot as plt
import numpy as np
from pictures import hills

import authalic

surface = authalic.Surface(*hills(8000))
methods = {
    "fixed point (Liu & Yueh)": {"method": "fixed_point", "max_iterations": 40},
    "conjugate gradients (Liu & Yueh)": {"method": "conjugate_gradient", "max_iterations": 40},
    "Gauss–Newton (the default)": {"method": "gauss_newton"},
}

# %%
# Every result keeps its history: one record per iteration.

figure, panel = plt.subplots(figsize=(7, 4), layout="constrained")
for name, options in methods.items():
    result = authalic.disk_map(surface, **options)
    energy = result.history["authalic_energy"]
    panel.semilogy(np.arange(len(energy)), energy, marker=".", label=name)
    print(f"{name}: {energy[-1]:.1e} after {len(energy) - 1} iterations")
panel.set(xlabel="iteration", ylabel="authalic energy")
panel.legend()
plt.show()
