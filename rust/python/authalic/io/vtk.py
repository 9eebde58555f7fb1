# SPDX-License-Identifier: MIT OR Apache-2.0
"""Legacy VTK: POLYDATA, which meshio does not read, and unstructured grids by meshio."""

from itertools import pairwise
from pathlib import Path

import numpy as np

from . import meshio_formats
from .mesh import MeshData, Reals, fans

_TYPES = {
    **{"float": ">f4", "double": ">f8", "int": ">i4", "long": ">i8"},
    **{"vtktypeint32": ">i4", "vtktypeint64": ">i8", "unsigned_int": ">u4"},
}
"""Big-endian, as all binary legacy files."""

write_mesh = meshio_formats.write_mesh


def read_mesh(path: Path, name: str) -> MeshData:
    head = path.read_bytes()[:1000].upper()
    if b"POLYDATA" in head:
        return _Polydata(path.read_bytes()).mesh()
    return meshio_formats.read_mesh(path, name)


class _Polydata:
    """A reader of POLYDATA, ASCII or binary, of versions 2 to 5.1."""

    def __init__(self, content: bytes) -> None:
        version, title, coding, *_ = content.split(b"\n", 3)
        if not version.startswith(b"# vtk DataFile"):
            raise ValueError("it does not begin with: # vtk DataFile")
        self.content, self.place = content, len(version) + len(title) + len(coding) + 3
        self.is_binary = coding.strip().upper() == b"BINARY"

    def mesh(self) -> MeshData:
        """Points and polygons; sections between them (vertices, lines) are passed over."""
        points = np.empty((0, 3))
        while self.place < len(self.content):
            words = self._line().split()
            if words[:1] == ["POINTS"]:
                points = self._numbers(3 * int(words[1]), words[2]).reshape(-1, 3)
            elif words[:1] == ["POLYGONS"]:
                return MeshData(points, fans(self._cells(int(words[1]), int(words[2]))))
            elif words[:1] in (["VERTICES"], ["LINES"]):
                self._cells(int(words[1]), int(words[2]))
        raise ValueError("it has no POLYGONS")

    def _cells(self, first: int, second: int) -> list[list[int]]:
        """Version 5.1 has offsets and connectivity; older ones each cell's corners after their number."""
        start = self.place
        words = self._line().split()
        if words[:1] == ["OFFSETS"]:
            offsets = self._numbers(first, words[1]).astype(int)
            kind = self._line().split()[1]
            corners = self._numbers(second, kind).astype(int)
            return [corners[a:b].tolist() for a, b in pairwise(offsets.tolist())]
        self.place = start
        flat = self._numbers(second, "int").astype(int).tolist()
        cells, place = [], 0
        for _ in range(first):
            cells.append(flat[place + 1 : place + 1 + flat[place]])
            place += 1 + flat[place]
        return cells

    def _numbers(self, count: int, kind: str) -> Reals:
        numbers = self._binary(count, kind) if self.is_binary else self._text(count)
        if len(numbers) < count:
            raise ValueError(f"the file ends after {len(numbers)} of {count} numbers")
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
        return np.array(words, np.float64)

    def _line(self) -> str:
        """The next line that is not empty, or what is left."""
        while True:
            end = self.content.find(b"\n", self.place)
            end = len(self.content) if end < 0 else end
            line, self.place = self.content[self.place : end], end + 1
            if line.strip() or self.place >= len(self.content):
                return line.decode("ascii", "replace")
