# SPDX-License-Identifier: MIT OR Apache-2.0
"""Options that would be wrong for every subject."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from .._native import MeshError, SolverError, disk_map, sphere_map, unwrap
from .task import RUNS

_CORNERS = np.vstack([np.eye(3), [-1, 0, 0]])
_FACES = np.array([[0, 1, 2], [1, 0, 3], [2, 1, 3], [0, 2, 3]])
"""A tetrahedron."""


def check_options(command: str, options: Mapping[str, Any]) -> None:
    """Maps a surface of a few faces: what is refused there before any work is refused for every subject."""
    if command not in RUNS:
        raise ValueError(f"command must be one of {sorted(RUNS)}, but is {command}")
    try:
        match command:
            case "sphere":
                sphere_map(_CORNERS, _FACES, **options)
            case "disk":
                disk_map(_CORNERS, _FACES[1:], **options)
            case "unwrap":
                unwrap((_CORNERS, _FACES), **options)
    except (MeshError, SolverError):
        return  # this surface is not what counts
    except ValueError as error:
        if getattr(error, "kind", None) == "invalid_option":
            raise
