# SPDX-License-Identifier: GPL-3.0-or-later
"""Marks seams on a context's meshes: the one path of the operator, of scripts and of the preview."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import bpy

from .. import bridge, messages
from ..blender import edges, meshes, selection
from ..blender.types import MeshObject
from ..bridge.progress import Progress
from ..surfaces.surface import Surface
from . import found_seams, seam_groups, targets
from .job import Job
from .seam_groups import SeamGroups

Chosen = tuple[MeshObject, Surface]
"""An object and its surface."""


class CannotMark(Exception):
    """No seams could be marked; nothing was changed."""


@dataclass
class Settings:
    """All options of marking.

    Seams of the meshes stay unless `clear` is set, which finds all seams anew.
    """

    groups: SeamGroups = field(default_factory=SeamGroups)
    clear: bool = False
    search: bridge.SeamSettings = field(default_factory=bridge.SeamSettings)


@dataclass
class Report:
    """The number of edges that were marked, what was found, and the islands that were left as they were."""

    edges: int
    found: bridge.FoundSeams
    refusals: list[bridge.Refusal]
    notes: list[str]
    seconds: float

    def __str__(self) -> str:
        left = [f"left as it was: {messages.listed(self.refusals)}"] if self.refusals else []
        return "; ".join([f"{self._done()}, {self.seconds:.2f} s", *left, *self.notes])

    def _done(self) -> str:
        return f"Marked {messages.count(self.edges, 'edge')}: {in_words(self.found)}"


def in_words(found: bridge.FoundSeams) -> str:
    """The figures of seams."""
    islands = messages.count(found.islands, "island")
    return f"{islands}, {found_seams.length(found)}, predicted {found_seams.shear(found.shear, found)}"


def job(context: bpy.types.Context, settings: Settings) -> Job[bridge.FoundSeams, Report]:
    """A `Job` that finds seams on what is selected; its `apply` marks them and returns a `Report`.

    In edit mode of the selected faces, or of all if none is selected. Raises `targets.NothingToDo` or
    `seam_groups.NoGroup` before anything is computed.
    """
    started = time.perf_counter()
    objects, refusals = targets.editable(context)
    chosen = _read(context, objects, settings)
    if not chosen:
        raise targets.NothingToDo(messages.listed(refusals) or "The selected objects have no faces")

    def finish(found: bridge.FoundSeams) -> Report:
        if found.refusals and not found.islands:
            raise CannotMark(f"No seams were found: {messages.listed(found.refusals)}")
        marked = _write(chosen, found, settings.clear)
        seconds = time.perf_counter() - started
        return Report(marked, found, [*refusals, *found.refusals], found_seams.notes(found), seconds)

    return Job(_work(chosen, settings), finish)


def preview(
    context: bpy.types.Context, settings: Settings
) -> Job[bridge.FoundSeams, tuple[list[str], bridge.FoundSeams]]:
    """A `Job` that finds quick seams on what `job` would work on; its `apply` changes nothing.

    It returns the names of the objects and what was found on all of them. Raises `seam_groups.NoGroup`.
    """
    objects, _ = targets.editable(context)
    chosen = _read(context, objects, settings)
    quick = replace(settings, search=replace(settings.search, is_draft=True))
    return Job(_work(chosen, quick), lambda found: ([surface.name for _, surface in chosen], found))


def _read(context: bpy.types.Context, objects: Sequence[MeshObject], settings: Settings) -> list[Chosen]:
    """The objects that have faces to cut, with their surfaces."""
    seam_groups.check(objects, settings.groups)
    selected_only = context.mode == "EDIT_MESH" and any(selection.has_faces(obj) for obj in objects)
    read = [(obj, meshes.read(obj, selected_only=selected_only)) for obj in objects]
    chosen = [(obj, surface) for obj, surface in read if len(surface.triangles)]
    for obj, surface in chosen:
        seam_groups.apply(obj, surface, settings.groups)
    return chosen


def _work(chosen: Sequence[Chosen], settings: Settings) -> Callable[[Progress], bridge.FoundSeams]:
    surfaces = [surface for _, surface in chosen]
    search = replace(settings.search, keep_given=not settings.clear)
    return lambda progress: bridge.find_seams(surfaces, search, progress)


def _write(chosen: Sequence[Chosen], found: bridge.FoundSeams, clear: bool) -> int:
    """Marks the seams, after the last thing that can fail; returns the number of edges."""
    for obj, surface in chosen:
        if not meshes.has_corners(obj, len(surface.corner_vertex)):
            raise CannotMark(f"{surface.name} has changed meanwhile; nothing was marked")
    refused = {refusal.name for refusal in found.refusals}
    try:
        marks = found_seams.marks([obj for obj, _ in chosen], found)
        old = [
            edges.edges_between(obj.data, found_seams.pairs_of(surface.seams))
            if clear and surface.name not in refused
            else []
            for obj, surface in chosen
        ]
    except edges.NoEdge as problem:
        raise CannotMark("The meshes have changed meanwhile; nothing was marked") from problem
    for (obj, _), new, cleared in zip(chosen, marks, old, strict=True):
        if new or cleared:
            edges.mark_seams(obj.data, new, cleared)
    return sum(len(new) for new in marks)
