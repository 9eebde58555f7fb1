# SPDX-License-Identifier: GPL-3.0-or-later
"""Types of arrays and of paths. Shapes of arrays stand in the docstrings of functions."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Reals = NDArray[np.floating[Any]]
"""In double or in single precision."""
Integers = NDArray[np.integer[Any]]
Booleans = NDArray[np.bool_]

Edge = tuple[int, int]
"""Two vertices."""
Path = tuple[int, ...]
"""Vertices along edges, from start to end; those of a loop end with the first one again."""
