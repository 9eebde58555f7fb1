# SPDX-License-Identifier: MIT OR Apache-2.0
"""Area-preserving (authalic) maps of triangle meshes.

>>> import authalic
>>> pyramid = [[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
>>> faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]
>>> authalic.disk_map(pyramid, faces).uv.shape
(5, 2)
"""

from ._native import (
    ERROR_KINDS,
    WARNING_KINDS,
    Certificates,
    DiskMap,
    Distortion,
    HyperbolicStructure,
    Layout,
    MeshError,
    Pants,
    Patch,
    Refinement,
    Registration,
    Seams,
    SolverError,
    SphereMap,
    Surface,
    Untangled,
    Unwrap,
    __version__,
    cut,
    disk_map,
    distortion,
    homotopy,
    hyperbolic_structure,
    register_disks,
    register_hyperbolic,
    register_spheres,
    seams,
    sphere_map,
    stretch_hessian,
    untangle,
    unwrap,
)
from ._warnings import RegistrationWarning

__all__ = [
    "ERROR_KINDS",
    "WARNING_KINDS",
    "Certificates",
    "DiskMap",
    "Distortion",
    "HyperbolicStructure",
    "Layout",
    "MeshError",
    "Pants",
    "Patch",
    "Refinement",
    "Registration",
    "RegistrationWarning",
    "Seams",
    "SolverError",
    "SphereMap",
    "Surface",
    "Untangled",
    "Unwrap",
    "__version__",
    "cut",
    "disk_map",
    "distortion",
    "homotopy",
    "hyperbolic_structure",
    "register_disks",
    "register_hyperbolic",
    "register_spheres",
    "seams",
    "sphere_map",
    "stretch_hessian",
    "untangle",
    "unwrap",
]
