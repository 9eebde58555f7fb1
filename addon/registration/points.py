# SPDX-License-Identifier: GPL-3.0-or-later
"""Two surfaces that are to be registered, what is asked of them, and the figures. Plain numpy, no bpy."""

import hashlib
from collections import OrderedDict
from dataclasses import astuple, dataclass, field

import numpy as np

from .. import messages
from ..surfaces import suitability as domains
from ..surfaces import triangulation
from ..surfaces.suitability import Unsuitable

_KEPT = 4
_UNIFORM = 1e-5  # matrices have single precision
_FEWEST = {"DISK": 1, "SPHERE": 2}
_WORST, _NEXT_WORST = 3, 0.5  # so many pairs are named, of those with so much of the largest error
_SEEN = 5e-6  # errors above this are not 0.000 %


@dataclass
class Settings:
    """`method` is "POINTS" or "CURVES", and the others are of points alone.

    `domain` is "AUTO", "DISK" or "SPHERE", `weight` that of the landmarks at first, `angle_weight` the slider
    from areas, 0, to angles, 1.
    """

    domain: str = "AUTO"
    weight: float = 1.0
    angle_weight: float = 0.0
    method: str = "POINTS"

    @property
    def that_count(self):
        """The same, but for options that make no difference."""
        return self if self.method == "POINTS" else Settings(method=self.method)


@dataclass
class Side:
    """The triangles of one of the two meshes, without its loose vertices.

    They have the shape that they have in the world, but the place and the size of the mesh: whatever moves,
    turns or scales the object makes no difference. `matrix` (4, 4) leads from there into the world.
    `faces` (m, 3) are between `points` (u, 3); `vertices` (u,) and `corners` (m, 3) are those of the mesh,
    -1 at the centre of a divided polygon, `polygons` (m,) the polygons. The mesh has `count` vertices.
    """

    name: str
    matrix: np.ndarray
    points: np.ndarray
    faces: np.ndarray
    vertices: np.ndarray
    corners: np.ndarray
    polygons: np.ndarray
    count: int

    @property
    def size(self):
        """The diagonal of the bounding box."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0)))

    def points_of(self, vertices):
        """Where mesh vertices (k,) are among the points, -1 for loose ones."""
        numbers = np.full(self.count, -1)
        real = np.flatnonzero(self.vertices >= 0)
        numbers[self.vertices[real]] = real
        return numbers[vertices]


@dataclass
class Registered:
    """The library's registration of `source` onto `target` and figures of it.

    `places` (u, 3) and `target_places` are the points of either in the common domain, the unit sphere or the
    unit disk at height 1. `errors` (k,) are the distances of the landmarks, as parts of the target's size,
    `missed` the names of pairs that do not meet. `energy` is the larger of the two maps into the domain,
    `folds` counts those of both. By curves the `domain` is "CURVES", the common domain a sphere, and
    `remarks` say what should be looked at.
    """

    native: object
    source: Side
    target: Side
    domain: str
    places: np.ndarray
    target_places: np.ndarray
    names: list[str]
    errors: np.ndarray
    missed: list[str]
    energy: float
    folds: int
    status: str
    seconds: float
    remarks: list[str] = field(default_factory=list)

    @property
    def by_curves(self):
        return self.domain == "CURVES"

    @property
    def method(self):
        return "CURVES" if self.by_curves else "POINTS"

    @property
    def ended_early(self):
        return self.status == "cancelled"

    @property
    def worst(self):
        """The few pairs (name, error) with the largest errors, the largest first; none if all meet."""
        order = np.argsort(-self.errors, kind="stable")[:_WORST]
        least = max(_SEEN, _NEXT_WORST * self.errors.max(initial=0))
        return [(self.names[pair], float(self.errors[pair])) for pair in order if self.errors[pair] >= least]


def side(surface, matrix):
    """The `Side` of a `mesh_io.Surface` in the mesh's own coordinates, with a matrix (4, 4) into the world.

    A matrix that mirrors turns the faces over, as Blender does, so that fronts stay fronts.
    """
    shape = _shape_of(matrix[:3, :3])
    to_world = np.array(matrix, float)
    to_world[:3, :3] = matrix[:3, :3] @ np.linalg.inv(shape)
    mesh = triangulation.sound(surface)
    used, faces = np.unique(mesh.triangles, return_inverse=True)
    faces, corners = faces.reshape(-1, 3), mesh.corners
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
        polygons=mesh.polygons,
        count=count,
    )


def _shape_of(linear):
    """What a linear map (3, 3) does but to turn and to scale: to squeeze, and maybe to mirror."""
    u, scale, vt = np.linalg.svd(linear)
    squeeze = (vt.T * (scale / scale.max())) @ vt
    if scale.min() > (1 - _UNIFORM) * scale.max():
        squeeze = np.identity(3)
    return squeeze * [[-1], [1], [1]] if np.linalg.det(u @ vt) < 0 else squeeze


def moved(points, matrix):
    """Points (n, 3) moved by a matrix (4, 4)."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def domain(sides, patches, wanted):
    """ "DISK" or "SPHERE", which both sides (source, target) are; `patches` has the pieces of either.

    Raises `Unsuitable` where one of them is neither, where they differ, or where they are not what is wanted.
    """
    found = [_shape(*part) for part in zip(sides, patches, strict=True)]
    for one, shape in zip(sides, found, strict=True):
        if wanted not in ("AUTO", shape):
            raise Unsuitable(f"{one.name}: {_NOT_WANTED[wanted]}")
    if found[0] != found[1]:
        opened, closed = (sides[found.index(shape)].name for shape in ("DISK", "SPHERE"))
        raise Unsuitable(
            f"{opened} is open and {closed} is closed; both must be open or both closed: fill the hole of "
            f"{opened} or delete faces of {closed}"
        )
    return found[0]


