# SPDX-License-Identifier: GPL-3.0-or-later
"""The only module that talks to the native library: plain data in, plain data out, no bpy.

`unwrap` and `measure` are ordinary functions on numpy arrays. A `Job` runs such a call on a thread of its
own, so that a window stays alive, and hands the result back on the main thread.
"""

import re
import threading
from dataclasses import dataclass, field

import numpy as np

import authalic

from . import triangulation

# What face attributes show for a face that is folded over, and the limit for all others: shading
# cannot deal with infinities.
LOG2_LIMIT = 20.0


class Cancelled(Exception):
    """The job was cancelled; nothing was written."""


@dataclass
class UnwrapSettings:
    """How islands are mapped; the solver stops earlier where it has converged."""

    domain: str = "AUTO"
    fill_holes: bool = True
    iterations: int = 100


@dataclass
class Island:
    """A mapped island: `uv` (k, 2) at the mesh corners `corners` (k,) of the surface number `surface`.

    `turned` are the polygons whose normals point against those of the rest; they are mirrored in the map.
    """

    surface: int
    polygon: int
    corners: np.ndarray
    uv: np.ndarray
    area: float
    uv_area: float
    turned: np.ndarray


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


class Job:
    """Runs `work(progress)` on a thread, then `finish(result)` on the thread that calls `apply`.

    `work` must not touch bpy; `progress(fraction, message)` is False once the job is cancelled.
    """

    def __init__(self, work, finish=lambda result: result):
        self._work, self._finish = work, finish
        self._thread = threading.Thread(target=self._run, name="authalic", daemon=True)
        self._cancel = threading.Event()
        self._state = (0.0, "")
        self._result = self._error = None

    def start(self):
        self._thread.start()
        return self

    def poll(self):
        """(running, fraction, message)."""
        return (self._thread.is_alive(), *self._state)

    def cancel(self):
        """Asks the computation to stop; `apply` will raise `Cancelled` and change nothing."""
        self._cancel.set()

    def apply(self):
        """Waits for the end of the computation and hands its result to `finish`."""
        self._thread.join()
        if self._cancel.is_set():
            raise Cancelled("cancelled, nothing was changed")
        if self._error is not None:
            raise self._error
        return self._finish(self._result)

    def execute(self):
        """The whole job at once, for scripts; Ctrl-C cancels it."""
        self.start()
        try:
            while self._thread.is_alive():
                self._thread.join(0.05)
        except BaseException:
            self.cancel()
            self._thread.join()
            raise
        return self.apply()

    def _run(self):
        try:
            self._result = self._work(self._report)
        except BaseException as error:  # raised again by apply, on the caller's thread
            self._error = error

    def _report(self, fraction, message):
        self._state = (fraction, message)
        return not self._cancel.is_set()


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
            result.refusals.append(Refusal(piece.name, piece.polygon, piece.in_mesh_terms(str(error))))
        done += share
    return result


def measure(surfaces):
    """Figures of the UVs of `surfaces`, all on one scale; None where no triangle has an area."""
    points = np.concatenate([surface.positions[surface.triangles] for surface in surfaces])
    image = np.concatenate([surface.uv[surface.corners] for surface in surfaces]).astype(float)
    good = triangulation.has_area(points) & np.isfinite(image).all(axis=(1, 2))
    points, image = points[good], image[good]
    if not triangulation.signed_areas(image).any():
        return None
    corners = np.arange(3 * len(points)).reshape(-1, 3)
    figures = authalic.distortion(points.reshape(-1, 3), corners, image.reshape(-1, 2))
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

    def in_mesh_terms(self, message):
        """The message with the indices of the mesh in place of those of the patch."""
        numbers = {
            "face": self.polygons,
            "faces": self.polygons,
            "vertex": self.vertices,
            "vertices": self.vertices,
        }

        def translate(match):
            own = numbers[match[1]]
            return match[1] + re.sub(r"\d+", lambda digits: str(own[int(digits[0])]), match[2])

        return re.sub(r"\b(faces|face|vertices|vertex)( \([\d, …]+\)| \d+)", translate, message)


def _pieces(surfaces, index, result):
    """The islands of a surface; one that cannot be cut at all is refused as a whole."""
    surface = surfaces[index]
    mesh = triangulation.sound(surface)
    used, faces = np.unique(mesh.triangles, return_inverse=True)
    faces, points = faces.reshape(-1, 3), mesh.positions[used]
    number = np.full(len(mesh.positions), -1)
    number[used] = np.arange(len(used))
    try:
        # An island with a bad coordinate is refused by itself when its turn comes.
        patches = authalic.cut(np.nan_to_num(points, posinf=0, neginf=0), faces, seams=number[surface.seams])
    except authalic.MeshError as error:
        result.refusals.append(Refusal(surface.name, None, str(error)))
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
            vertices=used[patch.vertex_of],
            pinned=bool(surface.pinned is not None and surface.pinned[corners[corners >= 0]].any()),
        )


def _map(piece, settings, progress):
    """The disk map of one island, counter-clockwise as the mesh is wound."""
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
    uv = np.array(found.uv)
    signed = triangulation.signed_areas(uv[faces])
    turned = _turned(faces, np.asarray(found.faces))
    if signed.sum() < 0:
        uv[:, 0] *= -1
        turned = ~turned
    real = piece.corners >= 0
    return Island(
        surface=piece.index,
        polygon=piece.polygon,
        corners=piece.corners[real],
        uv=uv[faces.ravel()[real]],
        area=float(triangulation.areas(piece.points[faces]).sum()),
        uv_area=float(np.abs(signed).sum()),
        turned=np.unique(piece.polygons[turned]),
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
