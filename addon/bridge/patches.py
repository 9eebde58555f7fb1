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

from .. import messages
from ..messages import problems
from ..surfaces import degenerate, one_sided, triangulation
from ..surfaces.arrays import Booleans, Floats, Integers
from ..surfaces.carried import Carried
from ..surfaces.carried import carried as carried_corners
from ..surfaces.surface import Surface
from .results import Note, Refusal

_NO_AREA = "no face has an area; scale it up, or dissolve its faces"


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
    `density` (m,), if there is one, says how much more UV area faces are to get than their areas ask for.
    Mesh corners `carried` (k,) have the UVs of the corners `hosts` (k,), ascending, of the triangles.
    `own_vertices` (3m,) are the vertices that the mesh has at the corners, where others stand for them; None
    where they are the same. `slivers` (m,) are triangles that have no area in the mesh: `points` are not
    quite its vertices there.
    """

    name: str
    index: int
    points: Floats
    corners: Integers
    polygons: Integers
    vertices: Integers
    density: Floats | None
    carried: Integers
    hosts: Integers
    own_vertices: Integers | None
    slivers: Booleans

    def restricted(self, patch: authalic.Patch) -> "SurfacePatch":
        """The numbers for a patch of these triangles."""
        corners = np.asarray(patch.corner_of).ravel()
        carried, hosts = self._carried_by(corners)
        return SurfacePatch(
            name=self.name,
            index=self.index,
            points=self.points[patch.vertex_of],
            corners=self.corners[corners],
            polygons=self.polygons[patch.face_of],
            vertices=self.vertices[patch.vertex_of],
            density=None if self.density is None else self.density[patch.face_of],
            carried=carried,
            hosts=hosts,
            own_vertices=None if self.own_vertices is None else self.own_vertices[corners],
            slivers=self.slivers[patch.face_of],
            patch=patch,
        )

    def _carried_by(self, corners: Integers) -> tuple[Integers, Integers]:
        """The mesh corners that some corners (l,), ascending, are hosts of, and the place of each host."""
        if not len(self.hosts):
            return self.carried, self.hosts
        first, last = np.searchsorted(self.hosts, [corners[0], corners[-1] + 1])
        hosts = self.hosts[first:last]
        places = np.searchsorted(corners, hosts)
        is_here = corners[places] == hosts
        return self.carried[first:last][is_here], places[is_here]


@dataclass
class SurfacePatch(_Numbers):
    """A patch of a surface, with the mesh's numbers."""

    patch: authalic.Patch

    @property
    def polygon(self) -> int:
        return int(self.polygons[0])

    @property
    def target_areas(self) -> Floats | None:
        """The areas (m,) that faces are to get, on any scale; None where these are their own."""
        if self.density is None or np.ptp(self.density) == 0:
            return None
        return self.density * triangulation.areas(self.points[np.asarray(self.patch.faces)])

    def mesh_edges(self, pairs: Integers) -> Integers:
        """Pairs of vertices of the mesh (k, 2) for pairs of the patch's; an edge where there is one."""
        edges = self.vertices[pairs]
        if self.own_vertices is None:
            return edges
        known = self._edges_of_others(self.own_vertices.reshape(-1, 3))
        for row, pair in enumerate(np.sort(pairs, axis=1).tolist()):
            edges[row] = known.get(tuple(pair), edges[row])
        return edges

    def _edges_of_others(self, own: Integers) -> dict[tuple[int, ...], list[int]]:
        """The ends of edges in the mesh, by those in the patch, where they are not the same."""
        faces = np.asarray(self.patch.faces)
        ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2)
        mesh_ends = np.stack([own, np.roll(own, -1, axis=1)], axis=-1).reshape(-1, 2)
        is_other = (mesh_ends != self.vertices[ends]).any(axis=1) & (mesh_ends >= 0).all(axis=1)
        names = np.sort(ends[is_other], axis=1).tolist()
        return {tuple(pair): edge for pair, edge in zip(names, mesh_ends[is_other].tolist(), strict=True)}

    def parts(self, seams: Integers) -> "list[SurfacePatch]":
        """What becomes of the patch when it is cut along seams (k, 2), pairs of its vertices."""
        return [self.restricted(part) for part in cut(self.points, np.asarray(self.patch.faces), seams)]


def opened(piece: SurfacePatch, notes: list[Note]) -> tuple[list[SurfacePatch], Integers]:
    """A patch, or its parts if it is one-sided: it is cut across then, at edges of the mesh (k, 2)."""
    if piece.patch.genus is not None:
        return [piece], np.empty((0, 2), int)
    across = one_sided.edges_across(np.asarray(piece.patch.faces), piece.polygons)
    notes.append(Note(piece.name, piece.polygon, "one-sided, like a Moebius strip; cut across"))
    return piece.parts(across), piece.mesh_edges(across)


class Noting(Protocol):
    """A result that names what was left as it was, and what is remarkable."""

    refusals: list[Refusal]
    notes: list[Note]
    at_a_point: list[tuple[int, Integers]]
    left_out: dict[int, Integers]


