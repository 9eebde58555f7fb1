# SPDX-License-Identifier: MIT OR Apache-2.0
"""JSON that every reader takes: it has no infinity, as σ₁/σ₂ of a folded face is."""

import json
import math
from typing import Any


def dumps(data: Any, indent: int | None = None) -> str:
    """Data as JSON, with null for numbers that are not finite."""
    return json.dumps(_finite(data), indent=indent, allow_nan=False)


def _finite(data: Any) -> Any:
    if isinstance(data, float):
        return data if math.isfinite(data) else None
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [_finite(value) for value in data]
    return data
