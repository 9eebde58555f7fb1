# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects with landmark pairs, and the data that registrations leave on them."""

from collections.abc import Iterable
from typing import Any

import bpy
import meshes
import numpy as np
from installed import part
from mathutils import Euler, Matrix
from meshes import Array, MeshObject
from numpy.typing import ArrayLike

TILTED = Matrix.LocRotScale((3, -2, 1), Euler((0.3, -0.8, 1.1)), (1.7, 1.7, 1.7))
SQUEEZED = Matrix.LocRotScale((-1, 4, 0.5), Euler((-0.5, 0.2, 2.0)), (0.5, 0.9, 1.4))


def pair(
    source: MeshObject, target: MeshObject, vertices: dict[str, tuple[int, int]] | Iterable[int]
) -> tuple[MeshObject, MeshObject]:
    """Gives the source a target and landmarks, {name: (vertex, vertex)} or a list of vertices of both."""
    if not isinstance(vertices, dict):
        vertices = {f"Landmark {number}": (vertex, vertex) for number, vertex in enumerate(vertices, 1)}
    source.authalic_target = target
    part("landmarks.points").clear(source)
    for name, (first, second) in vertices.items():
        part("landmarks.points").add(source, first, second, name)
    meshes.select(source)
    bpy.context.view_layer.update()
    return source, target


def twin(obj: MeshObject, matrix: Matrix | None = None, name: str = "Twin") -> MeshObject:
    """A copy of an object with a mesh of its own, elsewhere."""
    copy = obj.copy()
    copy.data = obj.data.copy()
    copy.name = name
    bpy.context.collection.objects.link(copy)
    copy.matrix_world = matrix or Matrix.Identity(4)
    bpy.context.view_layer.update()
    return copy


def nearest(obj: MeshObject, points: ArrayLike) -> list[int]:
    """The vertices nearest to points (k, 3) in the coordinates of the mesh."""
    distance = np.linalg.norm(positions(obj)[:, None] - np.asarray(points, float), axis=2)
    return distance.argmin(axis=0).tolist()


def positions(obj: MeshObject, key: str | None = None) -> Array:
    """The positions (n, 3) of a mesh or of its shape key."""
    points = obj.data.shape_keys.key_blocks[key].points if key else obj.data.vertices
    values = np.empty(3 * len(points), np.float32)
    points.foreach_get("co", values)
    return values.reshape(-1, 3).astype(float)


def moved(points: Array, matrix: Any) -> Array:
    matrix = np.array(matrix)
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def size(points: Array) -> float:
    return np.linalg.norm(np.ptp(points, axis=0))
