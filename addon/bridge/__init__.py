# SPDX-License-Identifier: GPL-3.0-or-later
"""The only folder that imports the native library: functions on numpy arrays and plain data, no bpy."""

from authalic import set_threads

from ..registration.piece import UnjoinedSide
from ..surfaces.suitability import Unsuitable
from .figures import measure
from .flips import fix_flips
from .islands import unwrap
from .known import forget
from .placement import Placed, place
from .registrations import (
    MirroredCurves,
    Preview,
    followed,
    kept,
    local_similarities,
    morphed,
    pull,
    register,
    strain,
)
from .results import Figures, FoundSeams, Island, Mapping, Measurement, Refusal, SphereShape, Unflipped
from .seams import find_seams
from .settings import PlacementSettings, SeamSettings, UnwrapSettings
from .shortfall import Shortfall
from .solver import Solver
from .spheres import sphere_shape

__all__ = (
    "Figures",
    "FoundSeams",
    "Island",
    "Mapping",
    "Measurement",
    "MirroredCurves",
    "Placed",
    "PlacementSettings",
    "Preview",
    "Refusal",
    "SeamSettings",
    "Shortfall",
    "Solver",
    "SphereShape",
    "Unflipped",
    "UnjoinedSide",
    "Unsuitable",
    "UnwrapSettings",
    "find_seams",
    "fix_flips",
    "followed",
    "forget",
    "kept",
    "local_similarities",
    "measure",
    "morphed",
    "place",
    "pull",
    "register",
    "set_threads",
    "sphere_shape",
    "strain",
    "unwrap",
)