def surface_patches(
    surfaces: Sequence[Surface], result: Noting, with_seams: bool = True
) -> list[SurfacePatch]:
    """The patches of all surfaces, cut along their seams or whole; one that cannot be cut is refused.

    Faces without area and duplicate faces are in no patch: patches carry their corners along.
    """
    patches = []
    for index, surface in enumerate(surfaces):
        patches += _patches(surface, index, result, with_seams)
    return patches


def _patches(surface: Surface, index: int, result: Noting, with_seams: bool) -> list[SurfacePatch]:
    collapsed = degenerate.collapsed(surface, surface.seams if with_seams else np.empty((0, 2), int))
    mesh = collapsed.mesh
    if not len(collapsed.mesh.triangles) or collapsed.slivers.all():
        result.refusals.append(Refusal(surface.name, None, _NO_AREA))
        return []
    used, faces = np.unique(mesh.triangles, return_inverse=True)
    faces, points = faces.reshape(-1, 3), mesh.positions[used]
    number = np.full(len(mesh.positions), -1)
    number[used] = np.arange(len(used))
    # The center of a divided polygon is no vertex of the mesh.
    vertices = np.where(used < len(surface.positions), used, -1)
    seams = number[collapsed.seams]
    try:
        patches = cut(points, faces, seams=seams)
    except authalic.MeshError as error:
        reason = problems.in_words(error, mesh.polygons, vertices)
        result.refusals.append(Refusal(surface.name, None, reason))
        return []
    patch_of, patches = _with_area(collapsed, patches)
    carried = carried_corners(surface, collapsed, patch_of)
    if surface.pinned is not None:
        carried = carried.without(surface.pinned)
    if len(carried.lost):
        result.at_a_point.append((index, carried.lost))
    if len(collapsed.left_out):
        result.left_out[index] = collapsed.left_out
    result.notes += _notes(surface, collapsed, carried.lost, _branches(faces, len(used), seams))
    numbers = _numbers(surface, index, points, vertices, collapsed, carried)
    return [numbers.restricted(patch) for patch in patches]


def _with_area(
    collapsed: degenerate.Collapsed, patches: Sequence[authalic.Patch]
) -> tuple[Integers, list[authalic.Patch]]:
    """The number of the patch of each triangle (m,), -1 if none of its faces has an area, and the others."""
    polygons, flat = collapsed.mesh.polygons, np.zeros(int(collapsed.mesh.polygons.max()) + 1, bool)
    flat[collapsed.flat[collapsed.flat < len(flat)]] = True
    patch_of = np.full(len(polygons), -1)
    kept: list[authalic.Patch] = []
    for patch in patches:
        if not flat[polygons[patch.face_of]].all():
            patch_of[patch.face_of] = len(kept)
            kept.append(patch)
    return patch_of, kept


def _branches(faces: Integers, count: int, seams: Integers) -> int:
    """How many edges of triangles between `count` vertices are those of more than two, seams not counted."""
    ends = np.sort(seams, axis=1).astype(np.int64)
    at_seams = ends[:, 0] * count + ends[:, 1]
    return len(np.setdiff1d(triangulation.branching_edges(faces, count), at_seams))


def _numbers(
    surface: Surface,
    index: int,
    points: Floats,
    vertices: Integers,
    collapsed: degenerate.Collapsed,
    carried: Carried,
) -> _Numbers:
    """The mesh's numbers for the triangles that a surface is cut from, between `points` (n, 3)."""
    corners = collapsed.mesh.corners.ravel()
    own = np.where(corners >= 0, surface.corner_vertex[corners], -1) if collapsed.has_joined else None
    return _Numbers(
        name=surface.name,
        index=index,
        points=points,
        corners=corners,
        polygons=collapsed.mesh.polygons,
        vertices=vertices,
        density=None if surface.density is None else surface.density[collapsed.mesh.polygons],
        carried=carried.corners,
        hosts=carried.hosts,
        own_vertices=own,
        slivers=collapsed.slivers,
    )


def _notes(surface: Surface, collapsed: degenerate.Collapsed, lost: Integers, branches: int) -> list[Note]:
    """What is remarkable about a surface: faces without area, duplicate faces, edges of more than two faces.

    `lost` are mesh corners of faces without area that no other face touches.
    """
    owner = np.repeat(np.arange(surface.polygon_count), surface.polygon_size)
    away = len(np.unique(owner[lost]))
    doubled = len(collapsed.duplicates)
    flat = len(collapsed.flat) - away
    notes = []
    if flat:
        notes.append(f"{messages.count(flat, 'face')} without area, put where the corners are")
    if away:
        notes.append(f"{messages.count(away, 'face')} without area apart, put in the lower left corner")
    if doubled:
        notes.append(f"{messages.count(doubled, 'duplicate face')}, put over the first ones")
    if branches:
        notes.append(f"cut along {messages.count(branches, 'edge')} of more than two faces")
    return [Note(surface.name, None, note) for note in notes]
