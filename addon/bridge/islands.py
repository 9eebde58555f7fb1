# SPDX-License-Identifier: GPL-3.0-or-later
"""UVs for the islands of surfaces: by a map onto a disk or, for closed islands, onto a sphere."""

from collections.abc import Sequence
from contextlib import suppress

import numpy as np

import authalic

from ..surfaces import spherical, suitability, triangulation
from ..surfaces.arrays import Floats
from ..surfaces.suitability import Unsuitable
from ..surfaces.surface import Surface
from . import closed, remedies
from .disks import disk_maps
from .island import figures_of, island_of
from .patches import SurfacePatch, checked, opened, surface_patches
from .progress import READING, Progress, keep_going, one_by_one, refused, share_of, to_the_end
from .results import Island, Mapping, Note
from .seams import Cutter, disks
from .settings import SeamSettings, UnwrapSettings
from .shortfall import UNEVEN_DISK, shortfall

# The part of the time that a map onto the sphere takes; seams take the rest, where they are needed.
_LAYOUTS = 0.9
# The part of the time that the search for seams takes; the maps take the rest, where the search made none.
_SEAMS = 0.7


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
        share = 1.0 if _are_mapped_by_search(surfaces, settings) else _SEAMS
        patches = _unmapped_disks(surfaces, settings, settings.seams, result, share_of(progress, 0.0, share))
        progress = share_of(progress, share, 1.0 - share)
        if result.seams is not None and result.seams.ended_early:  # seams are worth nothing here without maps
            progress = to_the_end(progress)

    cutter = Cutter(surfaces, SeamSettings(), _are_mapped_by_search(surfaces, settings))
    result.islands += _mapped(patches, settings, cutter, result, progress)
    return result


def _mapped(
    pieces: Sequence[SurfacePatch],
    settings: UnwrapSettings,
    cutter: Cutter,
    result: Mapping,
    progress: Progress,
) -> list[Island]:
    """The islands of patches, in their order: the disks in one go, then the spheres one by one."""
    disks: list[SurfacePatch] = []
    spheres: list[SurfacePatch] = []
    known = len(result.refusals)
    for piece in pieces:
        with refused(piece, result):
            (disks if _domain(piece, settings) == "DISK" else spheres).append(piece)
    islands: dict[int, list[Island]] = {}
    share = _face_count(disks) / max(_face_count(pieces), 1)
    maps = disk_maps(disks, settings, result, share_of(progress, 0.0, share))
    for piece, disk_map in zip(disks, maps, strict=True):
        if disk_map is not None:
            islands[id(piece)] = [_of_disk_map(piece, disk_map, settings)]

    def lay_flat(piece: SurfacePatch, step: Progress) -> None:
        islands[id(piece)] = _by_sphere(piece, settings, cutter, result, step)

    one_by_one(spheres, lay_flat, result, share_of(progress, share, 1.0 - share))
    # in the order of the patches, whatever was mapped first
    order = {(piece.name, piece.polygon): number for number, piece in enumerate(pieces)}
    result.refusals[known:] = sorted(
        result.refusals[known:], key=lambda refusal: order.get((refusal.name, refusal.polygon or 0), 0)
    )
    return [island for piece in pieces for island in islands.get(id(piece), [])]


def _face_count(pieces: Sequence[SurfacePatch]) -> int:
    return sum(len(piece.polygons) for piece in pieces)


def _domain(piece: SurfacePatch, settings: UnwrapSettings) -> str:
    """What an island is mapped onto, "DISK" or "SPHERE"; raises `Unsuitable` if it cannot be mapped."""
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
    result.seams, found = disks(surfaces, search, _are_mapped_by_search(surfaces, settings), progress)
    result.refusals += result.seams.refusals
    result.at_a_point += result.seams.at_a_point
    result.left_out |= result.seams.left_out
    result.islands += [_mapped_by_search(disk.piece, disk.uv) for disk in found if disk.uv is not None]
    return [disk.piece for disk in found if disk.uv is None]


def _are_mapped_by_search(surfaces: Sequence[Surface], settings: UnwrapSettings) -> bool:
    """Whether the maps of the search for seams are those that are wanted."""
    return settings.solver.is_even and all(surface.density is None for surface in surfaces)


def _mapped_by_search(piece: SurfacePatch, uv: Floats) -> Island:
    """An island with the UVs (n, 2) of its points by the search for its seams."""
    native, faces = checked(piece.patch, piece.points), np.asarray(piece.patch.faces)
    turned = triangulation.signed_areas(uv[faces]) < 0
    if 2 * np.count_nonzero(turned) + int(turned[0]) > len(turned):
        # the island's own orientation is that of most of its faces, at a tie that of the first
        uv, turned = uv * [-1.0, 1.0], ~turned
    island = island_of(piece, native, uv, faces, turned, np.arange(len(piece.points)))
    island.may_turn = True
    return island


def _by_sphere(
    piece: SurfacePatch, settings: UnwrapSettings, cutter: Cutter, result: Mapping, progress: Progress
) -> list[Island]:
    """The islands of a closed one: itself laid flat or, where no layout is good, cut open by seams."""
    found = closed.laid_flat(piece, settings, share_of(progress, 0.0, _LAYOUTS))
    step = share_of(progress, _LAYOUTS, 1.0 - _LAYOUTS)
    if not found.is_good and settings.domain != "SPHERE":
        with suppress(Unsuitable, authalic.MeshError, authalic.SolverError):
            cut = _cut_open(piece, settings, cutter, result, step)
            result.notes.append(Note(piece.name, piece.polygon, closed.CUT_OPEN))
            return cut
    closed.soften(found, settings, step)
    return [found.island(result.notes)]


def _cut_open(
    piece: SurfacePatch, settings: UnwrapSettings, cutter: Cutter, result: Mapping, progress: Progress
) -> list[Island]:
    """The islands of a closed one along seams that are found for it."""
    found = cutter.disks(piece, share_of(progress, 0.0, _SEAMS))
    unmapped = [disk.piece for disk in found if disk.uv is None]
    maps = disk_maps(unmapped, settings, result, share_of(to_the_end(progress), _SEAMS, 1.0 - _SEAMS))
    mapped = [_mapped_by_search(disk.piece, disk.uv) for disk in found if disk.uv is not None]
    pairs = zip(unmapped, maps, strict=True)
    return mapped + [_of_disk_map(part, each, settings) for part, each in pairs if each is not None]


def _of_disk_map(piece: SurfacePatch, disk_map: authalic.DiskMap, settings: UnwrapSettings) -> Island:
    """An island by its disk map; most of its faces are counter-clockwise."""
    native = checked(piece.patch, piece.points)
    faces = np.asarray(piece.patch.faces)
    turned = spherical.turned(faces, np.asarray(disk_map.faces))
    island = island_of(piece, native, np.array(disk_map.uv), faces, turned, np.arange(len(piece.points)))
    figures = figures_of(disk_map.distortion, piece)
    remedy = remedies.of_disk(settings)
    island.shortfall = shortfall(disk_map.status, figures, settings.solver, UNEVEN_DISK, remedy)
    island.may_turn = settings.solver.is_free
    return island
