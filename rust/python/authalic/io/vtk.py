# SPDX-License-Identifier: MIT OR Apache-2.0
"""Legacy VTK: POLYDATA, which meshio does not read, and unstructured grids by meshio."""

import re
from itertools import pairwise
from math import prod
from pathlib import Path

import numpy as np

from . import meshio_formats
from .mesh import MeshData, Reals, fans
from .words import check_count, quoted, reals, whole

_TYPES = {
    **{"float": ">f4", "double": ">f8", "int": ">i4", "long": ">i8"},
    **{"vtktypeint32": ">i4", "vtktypeint64": ">i8", "unsigned_int": ">u4"},
}
"""Big-endian, as all binary legacy files."""

_DATASET = re.compile(rb"(?im)^\s*DATASET\s+(\S+)")
_GRIDS = {b"STRUCTURED_POINTS", b"STRUCTURED_GRID", b"RECTILINEAR_GRID"}
_SIZES = re.compile(rb"(?im)^\s*DIMENSIONS\s+([-+\d_]+)\s+([-+\d_]+)\s+([-+\d_]+)(?!\S)")
_MOST_POINTS = 1_000_000
"""Of a grid that states how many points it has and does not list them, unless the file has as many bytes."""

write_mesh = meshio_formats.write_mesh


def read_mesh(path: Path, name: str) -> MeshData:
    content = path.read_bytes()
    body = b"".join(content.split(b"\n", 3)[3:])  # below the version, the title and the coding
    kinds = [kind.upper() for kind in _DATASET.findall(body)]
    if kinds[:1] == [b"POLYDATA"]:
        return _Polydata(content).mesh()
    if _GRIDS & set(kinds):
        _check_grids(body)
    return meshio_formats.read_mesh(path, name)


def _check_grids(body: bytes) -> None:
    """Refuses grids of more points than any that meshio could list."""
    for found in _SIZES.finditer(body):
        sizes = [whole(size.decode("ascii"), "a size of a grid") for size in found.groups()]
        check_count(prod(map(abs, sizes)), "points of a grid", max(_MOST_POINTS, len(body)))


class _Polydata:
    """A reader of POLYDATA, ASCII or binary, of versions 2 to 5.1."""

    def __init__(self, content: bytes) -> None:
        head = content.split(b"\n", 3)[:3]
        if len(head) < 3 or not head[0].startswith(b"# vtk DataFile"):
            raise ValueError("it does not begin with: # vtk DataFile, a title and ASCII or BINARY")
        version, title, coding = head
        self.content, self.place = content, len(version) + len(title) + len(coding) + 3
        self.is_binary = coding.strip().upper() == b"BINARY"

    def mesh(self) -> MeshData:
        """Points and polygons; sections between them (vertices, lines) are passed over."""
        points = np.empty((0, 3))
        while self.place < len(self.content):
            words = self._line().split()
            if words[:1] == ["POINTS"]:
                [count], kind = self._counts(words, 1), words[2]
                points = self._numbers(3 * count, kind, "coordinates").reshape(-1, 3)
            elif words[:1] == ["POLYGONS"]:
                return MeshData(points, fans(self._cells(*self._counts(words, 2))))
            elif words[:1] in (["VERTICES"], ["LINES"]):
                self._cells(*self._counts(words, 2))
        raise ValueError("it has no POLYGONS")

    def _counts(self, words: list[str], count: int) -> list[int]:
        """The numbers behind the keyword of a section."""
        if len(words) < 3:
            raise ValueError(f"it has the line {quoted(' '.join(words))}, which is cut short")
        return [whole(word, f"a number of {quoted(words[0])}") for word in words[1 : 1 + count]]

    def _cells(self, first: int, second: int) -> list[list[int]]:
        """Version 5.1 has offsets and connectivity; older ones each cell's corners after their number."""
        start = self.place
        words = self._line().split()
        if words[:1] == ["OFFSETS"]:
            offsets = self._whole_numbers(first, words[-1], "offsets")
            corners = self._whole_numbers(second, self._line().split()[-1], "corners")
            if any(a > b for a, b in pairwise([0, *offsets, len(corners)])):
                raise ValueError(f"its offsets do not rise from 0 to the {len(corners)} corners")
            return [corners[a:b] for a, b in pairwise(offsets)]
        self.place = start
        flat = self._whole_numbers(second, "int", "numbers of cells")
        check_count(first, "cells", len(flat))
        cells, place = [], 0
        for number in range(1, first + 1):
            if place >= len(flat):
                raise ValueError(f"its numbers end before cell {number} of {first}")
            check_count(flat[place], f"corners of cell {number}", len(flat) - place - 1)
            cells.append(flat[place + 1 : place + 1 + flat[place]])
            place += 1 + flat[place]
        return cells

    def _whole_numbers(self, count: int, kind: str, what: str) -> list[int]:
        numbers = self._numbers(count, kind, what)
        odd = numbers[~(np.abs(numbers) < 2.0**53) | (numbers % 1 != 0)]
        if len(odd):
            raise ValueError(f"{what}: there is {odd[0]}, which is no whole number")
        listed: list[int] = numbers.astype(int).tolist()
        return listed

    def _numbers(self, count: int, kind: str, what: str) -> Reals:
        if self.is_binary and kind.lower() not in _TYPES:
            raise ValueError(f"{what} have the type {quoted(kind)}, which is not known")
        size = np.dtype(_TYPES[kind.lower()]).itemsize if self.is_binary else 1
        check_count(count, what, max(0, len(self.content) - self.place) // size)
        numbers = self._binary(count, kind) if self.is_binary else self._text(count)
        if len(numbers) < count:
            raise ValueError(f"the file ends after {len(numbers)} of {count} {what}")
        return numbers

    def _binary(self, count: int, kind: str) -> Reals:
        dtype = np.dtype(_TYPES[kind.lower()])
        part = self.content[self.place : self.place + count * dtype.itemsize]
        self.place += len(part)
        return np.frombuffer(part[: len(part) // dtype.itemsize * dtype.itemsize], dtype).astype(np.float64)

    def _text(self, count: int) -> Reals:
        words: list[str] = []
        while len(words) < count and self.place < len(self.content):
            words += self._line().split()
        return reals(words)

    def _line(self) -> str:
        """The next line that is not empty, or what is left."""
        while True:
            end = self.content.find(b"\n", self.place)
            end = len(self.content) if end < 0 else end
            line, self.place = self.content[self.place : end], end + 1
            if line.strip() or self.place >= len(self.content):
                return line.decode("ascii", "replace")
