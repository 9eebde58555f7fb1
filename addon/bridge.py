# SPDX-License-Identifier: GPL-3.0-or-later
"""The only module that talks to the native library: plain data in, plain data out, no bpy.

`unwrap`, `folds` and `measure` are ordinary functions on numpy arrays.
"""

from dataclasses import dataclass, field

import numpy as np

import authalic

from . import messages, triangulation
from .job import Cancelled

# What face attributes show for a face that is folded over, and the limit for all others: shading
# cannot deal with infinities.
LOG2_LIMIT = 20.0


@dataclass
class UnwrapSettings:
    """How islands are mapped; the solver stops earlier where it has converged."""

    fill_holes: bool = True
    iterations: int = 100


@dataclass
class Island:
    """A disk map `uv` (n, 2) of the triangles `faces` (m, 3) between `points` (n, 3) of surface `surface`.

    The UVs of the mesh corners `corners` (k,) are those of the points `corner_point` (k,). `turned` are the
    polygons whose normals point against those of the rest; they are mirrored in the map. `uneven` is the
    standard deviation of the area ratios where the solver could not go on to make them even, else None.
    """

    name: str
    surface: int
    polygon: int
    points: np.ndarray
    faces: np.ndarray
    corners: np.ndarray
    corner_point: np.ndarray
    uv: np.ndarray
    turned: np.ndarray
    uneven: float | None = None


@dataclass
class Refusal:
    """An island, or with `polygon` None a whole object, that was left as it was."""

    name: str
    polygon: int | None
    reason: str

    def __str__(self):
        where = "" if self.polygon is None else f" at face {self.polygon}"
        return f"{self.name}{where}: {self.reason}"


@dataclass
class Mapping:
    """What `unwrap` found."""

    islands: list[Island] = field(default_factory=list)
    refusals: list[Refusal] = field(default_factory=list)


@dataclass
class Measurement:
    """Area ratio figures over the triangles of all surfaces; `log2` has an array (polygons,) for each."""

    triangles: int
    mean: float
    deviation: float
    log2_min: float
    log2_max: float
    flips: int
    angle: float
    without_area: int
    log2: list[np.ndarray]


def _keep_going(_fraction, _message):
    return True


def unwrap(surfaces, settings, progress=_keep_going):
    """Maps every island of every surface (`mesh_io.Surface`) onto a disk of its own.

    Raises `Cancelled` when `progress` returns False. Islands that cannot be mapped are refused, not raised.
    """
    result = Mapping()
    pieces = [piece for index in range(len(surfaces)) for piece in _pieces(surfaces, index, result)]
    total = sum(len(piece.patch.faces) for piece in pieces)
    done = 0
    for piece in pieces:
        share = len(piece.patch.faces)
        if progress(done / total, f"island {len(result.islands) + 1} of {len(pieces)}") is False:
            raise Cancelled("cancelled, nothing was changed")
        step = _sub_progress(progress, done / total, share / total)
        try:
            result.islands.append(_map(piece, settings, step))
        except (_Unsuitable, authalic.MeshError, authalic.SolverError) as error:
            reason = messages.in_mesh_terms(str(error), piece.polygons, piece.vertices)
            result.refusals.append(Refusal(piece.name, piece.polygon, reason))
        done += share
    return result


def folds(island):
    """Whether a face of an island is folded over, exactly, in UVs of single precision as Blender has them."""
    try:
        figures = authalic.distortion(island.points, island.faces, island.uv.astype(np.float32).astype(float))
    except authalic.MeshError:  # the whole island has shrunk to a line or a point
        return True
    return len(figures.folded) > 0


def measure(surfaces):
    """Figures of the UVs of `surfaces`, all on one scale; None where no triangle has an area."""
    points = np.concatenate([surface.positions[surface.triangles] for surface in surfaces])
    image = np.concatenate([surface.uv[surface.corners] for surface in surfaces])
    good = triangulation.has_area(points) & np.isfinite(image).all(axis=(1, 2))
    points, image = points[good], image[good]
    if not triangulation.signed_areas(image.astype(float)).any():
        return None
    # With the UV islands in one piece the library turns faces of inconsistent normals by itself.
    first, faces = triangulation.welded(_vertices(surfaces)[good], image)
    corner_points, corner_image = points.reshape(-1, 3)[first], image.reshape(-1, 2)[first]
    figures = authalic.distortion(corner_points, faces, corner_image.astype(float))
    log2 = np.clip(figures.log2_area_ratio, -LOG2_LIMIT, LOG2_LIMIT)
    log2[figures.folded] = -LOG2_LIMIT
    unfolded = np.ones(len(log2), bool)
    unfolded[figures.folded] = False
    angles = figures.angle_distortion[unfolded]
    return Measurement(
        triangles=len(log2),
        mean=float(figures.area_ratio_mean),
        deviation=float(figures.area_ratio_std),
        log2_min=float(log2.min()),
        log2_max=float(log2.max()),
        flips=len(figures.folded),
        angle=float(angles.mean()) if len(angles) else float("inf"),
        without_area=int(np.count_nonzero(~good)),
        log2=_per_polygon(surfaces, good, points, log2, unfolded),
    )


class _Unsuitable(Exception):
    """An island that no disk map exists for, in the words of an artist."""


