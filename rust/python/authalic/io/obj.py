# SPDX-License-Identifier: MIT OR Apache-2.0
"""Wavefront OBJ: vertices, polygons and the UV point of each corner.

The readers of trimesh and meshio split or drop the UV points of seams, so this one is our own.
"""

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from .._reading import short, there_is
from .errors import FileError
from .mesh import Indices, MeshData, Reals, fans
from .words import check_plain

_DIGITS = 20
"""So many of an index are quoted."""


def read_mesh(path: Path, name: str) -> MeshData:
    """Lines v, vt and f; everything else is passed over. Indices may be relative to the end."""
    points: list[list[float]] = []
    uv: list[list[float]] = []
    polygons: list[list[int]] = []
    uv_polygons: list[list[int]] = []
    numbers: list[int] = []
    with open(path, encoding="utf-8-sig", errors="replace") as file:
        for number, line in enumerate(_joined(file), start=1):
            words = line.split()
            keyword = words[0] if words else ""
            try:
                if keyword in ("v", "vt"):
                    check_plain(words[1:4])
                if keyword == "v":
                    points.append([float(words[k]) for k in (1, 2, 3)])
                elif keyword == "vt":
                    uv.append([float(word) for word in (words[1], *words[2:3], "0")[:2]])
                elif keyword == "f":
                    check_plain(words[1:])
                    polygon, uv_polygon = _corners(words[1:], len(points), len(uv))
                    polygons.append(polygon)
                    uv_polygons.append(uv_polygon)
                    numbers.append(number)
            except (ValueError, IndexError) as error:
                raise FileError(path, f"line {number} cannot be read: {line.strip()[:60]!r}") from error
    has_uv = bool(uv) and all(map(len, uv_polygons))
    _check_range(path, numbers, polygons, len(points), "vertex", "vertices")
    if has_uv:
        _check_range(path, numbers, uv_polygons, len(uv), "UV point", "UV points")
    return MeshData(
        np.array(points).reshape(-1, 3),
        fans(polygons),
        np.array(uv) if has_uv else None,
        fans(uv_polygons) if has_uv else None,
    )


def write_mesh(path: Path, mesh: MeshData, name: str) -> None:
    lines = ["# authalic", *_real_lines("v", mesh.vertices)]
    if mesh.uv is None or mesh.uv_faces is None:
        lines += [f"f {a} {b} {c}" for a, b, c in (mesh.faces + 1).tolist()]
    else:
        lines += _real_lines("vt", mesh.uv)
        corners = np.stack([mesh.faces, mesh.uv_faces], axis=2).reshape(-1, 6) + 1
        lines += [f"f {a}/{i} {b}/{j} {c}/{k}" for a, i, b, j, c, k in corners.tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def append_lines(path: Path, edges: Indices) -> None:
    """Appends edges (k, 2) as line elements."""
    with open(path, "a", encoding="utf-8") as file:
        file.writelines(f"l {a} {b}\n" for a, b in (edges + 1).tolist())


def _joined(lines: Iterable[str]) -> Iterator[str]:
    """Lines, with those that a backslash continues joined."""
    held = ""
    for line in lines:
        if line.endswith("\\\n"):
            held += line[:-2] + " "
        else:
            yield held + line
            held = ""


def _corners(words: list[str], points: int, uv_points: int) -> tuple[list[int], list[int]]:
    """The vertices and the UV points of a polygon's corners v, v/vt, v/vt/vn or v//vn."""
    parts = [word.split("/") for word in words]
    vertices = [_index(part[0], points) for part in parts]
    with_uv = all(len(part) > 1 and part[1] for part in parts)
    return vertices, [_index(part[1], uv_points) for part in parts] if with_uv else []


def _index(word: str, count: int) -> int:
    """From 1 onwards, or from -1 backwards."""
    index = int(word)
    if index == 0 or index < -count:
        raise IndexError(f"{index} is no index")
    return index - 1 if index > 0 else count + index


def _check_range(
    path: Path, numbers: list[int], polygons: list[list[int]], count: int, noun: str, nouns: str
) -> None:
    """Refuses corners that have no point among `count`; `numbers` are the lines of the polygons."""
    for number, polygon in zip(numbers, polygons, strict=True):
        if polygon and max(polygon) >= count:
            point, there = short(str(max(polygon) + 1), _DIGITS), there_is(count, noun, nouns)
            raise FileError(path, f"line {number} names {noun} {point}, but {there}")


def _real_lines(word: str, rows: Reals) -> list[str]:
    """Shortest decimals that read back to the same bits."""
    return [f"{word} {' '.join(map(repr, row))}" for row in rows.tolist()]
