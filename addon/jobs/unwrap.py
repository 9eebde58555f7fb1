# SPDX-License-Identifier: GPL-3.0-or-later
"""The unwrap from a context's objects to their UV layers: the one path of the operator and of scripts."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import bpy
import numpy as np

from .. import bridge, messages
from ..blender import edges, meshes, uv_maps
from ..blender.packing import PackSettings, pack
from ..blender.types import MeshObject
from ..bridge.progress import Progress
from ..surfaces.arrays import Integers, Singles
from ..surfaces.islands import scale_to_one_density, upright
from ..surfaces.surface import Surface
from . import found_seams, seam_groups, targets
from .job import Job
from .seam_groups import SeamGroups

_NAMED = 3
_FOLDS = "its faces would fold over in UV precision; cut its long or thin parts open by seams"

Chosen = tuple[MeshObject, str, Surface]
"""An object, the name of its UV map, and its surface."""


class CannotUnwrap(Exception):
    """The unwrap was refused and nothing was changed."""


@dataclass
class Settings:
    """All options of the unwrap; an empty `uv_layer` is the active one.

    With `mark_seams` the seams that are found for it are marked on the meshes; `groups` count for these seams
    only.
    """

    uv_layer: str = ""
    mark_seams: bool = True
    groups: SeamGroups = field(default_factory=SeamGroups)
    mapping: bridge.UnwrapSettings = field(default_factory=bridge.UnwrapSettings)
    packing: PackSettings = field(default_factory=PackSettings)


@dataclass
class Report:
    """The number of mapped islands, their figures, and the islands that were left as they were.

    `seams` are those that were found for it, None where those of the meshes count.
    """

    islands: int
    figures: bridge.Figures | None
    seams: bridge.FoundSeams | None
    refusals: list[bridge.Refusal]
    notes: list[str]
    seconds: float

    def __str__(self) -> str:
        parts = [messages.count(self.islands, "island")]
        if self.seams is not None:
            parts.append(found_seams.length(self.seams))
        if self.figures is not None:
            parts += [
                f"area ratio SD {self.figures.deviation:.3g}",
                messages.count(self.figures.flips, "flip"),
                self._shear(self.figures),
            ]
        line = ", ".join([*parts, f"{self.seconds:.2f} s"])
        left = [f"left as it was: {messages.listed(self.refusals)}"] if self.refusals else []
        return "; ".join([line, *left, *self.notes])

    def _shear(self, figures: bridge.Figures) -> str:
        if self.seams is None:
            return f"angle distortion {figures.angle:.2f}"
        return found_seams.shear(figures.shear, self.seams)


def job(context: bpy.types.Context, settings: Settings) -> Job[bridge.Mapping, Report]:
    """A `Job` that unwraps what is selected; its `apply` writes the UVs and returns a `Report`.

    Raises `targets.NothingToDo`, `CannotUnwrap` or `seam_groups.NoGroup` before anything is computed.
    """
    started = time.perf_counter()
    selected_only = context.mode == "EDIT_MESH"
    objects, refusals = targets.editable(context)
    layers = [_layer(obj, settings.uv_layer) for obj in objects]
    read = [
        (obj, layer, meshes.read(obj, selected_only=selected_only, uv_layer=layer))
        for obj, layer in zip(objects, layers, strict=True)
    ]
    chosen = [entry for entry in read if len(entry[2].triangles)]
    if not chosen:
        raise targets.NothingToDo(_why_nothing(selected_only, refusals))
    surfaces = [surface for _, _, surface in chosen]
    if settings.mapping.seams is not None:
        seam_groups.check(objects, settings.groups)
        for obj, _, surface in chosen:
            seam_groups.apply(obj, surface, settings.groups)

    def work(progress: Progress) -> bridge.Mapping:
        return bridge.unwrap(surfaces, settings.mapping, progress)

    def finish(mapping: bridge.Mapping) -> Report:
        mapping.refusals[:0] = refusals
        _check_unchanged(chosen)
        unmapped = [obj.name for obj, _, _ in chosen if not uv_maps.names(obj)]
        figures = _write(chosen, mapping, settings)
        seconds = time.perf_counter() - started
        notes = messages.grouped(mapping.notes) + _notes(chosen, mapping.islands, figures)
        if {refusal.name for refusal in mapping.refusals} & set(unmapped):
            notes.append("on a mesh without a UV map, these lie in the lower left corner")
        if mapping.ended_early:
            notes.insert(0, messages.ENDED_EARLY)
        if mapping.seams is not None:
            notes[:0] = found_seams.notes(mapping.seams)
        return Report(len(mapping.islands), figures, mapping.seams, mapping.refusals, notes, seconds)

    return Job(work, finish)


def _layer(obj: MeshObject, wanted: str) -> str:
    layer = uv_maps.name_of(obj.data, wanted)
    if uv_maps.is_taken(obj, layer):
        raise CannotUnwrap(
            f'{obj.name} has an attribute or a vertex group "{layer}", which is no UV map; '
            "name another UV map or rename that"
        )
    if not uv_maps.has_room_for(obj.data, layer):
        raise CannotUnwrap(
            f'{obj.name} has {uv_maps.MAX_UV_LAYERS} UV maps, no room for "{layer}"; '
            "remove one or name one of them"
        )
    return layer


def _why_nothing(selected_only: bool, refusals: list[bridge.Refusal]) -> str:
    if refusals:
        return messages.listed(refusals)
    return "No faces are selected" if selected_only else "The selected objects have no faces"


def _check_unchanged(chosen: Sequence[Chosen]) -> None:
    """Meshes may have changed since they were read, where a window was alive meanwhile."""
    for obj, _, surface in chosen:
        if not meshes.has_corners(obj, len(surface.corner_vertex)):
            raise CannotUnwrap(f"{surface.name} has changed meanwhile; nothing was written")


def _write(chosen: Sequence[Chosen], mapping: bridge.Mapping, settings: Settings) -> bridge.Figures:
    """Packs the islands and writes them, after the last thing that can fail; returns their figures."""
    _place(mapping, settings.packing)
    parts = [_gather(mapping, index) for index in range(len(chosen))]
    figures = _figures(_measured(chosen, mapping), parts, mapping.islands)
    if figures is None:
        raise CannotUnwrap("No face has an area in the packed UVs; nothing was changed")
    marks = _marks(chosen, mapping) if settings.mark_seams else []
    for (obj, layer, _), (corners, uv) in zip(chosen, parts, strict=True):
        if len(corners):
            uv_maps.write(obj.data, uv_maps.ensure(obj.data, layer), corners, uv)
    for obj, numbers in marks:
        edges.mark_seams(obj.data, numbers)
    return figures


def _marks(chosen: Sequence[Chosen], mapping: bridge.Mapping) -> list[tuple[MeshObject, list[int]]]:
    """The objects with the edges to mark as seams; none where no seams were sought."""
    if mapping.seams is None:
        return []
    objects = [obj for obj, _, _ in chosen]
    try:
        return list(zip(objects, found_seams.marks(objects, mapping.seams), strict=True))
    except edges.NoEdge as problem:
        raise CannotUnwrap("The meshes have changed meanwhile; nothing was written") from problem


def _place(mapping: bridge.Mapping, settings: PackSettings) -> None:
    """Packs the islands; those that would fold over where they come to lie are refused."""
    for island in mapping.islands:
        if island.may_turn:
            island.uv = upright(island.uv)
    while mapping.islands:
        scale_to_one_density(mapping.islands)
        pack(mapping.islands, settings)
        if not all(np.isfinite(island.uv).all() for island in mapping.islands):
            raise CannotUnwrap("The packed UVs are not finite; nothing was changed")
        sound = [island for island in mapping.islands if not bridge.folds(island)]
        if len(sound) == len(mapping.islands):
            return
        kept = {id(island) for island in sound}
        folded = [island for island in mapping.islands if id(island) not in kept]
        mapping.refusals += [bridge.Refusal(island.name, island.polygon, _FOLDS) for island in folded]
        mapping.islands = sound
    raise CannotUnwrap(f"No island could be unwrapped: {messages.listed(mapping.refusals)}")


def _gather(mapping: bridge.Mapping, index: int) -> tuple[Integers, Singles]:
    """The corners (k,) to write of one surface, and their UVs (k, 2) as Blender will keep them.

    They are those of its islands, and those of islands without area, which lie in the lower left corner.
    """
    of_surface = [island for island in mapping.islands if island.surface == index]
    at_a_point = [corners for surface, corners in mapping.at_a_point if surface == index]
    corners = np.concatenate([np.empty(0, int), *(island.corners for island in of_surface), *at_a_point])
    uv = np.concatenate([np.empty((0, 2)), *(island.uv[island.corner_point] for island in of_surface)])
    return corners, np.pad(uv, ((0, len(corners) - len(uv)), (0, 0))).astype(np.float32)


def _measured(chosen: Sequence[Chosen], mapping: bridge.Mapping) -> list[Surface]:
    """The surfaces without polygons that are in no island."""
    surfaces = [surface for _, _, surface in chosen]
    for index, polygons in mapping.left_out.items():
        surfaces[index] = surfaces[index].without(polygons)
    return surfaces


def _figures(
    surfaces: Sequence[Surface], parts: Sequence[tuple[Integers, Singles]], islands: Sequence[bridge.Island]
) -> bridge.Figures | None:
    """The figures of what was mapped, by Blender's triangles where these are not those of the islands."""
    if not any(island.has_divided_polygons for island in islands):
        return bridge.measure_islands(islands)
    return bridge.measure([_mapped(surface, *uvs) for surface, uvs in zip(surfaces, parts, strict=True)])


