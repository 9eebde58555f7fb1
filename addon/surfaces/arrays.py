# SPDX-License-Identifier: GPL-3.0-or-later
"""The types of arrays. Shapes stand in the docstrings of those who take or give them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Reals = NDArray[np.floating[Any]]
"""In double or in single precision."""
Integers = NDArray[np.integer[Any]]
Booleans = NDArray[np.bool_]
