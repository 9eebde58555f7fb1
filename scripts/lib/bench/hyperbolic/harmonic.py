# SPDX-License-Identifier: MIT OR Apache-2.0
"""The conventional registration that the paper compares with: harmonic maps into a disk, landmarks pinned.

Both surfaces are opened along their first curve. The target is flattened onto the round disk by a harmonic
map, its boundary by arc length; the source is mapped into that disk by a Euclidean harmonic map that takes
its boundary, and every vertex of its other curves, to the points of equal arc length. Faces may fold. The
cost is two sparse solves and the point location.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

import authalic
from bench.hyperbolic.pairs import at_shares, shares

NEIGHBORS = 24
"""The number of triangles with the nearest middles that point location tries first."""


@dataclass(frozen=True)
class Disk:
    """A surface opened along its first curve, and its place in the plane."""

    patch: object
    loop: np.ndarray
    """The boundary as patch vertices, from the start of the curve."""
    shares: np.ndarray
    """The share of the way around at each vertex of the loop."""
    plane: np.ndarray = None
    """(n, 2), the places of the vertices once mapped."""


@dataclass(frozen=True)
class Location:
    """The places of the source's vertices on the target."""

    triangles: np.ndarray
    barycentric: np.ndarray
    folded: np.ndarray
    """Source faces that lie the wrong way round in the disk."""
    target_folded: int
    """The number of target faces that do so in the target's own flattening."""


def register(pair):
    """The conventional registration of a pair."""
    target = flattened(opened(pair.target))
    source = pinned(opened(pair.source), target, pair)
    triangles, barycentric = located(source.plane, target.plane, target.patch.faces)
    first = np.full(len(pair.source.vertices), -1)
    first[source.patch.vertex_of[::-1]] = np.arange(len(source.plane))[::-1]
    folded = np.sort(source.patch.face_of[signed_areas(source.plane, source.patch.faces) <= 0])
    turned = (signed_areas(target.plane, target.patch.faces) <= 0).sum()
    barycentric = corners(target, triangles, barycentric, pair)
    return Location(target.patch.face_of[triangles[first]], barycentric[first], folded, int(turned))


def opened(surface):
    """The surface cut along its first curve, with the way around the cut."""
    curve = surface.curves[0]
    (patch,) = authalic.cut(*surface.mesh, seams=np.stack([curve[:-1], curve[1:]], axis=1))
    (loop,) = patch.boundary_loops
    loop = np.roll(loop, -int(np.flatnonzero(patch.vertex_of[loop] == curve[0])[0]))
    there = shares(surface.vertices[curve]) / 2  # along one bank, and back along the other
    return Disk(patch, loop, np.append(there, 1 - there[-2:0:-1]))


def flattened(disk):
    """The target on the round disk, its boundary by arc length."""
    angle = 2 * np.pi * disk.shares
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return mapped(disk, disk.loop, circle)


def pinned(disk, target, pair):
    """The source in the target's disk, with all curves in place."""
    around = np.append(target.loop, target.loop[0])
    places = [at_shares(target.plane[around], np.append(target.shares, 1), disk.shares)]
    fixed, copy_of, target_copy_of = [disk.loop], copies(disk.patch), copies(target.patch)
    for curve, partner in zip(pair.source.curves[1:], pair.target.curves[1:], strict=True):
        path = target.plane[target_copy_of[partner]]
        wanted = shares(pair.source.vertices[curve])
        fixed.append(copy_of[curve])
        places.append(at_shares(path, shares(pair.target.vertices[partner]), wanted))
    fixed, places = np.concatenate(fixed), np.concatenate(places)
    once = np.unique(fixed, return_index=True)[1]  # a closed curve has its first vertex twice
    return mapped(disk, fixed[once], places[once])


def copies(patch):
    """For each vertex of the surface one vertex of the patch."""
    copy_of = np.full(patch.vertex_of.max() + 1, -1)
    copy_of[patch.vertex_of] = np.arange(len(patch.vertex_of))
    return copy_of


def mapped(disk, fixed, places):
    """The harmonic map with some vertices at their places."""
    patch = disk.patch
    plane = np.zeros((len(patch.vertices), 2))
    plane[fixed] = places
    free = np.setdiff1d(np.arange(len(plane)), fixed)
    laplacian = cotangent_laplacian(patch.vertices, patch.faces).tocsr()[free]
    plane[free] = splu(laplacian[:, free].tocsc()).solve(-(laplacian[:, fixed] @ places))
    return Disk(patch, disk.loop, disk.shares, plane)


def cotangent_laplacian(vertices, faces):
    """The stiffness matrix of linear elements, (n, n)."""
    rows, columns, weights = [], [], []
    for k in range(3):
        i, j, opposite = faces[:, k], faces[:, (k + 1) % 3], faces[:, (k + 2) % 3]
        u, v = vertices[i] - vertices[opposite], vertices[j] - vertices[opposite]
        half = 0.5 * np.einsum("ij,ij->i", u, v) / np.linalg.norm(np.cross(u, v), axis=1)
        rows += [i, j, i, j]
        columns += [j, i, i, j]
        weights += [-half, -half, half, half]
    entries = np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns))
    return coo_matrix(entries, shape=(len(vertices),) * 2)


def signed_areas(plane, faces):
    """Twice the area of each face in the plane, negative where it lies the wrong way round."""
    a, b, c = (plane[faces[:, k]] for k in range(3))
    return cross(b - a, c - a)


def cross(u, v):
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def located(points, plane, faces):
    """The triangle of each point and its barycentric coordinates there, clipped for points outside."""
    tree = cKDTree(plane[faces].mean(axis=1))
    near = tree.query(points, k=min(NEIGHBORS, len(faces)))[1]
    chosen, inside = best(points, plane, faces, near)
    for k in np.flatnonzero(inside < -1e-9):  # not among the nearest: long thin triangles
        chosen[k] = best(points[k : k + 1], plane, faces, np.arange(len(faces))[None])[0][0]
    weights = coordinates(points, plane[faces[chosen]]).clip(0)
    return chosen, weights / weights.sum(axis=1, keepdims=True)


def best(points, plane, faces, candidates):
    """The candidate triangle in which each point lies deepest, and its least coordinate there."""
    weights = coordinates(points[:, None], plane[faces[candidates]])
    least = np.nan_to_num(weights.min(axis=2), nan=-np.inf)
    order = least.argmax(axis=1)
    rows = np.arange(len(points))
    return candidates[rows, order], least[rows, order]


def coordinates(points, triangles):
    """Barycentric coordinates of points (..., 2) in triangles (..., 3, 2)."""
    a, b, c = (triangles[..., k, :] for k in range(3))
    parts = [cross(b - points, c - points), cross(c - points, a - points), cross(a - points, b - points)]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.stack(parts, axis=-1) / cross(b - a, c - a)[..., None]


def corners(target, triangles, barycentric, pair):
    """The coordinates in the order of the target's own faces."""
    patch = target.patch
    of_patch, of_target = patch.vertex_of[patch.faces[triangles]], pair.target.faces[patch.face_of[triangles]]
    order = (of_target[:, :, None] == of_patch[:, None, :]).argmax(axis=2)
    return np.take_along_axis(barycentric, order, axis=1)
