# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes handed to the native library and cut into patches.

The arrays of a mesh cross here, once for an unwrap, a fix of flips or a sphere: its patches are surfaces of
the library, so that maps and figures of them send images and options only. Other arrays cross elsewhere:

- `islands`: the laid-out mesh of a closed island, which has the points on its seam twice;
- `registrations`: the two surfaces of a registration, and the values of a morph or a transfer;
- `figures.measure`: the triangles to measure, joined where they share UVs.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

import authalic

from ..messages import problems
from ..surfaces import triangulation
from ..surfaces.arrays import Booleans, Floats, Integers
from ..surfaces.surface import Surface
from .results import Refusal


def cut(points: Floats, faces: Integers, seams: Integers | None = None) -> list[authalic.Patch]:
    """The patches of triangles `faces` (m, 3) between `points` (n, 3).

    Coordinates that are not finite count as 0 here; `checked` refuses their patches later.
    """
    return authalic.cut(np.nan_to_num(points, posinf=0, neginf=0), faces, seams=seams)


def checked(patch: authalic.Patch, points: Floats) -> authalic.Surface:
    """The surface of a patch whose vertices are `points` (n, 3); raises MeshError unless all are finite."""
    if np.isfinite(points).all():
        return patch.surface
    return authalic.Surface(points, patch.faces)


@dataclass
class _Numbers:
    """The mesh's numbers for the corners (3m,), faces (m,) and vertices (n,) of triangles of a surface.

    Corners and vertices are -1 at the centers of divided polygons. The surface has the number `index`.
    `pinned_corners` (3m,) tells which corners have pinned UVs.
    """

    name: str
    index: int
    points: Floats
    corners: Integers
    polygons: Integers
    vertices: Integers
    pinned_corners: Booleans

    def restricted(self, patch: authalic.Patch) -> "SurfacePatch":
        """The numbers for a patch of these triangles."""
        corners = np.asarray(patch.corner_of).ravel()
        return SurfacePatch(
            name=self.name,
            index=self.index,
            points=self.points[patch.vertex_of],
            corners=self.corners[corners],
            polygons=self.polygons[patch.face_of],
            vertices=self.vertices[patch.vertex_of],
            pinned_corners=self.pinned_corners[corners],
            patch=patch,
        )


@dataclass
class SurfacePatch(_Numbers):
    """A patch of a surface, with the mesh's numbers."""

    patch: authalic.Patch

    @property
    def polygon(self) -> int:
        return int(self.polygons[0])

    @property
    def is_pinned(self) -> bool:
        return bool(self.pinned_corners.any())

    def parts(self, seams: Integers) -> "list[SurfacePatch]":
        """What becomes of the patch when it is cut along seams (k, 2), pairs of its vertices."""
        return [self.restricted(part) for part in cut(self.points, np.asarray(self.patch.faces), seams)]


class Refusing(Protocol):
    """A result that names what was left as it was."""

    refusals: list[Refusal]


def surface_patches(
    surfaces: Sequence[Surface], result: Refusing, with_seams: bool = True
) -> list[SurfacePatch]:
    """The patches of all surfaces, cut along their seams or whole; one that cannot be cut is refused."""
    patches = []
    for index, surface in enumerate(surfaces):
        patches += _patches(surface, index, result, with_seams)
    return patches


def _patches(surface: Surface, index: int, result: Refusing, with_seams: bool) -> list[SurfacePatch]:
    mesh = triangulation.sound(surface)
    used, faces = np.unique(mesh.triangles, return_inverse=True)
    faces, points = faces.reshape(-1, 3), mesh.positions[used]
    number = np.full(len(mesh.positions), -1)
    number[used] = np.arange(len(used))
    # The center of a divided polygon is no vertex of the mesh.
    vertices = np.where(used < len(surface.positions), used, -1)
    try:
        patches = cut(points, faces, seams=number[surface.seams] if with_seams else None)
    except authalic.MeshError as error:
        reason = problems.in_words(error, mesh.polygons, vertices)
        result.refusals.append(Refusal(surface.name, None, reason))
        return []
    corners = mesh.corners.ravel()
    pinned = np.zeros(len(corners), bool) if surface.pinned is None else surface.pinned[corners]
    numbers = _Numbers(surface.name, index, points, corners, mesh.polygons, vertices, pinned & (corners >= 0))
    return [numbers.restricted(patch) for patch in patches]
