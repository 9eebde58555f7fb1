# SPDX-License-Identifier: GPL-3.0-or-later
"""UVs of a map onto the sphere by a projection that keeps areas. Plain numpy, no bpy.

A layout has singular points: the poles of Lambert's cylinder, four points of the equator for the octahedral
square. A face with one inside would fold over, so that first a vertex is moved onto each of them, the first
by a rotation of the sphere, the others by twists that keep areas. What straight edges do to areas, near
poles and across the creases of the octahedral map, is evened out in the plane, and what they fold unfolded.
"""

import numpy as np

from ..surfaces import triangulation
from ..surfaces.arrays import Booleans, Floats, Integers
from .charts import develop
from .layouts import LAYOUTS
from .relaxation import even_out, relax
from .twist import rotation, twist
from .untangle import folded, folded_when_rounded, untangle

# The seam's side, then what lies a quarter turn on about the pole axis, then the axis.
_FRAMES = {
    "X": ((0, 1, 0), (0, 0, 1), (1, 0, 0)),
    "Y": ((0, 0, -1), (-1, 0, 0), (0, 1, 0)),
    "Z": ((0, 1, 0), (-1, 0, 0), (0, 0, 1)),
}
_FIRST_CANDIDATES = 6
_CANDIDATES = 30
_NEIGHBOURHOOD = 150
# In coarse meshes no farther than this, so as not to come to the next singular point.
_FAR, _FEWEST = 0.9, 12
# Choice of vertices for the singular points, and turn about the pole axis; the turns are for coarse meshes.
_ATTEMPTS = [(rank, 0.0) for rank in range(4)] + [(0, 2.4 * turn) for turn in range(1, 16)]
_COARSE = 500
_FEW, _SHARE = 100, 1e-3
_FOLD_PENALTY = 100.0
_DETOUR = 0.25
_IN_PLACE = 0.1


class CannotProject(Exception):
    """Some faces fold over in the layout, wherever its singular points are put; `count` of them at best."""

    def __init__(self, count):
        super().__init__(f"{count} faces fold over")
        self.count = count


def project(
    positions: Floats,
    faces: Integers,
    *,
    polygons: Integers | None = None,
    areas: Floats | None = None,
    movable: Booleans | None = None,
    layout: str = "LAMBERT",
    axis: str = "Z",
    seam: float = 0.0,
) -> Floats:
    """UVs (m, 3, 2) of the corners of faces (m, 3) between positions (n, 3) on the unit sphere.

    Faces are seen counter-clockwise from outside, or all clockwise: then the image is mirrored. Faces with
    one number in `polygons` (m,) keep together. `areas` (m,) are the areas wanted, by default those on the
    sphere; only vertices in the mask `movable` (n,) may come to lie on singular points. `layout` is "LAMBERT"
    or "OCTAHEDRAL", `axis` "X", "Y" or "Z", `seam` an angle about it.

    The whole image has the area of the sphere. Raises `CannotProject`.
    """
    layout = LAYOUTS[layout]
    polygons = np.arange(len(faces)) if polygons is None else polygons
    movable = np.ones(len(positions), bool) if movable is None else movable
    areas = triangulation.areas(positions[faces]) if areas is None else areas
    areas = areas * (4 * np.pi / areas.sum())
    points = _in_frame(positions, faces, axis, seam)
    fewest = len(faces)
    for rank, turn in _ATTEMPTS:
        if turn and len(points) > _COARSE:
            break
        mesh = _Mesh(points @ _about_the_pole(turn), faces, polygons, areas, movable)
        if not _place_singular_points(mesh, layout, rank):
            continue
        chart = develop(layout, mesh.points, faces, polygons)
        bad = _straighten(chart, polygons, areas * layout.scale, ~mesh.singular)
        if bad == 0:
            return layout.finish(chart.uv())
        fewest = min(fewest, bad)
        if bad > _hopeless(faces):  # no matter of where the singular points are
            break
    raise CannotProject(fewest)


def _straighten(chart, polygons, areas, movable):
    """Mends what straight edges do to a chart, towards `areas` (m,); returns how many folds are left."""
    if not chart.closed.all():
        return np.count_nonzero(~chart.closed)
    relax(chart, areas, movable)
    if 0 < len(folded(chart.uv())) <= _hopeless(chart.faces):
        untangle(chart, areas, movable)
        relax(chart, areas, movable)
    bad = len(folded_when_rounded(chart.uv()))
    if bad == 0:
        even_out(chart, polygons, areas, movable)
        bad = len(folded_when_rounded(chart.uv()))
    return bad


