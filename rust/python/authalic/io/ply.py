# SPDX-License-Identifier: MIT OR Apache-2.0
"""PLY, in ASCII and binary, with UVs at vertices (s, t) or at corners (texcoord).

meshio misreads binary faces with further properties, and trimesh puts triangles before other polygons; so
this reader is our own.
"""

import struct
from itertools import accumulate, pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .mesh import Indices, MeshData, Reals, fans, uv_of_columns
from .words import check_count, quoted, reals, whole

_TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float32": "f4", "float64": "f8", "double": "f8"},
}
_LENGTHS = {name: kind for name, kind in _TYPES.items() if kind[0] in "iu"}
_STRUCT = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f4": "f", "f8": "d"}
_ORDERS = {"binary_little_endian": "<", "binary_big_endian": ">", "ascii": ""}
_CORNERS = ("vertex_indices", "vertex_index")


class _Property(NamedTuple):
    """A column; a list has the type of its length too."""

    name: str
    kind: str
    length: str | None


class _Element(NamedTuple):
    name: str
    rows: int
    properties: list[_Property]


def read_mesh(path: Path, name: str) -> MeshData:
    """Elements in the order of the file; those other than vertices and faces are passed over."""
    content = path.read_bytes()
    order, elements, place = _header(content)
    text = "" if order else content[place:].decode("ascii", "replace")
    source = _Binary(content, place, order) if order else _Text(text.split())
    tables = {element.name: (element, source.table(element)) for element in elements}
    vertex, face = _columns(tables.get("vertex"), False), _columns(tables.get("face"), True)
    corners = next((face[key] for key in _CORNERS if key in face), None)
    if corners is None or not {"x", "y", "z"} <= vertex.keys():
        raise ValueError("it lacks the coordinates x, y, z or the faces' vertex_indices")
    points = np.column_stack([vertex[key] for key in "xyz"]).astype(np.float64)
    faces = _triangles(corners)
    return MeshData(points, faces, *_uv(vertex, face.get("texcoord"), faces))