def _mapped(surface: Surface, corners: Integers, uv: Singles) -> Surface:
    """The part of a surface that was mapped, with its new UVs."""
    values = np.full((len(surface.corner_vertex), 2), np.nan, np.float32)
    values[corners] = uv
    return surface.restricted(np.isfinite(values[surface.corners]).all(axis=(1, 2)), values)


def _notes(chosen: Sequence[Chosen], islands: Sequence[bridge.Island], figures: bridge.Figures) -> list[str]:
    """Remarks on UVs that were written but may not be as wanted."""
    short = [(island, island.shortfall) for island in islands if island.shortfall is not None]
    short.sort(key=lambda pair: -pair[1].deviation)
    notes = [f"{island.name} at face {island.polygon}: {shortfall}" for island, shortfall in short]
    if len(notes) > _NAMED:
        notes[_NAMED:] = [f"and {messages.count(len(notes) - _NAMED, 'island')} more"]
    turned = sum(len(island.turned) for island in islands)
    if turned:
        notes.append(
            f"{messages.count(turned, 'face')} with inconsistent normals mirrored, recalculate the normals"
        )
    if figures.flips:  # of no triangle of the solver's: those were checked
        notes.append("the flips are where Blender divides polygons in other ways; triangulate them")
    scaled = [obj.name for obj, _, _ in chosen if not meshes.has_uniform_scale(obj)]
    if scaled:
        notes.append(f"{messages.named(scaled)}: non-uniform scale, areas are those of the non-scaled mesh")
    return notes