_NOT_WANTED = {
    "DISK": "is closed, a disk has a boundary; set Domain to Automatic or Sphere",
    "SPHERE": "has a boundary, which a sphere has not; fill it or set Domain to Automatic or Disk",
}


def _shape(one, patches):
    """What one side is, which must be a single piece without handles and with one boundary at the most."""
    patch = check_piece(one, patches)
    loops = [one.vertices[patch.vertex_of[loop]] for loop in patch.boundary_loops]
    if len(loops) > 1:
        holes = _holes(loops[1:])
        raise Unsuitable(f"{one.name}: has {len(loops)} boundaries where one is allowed; fill {holes}")
    return "DISK" if loops else "SPHERE"


def check_piece(one, patches):
    """The one piece (`authalic.Patch`) without handles that a side must be. Raises `Unsuitable`."""
    try:
        _check_one_piece(len(one.points), patches)
        if patches[0].genus is None:
            raise Unsuitable("is one-sided, like a Moebius strip, and cannot be registered; remesh it")
        if patches[0].genus > 0:
            raise Unsuitable(f"has {domains.handles(patches[0])}, like a torus; close it up or remesh it")
    except Unsuitable as problem:
        raise Unsuitable(f"{one.name}: {problem}") from problem
    return patches[0]


def _check_one_piece(count, patches):
    if sum(len(patch.vertex_of) for patch in patches) > count:
        raise Unsuitable(
            "has edges or vertices where surfaces meet that should be apart; separate them or delete inner "
            "faces (Select > All by Trait > Non Manifold shows them)"
        )
    if len(patches) > 1:
        raise Unsuitable(
            f"consists of {len(patches)} pieces where one is allowed; separate it by loose parts, or join "
            "them by a remesh"
        )


def _holes(loops):
    """All boundaries but the longest, each by its length and a vertex."""
    named = messages.listed([f"the one of {len(loop)} edges at vertex {max(loop)}" for loop in loops])
    return f"{named} (select a boundary edge, Select Boundary Loop, F)"


def boundaries(patches):
    """The boundary loops of the pieces (k,) as points of their side."""
    return [np.asarray(patch.vertex_of)[loop] for patch in patches for loop in patch.boundary_loops]


