# SPDX-License-Identifier: GPL-3.0-or-later
"""UVs for the islands of surfaces: by a map onto a disk or, for closed islands, onto a sphere."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

import authalic

from ..messages import problems
from ..surfaces import spherical, suitability, triangulation
from ..surfaces.arrays import Booleans, Floats, Integers
from ..surfaces.suitability import Unsuitable
from ..surfaces.surface import Surface
from .patches import checked, cut
from .progress import Progress, keep_going, one_by_one, share_of, to_the_end
from .results import Island, Mapping, Refusal
from .settings import UnwrapSettings
from .shortfall import UNEVEN_DISK, UNEVEN_SPHERE, shortfall
from .solver import Solver
from .spheres import sphere_map

_CUT = "cut its long parts open by seams"
_NOT_FREE = f"set Outline to Free, or {_CUT}"
_OF_A_SPHERE = "try another Layout, mark seams that cut its long parts open, or poke large n-gons"
# A slider position whose shapes a layout of the sphere does not fold.
_FIT_TO_LAY_FLAT = 0.9
# The directions of the pole, and of the seam at the angle 0.
_AXES = {
    "X": ((1, 0, 0), (0, 1, 0)),
    "Y": ((0, 1, 0), (0, 0, -1)),
    "Z": ((0, 0, 1), (0, 1, 0)),
}
# The part of the time that the sphere map takes; the layout takes the rest.
_SPHERE = 0.9
# The most vertices that a layout needs for its poles.
_POLES = 4


def unwrap(surfaces: Sequence[Surface], settings: UnwrapSettings, progress: Progress = keep_going) -> Mapping:
    """Maps every island of every surface (`Surface`) to UVs, by a disk or by a sphere.

    When `progress` returns False, the current island keeps its best map so far, and later ones are refused.
    Islands that cannot be mapped are refused, not raised.
    """
    result = Mapping()
    pieces = [piece for index in range(len(surfaces)) for piece in _pieces(surfaces, index, result)]

    def mapped(piece: _Piece, step: Progress) -> None:
        result.islands.append(_map(piece, settings, step))

    one_by_one(pieces, mapped, result, progress)
    return result


@dataclass
class _Piece:
    """A patch of a surface, with the mesh's numbers for its corners, faces and vertices."""

    name: str
    index: int
    patch: authalic.Patch
    points: Floats
    corners: Integers
    polygons: Integers
    vertices: Integers
    pinned: bool

    @property
    def polygon(self) -> int:
        return int(self.polygons[0])


def _pieces(surfaces: Sequence[Surface], index: int, result: Mapping) -> Iterator[_Piece]:
    """The islands of a surface; a surface that cannot be cut is refused as a whole."""
    surface = surfaces[index]
    mesh = triangulation.sound(surface)
    used, faces = np.unique(mesh.triangles, return_inverse=True)
    faces, points = faces.reshape(-1, 3), mesh.positions[used]
    number = np.full(len(mesh.positions), -1)
    number[used] = np.arange(len(used))
    # The center of a divided polygon is no vertex of the mesh.
    vertices = np.where(used < len(surface.positions), used, -1)
    try:
        patches = cut(points, faces, seams=number[surface.seams])
    except authalic.MeshError as error:
        reason = problems.in_words(error, mesh.polygons, vertices)
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


def _map(piece: _Piece, settings: UnwrapSettings, progress: Progress) -> Island:
    """The UVs of one island; most of its faces are counter-clockwise."""
    if piece.pinned:
        raise Unsuitable("has pinned UVs, which would have to move; unpin them first")
    domain = suitability.choose(piece.patch, settings.domain, settings.fill_holes)
    return (_by_disk if domain == "DISK" else _by_sphere)(piece, settings, progress)