def write_mesh(path: Path, mesh: MeshData, name: str) -> None:
    """Little-endian, with double precision."""
    columns = [mesh.vertices] if mesh.uv is None else [mesh.vertices, mesh.uv]
    names = "xyz" if mesh.uv is None else "xyzst"
    lines = [
        "ply",
        "format binary_little_endian 1.0",
        "comment authalic",
        f"element vertex {len(mesh.vertices)}",
    ]
    lines += [f"property double {name}" for name in names]
    lines += [f"element face {len(mesh.faces)}", "property list uchar int vertex_indices", "end_header", ""]
    faces = np.empty(len(mesh.faces), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, mesh.faces
    path.write_bytes("\n".join(lines).encode() + np.hstack(columns).astype("<f8").tobytes() + faces.tobytes())


def _header(content: bytes) -> tuple[str, list[_Element], int]:
    """The byte order ("" for ASCII), the elements, and where the data begin."""
    end = content.find(b"end_header")
    if not content.startswith(b"ply") or end < 0:
        raise ValueError("it does not begin with a header from ply to end_header")
    order, elements = None, []
    for line in content[:end].decode("ascii", "replace").splitlines():
        words = line.split()
        try:
            if words[:1] == ["format"]:
                order = _ORDERS.get(words[1])
            elif words[:1] == ["element"]:
                rows = whole(words[2], f"the number of rows of {quoted(words[1])}")
                elements.append(_Element(words[1], rows, []))
            elif words[:2] == ["property", "list"]:
                elements[-1].properties.append(_Property(words[4], _TYPES[words[3]], _LENGTHS[words[2]]))
            elif words[:1] == ["property"]:
                elements[-1].properties.append(_Property(words[2], _TYPES[words[1]], None))
        except (IndexError, KeyError) as error:
            raise ValueError(f"its header has the line {quoted(line)}, which cannot be read") from error
    if order is None:
        raise ValueError("its header names no known format")
    return order, elements, content.index(b"\n", end) + 1


def _columns(table: tuple[_Element, dict[str, Any]] | None, lists: bool) -> dict[str, Any]:
    """The columns that are lists, or those that are none."""
    if table is None:
        return {}
    element, columns = table
    return {
        each.name: columns[each.name] for each in element.properties if (each.length is not None) == lists
    }


class _Text:
    """Reads the words of an ASCII file."""

    def __init__(self, words: list[str]) -> None:
        self.words, self.place = words, 0

    def table(self, element: _Element) -> dict[str, Any]:
        width = len(element.properties)
        if width == 0:
            return {}
        check_count(element.rows, f"rows of {quoted(element.name)}", (len(self.words) - self.place) // width)
        if not any(column.length for column in element.properties):
            rows = reals(self._take(element.rows * width)).reshape(-1, width)
            return {column.name: rows[:, k] for k, column in enumerate(element.properties)}
        table: dict[str, Any] = {column.name: [] for column in element.properties}
        for row in range(1, element.rows + 1):
            for column in element.properties:
                count = (
                    self._length(f"numbers in row {row} of {quoted(element.name)}") if column.length else 1
                )
                numbers = self._take(count)
                table[column.name].append(numbers if column.length else numbers[0])
        return {column.name: _numbers(table[column.name], column) for column in element.properties}

    def _length(self, what: str) -> int:
        [word] = self._take(1)
        count = whole(word, f"the number of {what}")
        check_count(count, what, len(self.words) - self.place)
        return count

    def _take(self, count: int) -> list[str]:
        words = self.words[self.place : self.place + count]
        if len(words) < count:
            raise ValueError("the file ends early")
        self.place += count
        return words


def _numbers(values: list[Any], column: _Property) -> Any:
    """Words as numbers, in lists as they are."""
    if not column.length:
        return reals(values)
    flat = reals([word for row in values for word in row]).tolist()
    ends = list(accumulate(map(len, values), initial=0))
    return [flat[start:end] for start, end in pairwise(ends)]


class _Binary:
    """Reads rows of a binary file: all at once where lists have one length, else one after the other."""

    def __init__(self, content: bytes, place: int, order: str) -> None:
        self.content, self.place, self.order = content, place, order

    def table(self, element: _Element) -> dict[str, Any]:
        least = sum(np.dtype(column.length or column.kind).itemsize for column in element.properties)
        if least == 0:
            return {}
        room = (len(self.content) - self.place) // least
        check_count(element.rows, f"rows of {quoted(element.name)}", room)
        if element.rows == 0:
            return {column.name: [] for column in element.properties}
        start = self.place
        lengths = [len(value) if column.length else 0 for column, value in self._row(element, 1)]
        self.place = start
        fields: list[Any] = []
        for column, length in zip(element.properties, lengths, strict=True):
            fields += [(f"count of {column.name}", self.order + column.length)] if column.length else []
            shape = (length,) if column.length else ()
            fields.append((column.name, self.order + column.kind, shape))
        dtype = np.dtype(fields)
        if start + element.rows * dtype.itemsize <= len(self.content):
            rows = np.frombuffer(self.content, dtype, element.rows, start)
            counted = zip(element.properties, lengths, strict=True)
            if all((rows[f"count of {column.name}"] == n).all() for column, n in counted if column.length):
                self.place = start + element.rows * dtype.itemsize
                return {column.name: rows[column.name] for column in element.properties}
        table: dict[str, Any] = {column.name: [] for column in element.properties}
        for number in range(1, element.rows + 1):
            for column, value in self._row(element, number):
                table[column.name].append(value)
        return table

    def _row(self, element: _Element, number: int) -> list[tuple[_Property, Any]]:
        row: list[tuple[_Property, Any]] = []
        for column in element.properties:
            count = 1
            if column.length:
                [count] = self._unpack(column.length, 1)
                room = (len(self.content) - self.place) // np.dtype(column.kind).itemsize
                check_count(count, f"numbers in row {number} of {quoted(element.name)}", room)
            numbers = self._unpack(column.kind, count)
            row.append((column, numbers if column.length else numbers[0]))
        return row

    def _unpack(self, kind: str, count: int) -> list[Any]:
        pattern = struct.Struct(f"{self.order}{count}{_STRUCT[kind]}")
        if self.place + pattern.size > len(self.content):
            raise ValueError("the file ends early")
        numbers = pattern.unpack_from(self.content, self.place)
        self.place += pattern.size
        return list(numbers)


def _triangles(corners: Any) -> Indices:
    if isinstance(corners, np.ndarray) and corners.shape[1] == 3 and corners.dtype.kind in "iu":
        return corners.astype(np.int64)
    polygons = [list(polygon) for polygon in corners]
    odd = next((corner for polygon in polygons for corner in polygon if corner % 1 != 0), None)
    if odd is not None:
        raise ValueError(f"a polygon has the corner {odd}, which is no whole number")
    return fans([[int(corner) for corner in polygon] for polygon in polygons])


def _uv(vertex: dict[str, Any], texcoord: Any, faces: Indices) -> tuple[Reals | None, Indices | None]:
    """Points at vertices, or six numbers for each triangle."""
    uv = uv_of_columns(vertex)
    if uv is not None:
        return uv, None
    if texcoord is None or len(texcoord) != len(faces) or any(len(row) != 6 for row in texcoord):
        return None, None
    points = np.asarray(texcoord, np.float64).reshape(-1, 2)
    return points, np.arange(len(points)).reshape(-1, 3)
