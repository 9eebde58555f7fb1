# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles without area taken out of a mesh, so that those that are left are sound. Plain numpy, no bpy.

Vertices at the ends of an edge without length become one vertex, so that the triangles there vanish. Where
the three corners of a triangle lie on a line, the one in the middle moves a little off it, away from the
triangle beyond the longest edge: its little area keeps it at that edge in the map. Neither changes the holes
or the handles of a surface.
"""

from dataclasses import dataclass, replace

import numpy as np

from . import triangulation
from .arrays import Booleans, Floats, Integers
from .surface import Surface
from .triangulation import Triangles

# Triangles may come to lie flat when others are mended; few need a third round.
_ROUNDS = 8
# How far a vertex moves off a line, over the length of the line.
_OFF = 1e-4


@dataclass
class Collapsed:
    """A mesh without triangles that have no area.

    `stands_for` (n,) is the vertex that each vertex has become: itself, unless it lies on another. `seams`
    (k, 2) are what has become of the seams. `flat` (f,) are the polygons that have no area, `left_out` (p,)
    those that have no triangle, of which `duplicates` (d,) are on the vertices of others. `slivers` (m,) are
    the triangles that had no area before vertices were moved.
    """

    mesh: Triangles
    stands_for: Integers
    seams: Integers
    flat: Integers
    left_out: Integers
    duplicates: Integers
    slivers: Booleans

    @property
    def has_joined(self) -> bool:
        """Whether vertices have been joined."""
        return bool((self.stands_for != np.arange(len(self.stands_for))).any())


def collapsed(surface: Surface, seams: Integers) -> Collapsed:
    """The triangles of a surface that have an area, its polygons divided where need be.

    `seams` (k, 2) are the edges along which it will be cut.
    """
    count = len(surface.positions)
    flat = triangulation.flat(surface.positions, surface.triangles)
    no_area = _missing(surface, surface.polygons[~flat])
    stands_for = _joined(surface.positions, surface.triangles, flat)
    torn = np.empty(0, int)
    for _ in range(_ROUNDS):
        # 1. Vertices that lie on others, and polygons that thereby, or anyway, have the same vertices.
        lowest = stands_for[:count]
        welded = replace(
            surface, triangles=lowest[surface.triangles], corner_vertex=lowest[surface.corner_vertex]
        )
        duplicates = np.setdiff1d(duplicates_of(welded), no_area)
        # 2. Polygons whose triangles would seem to branch, or have no area beside others, divided.
        mesh = triangulation.sound(welded.without(duplicates), torn)
        stands_for = np.concatenate([lowest, np.arange(count, len(mesh.positions))])
        # 3. What is flat even so.
        positions = mesh.positions
        mesh, stands_for = _without_flat(mesh, stands_for)
        torn_now = np.union1d(torn, _torn(mesh))
        if len(torn_now) == len(torn):
            break
        torn = torn_now
    return Collapsed(
        mesh=mesh,
        stands_for=stands_for,
        seams=_edges_among(stands_for[seams], mesh),
        flat=no_area,
        left_out=_missing(surface, mesh.polygons),
        duplicates=duplicates,
        slivers=triangulation.flat(positions, mesh.triangles),
    )


def without_area(surface: Surface) -> Integers:
    """The polygons of a surface that have no area, ascending."""
    return _missing(surface, surface.polygons[~triangulation.flat(surface.positions, surface.triangles)])


def _missing(surface: Surface, polygons: Integers) -> Integers:
    """The polygons of a surface, ascending, that are not among others (k,)."""
    chosen, there = surface.chosen, np.zeros(surface.polygon_count, bool)
    there[polygons] = True
    missing: Integers = chosen[~there[chosen]]
    return missing


def _torn(mesh: Triangles) -> Integers:
    """The polygons whose triangles fall apart: more than two triangles are at an edge between them."""
    keys = triangulation.edge_keys(mesh.triangles, len(mesh.positions))
    branches = triangulation.branching_edges(mesh.triangles, len(mesh.positions))
    if not len(branches):
        return np.empty(0, int)
    row, place = np.nonzero(np.isin(keys, branches))
    at_edge = np.stack([keys[row, place], mesh.polygons[row]], axis=1)
    distinct, times = np.unique(at_edge, axis=0, return_counts=True)
    torn: Integers = np.unique(distinct[times > 1, 1])
    return torn


def _without_flat(mesh: Triangles, stands_for: Integers) -> tuple[Triangles, Integers]:
    """A mesh without flat triangles, and what vertices (n,) have become."""
    for _ in range(_ROUNDS):
        flat = triangulation.flat(mesh.positions, mesh.triangles)
        if not flat.any():
            return mesh, stands_for
        joined = _joined(mesh.positions, mesh.triangles, flat)
        stands_for = joined[stands_for]
        mesh = _distinct(replace(mesh, triangles=joined[mesh.triangles]))
        mesh = _raised(mesh, triangulation.flat(mesh.positions, mesh.triangles))
    return _chosen(mesh, ~triangulation.flat(mesh.positions, mesh.triangles)), stands_for


def _edges_among(pairs: Integers, mesh: Triangles) -> Integers:
    """Those of some pairs of vertices (k, 2) that are edges of a mesh."""
    if not len(pairs):
        return pairs
    count, ends = len(mesh.positions), np.sort(pairs, axis=1).astype(np.int64)
    keys = triangulation.edge_keys(mesh.triangles, count)
    edges: Integers = pairs[np.isin(ends[:, 0] * count + ends[:, 1], keys)]
    return edges


def duplicates_of(surface: Surface) -> Integers:
    """The polygons of a surface on the vertices of one before, ascending."""
    polygons = surface.chosen
    # Sums of random numbers are the same for the same vertices, whatever their order, and for no others.
    numbers = np.random.default_rng(0).integers(2**63, size=len(surface.positions), dtype=np.uint64)
    sums = np.add.reduceat(numbers[surface.corner_vertex], surface.polygon_start)[polygons]
    ordered = np.sort(sums)
    if not (ordered[1:] == ordered[:-1]).any():
        return np.empty(0, int)
    _, first = np.unique(sums, return_index=True)
    return np.setdiff1d(polygons, polygons[first], assume_unique=True)


def _chosen(mesh: Triangles, triangles: Booleans) -> Triangles:
    """The triangles of a mesh that a mask (m,) gives."""
    if triangles.all():
        return mesh
    kept = {name: getattr(mesh, name)[triangles] for name in ("triangles", "corners", "polygons")}
    return replace(mesh, **kept)


def _joined(positions: Floats, triangles: Integers, flat: Booleans) -> Integers:
    """The vertex (n,) that each vertex becomes where edges of flat triangles have no length: the lowest."""
    corners = triangles[flat]
    points = positions[corners]
    lengths = np.linalg.norm(points - np.roll(points, -1, axis=1), axis=2)
    short = lengths <= triangulation.rounding(points)[:, None]
    first, second = corners[short], np.roll(corners, -1, axis=1)[short]
    lowest: Integers = np.arange(len(positions))
    while (lowest[first] != lowest[second]).any():
        low = np.minimum(lowest[first], lowest[second])
        for ends in (first, second):
            np.minimum.at(lowest, lowest[ends], low)
        lowest = lowest[lowest]
    return lowest


def _distinct(mesh: Triangles) -> Triangles:
    """A mesh without triangles that have a vertex twice, or the vertices of one before."""
    different = (mesh.triangles != np.roll(mesh.triangles, 1, axis=1)).all(axis=1)
    mesh = _chosen(mesh, different)
    _, first = np.unique(np.sort(mesh.triangles, axis=1), axis=0, return_index=True)
    kept = np.zeros(len(mesh.triangles), bool)
    kept[first] = True
    return _chosen(mesh, kept)


def _raised(mesh: Triangles, flat: Booleans) -> Triangles:
    """The mesh with its flat triangles raised: their corners in the middle moved off the longest edge.

    Those at edges of more than two triangles, where they would part the others, are taken out.
    """
    if not flat.any():
        return mesh
    count = len(mesh.positions)
    keys = triangulation.edge_keys(mesh.triangles, count)
    parting = flat & np.isin(keys, triangulation.branching_edges(mesh.triangles, count)).any(axis=1)
    if parting.any():
        return _chosen(mesh, ~parting)
    rows = np.flatnonzero(flat)
    points = mesh.positions[mesh.triangles[rows]]
    lengths = np.linalg.norm(np.roll(points, -1, axis=1) - points, axis=2)
    start = lengths.argmax(axis=1)  # the longest edge runs from this corner to the next
    place = np.arange(len(rows))
    line = points[place, (start + 1) % 3] - points[place, start]
    middle = (start + 2) % 3
    away = points[place, middle] - _opposite(mesh, keys, rows, keys[rows, start], points[place, middle])
    positions = mesh.positions.copy()
    moved = mesh.triangles[rows, middle]
    positions[moved] += _OFF * lengths.max(axis=1)[:, None] * _across(line, away)
    return replace(mesh, positions=positions)


def _opposite(mesh: Triangles, keys: Integers, rows: Integers, edges: Integers, other: Floats) -> Floats:
    """The corners (k, 3) opposite to `edges` (k,), by key, of triangles `rows` (k,) in the triangles beyond.

    `other` (k, 3) where there is none.
    """
    near = np.flatnonzero(np.isin(keys, edges).any(axis=1))
    beyond = {(int(keys[row, at]), int(row)): at for row in near for at in range(3)}
    at_edge: dict[int, list[int]] = {}
    for key, row in beyond:
        at_edge.setdefault(key, []).append(row)
    result = other.copy()
    for index, (row, key) in enumerate(zip(rows.tolist(), edges.tolist(), strict=True)):
        for neighbor in at_edge[key]:
            if neighbor != row:
                corner = (beyond[key, neighbor] + 2) % 3
                result[index] = mesh.positions[mesh.triangles[neighbor, corner]]
    return result


def _across(line: Floats, wanted: Floats) -> Floats:
    """Unit vectors (k, 3) across lines (k, 3), as near to wanted directions (k, 3) as can be."""
    line = line / np.linalg.norm(line, axis=1, keepdims=True)
    # where the wanted direction is along the line, the axis that is most across it
    axis = np.eye(3)[np.abs(line).argmin(axis=1)]
    across = wanted - (wanted * line).sum(axis=1, keepdims=True) * line
    is_along = np.linalg.norm(across, axis=1) <= 1e-6 * np.linalg.norm(wanted, axis=1)
    across[is_along] = (axis - (axis * line).sum(axis=1, keepdims=True) * line)[is_along]
    unit: Floats = across / np.linalg.norm(across, axis=1, keepdims=True)
    return unit
