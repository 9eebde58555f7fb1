# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams of meshes, and what they cut meshes into, by Python alone."""

from collections.abc import Hashable, Iterable
from itertools import product
from typing import Any

import bmesh
import meshes
import numpy as np
from meshes import MeshObject

Pair = tuple[int, int]


def pair(vertices: Iterable[int]) -> Pair:
    first, second = sorted(vertices)
    return first, second


def edges(obj: MeshObject) -> set[Pair]:
    """The edges of a mesh as pairs of vertices; object mode."""
    return {pair(edge.vertices) for edge in obj.data.edges}


def marked(obj: MeshObject) -> set[Pair]:
    """The edges that are marked as seams, in object mode or edit mode."""
    if obj.data.is_editmode:
        mesh = bmesh.from_edit_mesh(obj.data)
        return {pair(vertex.index for vertex in edge.verts) for edge in mesh.edges if edge.seam}
    return {pair(edge.vertices) for edge in obj.data.edges if edge.use_seam}


def mark(obj: MeshObject, pairs: set[Pair]) -> None:
    """Marks these edges as seams, and no others; object mode."""
    edge: Any
    for edge in obj.data.edges:
        edge.use_seam = pair(edge.vertices) in pairs


def characteristics(obj: MeshObject) -> list[int]:
    """V - E + F of each island between the seams; 1 for a disk."""
    # A corner is a polygon and a vertex. Corners on either side of an edge without a seam are one point.
    seams, points, faces = marked(obj), _Sets(), _Sets()
    sides: dict[Pair, list[int]] = {}
    for polygon in obj.data.polygons:
        corners = list(polygon.vertices)
        for ends in zip(corners, corners[1:] + corners[:1], strict=True):
            sides.setdefault(pair(ends), []).append(polygon.index)
    copies = [(ends, owner) for ends, owners in sides.items() for owner in owners]
    for ends, owners in sides.items():
        if len(owners) == 2 and ends not in seams:
            copies.remove((ends, owners[1]))
            faces.join(*owners)
            for vertex in ends:
                points.join((owners[0], vertex), (owners[1], vertex))
    count: dict[Hashable, int] = {}

    def add(owner: int, number: int) -> None:
        island = faces.root(owner)
        count[island] = count.get(island, 0) + number

    for polygon in obj.data.polygons:
        add(polygon.index, 1)
    for _, owner in copies:
        add(owner, -1)
    roots = {
        points.root((polygon.index, vertex)) for polygon in obj.data.polygons for vertex in polygon.vertices
    }
    for owner, _ in roots:
        add(owner, 1)
    return list(count.values())


class _Sets:
    """Sets of things, joined two by two."""

    def __init__(self) -> None:
        self._parents: dict[Any, Any] = {}

    def root(self, item: Any) -> Any:
        while self._parents.setdefault(item, item) != item:
            item = self._parents[item]
        return item

    def join(self, first: Any, second: Any) -> None:
        self._parents[self.root(first)] = self.root(second)


def two_handles() -> MeshObject:
    """A slab of cubes with two holes, all quads."""
    cells = {(x, y) for x, y in product(range(5), range(3)) if (x, y) not in {(1, 1), (3, 1)}}
    number: dict[tuple[int, int, int], int] = {}
    faces = []
    for (x, y), (dx, dy) in product(cells, ((1, 0), (-1, 0), (0, 1), (0, -1))):
        if (x + dx, y + dy) not in cells:
            a, b = _side(x, y, dx, dy)
            faces.append([(*a, 0), (*b, 0), (*b, 1), (*a, 1)])
    for x, y in cells:
        square = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)]
        faces += [[(*corner, 1) for corner in square], [(*corner, 0) for corner in reversed(square)]]
    polygons = [[number.setdefault(corner, len(number)) for corner in face] for face in faces]
    return meshes.add(np.array(list(number), float), polygons, "Slab")


def _side(x: int, y: int, dx: int, dy: int) -> tuple[tuple[int, int], tuple[int, int]]:
    """The side of a square toward a neighbor, counter-clockwise."""
    sides = {
        (1, 0): ((x + 1, y), (x + 1, y + 1)),
        (-1, 0): ((x, y + 1), (x, y)),
        (0, 1): ((x + 1, y + 1), (x, y + 1)),
        (0, -1): ((x, y), (x + 1, y)),
    }
    return sides[dx, dy]
