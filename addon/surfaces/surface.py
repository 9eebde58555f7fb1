# SPDX-License-Identifier: GPL-3.0-or-later
"""The triangles of a mesh as arrays. Plain numpy, no bpy."""

from dataclasses import dataclass, replace

import numpy as np

from .arrays import Booleans, Floats, Integers, Singles


@dataclass
class Surface:
    """The triangles of an object's mesh, or of its selected faces, with all numbers those of the mesh.

    `positions` (n, 3) have the size of the object in the world, and the shape of the mesh or that in the
    world. `triangles` (t, 3) are vertices, `corners` (t, 3) mesh corners, `polygons` (t,) polygons; `seams`
    (k, 2) vertices.
    `pinned` (c,) and `uv` (c, 2) of the UV layer, if there is one, have one entry per mesh corner.
    `seam_factors` (n,), if there are some, say how dear a seam is at each vertex; infinite forbids it.
    `density` (p,), if there is one, says how much more UV area each polygon is to get than its area asks for.
    """

    name: str
    positions: Floats
    triangles: Integers
    corners: Integers
    polygons: Integers
    seams: Integers
    corner_vertex: Integers
    polygon_start: Integers
    polygon_size: Integers
    pinned: Booleans | None = None
    uv: Singles | None = None
    seam_factors: Floats | None = None
    density: Floats | None = None

    @property
    def polygon_count(self) -> int:
        return len(self.polygon_start)

    @property
    def uvs(self) -> Singles:
        """The UVs (c, 2) of a surface that has a UV map."""
        assert self.uv is not None, f"{self.name} has no UV map"
        return self.uv

    @property
    def densities(self) -> Floats:
        """The density (t,) of each triangle, 1 where none is given."""
        return np.ones(len(self.triangles)) if self.density is None else self.density[self.polygons]

    @property
    def chosen(self) -> Integers:
        """The polygons that have triangles here, ascending."""
        has_triangle = np.zeros(self.polygon_count, bool)
        has_triangle[self.polygons] = True
        return np.flatnonzero(has_triangle)

    def corners_of(self, polygons: Integers) -> Integers:
        """All mesh corners of some polygons (k,), one polygon after the other."""
        start, size = self.polygon_start[polygons], self.polygon_size[polygons]
        first = np.repeat(start - np.cumsum(size) + size, size)
        corners: Integers = first + np.arange(len(first))
        return corners

    def polygons_of(self, corners: Integers) -> Integers:
        """The polygons (k,) that some mesh corners belong to, ascending."""
        polygons: Integers = np.unique(np.searchsorted(self.polygon_start, corners, side="right") - 1)
        return polygons

    def without(self, polygons: Integers) -> "Surface":
        """The surface without some of its polygons (k,)."""
        if not len(polygons):
            return self
        kept = np.ones(self.polygon_count, bool)
        kept[polygons] = False
        chosen = kept[self.polygons]
        arrays = {name: getattr(self, name)[chosen] for name in ("triangles", "corners", "polygons")}
        return replace(self, **arrays)

    def restricted(self, triangles: Booleans, uv: Singles) -> "Surface":
        """The part of the surface given by a mask (t,) of its triangles, with other UVs."""
        kept = {name: getattr(self, name)[triangles] for name in ("triangles", "corners", "polygons")}
        return replace(self, uv=uv, **kept)
