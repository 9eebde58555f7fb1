# SPDX-License-Identifier: MIT OR Apache-2.0
"""OFF: counts, vertices, polygons."""

import re
from pathlib import Path

from .mesh import MeshData, fans
from .words import check_count, check_plain, quoted, reals, whole


def read_mesh(path: Path, name: str) -> MeshData:
    """ASCII OFF. What else there is on the line of a vertex or a polygon is colors."""
    text = re.sub(r"#.*", "", path.read_text(encoding="utf-8-sig"))
    head = re.match(r"\s*(?:ST)?C?N?OFF\b(?! *BINARY)", text)
    if head is None:
        raise ValueError("it does not begin with the word OFF of an ASCII file")
    words = text[head.end() :].split()
    lines = [line.split() for line in text[head.end() :].splitlines() if line.strip()]
    n, m = _counts(words)
    if len(lines) == 1 + n + m:
        points = [word for number, line in enumerate(lines[1 : 1 + n], 1) for word in _point(line, number)]
        polygons = [_polygon(line, 0, number) for number, line in enumerate(lines[1 + n :], 1)]
    elif head[0].strip() != "OFF":
        raise ValueError(f"a {head[0].strip()} file must have one element a line")
    else:  # not one element a line: then there are no colors
        points = words[3 : 3 + 3 * n]
        polygons = _polygons(words[3 + 3 * n :], m)
    return MeshData(reals(points).reshape(-1, 3), fans(polygons))


def write_mesh(path: Path, mesh: MeshData, name: str) -> None:
    lines = ["OFF", f"{len(mesh.vertices)} {len(mesh.faces)} 0"]
    lines += [" ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    lines += [f"3 {a} {b} {c}" for a, b, c in mesh.faces.tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def _counts(words: list[str]) -> tuple[int, int]:
    """The numbers of vertices and of polygons, for which there are enough words."""
    if len(words) < 2:
        raise ValueError("it ends before the numbers of its vertices and polygons")
    n = whole(words[0], "the number of its vertices")
    m = whole(words[1], "the number of its polygons")
    left = max(0, len(words) - 3)
    check_count(n, "vertices", left // 3)
    check_count(m, "polygons", left - 3 * n)
    return n, m


def _point(line: list[str], number: int) -> list[str]:
    if len(line) < 3:
        raise ValueError(f"vertex {number} has {len(line)} coordinates, not 3")
    return line[:3]


def _polygons(words: list[str], count: int) -> list[list[int]]:
    polygons, place = [], 0
    for number in range(1, count + 1):
        polygons.append(_polygon(words, place, number))
        place += 1 + len(polygons[-1])
    return polygons


def _polygon(words: list[str], place: int, number: int) -> list[int]:
    """The corners of a polygon, which come after how many they are."""
    if place >= len(words):
        raise ValueError(f"it ends before polygon {number}")
    size = whole(words[place], f"the number of corners of polygon {number}")
    check_count(size, f"corners of polygon {number}", len(words) - place - 1)
    corners = words[place + 1 : place + 1 + size]
    try:
        check_plain(corners)
        return list(map(int, corners))
    except ValueError as error:
        said = quoted(" ".join(corners))
        raise ValueError(f"polygon {number} has the corners {said}, which are no whole numbers") from error
