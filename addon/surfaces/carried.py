# SPDX-License-Identifier: GPL-3.0-or-later
"""Where mesh corners get their UVs from that no triangle of the mapped mesh has. Plain numpy, no bpy.

They are corners of polygons without area and of duplicate polygons. All corners of such a polygon take UVs of
one patch: at their own vertices where the patch has them, else at the nearest vertex.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import Booleans, Integers
from .degenerate import Collapsed
from .surface import Surface


@dataclass
class Carried:
    """Mesh corners (k,) that have the UVs of corners of triangles, their `hosts` (k,):
    3 × triangle + place, ascending.

    `lost` (l,) are mesh corners that no triangle is near.
    """

    corners: Integers
    hosts: Integers
    lost: Integers

    def without(self, corners: Booleans) -> "Carried":
        """What is left without some mesh corners, given by a mask (c,) of all."""
        kept = ~corners[self.corners]
        return Carried(self.corners[kept], self.hosts[kept], self.lost[~corners[self.lost]])


def carried(surface: Surface, collapsed: Collapsed, patch_of: Integers) -> Carried:
    """Hosts for the mesh corners of a surface that the triangles (m,) left of it do not have.

    `patch_of` (m,) numbers the patches of the triangles; -1 for those that are left out, too.
    """
    polygons = surface.chosen
    is_there = np.zeros(len(surface.corner_vertex) + 1, bool)  # the last is for the number -1
    is_there[collapsed.mesh.corners[patch_of >= 0]] = True
    owner = np.repeat(polygons, surface.polygon_size[polygons])
    incomplete = np.unique(owner[~is_there[surface.corners_of(polygons)]])
    corners = surface.corners_of(incomplete)
    left_out = corners[~is_there[corners]]
    if not len(left_out):
        return Carried(left_out, left_out, left_out)
    search = _Search(surface, collapsed, patch_of, corners)
    ends = np.cumsum(surface.polygon_size[incomplete])[:-1]
    pieces = [each.tolist() for each in np.split(corners, ends)]
    found = search.run(list(zip(incomplete.tolist(), pieces, strict=True)))
    hosts = np.array([found.get(corner, -1) for corner in left_out.tolist()])
    order = np.argsort(hosts, kind="stable")
    order = order[hosts[order] >= 0]
    return Carried(left_out[order], hosts[order], left_out[hosts < 0])


class _Search:
    """Looks for hosts of the corners of polygons, one polygon after the other."""

    def __init__(self, surface: Surface, collapsed: Collapsed, patch_of: Integers, corners: Integers) -> None:
        self._faces, self._patch_of = collapsed.mesh.triangles, patch_of
        self._positions, self._polygons = collapsed.mesh.positions, collapsed.mesh.polygons
        vertices = collapsed.stands_for[surface.corner_vertex[corners]]
        self._vertex = dict(zip(corners.tolist(), vertices.tolist(), strict=True))
        wanted = np.zeros(len(self._positions), bool)
        wanted[vertices] = True
        is_near = wanted[self._faces] & (patch_of >= 0)[:, None]
        # the corners of triangles at each vertex, 3 × triangle + place
        self._at: dict[int, list[int]] = {}
        for place in np.flatnonzero(is_near).tolist():
            self._at.setdefault(int(self._faces.flat[place]), []).append(place)

    def run(self, polygons: Sequence[tuple[int, list[int]]]) -> dict[int, int]:
        """The hosts of the mesh corners of polygons, each with its number.

        Those of polygons that no triangle touches are found from others.
        """
        found: dict[int, int] = {}
        while polygons:
            later = [each for each in polygons if not self._place(*each, found)]
            if len(later) == len(polygons):
                return found
            polygons = later
        return found

    def _place(self, polygon: int, corners: list[int], found: dict[int, int]) -> bool:
        """Finds hosts for the corners of a polygon, if any of them is where a triangle has a corner."""
        vertices = [self._vertex[corner] for corner in corners]
        triangle = self._neighbor(polygon, vertices)
        if triangle is None:
            return False
        for corner, vertex in zip(corners, vertices, strict=True):
            found[corner] = self._host(polygon, vertex, triangle)
            self._at.setdefault(vertex, [found[corner]])
        return True

    def _neighbor(self, polygon: int, vertices: list[int]) -> int | None:
        """The triangle that has most of some vertices, of the polygon itself if it has any."""
        shared = Counter(place // 3 for vertex in set(vertices) for place in self._at.get(vertex, ()))
        if not shared:
            return None

        def rank(triangle: int) -> tuple[bool, int, int]:
            return self._polygons[triangle] != polygon, -shared[triangle], triangle

        return min(shared, key=rank)

    def _host(self, polygon: int, vertex: int, triangle: int) -> int:
        """The corner at a vertex of the polygon's own triangles, of a triangle, or of one of its patch.

        If there is none, the nearest corner of the triangle.
        """

        def rank(place: int) -> int:
            host = place // 3
            if self._polygons[host] == polygon:
                return 0
            return 1 if host == triangle else 2 if self._patch_of[host] == self._patch_of[triangle] else 3

        places = self._at.get(vertex, [])
        best = min(places, key=rank, default=None)
        if best is not None and rank(best) < 3:
            return best
        away = np.linalg.norm(self._positions[self._faces[triangle]] - self._positions[vertex], axis=1)
        return 3 * triangle + int(away.argmin())
