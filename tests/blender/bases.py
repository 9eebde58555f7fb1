# SPDX-License-Identifier: GPL-3.0-or-later
"""A base mesh as artists have them, of a body, eyes and teeth, a scan to wrap it onto, and measures."""

from collections.abc import Sequence

import bmesh
import bpy
import meshes
import numpy as np
import pairs
import spheres
from meshes import Array, MeshObject

EYES = spheres.unit(np.array([[0.4, -0.8, 0.45], [-0.4, -0.8, 0.45]]))
MOUTH = spheres.unit(np.array([0, -0.9, -0.35]))
PLACES = spheres.unit(
    np.array(
        [
            *((0, -1, 0.1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1), (0.6, 0.6, 0.5)),
            *((-0.6, 0.6, 0.5), (0.6, 0.6, -0.5), (-0.6, 0.6, -0.5), (0.65, -0.7, 0.6), (-0.65, -0.7, 0.6)),
            *((0.4, -0.8, -0.3), (-0.4, -0.8, -0.3), (0, -0.8, -0.7), (0, -0.8, 0.7)),
        ]
    )
)
"""Directions of the landmarks: the nose, the ears, the back, around eyes and mouth."""
EYE_RADIUS = 0.12


def shape(directions: Array) -> Array:
    """The surface of a head in some directions (n, 3)."""
    radius = 1 + 0.25 * np.exp(-8 * np.linalg.norm(directions - PLACES[0], axis=1) ** 2)
    for ear in PLACES[1:3]:
        radius += 0.15 * np.exp(-20 * np.linalg.norm(directions - ear, axis=1) ** 2)
    return directions * radius[:, None] * [0.8, 0.9, 1.1]


def base(holes: bool = False, levels: int = 4) -> tuple[MeshObject, list[slice]]:
    """The body of quads and the vertices of its pieces: the body, both eyes, the teeth.

    With `holes` it is open at the eyes, the mouth and the neck.
    """
    body = meshes.cube_sphere(levels)
    body.name = "Body"
    directions = spheres.unit(pairs.positions(body))
    body.data.vertices.foreach_set("co", shape(directions).astype(np.float32).ravel())
    if holes:
        cut(body, [*EYES, MOUTH], 0.2)
        cut(body, [np.array([0, 0, -1])], 0.35)
    parts = [body, *(_eye(eye) for eye in EYES), _teeth()]
    sizes = [len(part.data.vertices) for part in parts]
    meshes.join(*parts)
    ends = np.cumsum(sizes).tolist()
    return body, [slice(end - size, end) for end, size in zip(ends, sizes, strict=True)]


def cut(obj: MeshObject, directions: Sequence[Array], radius: float) -> None:
    """Removes the faces around some directions, seen from the origin."""
    edit = bmesh.new()
    edit.from_mesh(obj.data)
    middles = spheres.unit(np.array([face.calc_center_median() for face in edit.faces]))
    near = np.any([np.linalg.norm(middles - direction, axis=1) < radius for direction in directions], axis=0)
    gone = [face for face, is_near in zip(edit.faces, near.tolist(), strict=True) if is_near]
    bmesh.ops.delete(edit, geom=gone, context="FACES")
    edit.to_mesh(obj.data)
    edit.free()


def scan(level: int = 4) -> MeshObject:
    """A closed head of triangles that is larger, stands elsewhere and leans over."""
    directions, faces = spheres.icosphere(level, turned=5)
    return meshes.add(bent(shape(directions)), faces, "Scan")


def bent(points: Array) -> Array:
    x, y, z = np.asarray(points).T
    lean = 0.25 * (z + 1)
    x, z = np.cos(lean) * x + np.sin(lean) * (z + 1), np.cos(lean) * (z + 1) - np.sin(lean) * x
    return 2.5 * np.stack([x, y, 1.1 * z], axis=1) @ spheres.rotation(3).T + [7, -3, 11]


def landmarks(body: MeshObject, target: MeshObject, where: slice) -> dict[str, tuple[int, int]]:
    """Pairs of vertices of a body, among some of its vertices, and of a target."""
    points = shape(PLACES)
    gaps = np.linalg.norm(pairs.positions(body)[where][:, None] - points, axis=2)
    on_target = pairs.nearest(target, bent(points))
    first = where.start + gaps.argmin(axis=0)
    return {f"Place {k}": both for k, both in enumerate(zip(first.tolist(), on_target, strict=True))}


def best_ball(points: Array) -> tuple[Array, float, float]:
    """Center and radius of the ball nearest to points, and their largest distance from it over the radius."""
    middle = points.mean(axis=0)
    system = np.column_stack([2 * (points - middle), np.ones(len(points))])
    center = np.linalg.lstsq(system, ((points - middle) ** 2).sum(axis=1), rcond=None)[0]
    radius = float(np.sqrt(center[3] + center[:3] @ center[:3]))
    apart = np.abs(np.linalg.norm(points - middle - center[:3], axis=1) - radius).max()
    return middle + center[:3], radius, float(apart / radius)


def windings(points: Array, obj: MeshObject) -> Array:
    """How often a closed mesh of triangles winds around points, by solid angles (Van Oosterom, Strackee)."""
    faces = np.array([face.vertices for face in obj.data.polygons])
    corners = pairs.positions(obj)[faces]
    a, b, c = np.moveaxis(corners - np.asarray(points)[:, None, None], 2, 0)
    na, nb, nc = (np.linalg.norm(corner, axis=-1) for corner in (a, b, c))
    over = (a * np.cross(b, c)).sum(axis=-1)
    under = na * nb * nc + (a * b).sum(-1) * nc + (b * c).sum(-1) * na + (c * a).sum(-1) * nb
    result: Array = np.arctan2(over, under).sum(axis=1) / (2 * np.pi)
    return result


def eye_center(eye: Array) -> Array:
    center: Array = shape(eye[None])[0] * 0.85
    return center


def _eye(direction: Array) -> MeshObject:
    center = eye_center(direction)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=8, radius=EYE_RADIUS)
    eye = bpy.context.object
    points = pairs.positions(eye) + center
    eye.data.vertices.foreach_set("co", points.astype(np.float32).ravel())
    return eye


def _teeth() -> MeshObject:
    """An arch behind the mouth: a strip of quads with a thickness."""
    turns = np.linspace(-0.5, 0.5, 9)
    rings = []
    for turn in turns:
        across = np.array([np.sin(turn), -np.cos(turn), 0])
        for reach, height in ((0.5, -0.3), (0.58, -0.3), (0.58, -0.2), (0.5, -0.2)):
            rings.append(across * reach + [0, 0, height])
    count = len(turns)
    faces = [
        [4 * k + side, 4 * k + (side + 1) % 4, 4 * k + 4 + (side + 1) % 4, 4 * k + 4 + side]
        for k in range(count - 1)
        for side in range(4)
    ]
    ends = [[3, 2, 1, 0], [4 * (count - 1) + side for side in range(4)]]
    return meshes.add(rings, [*faces, *ends], "Teeth")
