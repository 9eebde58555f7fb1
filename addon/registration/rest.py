# SPDX-License-Identifier: GPL-3.0-or-later
"""What of a mesh is matched, one piece without its mask, and the rest, which follows. Plain numpy, no bpy."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import messages
from ..surfaces import components, triangulation
from ..surfaces.arrays import Booleans, Floats, Integers, Path
from ..surfaces.surface import Surface
from ..surfaces.triangulation import Triangles

# The number of vertices that hang on the matched piece and are no pieces of their own.
ATTACHED = -1


@dataclass
class Rest:
    """The vertices (k,) of a mesh that have faces but are not matched, and `loose` ones (l,) without faces.

    `points` (k, 3) and `loose_points` (l, 3) have the coordinates of the matched side. `pieces` (k,) number
    the pieces, and are `ATTACHED` for vertices that hang on what is matched: the masked ones, and those that
    the mask cuts off.
    """

    vertices: Integers
    points: Floats
    pieces: Integers
    loose: Integers
    loose_points: Floats

    def moved(self, matrix: Floats) -> "Rest":
        """The rest with all points moved by a linear map (3, 3)."""
        return replace(self, points=self.points @ matrix.T, loose_points=self.loose_points @ matrix.T)

    @property
    def followers(self) -> tuple[Integers, Floats, Integers]:
        """All vertices that follow where the mesh goes, their points, and the pieces that they belong to."""
        return (
            np.concatenate([self.vertices, self.loose]),
            np.concatenate([self.points, self.loose_points]),
            np.concatenate([self.pieces, np.full(len(self.loose), ATTACHED)]),
        )

    def in_words(self, name: str, what: str) -> list[str]:
        """The rest of an object, and what became of it: "2 other pieces of Body followed (128 vertices)"."""
        is_attached = self.pieces == ATTACHED
        others = len(np.unique(self.pieces[~is_attached]))
        notes = []
        if others:
            vertices = messages.count(int((~is_attached).sum()), "vertex")
            notes.append(f"{messages.count(others, 'other piece')} of {name} {what} ({vertices})")
        if is_attached.any():
            notes.append(f"{messages.count(int(is_attached.sum()), 'masked vertex')} of {name} {what}")
        return notes

    def why_not(self, name: str) -> str:
        """Why a landmark on the rest of an object cannot be matched."""
        if (self.pieces == ATTACHED).all():
            return f"is on masked vertices of {name}; move it, or paint a smaller mask"
        return f"is on another piece of {name} than most, or on masked vertices; only one piece is matched"


def divided(
    surface: Surface, mesh: Triangles, masked: Booleans, marked: Sequence[Path]
) -> tuple[Booleans, Rest]:
    """Which triangles (t,) of a mesh are matched, and the `Rest` in the coordinates of the mesh.

    No polygon with a masked vertex, (n,), is matched. Of several pieces the one with most of the landmarks
    is, each given by its vertices (k,), or else the largest. No triangle is matched where all are masked.
    """
    kept = ~_masked_polygons(surface, masked)[mesh.polygons]
    matched = np.zeros(len(mesh.triangles), bool)
    if kept.any():
        faces = mesh.triangles[kept]
        component = components.joined_by_edges(faces)
        areas = triangulation.areas(mesh.positions[faces])
        matched[kept] = component == _chosen(faces, component, areas, marked)
    return matched, _rest(surface, mesh, matched)


def _masked_polygons(surface: Surface, masked: Booleans) -> Booleans:
    """Which polygons (p,) have a masked vertex."""
    owner = np.repeat(np.arange(surface.polygon_count), surface.polygon_size)
    result = np.zeros(surface.polygon_count, bool)
    if masked.any():
        result[owner[masked[surface.corner_vertex]]] = True
    return result


def _chosen(faces: Integers, component: Integers, areas: Floats, marked: Sequence[Path]) -> int:
    """The component with vertices of most landmarks, of equal ones the largest."""
    count = int(component.max()) + 1
    if count == 1:
        return 0
    votes = np.zeros(count)
    for vertices in marked:
        votes[np.unique(component[np.isin(faces, vertices).any(axis=1)])] += 1
    area = np.bincount(component, np.nan_to_num(areas), count)
    return int(np.lexsort([area, votes])[-1])


def _rest(surface: Surface, mesh: Triangles, matched: Booleans) -> Rest:
    """The vertices that are in no matched triangle."""
    count = len(surface.positions)
    is_matched, has_faces = np.zeros((2, len(mesh.positions)), bool)
    is_matched[mesh.triangles[matched]] = True
    has_faces[mesh.triangles] = True
    vertices = np.flatnonzero((has_faces & ~is_matched)[:count])
    loose = np.flatnonzero(~has_faces[:count])
    pieces = np.full(len(mesh.positions), ATTACHED)
    if len(vertices):
        component = components.joined_by_edges(mesh.triangles)
        component[component == component[np.argmax(matched)]] = ATTACHED
        pieces[mesh.triangles] = component[:, None]
    points = surface.positions
    return Rest(vertices, points[vertices], pieces[vertices], loose, points[loose])
