# SPDX-License-Identifier: MIT OR Apache-2.0
"""Area-preserving (authalic) maps of triangle meshes.

>>> import authalic
>>> pyramid = [[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
>>> faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]
>>> authalic.disk_map(pyramid, faces).uv.shape
(5, 2)
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._files import load
    from ._native import (
        ERROR_KINDS,
        WARNING_KINDS,
        Certificates,
        DiskMap,
        Distortion,
        HyperbolicStructure,
        Layout,
        MeshError,
        Packing,
        Pants,
        Patch,
        Refinement,
        Registration,
        Repaired,
        Result,
        Seams,
        SolverError,
        SphereMap,
        Strain,
        Surface,
        Untangled,
        Unwrap,
        __version__,
        cut,
        disk_map,
        disk_maps,
        distortion,
        distortions,
        homotopy,
        hyperbolic_structure,
        pack,
        register_disks,
        register_hyperbolic,
        register_spheres,
        repair,
        seams,
        set_threads,
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
    "Packing",
    "Pants",
    "Patch",
    "Refinement",
    "Registration",
    "RegistrationWarning",
    "Repaired",
    "Result",
    "Seams",
    "SolverError",
    "SphereMap",
    "Strain",
    "Surface",
    "Untangled",
    "Unwrap",
    "__version__",
    "cut",
    "disk_map",
    "disk_maps",
    "distortion",
    "distortions",
    "homotopy",
    "hyperbolic_structure",
    "load",
    "pack",
    "register_disks",
    "register_hyperbolic",
    "register_spheres",
    "repair",
    "seams",
    "set_threads",
    "sphere_map",
    "stretch_hessian",
    "untangle",
    "unwrap",
]


def __getattr__(name: str) -> Any:
    """Imports the library on first use, so that the command can set up its process before numpy is loaded."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import _files, _native, _warnings

    found = vars(_native) | {"load": _files.load, "RegistrationWarning": _warnings.RegistrationWarning}
    globals().update({public: found[public] for public in __all__})
    return globals()[name]


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
