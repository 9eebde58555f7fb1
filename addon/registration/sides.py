# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface to be registered, in the shape that it has in the world. Plain numpy, no bpy."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..surfaces import triangulation
from ..surfaces.arrays import Booleans, Floats, Integers, Path
from ..surfaces.suitability import Patch
from ..surfaces.surface import Surface
from .rest import Rest, divided

PointPair = tuple[str, int, int]
"""The name of a pair of landmarks, its vertices on the source and on the target."""
CurvePair = tuple[str, Path, Path]
"""The name of a pair of landmark curves, its vertices along the source and along the target."""

_UNIFORM = 1e-5  # matrices have single precision


@dataclass
class Side:
    """The triangles of one of the two meshes that are matched: one piece, without mask and loose vertices.

    They have the shape that they have in the world, but the place and the size of the mesh: whatever moves,
    turns or scales the object makes no difference. `matrix` (4, 4) leads from there into the world.
    `faces` (m, 3) are between `points` (u, 3); `vertices` (u,) and `corners` (m, 3) are those of the mesh,
    -1 at the center of a divided polygon, `polygons` (m,) the polygons. The mesh has `count` vertices, of
    which `rest` are not matched.
    """

    name: str
    matrix: Floats
    points: Floats
    faces: Integers
    vertices: Integers
    corners: Integers
    polygons: Integers
    count: int
    rest: Rest

    @property
    def size(self) -> float:
        """The diagonal of the bounding box."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0)))

    def points_of(self, vertices: Integers) -> Integers:
        """The points of mesh vertices (k,), -1 for loose vertices."""
        numbers = np.full(self.count, -1)
        real = np.flatnonzero(self.vertices >= 0)
        numbers[self.vertices[real]] = real
        return numbers[vertices]


def side(
    surface: Surface, matrix: Floats, masked: Booleans | None = None, marked: Sequence[Path] = ()
) -> Side:
    """The `Side` of a `Surface` in the mesh's own coordinates, with a matrix (4, 4) into the world.

    A matrix that mirrors turns the faces over, as Blender does, so that fronts stay fronts. Vertices that are
    `masked` (n,) are not matched. Of several pieces the one with most of the landmarks is, each of them given
    by its vertices (k,) in `marked`, or else the largest.
    """
    shape = _shape_of(matrix[:3, :3])
    to_world = np.array(matrix, float)
    to_world[:3, :3] = matrix[:3, :3] @ np.linalg.inv(shape)
    mesh = triangulation.sound(surface)
    if masked is None:
        masked = np.zeros(len(surface.positions), bool)
    matched, rest = divided(surface, mesh, masked, marked)
    used, faces = np.unique(mesh.triangles[matched], return_inverse=True)
    faces, corners = faces.reshape(-1, 3), mesh.corners[matched]
    if np.linalg.det(matrix[:3, :3]) < 0:
        faces, corners = faces[:, ::-1], corners[:, ::-1]
    count = len(surface.positions)
    return Side(
        name=surface.name,
        matrix=to_world,
        points=mesh.positions[used] @ shape.T,
        faces=np.ascontiguousarray(faces),
        vertices=np.where(used < count, used, -1),
        corners=np.ascontiguousarray(corners),
        polygons=mesh.polygons[matched],
        count=count,
        rest=rest.moved(shape),
    )


def _shape_of(linear: Floats) -> Floats:
    """A linear map (3, 3) without its rotation and scale: what it squeezes and whether it mirrors."""
    u, scale, vt = np.linalg.svd(linear)
    squeeze = (vt.T * (scale / scale.max())) @ vt
    if scale.min() > (1 - _UNIFORM) * scale.max():
        squeeze = np.identity(3)
    return squeeze * [[-1], [1], [1]] if np.linalg.det(u @ vt) < 0 else squeeze


def moved(points: Floats, matrix: Floats) -> Floats:
    """Points (n, 3) moved by a matrix (4, 4)."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def boundaries(patches: Sequence[Patch]) -> list[Integers]:
    """The boundary loops of the pieces (k,) as points of their side."""
    return [np.asarray(patch.vertex_of)[loop] for patch in patches for loop in patch.boundary_loops]


def is_open(side: Side) -> bool:
    """Whether a side has an edge with one face."""
    ends = np.sort(side.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    return bool((np.unique(ends, axis=0, return_counts=True)[1] == 1).any())
