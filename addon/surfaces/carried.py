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
    found = search.run([each.tolist() for each in np.split(corners, ends)])
    hosts = np.array([found.get(corner, -1) for corner in left_out.tolist()])
    order = np.argsort(hosts, kind="stable")
    order = order[hosts[order] >= 0]
    return Carried(left_out[order], hosts[order], left_out[hosts < 0])


class _Search:
    """Looks for hosts of the corners of polygons, one polygon after the other."""

    def __init__(self, surface: Surface, collapsed: Collapsed, patch_of: Integers, corners: Integers) -> None:
        self._faces, self._patch_of = collapsed.mesh.triangles, patch_of
        self._positions = collapsed.mesh.positions
        vertices = collapsed.stands_for[surface.corner_vertex[corners]]
        self._vertex = dict(zip(corners.tolist(), vertices.tolist(), strict=True))
        wanted = np.zeros(len(self._positions), bool)
        wanted[vertices] = True
        is_near = wanted[self._faces] & (patch_of >= 0)[:, None]
        # the corners of triangles at each vertex, 3 × triangle + place
        self._at: dict[int, list[int]] = {}
        for place in np.flatnonzero(is_near).tolist():
            self._at.setdefault(int(self._faces.flat[place]), []).append(place)

    def run(self, polygons: Sequence[list[int]]) -> dict[int, int]:
        """The hosts of mesh corners; those of polygons that no triangle touches are found from others."""
        found: dict[int, int] = {}
        while polygons:
            later = [corners for corners in polygons if not self._place(corners, found)]
            if len(later) == len(polygons):
                return found
            polygons = later
        return found

    def _place(self, corners: list[int], found: dict[int, int]) -> bool:
        """Finds hosts for the corners of a polygon, if any of them is where a triangle has a corner."""
        vertices = [self._vertex[corner] for corner in corners]
        triangle = self._neighbor(vertices)
        if triangle is None:
            return False
        for corner, vertex in zip(corners, vertices, strict=True):
            found[corner] = self._host(vertex, triangle)
            self._at.setdefault(vertex, [found[corner]])
        return True

    def _neighbor(self, vertices: list[int]) -> int | None:
        """The triangle that has most of some vertices."""
        shared = Counter(place // 3 for vertex in set(vertices) for place in self._at.get(vertex, ()))
        if not shared:
            return None
        most = max(shared.values())
        return min(triangle for triangle, count in shared.items() if count == most)

    def _host(self, vertex: int, triangle: int) -> int:
        """The corner at a vertex of a triangle, or of one of its patch; else the nearest of the triangle."""
        places = self._at.get(vertex, [])
        for place in places:
            if place // 3 == triangle:
                return place
        for place in places:
            if self._patch_of[place // 3] == self._patch_of[triangle]:
                return place
        away = np.linalg.norm(self._positions[self._faces[triangle]] - self._positions[vertex], axis=1)
        return 3 * triangle + int(away.argmin())
