# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangulated spheres as arrays, and folds in exact arithmetic."""

from fractions import Fraction

import numpy as np
from meshes import Array


def unit(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def icosphere(subdivisions: int, turned: int | None = None) -> tuple[Array, Array]:
    """Vertices (n, 3) and triangles (m, 3) of a subdivided icosahedron, optionally turned."""
    golden = (1 + 5**0.5) / 2
    corners = np.array([(0, a, b * golden) for a in (-1, 1) for b in (-1, 1)])
    vertices = unit(np.concatenate([np.roll(corners, k, axis=1) for k in range(3)]))
    near = np.linalg.norm(vertices[:, None] - vertices, axis=2) < 1.1
    some = [(i, j, k) for i in range(12) for j in range(12) for k in range(12) if i < j and i < k and j != k]
    faces = np.array([face for face in some if near[face[0], face[1]] and near[face[1], face[2]]])
    faces = faces[near[faces[:, 0], faces[:, 2]]]
    faces = faces[np.linalg.det(vertices[faces]) > 0]
    for _ in range(subdivisions):
        vertices, faces = _divided(vertices, faces)
    return (vertices if turned is None else vertices @ rotation(turned).T), faces


def _divided(vertices: Array, faces: Array) -> tuple[Array, Array]:
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    unique, index = np.unique(edges, axis=0, return_inverse=True)
    ab, bc, ca = (len(vertices) + index.reshape(-1, 3)).T
    a, b, c = faces.T
    parts = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    middles = unit(vertices[unique].mean(axis=1))
    return np.concatenate([vertices, middles]), np.concatenate([np.stack(part, axis=1) for part in parts])


def rotation(seed: int) -> Array:
    """A random rotation (3, 3)."""
    matrix = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return matrix * np.linalg.det(matrix)


def exactly_folded(uv: Array) -> list[int]:
    """Faces of images (m, 3, 2) in single precision that are not counter-clockwise, in exact arithmetic."""
    folded = []
    for face, triangle in enumerate(np.asarray(uv, np.float32)):
        (ax, ay), (bx, by), (cx, cy) = [[Fraction(float(x)) for x in corner] for corner in triangle]
        if (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) <= 0:
            folded.append(face)
    return folded