def _by_disk(piece: _Piece, settings: UnwrapSettings, progress: Progress) -> Island:
    native = checked(piece.patch, piece.points)
    disk_map = authalic.disk_map(
        native, fill_holes=settings.fill_holes, progress=progress, **settings.solver.disk_options()
    )
    faces = np.asarray(piece.patch.faces)
    turned = spherical.turned(faces, np.asarray(disk_map.faces))
    island = _island(piece, native, np.array(disk_map.uv), faces, turned, np.arange(len(piece.points)))
    remedy = _CUT if settings.solver.is_free else _NOT_FREE
    island.shortfall = shortfall(disk_map.status, disk_map.distortion, settings.solver, UNEVEN_DISK, remedy)
    island.may_turn = settings.solver.is_free
    return island


def _by_sphere(piece: _Piece, settings: UnwrapSettings, progress: Progress) -> Island:
    """Lays the sphere map flat; if its faces are too thin for that, one with better shapes."""
    solver = settings.solver
    try:
        return _laid_flat(piece, settings, solver, progress)
    except authalic.SolverError as problem:
        if problem.kind != "layout_fold":
            raise
        if solver.method == "GAUSS_NEWTON" and solver.angle_weight < _FIT_TO_LAY_FLAT:
            solver = replace(solver, angle_weight=_FIT_TO_LAY_FLAT, area_tolerance=0.0)
            with suppress(authalic.SolverError):
                return _laid_flat(piece, settings, solver, progress)
        raise


def _laid_flat(piece: _Piece, settings: UnwrapSettings, solver: Solver, progress: Progress) -> Island:
    faces = np.asarray(piece.patch.faces)
    native = checked(piece.patch, piece.points)
    sphere, over, turned = sphere_map(native, solver, share_of(progress, 0.0, _SPHERE))
    layout = _layout(sphere, over, piece, settings, share_of(progress, _SPHERE, 1.0 - _SPHERE))
    # the map has turned some faces over: back to the order of the mesh
    order = (np.asarray(sphere.faces)[:, None, :] == faces[:, :, None]).argmax(axis=2)
    corner_point = np.take_along_axis(np.asarray(layout.faces), order, axis=1)
    points, uv = np.asarray(layout.vertex_of), np.asarray(layout.points, float)
    native = authalic.Surface(piece.points[points], corner_point)
    island = _island(piece, native, uv, corner_point, turned, points)
    figures = authalic.distortion(native, island.uv)
    island.shortfall = shortfall(sphere.status, figures, solver, UNEVEN_SPHERE, _OF_A_SPHERE)
    return island


def _layout(
    sphere: authalic.SphereMap, over: Floats, piece: _Piece, settings: UnwrapSettings, progress: Progress
) -> authalic.Layout:
    """The layout of a sphere map by the settings; `over` lays the map over the surface, whose axes count."""
    pole, start = np.array(_AXES[settings.pole_axis], float)
    angle = settings.seam_direction
    seam = np.cos(angle) * start + np.sin(angle) * np.cross(pole, start)
    real = piece.vertices >= 0
    return sphere.layout(
        "lambert" if settings.layout == "LAMBERT" else "octahedral",
        pole=over @ pole,
        seam=over @ seam,
        polygons=piece.polygons,
        candidates=real if np.count_nonzero(real) >= _POLES else None,
        precision="float32",
        # a map that ended early has to be laid flat, too
        progress=to_the_end(progress),
    )


def _island(
    piece: _Piece,
    native: authalic.Surface,
    uv: Floats,
    faces: Integers,
    turned: Booleans,
    points: Integers,
) -> Island:
    """An `Island` of the piece's points (n,) with UVs (n, 2) and triangles `faces`."""
    real = piece.corners >= 0
    return Island(
        name=piece.name,
        surface=piece.index,
        polygon=piece.polygon,
        points=piece.points[points],
        faces=faces,
        corners=piece.corners[real],
        corner_point=faces.ravel()[real],
        uv=uv,
        turned=np.unique(piece.polygons[turned]),
        native=native,
    )
