# SPDX-License-Identifier: MIT OR Apache-2.0
"""What a result was computed from, as plain data."""

import copy
import hashlib
import platform
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import _native

_MOST_NUMBERS = 16
"""Longer arrays stand as their fingerprints."""


def plain(options: Mapping[str, object]) -> dict[str, Any]:
    """Options as text, numbers, lists and dictionaries; callbacks are left out."""
    return {name: _kept(value) for name, value in options.items() if not callable(value)}


def described(
    function: str, options: Mapping[str, Any], inputs: Mapping[str, tuple[str, int, int]]
) -> dict[str, Any]:
    """The attribute `provenance` of a result of this process."""
    surfaces = {
        name: {"sha256": digest, "vertices": vertices, "faces": faces}
        for name, (digest, vertices, faces) in inputs.items()
    }
    return {
        "function": function,
        "options": copied(options),
        "inputs": surfaces,
        "authalic": _native.__version__,
        "numpy": np.__version__,
        "python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
    }


def copied(provenance: Mapping[str, Any]) -> dict[str, Any]:
    return copy.deepcopy(dict(provenance))


def _kept(value: object) -> Any:
    try:
        return _plain(value)
    except RecursionError:  # lists in lists without end, which the function itself refuses
        return type(value).__name__


def _plain(value: object) -> Any:
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, np.ndarray):
        return _array(value)
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    # the elements of a memoryview with several axes cannot be taken one by one
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray, memoryview)):
        return _sequence(value)
    try:
        return _array(np.asarray(value))
    except (TypeError, ValueError):
        return repr(value)


def _sequence(values: Sequence[object]) -> Any:
    """Short ones as they are, long ones of numbers as an array."""
    if len(values) <= _MOST_NUMBERS:
        return [_plain(value) for value in values]
    try:
        return _array(np.asarray(values))
    except ValueError:  # of different lengths
        return [_plain(value) for value in values]


def _array(array: np.ndarray[Any, Any]) -> Any:
    if array.dtype.kind not in "biufc":
        return repr(array)
    if array.size <= _MOST_NUMBERS and array.dtype.kind != "c":
        return array.tolist()
    digest = hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()
    return {"shape": list(array.shape), "dtype": array.dtype.name, "sha256": digest}
