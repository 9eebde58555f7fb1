# SPDX-License-Identifier: GPL-3.0-or-later
"""The UV map of a surface as triangles in the plane, and which points must stay. Plain numpy, no bpy."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import degenerate, triangulation
from .arrays import Booleans, Floats, Integers, Singles
from .surface import Surface


@dataclass
class UvMap:
    """The triangles of a surface (`Surface`), joined where they share UVs at a vertex.

    Each UV vertex has a point in space, `points` (n, 3), one in the plane, `uv` (n, 2), and a vertex of the
    mesh, `vertices` (n,), -1 at the centers of divided polygons. `faces` (m, 3) are UV vertices, `corners`
    (m, 3) mesh corners, -1 at such centers, `polygons` (m,) polygons. UV vertices must stay if they are
    `pinned` (n,), or `shared` (n,) with faces that are left out.
    """

    points: Floats
    uv: Singles
    vertices: Integers
    faces: Integers
    corners: Integers
    polygons: Integers
    pinned: Booleans
    shared: Booleans


def joined(surface: Surface) -> UvMap:
    """The UV map of a surface with UVs, its triangles joined.

    Faces without area and duplicate faces are left out.
    """
    surface = surface.without(degenerate.without_area(surface))
    surface = surface.without(degenerate.duplicates_of(surface))
    mesh = triangulation.sound(surface)
    image = _corner_uvs(surface, mesh)
    first, faces = triangulation.welded(mesh.triangles, image)
    vertices = mesh.triangles.ravel()[first]
    uv = image.reshape(-1, 2)[first]
    return UvMap(
        points=mesh.positions[vertices],
        uv=uv,
        vertices=np.where(vertices < len(surface.positions), vertices, -1),
        faces=faces,
        corners=mesh.corners,
        polygons=mesh.polygons,
        pinned=_pinned(surface, mesh, faces, len(first)),
        shared=_shared(surface, vertices, uv),
    )


def may_be_flipped(faces: Integers, uv: Singles) -> bool:
    """Whether triangles (m, 3) between UVs (n, 2) wind both ways, or have no area."""
    # Differences and their products are exact for UVs in single precision, so the signs are as well.
    areas = triangulation.signed_areas(uv[faces].astype(float))
    return not ((areas > 0).all() or (areas < 0).all())


def _corner_uvs(surface: Surface, mesh: triangulation.Triangles) -> Singles:
    """UVs (m, 3, 2) in single precision; the center of a divided polygon is amid its corners."""
    image = surface.uvs[mesh.corners]
    center = mesh.corners < 0
    if not center.any():
        return image
    polygons = mesh.polygons[center.any(axis=1)]
    owner = np.repeat(np.arange(surface.polygon_count), surface.polygon_size)
    corners = surface.corners_of(np.arange(surface.polygon_count))
    sums = [np.bincount(owner, surface.uvs[corners, axis], surface.polygon_count) for axis in (0, 1)]
    means = np.stack(sums, axis=1) / surface.polygon_size[:, None]
    image[center] = means[polygons]
    return image


def _pinned(surface: Surface, mesh: triangulation.Triangles, faces: Integers, count: int) -> Booleans:
    """Which UV vertices (n,) have a pin at one of their corners."""
    pinned = np.zeros(count, bool)
    if surface.pinned is not None:
        real = mesh.corners >= 0
        pinned[faces[real][surface.pinned[mesh.corners[real]]]] = True
    return pinned


def _shared(surface: Surface, vertices: Integers, uv: Singles) -> Booleans:
    """Which UV vertices (n,) are also those of faces that are left out."""
    left_out = np.ones(len(surface.corner_vertex), bool)
    left_out[surface.corners_of(surface.chosen)] = False
    if not left_out.any():
        return np.zeros(len(vertices), bool)
    left_out_keys = _keys(surface.corner_vertex[left_out], surface.uvs[left_out])
    return np.isin(_keys(vertices, uv), left_out_keys)


def _keys(vertices: Integers, uv: Singles) -> NDArray[np.void]:
    """A key for each vertex with UVs; keys are equal where vertex and UVs are."""
    places = (np.ascontiguousarray(uv, np.float32) + np.float32(0)).view(np.uint64).ravel()
    keys = np.empty(len(vertices), [("vertex", np.int64), ("place", np.uint64)])
    keys["vertex"], keys["place"] = vertices, places
    return keys