@dataclass
class _Piece:
    """A patch of a surface, with what leads back from its numbers to those of the mesh."""

    name: str
    index: int
    patch: object
    points: np.ndarray
    corners: np.ndarray
    polygons: np.ndarray
    vertices: np.ndarray
    pinned: bool

    @property
    def polygon(self):
        return int(self.polygons[0])


def _pieces(surfaces, index, result):
    """The islands of a surface; one that cannot be cut at all is refused as a whole."""
    surface = surfaces[index]
    mesh = triangulation.sound(surface)
    used, faces = np.unique(mesh.triangles, return_inverse=True)
    faces, points = faces.reshape(-1, 3), mesh.positions[used]
    number = np.full(len(mesh.positions), -1)
    number[used] = np.arange(len(used))
    # The centre of a divided polygon is no vertex of the mesh.
    vertices = np.where(used < len(surface.positions), used, -1)
    try:
        # An island with a bad coordinate is refused by itself when its turn comes.
        patches = authalic.cut(np.nan_to_num(points, posinf=0, neginf=0), faces, seams=number[surface.seams])
    except authalic.MeshError as error:
        reason = messages.in_mesh_terms(str(error), mesh.polygons, vertices)
        result.refusals.append(Refusal(surface.name, None, reason))
        return
    for patch in patches:
        corners = mesh.corners.ravel()[np.asarray(patch.corner_of).ravel()]
        yield _Piece(
            name=surface.name,
            index=index,
            patch=patch,
            points=points[patch.vertex_of],
            corners=corners,
            polygons=mesh.polygons[patch.face_of],
            vertices=vertices[patch.vertex_of],
            pinned=bool(surface.pinned is not None and surface.pinned[corners[corners >= 0]].any()),
        )


def _map(piece, settings, progress):
    """The disk map of one island, counter-clockwise as most of its faces are wound."""
    _check(piece, settings)
    faces = np.asarray(piece.patch.faces)
    found = authalic.disk_map(
        piece.points,
        faces,
        max_iterations=settings.iterations,
        fill_holes=settings.fill_holes,
        progress=progress,
    )
    if found.status == "cancelled":
        raise Cancelled("cancelled, nothing was changed")
    real = piece.corners >= 0
    return Island(
        name=piece.name,
        surface=piece.index,
        polygon=piece.polygon,
        points=piece.points,
        faces=faces,
        corners=piece.corners[real],
        corner_point=faces.ravel()[real],
        uv=np.array(found.uv),
        turned=np.unique(piece.polygons[_turned(faces, np.asarray(found.faces))]),
        uneven=float(found.distortion.area_ratio_std) if found.status == "stalled" else None,
    )


def _turned(faces, oriented):
    """Which faces (m, 3) have been turned over to give all one orientation, (m,)."""
    return ~(oriented[:, None, :] == np.stack([np.roll(faces, k, axis=1) for k in range(3)], axis=1)).all(
        2
    ).any(1)


def _check(piece, settings):
    """Says what an artist can do where the island is no disk, before the solver does in its own words."""
    patch = piece.patch
    if piece.pinned:
        raise _Unsuitable("has pinned UVs, which would have to move; unpin them first")
    if patch.is_closed:
        raise _Unsuitable("is closed; mark seams to cut it open")
    if patch.genus is None:
        raise _Unsuitable("is one-sided, like a Moebius strip; mark seams across it")
    if patch.genus > 0:
        holes = "a handle" if patch.genus == 1 else f"{patch.genus} handles"
        raise _Unsuitable(f"has {holes}, like a torus; mark seams to cut it open")
    if len(patch.boundary_loops) > 1 and not settings.fill_holes:
        raise _Unsuitable(
            f"has {len(patch.boundary_loops)} boundaries; turn on Fill Holes or mark seams to join them"
        )


def _sub_progress(progress, start, share):
    """A part of the whole as a progress callback of its own."""
    return lambda fraction, message: progress(start + share * fraction, message)


def _vertices(surfaces):
    """The vertices of the triangles of all surfaces, (t, 3), numbered on from one surface to the next."""
    starts = np.cumsum([0, *(len(surface.positions) for surface in surfaces)])
    return np.concatenate([s.triangles + start for s, start in zip(surfaces, starts[:-1], strict=True)])


def _per_polygon(surfaces, good, points, log2, unfolded):
    """log2 of each polygon's own area ratio: the mean over its triangles, weighted by their areas."""
    ratios = np.zeros(len(good))
    ratios[good] = np.exp2(log2)
    weights = np.zeros(len(good))
    weights[good] = triangulation.areas(points)
    folded = np.zeros(len(good), bool)
    folded[good] = ~unfolded
    result, start = [], 0
    for surface in surfaces:
        part = slice(start, start + len(surface.triangles))
        result.append(_polygon_log2(surface, ratios[part], weights[part], folded[part]))
        start = part.stop
    return result


def _polygon_log2(surface, ratios, weights, folded):
    def total(values):
        return np.bincount(surface.polygons, values, surface.polygon_count)

    area = total(weights)
    mean = np.divide(total(ratios * weights), area, out=np.ones(surface.polygon_count), where=area > 0)
    log2 = np.clip(np.log2(mean), -LOG2_LIMIT, LOG2_LIMIT)
    log2[surface.polygons[folded]] = -LOG2_LIMIT
    return log2
