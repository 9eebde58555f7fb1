# SPDX-License-Identifier: GPL-3.0-or-later
"""The only folder that imports the native library: functions on numpy arrays and plain data, no bpy."""

from ..surfaces.suitability import Unsuitable
from .figures import folds, measure, measure_islands
from .flips import fix_flips
from .islands import unwrap
from .registrations import kept, morphed, pull, register
from .results import Figures, FoundSeams, Island, Mapping, Measurement, Refusal, SphereShape, Unflipped
from .seams import find_seams
from .settings import SeamSettings, UnwrapSettings
from .shortfall import Shortfall
from .solver import Solver
from .spheres import sphere_shape

__all__ = (
    "Figures",
    "FoundSeams",
    "Island",
    "Mapping",
    "Measurement",
    "Refusal",
    "SeamSettings",
    "Shortfall",
    "Solver",
    "SphereShape",
    "Unflipped",
    "Unsuitable",
    "UnwrapSettings",
    "find_seams",
    "fix_flips",
    "folds",
    "kept",
    "measure",
    "measure_islands",
    "morphed",
    "pull",
    "register",
    "sphere_shape",
    "unwrap",
)
