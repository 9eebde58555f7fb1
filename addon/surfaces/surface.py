# SPDX-License-Identifier: GPL-3.0-or-later
"""The triangles of a mesh as arrays. Plain numpy, no bpy."""

from dataclasses import dataclass, replace

import numpy as np


@dataclass
class Surface:
    """The triangles of an object's mesh, or of its selected faces, with all numbers those of the mesh.

    `positions` (n, 3) have the shape of the mesh and the size of the object in the world. `triangles` (t, 3)
    are vertices, `corners` (t, 3) mesh corners, `polygons` (t,) polygons; `seams` (k, 2) vertices.
    `pinned` (c,) and `uv` (c, 2) of the UV layer, if there is one, have one entry per mesh corner.
    """

    name: str
    positions: np.ndarray
    triangles: np.ndarray
    corners: np.ndarray
    polygons: np.ndarray
    seams: np.ndarray
    corner_vertex: np.ndarray
    polygon_start: np.ndarray
    polygon_size: np.ndarray
    pinned: np.ndarray | None = None
    uv: np.ndarray | None = None

    @property
    def polygon_count(self):
        return len(self.polygon_start)

    def restricted(self, triangles, uv):
        """The part of the surface given by a mask (t,) of its triangles, with other UVs."""
        part = {name: getattr(self, name)[triangles] for name in ("triangles", "corners", "polygons")}
        return replace(self, uv=uv, **part)
