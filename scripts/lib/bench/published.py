# SPDX-License-Identifier: MIT OR Apache-2.0
"""The published figures of the models in the data folder, by the papers' tables.

Disks: S.-Y. Liu, M.-H. Yueh, Preconditioned nonlinear conjugate gradient method of stretch energy
minimization for area-preserving parameterizations (2023); seconds on a MacBook Pro M1, in MATLAB.
Spheres: M. Sutti, M.-H. Yueh, Riemannian gradient descent for spherical area-preserving mappings (2024);
seconds on an Intel Core i7-6600, in MATLAB.
"""

from typing import NamedTuple, Optional


class Figures(NamedTuple):
    """A row of a published table; None where there is no such column or row."""

    deviation: Optional[float] = None
    """Disks: the SD of the area ratios (their means are 1.00). Spheres: SD/mean."""
    energy: Optional[float] = None
    """The authalic energy E_A."""
    seconds: Optional[float] = None
    folds: Optional[int] = None
    iterations: Optional[int] = None
    folds_corrected: Optional[int] = None
    error: Optional[float] = None
    """err-E_A, equation 6.6."""


NONE = Figures()

MODELS = {
    "chineselion_17334": "Chinese Lion",
    "hand_53054": "Left Hand (theirs: 53,011 vertices)",
    "david_10671": "David Head",
    "bulldog_49797": "Bulldog",
}
"""The papers' names of the models."""

DISKS = {
    ("chineselion_17334", "fixed_point"): Figures(0.0195, 1.15e-3, 1.83, 0),
    ("chineselion_17334", "conjugate_gradient"): Figures(0.0124, 4.29e-4, 1.43, 0),
    ("hand_53054", "fixed_point"): Figures(0.0493, 7.68e-3, 6.46, 0),
    ("hand_53054", "conjugate_gradient"): Figures(0.0309, 2.88e-3, 3.85, 0),
}
"""Disks, Table 1: 50 iterations."""

LINE_SEARCHES = {
    ("david_10671", "bounded", 10): Figures(0.0178, 4.04e-3, 1.66, 0),
    ("david_10671", "bounded", 100): Figures(0.0156, 3.05e-3, 14.95, 0),
    ("david_10671", "interpolation", 10): Figures(0.0178, 4.04e-3, 0.99, 0),
    ("david_10671", "interpolation", 100): Figures(0.0156, 3.04e-3, 9.16, 0),
    ("david_10671", "interpolation", 10_000): Figures(0.0029, 1.01e-4, 1018.87, 0),
    ("bulldog_49797", "bounded", 10): Figures(0.0369, 1.41e-2, 13.59, 0),
    ("bulldog_49797", "bounded", 100): Figures(0.0343, 1.27e-2, 136.63, 0),
    ("bulldog_49797", "interpolation", 10): Figures(0.0369, 1.41e-2, 6.60, 0),
    ("bulldog_49797", "interpolation", 100): Figures(0.0343, 1.27e-2, 61.93, 0),
}
"""Spheres, Tables 1 (fminbnd), 2 (quadratic/cubic interpolation) and 3 (10,000 iterations)."""

FIXED_POINT = {
    ("david_10671", "energy rises"): Figures(0.0191, 4.66e-3, 0.35, 0, 8),
    ("david_10671", "100 iterations"): Figures(0.0169, 3.58e-3, 4.30, 0, 100),
    ("bulldog_49797", "energy rises"): Figures(0.0381, 1.49e-2, 2.61, 0, 10),
    ("bulldog_49797", "100 iterations"): Figures(0.1833, 3.99e-1, 22.22, 53, 100),
}
"""Spheres, Table 5."""

NOISE = {
    ("david_10671", 1e-3): Figures(0.0108, 1.44e-3, 9.98, 0, None, 0, 4.47e-3),
    ("david_10671", 5e-3): Figures(0.0211, 5.51e-3, 9.43, 0, None, 0, 6.84e-3),
    ("bulldog_49797", 1e-3): Figures(0.0273, 6.94e-3, 59.26, 0, None, 0, 7.19e-6),
    ("bulldog_49797", 5e-3): Figures(0.0629, 3.86e-2, 61.75, 2, None, 0, 3.23e-5),
}
"""Spheres, Tables 7 and 8: 100 iterations, interpolation, on the mesh with noise."""

SMALLEST_EIGENVALUES = {
    ("david_10671", "fixed point"): -1.8481,
    ("david_10671", 10_000): -2.8445e-6,
}
"""Spheres, Table 4: after the fixed-point iteration, and after 10,000 iterations of gradient descent."""
