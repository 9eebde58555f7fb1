# SPDX-License-Identifier: GPL-3.0-or-later
"""The unwrap from a context's objects to their UV layers: the one path of the operator and of scripts."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import bpy

from .. import bridge, messages
from ..blender import edges, meshes, selection, uv_maps
from ..blender.types import MeshObject
from ..bridge.progress import Progress, share_of
from ..surfaces.surface import Surface
from . import densities, found_seams, reported, seam_groups, targets
from .job import Job
from .seam_groups import SeamGroups

_NAMED = 3
_NO_ROOM = "A margin of {:.3g} of the UV map on every side leaves no room for islands; it must be below 0.5"
# The part of the time that the maps take; packing takes the rest.
_MAPS = 0.9

Chosen = tuple[MeshObject, str, Surface]
"""An object, the name of its UV map, and its surface."""


class CannotUnwrap(Exception):
    """The unwrap was refused and nothing was changed; `refusals` are those of islands."""

    def __init__(self, reason: str, refusals: Sequence[bridge.Refusal] = ()) -> None:
        super().__init__(reason)
        self.refusals = refusals


@dataclass
class Settings:
    """All options of the unwrap; an empty `uv_layer` is the active one.

    With `mark_seams` the seams that are found for it are marked on the meshes; `groups` count for these seams
    only. `density_source` is the vertex group or color attribute that says where more texture is wanted.
    With `subdivided` areas are those of the Subdivision Surface modifier.
    """

    uv_layer: str = ""
    mark_seams: bool = True
    groups: SeamGroups = field(default_factory=SeamGroups)
    density_source: str = ""
    subdivided: bool = False
    mapping: bridge.UnwrapSettings = field(default_factory=bridge.UnwrapSettings)
    placement: bridge.PlacementSettings = field(default_factory=bridge.PlacementSettings)


@dataclass
class Report:
    """The number of mapped islands, their figures, and the islands that were left as they were.

    `seams` are those that were found for it, None where those of the meshes count. `places` are the islands
    that are not as good as they should be, worst first.
    """

    islands: int
    figures: bridge.Figures | None
    seams: bridge.FoundSeams | None
    refusals: list[bridge.Refusal]
    notes: list[str]
    seconds: float
    places: list[reported.Place] = field(default_factory=list)

    def __str__(self) -> str:
        parts = [messages.count(self.islands, "island")]
        if self.seams is not None:
            parts.append(found_seams.length(self.seams))
        if self.figures is not None:
            parts += [
                f"area ratio SD {self.figures.deviation:.3g}",
                f"shares {2**self.figures.log2_min:.2g} to {2**self.figures.log2_max:.2g}",
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


def job(
    context: bpy.types.Context, settings: Settings, only: MeshObject | None = None
) -> Job[tuple[bridge.Mapping, bridge.Placed], Report]:
    """A `Job` that unwraps what is selected; its `apply` writes the UVs and returns a `Report`.

    With `only` it is this object that is unwrapped, whatever is selected.

    Raises `targets.NothingToDo`, `CannotUnwrap`, `seam_groups.NoGroup` or `densities.NoDensity` before
    anything is computed.
    """
    started = time.perf_counter()
    placement = settings.placement
    if placement.margin_method == "FRACTION" and placement.margin >= 0.5:
        raise CannotUnwrap(_NO_ROOM.format(placement.margin))
    objects, refusals = targets.editable(context, only)
    layers = [_layer(obj, settings.uv_layer) for obj in objects]
    read = [
        (obj, layer, _read(context, obj, layer, settings)) for obj, layer in zip(objects, layers, strict=True)
    ]
    chosen = [entry for entry in read if len(entry[2].triangles)]
    if not chosen:
        raise targets.NothingToDo(_why_nothing(context.mode == "EDIT_MESH", refusals))
    surfaces = [surface for _, _, surface in chosen]
    densities.check(objects, settings.density_source)
    for obj, _, surface in chosen:
        densities.apply(obj, surface, settings.density_source)
    if settings.mapping.seams is not None:
        seam_groups.check(objects, settings.groups)
        for obj, _, surface in chosen:
            seam_groups.apply(obj, surface, settings.groups)

    def work(progress: Progress) -> tuple[bridge.Mapping, bridge.Placed]:
        mapping = bridge.unwrap(surfaces, settings.mapping, share_of(progress, 0.0, _MAPS))
        mapping.refusals[:0] = refusals
        try:
            rest = share_of(progress, _MAPS, 1.0 - _MAPS)
            return mapping, bridge.place(mapping, surfaces, settings.placement, rest)
        except bridge.Unsuitable as problem:
            raise CannotUnwrap(str(problem), mapping.refusals) from problem

    def finish(result: tuple[bridge.Mapping, bridge.Placed]) -> Report:
        mapping, placed = result
        figures = placed.figures
        _check_unchanged(chosen)
        unmapped = [obj.name for obj, _, _ in chosen if not uv_maps.names(obj)]
        _write(chosen, mapping, placed, settings)
        seconds = time.perf_counter() - started
        places = reported.of_islands(surfaces, mapping.islands)
        notes = messages.grouped(mapping.notes) + _notes(mapping.islands, figures)
        if {refusal.name for refusal in mapping.refusals} & set(unmapped):
            notes.append("on a mesh without a UV map, these lie in the lower left corner")
        if mapping.ended_early:
            notes.insert(0, messages.ENDED_EARLY)
        if mapping.seams is not None:
            notes[:0] = found_seams.notes(mapping.seams)
        return Report(len(mapping.islands), figures, mapping.seams, mapping.refusals, notes, seconds, places)

    return Job(work, finish)


def _read(context: bpy.types.Context, obj: MeshObject, layer: str, settings: Settings) -> Surface:
    """The surface of an object, in edit mode of its selected faces, with the UVs that it has by now."""
    return meshes.read(
        obj,
        selected_only=context.mode == "EDIT_MESH",
        uv_selection=selection.counts_in_uvs(context, obj),
        # a new UV map begins as a copy of the active one
        uv_layer=layer if uv_maps.has(obj, layer) else uv_maps.active(obj),
        world=True,
        subdivided=settings.subdivided,
    )


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


def _write(
    chosen: Sequence[Chosen], mapping: bridge.Mapping, placed: bridge.Placed, settings: Settings
) -> None:
    """Writes the islands, and the seams that were found for them, after the last thing that can fail."""
    marks = _marks(chosen, mapping) if settings.mark_seams else []
    for (obj, layer, _), (corners, uv) in zip(chosen, placed.parts, strict=True):
        if len(corners):
            uv_maps.write(obj.data, uv_maps.ensure(obj.data, layer), corners, uv)
    for obj, numbers in marks:
        edges.mark_seams(obj.data, numbers)


def _marks(chosen: Sequence[Chosen], mapping: bridge.Mapping) -> list[tuple[MeshObject, list[int]]]:
    """The objects with the edges to mark as seams; none where no seams were sought."""
    if mapping.seams is None:
        return []
    objects = [obj for obj, _, _ in chosen]
    try:
        return list(zip(objects, found_seams.marks(objects, mapping.seams), strict=True))
    except edges.NoEdge as problem:
        raise CannotUnwrap("The meshes have changed meanwhile; nothing was written") from problem


def _notes(islands: Sequence[bridge.Island], figures: bridge.Figures) -> list[str]:
    """Remarks on UVs that were written but may not be as wanted."""
    short = [(island, island.shortfall) for island in islands if island.shortfall is not None]
    short.sort(key=lambda pair: -pair[1].severity)
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
    return notes
