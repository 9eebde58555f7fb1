# SPDX-License-Identifier: MIT OR Apache-2.0
"""Distances along a surface: exact ones by pygeodesic, or along edges and midlines of faces without it."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from bench.hyperbolic.measures import face_areas

try:
    from pygeodesic.geodesic import PyGeodesicAlgorithmExact
except ImportError:
    PyGeodesicAlgorithmExact = None

NEAR = 0.1
"""The first search goes this far, in roots of the area, each further one four times as far."""


class Geodesics:
    """Distances over the root of the area, from one vertex at a time."""

    def __init__(self, vertices, faces, exact=PyGeodesicAlgorithmExact is not None):
        self.vertices, self.faces = np.ascontiguousarray(vertices, float), np.asarray(faces)
        self.root = np.sqrt(face_areas(self.vertices, self.faces).sum())
        self.exact = PyGeodesicAlgorithmExact(self.vertices, self.faces.astype(np.int32)) if exact else None
        self.graph = None if exact else midline_graph(self.vertices, self.faces)

    def from_vertex(self, vertex):
        """The distance of each vertex."""
        if self.exact is None:
            return self.along_lines(vertex, np.inf)
        return self.exact.geodesicDistances(np.array([vertex]), None)[0] / self.root

    def along_lines(self, vertex, limit):
        """The distance along edges and midlines, infinite beyond the limit."""
        found = dijkstra(self.graph, directed=False, indices=vertex, limit=limit * self.root)
        return found[: len(self.vertices)] / self.root

    def within(self, vertex, others, limit):
        """The distances to other vertices; infinite, or nothing sure, for those beyond the limit."""
        if self.exact is None:
            return self.along_lines(vertex, limit)[others]
        try:
            return self.exact.geodesicDistances(np.array([vertex]), others, limit * self.root)[0] / self.root
        except OverflowError:  # pygeodesic gives vertices out of reach a source of no meaning
            return np.full(len(others), np.inf)

    def to_place(self, vertex, triangle, barycentric):
        """The distance of a vertex from a point of a face: linear between the corners of that face.

        On a face that has the vertex as a corner it is the straight line.
        """
        corners = self.faces[triangle]
        if vertex in corners:
            point = barycentric @ self.vertices[corners]
            return np.linalg.norm(point - self.vertices[vertex]) / self.root
        limit = NEAR
        while limit < 16:
            distances = self.within(vertex, corners, limit)
            if (distances < limit).all():
                return barycentric @ distances
            limit *= 4
        return barycentric @ self.from_vertex(vertex)[corners]


def midline_graph(vertices, faces):
    """The edges halved, and the lines of each face between its midpoints and to its corners."""
    sides = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
    edges, edge_of = np.unique(sides, axis=0, return_inverse=True)
    middle = len(vertices) + edge_of.reshape(-1, 3)
    points = np.concatenate([vertices, vertices[edges].mean(axis=1)])
    corner, following = np.arange(3), np.arange(1, 4) % 3
    lines = [(faces[:, i], middle[:, j]) for i in corner for j in corner]
    lines += [(middle[:, i], middle[:, j]) for i, j in zip(corner, following)]
    pairs = np.unique(np.sort(np.concatenate([np.stack(line, axis=1) for line in lines]), axis=1), axis=0)
    i, j = pairs.T
    lengths = np.linalg.norm(points[i] - points[j], axis=1)
    return coo_matrix((lengths, (i, j)), (len(points), len(points))).tocsr()


def farthest(geodesics, vertices, count):
    """The indices of `count` of the vertices, each the farthest from those before it.

    The first is the farthest from the mean of all.
    """
    points = geodesics.vertices[vertices]
    distance = np.linalg.norm(points - points.mean(axis=0), axis=1)
    chosen = [int(distance.argmax())]
    distance = np.full(len(points), np.inf)
    while len(chosen) < count:
        distance = np.minimum(distance, geodesics.from_vertex(vertices[chosen[-1]])[vertices])
        chosen.append(int(distance.argmax()))
    return np.array(chosen)
