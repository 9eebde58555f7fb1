# SPDX-License-Identifier: MIT OR Apache-2.0
"""What every tool hands back: the UVs of the corners of the triangles, in the unit square."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Layout:
    """An unwrapped mesh, whichever tool unwrapped it."""

    corners: np.ndarray
    """The UVs of the corners of the faces, (m, 3, 2)."""
    seconds: float
    remark: str = ""


@dataclass(frozen=True)
class Failure:
    """Why a tool has no layout."""

    remark: str
