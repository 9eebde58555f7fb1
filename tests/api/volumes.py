# SPDX-License-Identifier: MIT OR Apache-2.0
"""Surfaces of volumes: marching tetrahedra, and the sides of voxels."""

from itertools import permutations, product

import numpy as np

from .meshes import Mesh


def level_set(values, level):
    """The surface where a volume has the level, by marching tetrahedra; values above the level are inside.

    Each edge that crosses the level has a vertex of its own: where the level is a value at a grid point,
    several lie on each other, and faces between them have no area.
    """
    shape, flat = np.array(values.shape), values.ravel()
    steps = np.array([shape[1] * shape[2], shape[2], 1])
    cells = np.stack(np.meshgrid(*(np.arange(n - 1) for n in shape), indexing="ij"), axis=-1).reshape(-1, 3)
    triangles = []
    for order in permutations(range(3)):  # the six tetrahedra of a cube around its diagonal
        corners = (cells @ steps)[:, None] + np.concatenate([[0], np.cumsum(steps[list(order)])])
        inside = flat[corners] > level
        for pattern in product([False, True], repeat=4):
            rows = corners[(inside == pattern).all(axis=1)]
            for triangle in crossing(pattern):
                triangles.append(outward(rows[:, triangle], rows, np.array(pattern), shape))
    ends, faces = np.unique(np.concatenate(triangles).reshape(-1, 2), axis=0, return_inverse=True)
    low, high = (grid_points(end, shape) for end in ends.T)
    below, above = flat[ends.T]
    share = ((level - below) / (above - below))[:, None]
    return Mesh(low + share * (high - low), faces.reshape(-1, 3))


def crossing(pattern):
    """The triangles in a tetrahedron with some corners inside: each as three edges, pairs of corners."""
    chosen, others = (np.flatnonzero(np.array(pattern) == value).tolist() for value in (True, False))
    if len(chosen) == 2:
        (a, b), (c, d) = chosen, others
        return [[(a, c), (a, d), (b, d)], [(a, c), (b, d), (b, c)]]
    if 4 in (len(chosen), len(others)):
        return []
    (apex,), base = sorted([chosen, others], key=len)
    return [[(apex, corner) for corner in base]]


def outward(edges, corners, inside, shape):
    """Triangles (k, 3, 2), each corner an edge of the grid, turned to look away from what is inside."""
    a, b, c = grid_points(edges, shape).mean(axis=2).transpose(1, 0, 2)
    points = grid_points(corners, shape)
    out = points[:, ~inside].mean(axis=1) - points[:, inside].mean(axis=1)
    turned = np.einsum("ij,ij->i", np.cross(b - a, c - a), out) < 0
    edges[turned] = edges[turned][:, ::-1]
    return np.sort(edges, axis=2)


def grid_points(indices, shape):
    return np.stack(np.unravel_index(indices, shape), axis=-1).astype(float)


def voxel_sides(mask):
    """The sides between voxels inside a mask and those outside, two triangles each, looking outward."""
    padded = np.pad(mask, 1).astype(int)
    quads = []
    for axis in range(3):
        difference = np.diff(padded, axis=axis)
        along, across = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
        for sign in (1, -1):
            corner = np.argwhere(difference == sign) + np.eye(3, dtype=int)[axis]
            ring = [corner, corner + along, corner + along + across, corner + across]
            quads.append(np.stack(ring[::-1] if sign == 1 else ring, axis=1))
    corners = np.concatenate(quads).reshape(-1, 3)
    vertices, index = np.unique(corners, axis=0, return_inverse=True)
    quads = index.reshape(-1, 4)
    return Mesh(vertices.astype(float), quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3))
