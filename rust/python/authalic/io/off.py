# SPDX-License-Identifier: MIT OR Apache-2.0
"""OFF: counts, vertices, polygons."""

import re
from pathlib import Path

import numpy as np

from .mesh import MeshData, fans


def read_mesh(path: Path, name: str) -> MeshData:
    """ASCII OFF. What else there is on the line of a vertex or a polygon is colors."""
    text = re.sub(r"#.*", "", path.read_text(encoding="ascii"))
    head = re.match(r"\s*(?:ST)?C?N?OFF\b(?! *BINARY)", text)
    if head is None:
        raise ValueError("it does not begin with the word OFF of an ASCII file")
    words = text[head.end() :].split()
    lines = [line.split() for line in text[head.end() :].splitlines() if line.strip()]
    n, m = int(words[0]), int(words[1])
    if len(lines) == 1 + n + m:
        points = [line[:3] for line in lines[1 : 1 + n]]
        polygons = [list(map(int, line[1 : 1 + int(line[0])])) for line in lines[1 + n :]]
    elif head[0].strip() != "OFF":
        raise ValueError(f"a {head[0].strip()} file must have one element a line")
    else:  # not one element a line: then there are no colors
        points = np.array(words[3 : 3 + 3 * n]).reshape(n, 3).tolist()
        polygons = _polygons(words[3 + 3 * n :], m)
    return MeshData(np.array(points, np.float64).reshape(-1, 3), fans(polygons))


def write_mesh(path: Path, mesh: MeshData, name: str) -> None:
    lines = ["OFF", f"{len(mesh.vertices)} {len(mesh.faces)} 0"]
    lines += [" ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    lines += [f"3 {a} {b} {c}" for a, b, c in mesh.faces.tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def _polygons(words: list[str], count: int) -> list[list[int]]:
    polygons, place = [], 0
    for _ in range(count):
        end = place + 1 + int(words[place])
        polygons.append(list(map(int, words[place + 1 : end])))
        place = end
    return polygons
