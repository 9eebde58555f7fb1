# SPDX-License-Identifier: MIT OR Apache-2.0
"""Results as objects: taken apart into their attributes, made again, compared."""

from collections.abc import Callable
from typing import Any

import numpy as np

from . import _native

_TIMES = {"seconds"}
"""Attributes and fields of what differs from run to run: the same result takes another time."""

State = dict[str, Any]


def state(result: object) -> State:
    """The attributes that make a result."""
    return {name: getattr(result, name) for name in _native._fields(type(result).__name__)}


def restored(kind: str, attributes: State, provenance: dict[str, Any] | None) -> Any:
    """The result of such attributes; pickles name this function."""
    return _native._restored(kind, _frozen(attributes), provenance)


def reduced(result: _native.Result) -> tuple[Callable[..., Any], tuple[str, State, dict[str, Any] | None]]:
    """What pickle keeps of a result."""
    return restored, (type(result).__name__, state(result), result.provenance)


def equal(one: object, other: object) -> bool:
    """Whether two results, or attributes of results, are the same up to the time that they took."""
    if type(one) is not type(other):
        return False
    if isinstance(one, _native.Result):
        return one is other or equal(state(one), state(other))
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return _equal_arrays(one, other)
    if isinstance(one, dict) and isinstance(other, dict):
        names = one.keys() - _TIMES
        return names == other.keys() - _TIMES and all(equal(one[name], other[name]) for name in names)
    if isinstance(one, (list, tuple)) and isinstance(other, (list, tuple)):
        return len(one) == len(other) and all(map(equal, one, other))
    if isinstance(one, float) and one != one:
        return other != other
    return one == other


def hashed(result: object) -> int:
    """The same for equal results: of the words, counts and shapes."""
    return hash((type(result).__name__, _sketch(state(result))))


def _equal_arrays(one: np.ndarray[Any, Any], other: np.ndarray[Any, Any]) -> bool:
    if one.shape != other.shape or one.dtype != other.dtype:
        return False
    if one.dtype.names:
        return all(np.array_equal(one[name], other[name]) for name in set(one.dtype.names) - _TIMES)
    return np.array_equal(one, other, equal_nan=one.dtype.kind in "fc")


def _sketch(value: object) -> Any:
    if isinstance(value, np.ndarray):
        return value.shape
    if isinstance(value, dict):
        return tuple((name, _sketch(entry)) for name, entry in sorted(value.items()) if name not in _TIMES)
    if isinstance(value, (list, tuple)):
        return tuple(map(_sketch, value))
    return value if isinstance(value, (str, int)) else None


def _frozen(value: Any) -> Any:
    """The same with arrays that cannot be written to."""
    if isinstance(value, np.ndarray):
        value.setflags(write=False)
    elif isinstance(value, dict):
        return {name: _frozen(entry) for name, entry in value.items()}
    elif isinstance(value, (list, tuple)):
        return type(value)(map(_frozen, value))
    return value