def _hopeless(faces):
    """How many folded faces are too many to be mended one by one."""
    return _FEW + _SHARE * len(faces)


class _Mesh:
    """What the search for singular points works on; `singular` (n,) are those already placed."""

    def __init__(self, points, faces, polygons, areas, movable):
        self.points, self.faces, self.polygons = points, faces, polygons
        self.areas, self.movable = areas, movable
        self.singular = np.zeros(len(points), bool)

    def part(self, vertices):
        """The mesh of the faces between some vertices, in their order."""
        number = np.full(len(self.points), -1)
        number[vertices] = np.arange(len(vertices))
        faces = number[self.faces]
        own = (faces >= 0).all(axis=1)
        return _Mesh(
            self.points[vertices], faces[own], self.polygons[own], self.areas[own], self.movable[vertices]
        )


def _in_frame(positions, faces, axis, seam):
    """The positions with the pole axis as their third and the seam's side as their first coordinate."""
    first, second, third = np.array(_FRAMES[axis], float)
    across = np.cross(third, first)
    first = np.cos(seam) * first + np.sin(seam) * across
    second = np.cross(third, first)
    a, b, c = (positions[faces[:, corner]] for corner in range(3))
    if np.einsum("ij,ij", a, np.cross(b, c)) < 0:
        second = -second
    return positions @ np.stack([first, second, third], axis=1)


def _about_the_pole(angle):
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]])


def _place_singular_points(mesh, layout, rank):
    """Moves a vertex onto each singular point of the layout, the best but for `rank` others."""
    for index, goal in enumerate(layout.singular):
        placed = layout.singular[:index]
        ranked = _ranked(mesh, layout, goal, placed, _FIRST_CANDIDATES if rank == 0 else _CANDIDATES)
        if len(ranked) == 0:
            return False
        vertex = ranked[min(rank, len(ranked) - 1)]
        mesh.points = _moved(mesh.points, mesh.points[vertex], goal, placed)
        mesh.singular[vertex] = True
        mesh.points[vertex] = goal
    return True


def _moved(points, start, goal, placed):
    if len(placed) == 0:
        return points @ rotation(start, goal).T
    return twist(points, start, goal, placed)


def _ranked(mesh, layout, goal, placed, enough):
    """The vertices near a singular point, best first, by how the faces about them come out.

    Beyond the `enough` nearest only while all of them fold faces over.
    """
    distance = np.linalg.norm(mesh.points - goal, axis=1)
    near = _nearest(distance, min(_NEIGHBOURHOOD, max(_FEWEST, np.count_nonzero(distance < _FAR))))
    part, own = mesh.part(near), np.flatnonzero((mesh.movable & ~mesh.singular)[near])
    costs = []
    for index in own[:_CANDIDATES]:
        if len(costs) >= enough and min(costs) < _FOLD_PENALTY:
            break
        detour = distance[near[index]] ** 2 / np.median(part.areas)
        cost = _cost(part, layout, index, goal, placed)
        if detour < _IN_PLACE and cost < _FOLD_PENALTY:
            cost = 0  # a mesh with a vertex at its pole, such as a UV sphere, keeps it there
        costs.append(cost + _DETOUR * detour)
    order = np.argsort(costs, kind="stable")
    return [near[own[index]] for index in order if np.isfinite(costs[index])]


def _nearest(distance, count):
    """The indices of the smallest distances, smallest first."""
    chosen = np.arange(len(distance))
    if len(distance) > count:
        chosen = np.argpartition(distance, count)[:count]
    return chosen[np.argsort(distance[chosen], kind="stable")]


def _cost(part, layout, index, goal, placed):
    """How far the areas of a part of the mesh are from those wanted, with its vertex `index` at `goal`."""
    moved = _moved(part.points, part.points[index], goal, placed)
    if moved is None:
        return np.inf
    moved[index] = goal
    chart = develop(layout, moved, part.faces, part.polygons)
    image = triangulation.signed_areas(chart.uv())
    ratio = image / (part.areas * layout.scale)
    bad = ~(ratio > 0) | ~chart.closed
    return _FOLD_PENALTY * bad.sum() + float(((ratio[~bad] - 1) ** 2).sum())
