# SPDX-License-Identifier: GPL-3.0-or-later
"""UVs for the islands of surfaces: each by a map onto a disk or, where it is closed, onto a sphere."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

import authalic

from .. import messages
from ..messages import problems
from ..sphere_layout import projection
from ..surfaces import spherical, suitability, triangulation
from ..surfaces.arrays import Booleans, Floats, Integers
from ..surfaces.suitability import Unsuitable
from ..surfaces.surface import Surface
from .patches import checked, cut
from .progress import Progress, keep_going, one_by_one
from .results import Island, Mapping, Refusal
from .settings import UnwrapSettings
from .shortfall import UNEVEN_DISK, UNEVEN_SPHERE, shortfall
from .solver import Solver
from .spheres import sphere_map

_CUT = "cut its long parts open by seams"
_NOT_FREE = f"set Outline to Free, or {_CUT}"
_OF_A_SPHERE = "try another Layout, mark seams that cut its long parts open, or poke large n-gons"
# Where the slider has to stand for shapes that a layout of the sphere does not fold.
_FIT_TO_LAY_FLAT = 0.9


def unwrap(surfaces: Sequence[Surface], settings: UnwrapSettings, progress: Progress = keep_going) -> Mapping:
    """Maps every island of every surface (`Surface`) to UVs of its own, by a disk or by a sphere.

    When `progress` returns False the island at hand is kept as it is by then, and later ones are refused.
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
    """A patch of a surface, with what leads back from its numbers to those of the mesh."""

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
    """The UVs of one island, counter-clockwise as most of its faces are wound."""
    if piece.pinned:
        raise Unsuitable("has pinned UVs, which would have to move; unpin them first")
    domain = suitability.choose(piece.patch, settings.domain, settings.fill_holes)
    return (_by_disk if domain == "DISK" else _by_sphere)(piece, settings, progress)


def _by_disk(piece: _Piece, settings: UnwrapSettings, progress: Progress) -> Island:
    native = checked(piece.patch, piece.points)
    found = authalic.disk_map(
        native, fill_holes=settings.fill_holes, progress=progress, **settings.solver.disk_options()
    )
    faces = np.asarray(piece.patch.faces)
    turned = spherical.turned(faces, np.asarray(found.faces))
    island = _island(piece, native, np.array(found.uv), faces, turned, np.arange(len(piece.points)))
    remedy = _CUT if settings.solver.is_free else _NOT_FREE
    island.shortfall = shortfall(found.status, found.distortion, settings.solver, UNEVEN_DISK, remedy)
    island.may_turn = settings.solver.is_free
    return island


def _by_sphere(piece: _Piece, settings: UnwrapSettings, progress: Progress) -> Island:
    """By the sphere map asked for, or by one with better shapes where its faces are too thin to lay flat."""
    try:
        return _laid_flat(piece, settings, settings.solver, progress)
    except projection.CannotProject as problem:
        if settings.solver.method == "GAUSS_NEWTON" and settings.solver.angle_weight < _FIT_TO_LAY_FLAT:
            with suppress(projection.CannotProject):
                solver = replace(settings.solver, angle_weight=_FIT_TO_LAY_FLAT, area_tolerance=0.0)
                return _laid_flat(piece, settings, solver, progress)
        raise Unsuitable(
            f"{messages.count(problem.count, 'triangle')} would fold over when its sphere is laid flat; try "
            "another Layout, Pole Axis or Angle Weight, poke its n-gons, subdivide the mesh or mark seams"
        ) from problem


def _laid_flat(piece: _Piece, settings: UnwrapSettings, solver: Solver, progress: Progress) -> Island:
    faces = np.asarray(piece.patch.faces)
    found, positions, turned = sphere_map(checked(piece.patch, piece.points), solver, progress)
    uv = projection.project(
        positions,
        np.where(turned[:, None], faces[:, ::-1], faces),
        polygons=piece.polygons,
        areas=triangulation.areas(piece.points[faces]),
        movable=piece.vertices >= 0,
        layout=settings.layout,
        axis=settings.pole_axis,
        seam=settings.seam_direction,
    )
    uv = np.where(turned[:, None, None], uv[:, ::-1], uv)
    first, corner_point = triangulation.welded(faces, uv)
    uv, points = uv.reshape(-1, 2)[first], faces.ravel()[first]
    native = authalic.Surface(piece.points[points], corner_point)
    island = _island(piece, native, uv, corner_point, turned, points)
    figures = authalic.distortion(native, island.uv)
    island.shortfall = shortfall(found.status, figures, solver, UNEVEN_SPHERE, _OF_A_SPHERE)
    return island


def _island(
    piece: _Piece,
    native: authalic.Surface,
    uv: Floats,
    faces: Integers,
    turned: Booleans,
    points: Integers,
) -> Island:
    """An `Island` of the piece's points (n,) with UVs (n, 2), its triangles `faces` between these."""
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
