# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of the library that are kept, so that a change of what comes after them computes nothing again.

A result is known by its mesh and options. One that also depends on what was computed before it, as where it
began with an earlier map or was asked to end, is kept apart: only who goes on from the last results gets it.
"""

import hashlib
from collections import OrderedDict
from collections.abc import Callable, Mapping
from threading import Lock
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

import authalic

from ..surfaces.arrays import Floats, Integers
from .progress import Progress

# The faces of all results that are kept: some hundred megabytes.
_MOST_FACES = 2_000_000
# A mesh of fewer faces is computed sooner than it is looked up.
_FEWEST_FACES = 64

Result = TypeVar("Result")
Key = tuple[bytes, str, bool]
"""The digest of a mesh, a call with its options, and whether the result depends on earlier ones."""


class _Results:
    """The results, the latest last, and the last disk map of each mesh."""

    def __init__(self) -> None:
        self._by_key: OrderedDict[Key, tuple[int, Any]] = OrderedDict()
        self._maps: dict[bytes, authalic.DiskMap] = {}
        self._faces = 0
        self._lock = Lock()

    def get(self, key: Key) -> Any:
        with self._lock:
            if key not in self._by_key:
                return None
            self._by_key.move_to_end(key)
            value = self._by_key[key][1]
            self._note(key, value)
            return value

    def keep(self, key: Key, faces: int, value: object) -> None:
        with self._lock:
            self._faces += faces - self._by_key.pop(key, (0, None))[0]
            self._by_key[key] = faces, value
            self._note(key, value)
            while len(self._by_key) > 1 and self._faces > _MOST_FACES:
                (mesh, *_), (size, _) = self._by_key.popitem(last=False)
                self._maps.pop(mesh, None)
                self._faces -= size

    def last_map(self, mesh: bytes) -> authalic.DiskMap | None:
        return self._maps.get(mesh)

    def clear(self) -> None:
        with self._lock:
            self._by_key.clear()
            self._maps.clear()
            self._faces = 0

    def _note(self, key: Key, value: object) -> None:
        if isinstance(value, authalic.DiskMap):
            self._maps[key[0]] = value


_results = _Results()


class Request:
    """A call for a surface with its options, and with `from_last` whether earlier results may count."""

    def __init__(
        self,
        call: Callable[..., Any],
        surface: authalic.Surface | authalic.SphereMap,
        options: Mapping[str, Any],
        from_last: bool = False,
    ) -> None:
        self._faces, self._from_last = len(surface.faces), from_last
        self._mesh, self._name = b"", ""
        if self._faces >= _FEWEST_FACES:
            self._mesh, self._name = _digest(*_arrays(surface)), _name(call, options)
        self._is_free = options.get("boundary") == "free"

    def known(self) -> Any:
        """The result, if it is known."""
        if not self._mesh:
            return None
        for depends in (True, False) if self._from_last else (False,):
            value = _results.get((self._mesh, self._name, depends))
            if value is not None:
                return value
        return None

    def initial(self) -> NDArray[np.float64] | None:
        """The last map of the surface, whatever its options, if it is one to begin with."""
        last = _results.last_map(self._mesh) if self._from_last and self._is_free else None
        return None if last is None else last.uv

    def keep(self, value: Any, *, began_with_last: bool = False) -> None:
        """Keeps a result, unless its mesh has few faces."""
        if not self._mesh:
            return
        depends = began_with_last or getattr(value, "status", None) == "cancelled"
        _results.keep((self._mesh, self._name, depends), self._faces, value)


def result(
    call: Callable[..., Result],
    surface: authalic.Surface | authalic.SphereMap,
    options: Mapping[str, Any],
    progress: Progress,
) -> Result:
    """`call(surface, **options)`, or what it returned for the same surface and options before."""
    request = Request(call, surface, options)
    value: Result | None = request.known()
    if value is None:
        value = call(surface, progress=progress, **options)
        request.keep(value)
    return value


def packing(
    uv: Floats, faces: Integers, island_of: Integers, options: Mapping[str, Any], progress: Progress
) -> authalic.Packing:
    """`authalic.pack(uv, faces, island_of, **options)`, or what it returned for the same before."""
    key = _digest(uv, faces, island_of), _name(authalic.pack, options), False
    value: authalic.Packing | None = _results.get(key)
    if value is None:
        value = authalic.pack(uv, faces, island_of, progress=progress, **options)
        _results.keep(key, len(faces), value)
    return value


def forget() -> None:
    """Keeps nothing of what was computed so far."""
    _results.clear()


def _arrays(surface: authalic.Surface | authalic.SphereMap) -> tuple[NDArray[Any], ...]:
    """What a surface is known by, or a map of one: the map by its areas as well."""
    if isinstance(surface, authalic.SphereMap):
        return surface.positions, surface.faces, surface.distortion.log2_area_ratio
    return surface.vertices, surface.faces


def _name(call: Callable[..., Any], options: Mapping[str, Any]) -> str:
    """A call with its options in words; arrays by their digests."""
    words = [
        f"{name}={_digest(value).hex() if isinstance(value, np.ndarray) else repr(value)}"
        for name, value in sorted(options.items())
    ]
    return ",".join([call.__name__, *words])


def _digest(*arrays: NDArray[Any]) -> bytes:
    digest = hashlib.blake2b(digest_size=16)
    for array in arrays:
        digest.update(np.ascontiguousarray(array).data)
    return digest.digest()
