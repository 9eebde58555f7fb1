# SPDX-License-Identifier: GPL-3.0-or-later
"""UVs for the islands of surfaces: by a map onto a disk or, for closed islands, onto a sphere."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

import authalic

from ..surfaces import spherical, suitability, triangulation
from ..surfaces.arrays import Booleans, Floats, Integers
from ..surfaces.suitability import Unsuitable
from ..surfaces.surface import Surface
from .disks import disk_maps
from .patches import SurfacePatch, checked, opened, surface_patches
from .progress import READING, Progress, keep_going, one_by_one, refused, share_of, to_the_end
from .results import Island, Mapping
from .seams import disks
from .settings import SeamSettings, UnwrapSettings
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
# The part of the time that the search for seams takes; the maps take the rest, where the search made none.
_SEAMS = 0.7
# The part of the time that the sphere map takes; the layout takes the rest.
_SPHERE = 0.9
# The most vertices that a layout needs for its poles.
_POLES = 4


def unwrap(surfaces: Sequence[Surface], settings: UnwrapSettings, progress: Progress = keep_going) -> Mapping:
    """Maps every island of every surface (`Surface`) to UVs, by a disk or by a sphere.

    When `progress` returns False, the current island keeps its best map so far, and later ones are refused.
    Islands that cannot be mapped are refused, not raised. Where seams are to be found, they are found first.
    """
    result = Mapping()
    if settings.seams is None:
        patches = [
            part for piece in surface_patches(surfaces, result) for part in opened(piece, result.notes)[0]
        ]
        progress = share_of(progress, READING, 1.0 - READING)
    else:
        share = 1.0 if settings.solver.is_even else _SEAMS
        patches = _unmapped_disks(surfaces, settings, settings.seams, result, share_of(progress, 0.0, share))
        progress = share_of(progress, share, 1.0 - share)
        if result.seams is not None and result.seams.ended_early:  # seams are worth nothing here without maps
            progress = to_the_end(progress)

    result.islands += _mapped(patches, settings, result, progress)
    return result


def _mapped(
    pieces: Sequence[SurfacePatch], settings: UnwrapSettings, result: Mapping, progress: Progress
) -> list[Island]:
    """The islands of patches, in their order: the disks in one go, then the spheres one by one."""
    disks: list[SurfacePatch] = []
    spheres: list[SurfacePatch] = []
    known = len(result.refusals)
    for piece in pieces:
        with refused(piece, result):
            (disks if _domain(piece, settings) == "DISK" else spheres).append(piece)
    islands: dict[int, Island] = {}
    share = _face_count(disks) / max(_face_count(pieces), 1)
    maps = disk_maps(disks, settings, result, share_of(progress, 0.0, share))
    for piece, disk_map in zip(disks, maps, strict=True):
        if disk_map is not None:
            islands[id(piece)] = _of_disk_map(piece, disk_map, settings)

    def lay_flat(piece: SurfacePatch, step: Progress) -> None:
        islands[id(piece)] = _by_sphere(piece, settings, step)

    one_by_one(spheres, lay_flat, result, share_of(progress, share, 1.0 - share))
    # in the order of the patches, whatever was mapped first
    order = {(piece.name, piece.polygon): number for number, piece in enumerate(pieces)}
    result.refusals[known:] = sorted(
        result.refusals[known:], key=lambda refusal: order.get((refusal.name, refusal.polygon or 0), 0)
    )
    return [islands[id(piece)] for piece in pieces if id(piece) in islands]


def _face_count(pieces: Sequence[SurfacePatch]) -> int:
    return sum(len(piece.polygons) for piece in pieces)


def _domain(piece: SurfacePatch, settings: UnwrapSettings) -> str:
    """What an island is mapped onto, "DISK" or "SPHERE"; raises `Unsuitable` if it cannot be mapped."""
    if piece.is_pinned:
        raise Unsuitable(suitability.PINNED)
    domain = settings.domain if settings.seams is None else "DISK"
    return suitability.choose(piece.patch, domain, settings.fill_holes)


def _unmapped_disks(
    surfaces: Sequence[Surface],
    settings: UnwrapSettings,
    search: SeamSettings,
    result: Mapping,
    progress: Progress,
) -> list[SurfacePatch]:
    """The disks along seams that are found; those that the search has mapped become islands of the result."""
    result.seams, found = disks(surfaces, search, settings.solver.is_even, progress)
    result.refusals += result.seams.refusals
    result.at_a_point += result.seams.at_a_point
    result.left_out |= result.seams.left_out
    result.islands += [_mapped_by_search(disk.piece, disk.uv) for disk in found if disk.uv is not None]
    return [disk.piece for disk in found if disk.uv is None]


def _mapped_by_search(piece: SurfacePatch, uv: Floats) -> Island:
    """An island with the UVs (n, 2) of its points by the search for its seams."""
    native, faces = checked(piece.patch, piece.points), np.asarray(piece.patch.faces)
    turned = triangulation.signed_areas(uv[faces]) < 0
    if 2 * np.count_nonzero(turned) + int(turned[0]) > len(turned):
        # the island's own orientation is that of most of its faces, at a tie that of the first
        uv, turned = uv * [-1.0, 1.0], ~turned
    island = _island(piece, native, uv, faces, turned, np.arange(len(piece.points)))
    island.may_turn = True
    return island


def _of_disk_map(piece: SurfacePatch, disk_map: authalic.DiskMap, settings: UnwrapSettings) -> Island:
    """An island by its disk map; most of its faces are counter-clockwise."""
    native = checked(piece.patch, piece.points)
    faces = np.asarray(piece.patch.faces)
    turned = spherical.turned(faces, np.asarray(disk_map.faces))
    island = _island(piece, native, np.array(disk_map.uv), faces, turned, np.arange(len(piece.points)))
    figures = _figures(disk_map.distortion, piece)
    remedy = _CUT if settings.solver.is_free else _NOT_FREE
    island.shortfall = shortfall(disk_map.status, figures, settings.solver, UNEVEN_DISK, remedy)
    island.may_turn = settings.solver.is_free
    return island


def _by_sphere(piece: SurfacePatch, settings: UnwrapSettings, progress: Progress) -> Island:
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


def _laid_flat(piece: SurfacePatch, settings: UnwrapSettings, solver: Solver, progress: Progress) -> Island:
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
    figures = _figures(authalic.distortion(native, island.uv), piece)
    island.shortfall = shortfall(sphere.status, figures, solver, UNEVEN_SPHERE, _OF_A_SPHERE)
    return island


def _layout(
    sphere: authalic.SphereMap,
    over: Floats,
    piece: SurfacePatch,
    settings: UnwrapSettings,
    progress: Progress,
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


def _figures(distortion: authalic.Distortion, piece: SurfacePatch) -> tuple[float, float]:
    """The standard deviation of area ratios, and the mean angle distortion, of faces that have an area."""
    if not piece.slivers.any():
        return float(distortion.area_ratio_std), float(distortion.angle_distortion_mean)
    counted = ~piece.slivers
    ratios = np.exp2(np.asarray(distortion.log2_area_ratio)[counted])
    return float(ratios.std()), float(np.asarray(distortion.angle_distortion)[counted].mean())


def _island(
    piece: SurfacePatch,
    native: authalic.Surface,
    uv: Floats,
    faces: Integers,
    turned: Booleans,
    points: Integers,
) -> Island:
    """An `Island` of the patch's points (n,) with UVs (n, 2) and triangles `faces`."""
    real, corner_point = piece.corners >= 0, faces.ravel()
    return Island(
        name=piece.name,
        surface=piece.index,
        polygon=piece.polygon,
        points=piece.points[points],
        faces=faces,
        corners=np.concatenate([piece.corners[real], piece.carried]),
        corner_point=np.concatenate([corner_point[real], corner_point[piece.hosts]]),
        uv=uv,
        turned=np.unique(piece.polygons[turned]),
        native=native,
        has_divided_polygons=bool(piece.slivers.any()) or not real.all(),
    )
