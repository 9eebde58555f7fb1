# SPDX-License-Identifier: MIT OR Apache-2.0
"""Seams and islands of a layout, read off its UVs: a seam is an edge across which the UVs differ."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components


@dataclass(frozen=True)
class Islands:
    """The seams of a layout and the islands that they bound."""

    seams: np.ndarray
    """The vertices of each seam edge, (k, 2); edges of the mesh's boundary are none."""
    count: int
    of_face: np.ndarray
    """The number of each face's island, (m,)."""
    euler: np.ndarray
    """The Euler characteristic of each island: 1 for a disk."""


def islands(faces, corners):
    """The islands of a layout (m, 3, 2) of a triangle mesh."""
    ends, pairs = inner_edges(faces)
    joined = (corners.reshape(-1, 2)[pairs[:, 0]] == corners.reshape(-1, 2)[pairs[:, 1]]).all(axis=(1, 2))
    links = pairs[joined]
    count, of_face = components(len(faces), links[:, :, 0] // 3)
    points, of_corner = components(3 * len(faces), links.transpose(0, 2, 1).reshape(-1, 2))
    of_point = np.zeros(points, int)
    of_point[of_corner] = np.repeat(of_face, 3)
    faces_of, points_of = np.bincount(of_face, minlength=count), np.bincount(of_point, minlength=count)
    joints_of = np.bincount(of_face[links[:, 0, 0] // 3], minlength=count)
    return Islands(ends[~joined], count, of_face, points_of - (3 * faces_of - joints_of) + faces_of)


def inner_edges(faces):
    """The vertices (k, 2) of the edges between two faces, and the corners there, (k, 2 faces, 2 ends)."""
    corner = np.arange(3 * len(faces)).reshape(-1, 3)
    sides = np.concatenate([corner[:, [0, 1]], corner[:, [1, 2]], corner[:, [2, 0]]])
    ends = faces.ravel()[sides]
    backward = ends[:, 0] > ends[:, 1]
    ends[backward], sides[backward] = ends[backward, ::-1], sides[backward, ::-1]
    edges, first, edge_of, faces_at = np.unique(
        ends, axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    order = np.argsort(edge_of.ravel(), kind="stable")
    last = np.cumsum(faces_at) - 1
    two = faces_at == 2
    return edges[two], np.stack([sides[first[two]], sides[order[last[two]]]], axis=1)


def components(count, links):
    """The number of components of a graph, and the component of each of its nodes."""
    graph = coo_matrix((np.ones(len(links), bool), links.T), (count, count))
    return connected_components(graph, directed=False)