def check_landmarks(sides, pairs, shape, boundaries):
    """The landmarks of source and target as points (2, k) of the sides.

    `pairs` are (name, source vertex, target vertex), `boundaries` the points of either boundary. Raises
    `Unsuitable` with the names of the pairs that cannot be.
    """
    if len(pairs) < _FEWEST[shape]:
        few = "a landmark pair" if shape == "DISK" else "at least two landmark pairs, better four or more"
        raise Unsuitable(f"{sides[0].name} needs {few}; add vertices that belong together")
    found = []
    for number, (one, border) in enumerate(zip(sides, boundaries, strict=True), 1):
        vertices = np.array([pair[number] for pair in pairs])
        outside = (vertices < 0) | (vertices >= one.count)
        _refuse(pairs, outside, f"is on no vertex of {one.name}; pick it again")
        points = one.points_of(vertices)
        _refuse(pairs, points < 0, f"is on a loose vertex of {one.name}; pick one that has faces")
        first = np.unique(points, return_index=True)[1]
        again = ~np.isin(np.arange(len(points)), first)
        _refuse(pairs, again, f"is on a vertex of {one.name} that has a landmark already; remove one of them")
        if shape == "DISK":
            problem = f"is on the boundary of {one.name}, which becomes a circle; pick a vertex inside"
            _refuse(pairs, np.isin(points, border), problem)
        found.append(points)
    return np.array(found)


def _refuse(pairs, bad, problem):
    names = [f'"{pairs[index][0]}"' for index in np.flatnonzero(bad)]
    if names:
        raise Unsuitable(f"Landmark {messages.listed(names)} {problem}")


def key(source, target, pairs):
    """A hash of all that a registration depends on but its settings: both sides and the landmarks.

    Pairs are (name, vertex, vertex), or (name, vertices, vertices) of curves.
    """
    digest = hashlib.blake2b(digest_size=16)
    for one in (source, target):
        digest.update(one.name.encode())
        for array in (one.points, one.faces, one.vertices, one.corners):
            digest.update(np.int64(array.shape).tobytes() + np.ascontiguousarray(array).tobytes())
    listed = [(name, np.array(first).tolist(), np.array(second).tolist()) for name, first, second in pairs]
    digest.update(repr(listed).encode())
    return digest.digest()


def registered(native, sides, shape, landmarks, names):
    """The figures of a registration (`authalic.Registration`) of two sides by landmarks (2, k)."""
    source, target = sides
    ends = np.asarray(native.positions)[landmarks[0]]
    apart = np.linalg.norm(ends - target.points[landmarks[1]], axis=1)
    figures = native.distortion, getattr(native, "target_distortion", None)
    figures = [one for one in figures if one is not None]
    return Registered(
        native=native,
        source=source,
        target=target,
        domain=shape,
        places=_in_space(np.asarray(native.registered)),
        target_places=_in_space(np.asarray(native.target_registered)),
        names=names,
        errors=apart / max(target.size, np.finfo(float).tiny),
        missed=[names[pair] for pair in native.missed],
        energy=max(float(one.authalic_energy) for one in figures),
        folds=sum(len(one.folded) for one in figures),
        status=native.status,
        seconds=float(native.seconds),
    )


def _in_space(points):
    """Points (n, 2) of the disk at height 1; points (n, 3) as they are."""
    return points if points.shape[1] == 3 else np.column_stack([points, np.ones(len(points))])


def is_open(one):
    """Whether a side has an edge with one face."""
    ends = np.sort(one.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    return bool((np.unique(ends, axis=0, return_counts=True)[1] == 1).any())


def in_mesh_terms(message, source, target):
    """The library's message with the numbers of the mesh that it is about, and that mesh's name."""
    for one, prefix in ((source, "the source: "), (target, "the target: ")):
        if message.startswith(prefix):
            rest = message.removeprefix(prefix)
            return f"{one.name}: {messages.in_mesh_terms(rest, one.polygons, one.vertices)}"
    return message


class Kept:
    """The last few registrations, for what is done with them after."""

    def __init__(self):
        self._found = OrderedDict()

    def get(self, key_, settings):
        """One of these meshes and settings that ran to its end, or None."""
        found = self._found.get((key_, astuple(settings)))
        return found if found is not None and not found.ended_early else None

    def latest(self, keys):
        """The latest of some (key, method), or None."""
        listed = reversed(self._found.items())
        return next((found for (own, used), found in listed if (own, Settings(*used).method) in keys), None)

    def put(self, key_, settings, registered):
        self._found.pop((key_, astuple(settings)), None)
        self._found[key_, astuple(settings)] = registered
        while len(self._found) > _KEPT:
            self._found.popitem(last=False)

    def touch(self, key_, settings):
        """Makes one that was found the latest."""
        self._found.move_to_end((key_, astuple(settings)))
