# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns over the flipped faces of a context's active UV maps: the one path of the operator and of scripts."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from .. import bridge, messages
from ..blender import meshes, uv_maps
from ..blender.types import MeshObject
from ..bridge.progress import Progress
from ..surfaces.surface import Surface
from . import targets
from .job import Job

Chosen = tuple[MeshObject, str, Surface]
"""An object, the name of its UV map, and its surface."""


class CannotFix(Exception):
    """No flipped face could be fixed; nothing was changed."""


@dataclass
class Report:
    """The report of a run: a `bridge.Unflipped`, refusals and notes."""

    result: bridge.Unflipped
    refusals: list[bridge.Refusal]
    notes: list[str]

    def __str__(self) -> str:
        left = [f"left as it was: {messages.listed(self.refusals)}"] if self.refusals else []
        return "; ".join([self._done(), *left, *self.notes])

    def _done(self) -> str:
        if not self.result.faces:
            return "No flipped faces"
        faces = messages.count(self.result.faces, "flipped face")
        islands = messages.count(self.result.islands, "island")
        return f"Fixed {faces} in {islands}; {messages.count(self.result.moved, 'UV')} moved"


def job(context: bpy.types.Context) -> Job[bridge.Unflipped, Report]:
    """A `Job` that fixes flipped faces in the active UV maps; its `apply` writes UVs and returns a `Report`.

    In edit mode of the selected faces only. Raises `targets.NothingToDo` before anything is computed.
    """
    selected_only = context.mode == "EDIT_MESH"
    objects, refusals = targets.editable(context)
    chosen = _chosen(objects, selected_only)
    if not chosen:
        raise targets.NothingToDo(_why_nothing(objects, selected_only, refusals))

    def work(progress: Progress) -> bridge.Unflipped:
        return bridge.fix_flips([surface for _, _, surface in chosen], progress)

    def finish(unflipped: bridge.Unflipped) -> Report:
        _check_unchanged(chosen)
        if unflipped.refusals and not unflipped.faces:
            raise CannotFix(f"No flipped face could be fixed: {messages.listed(unflipped.refusals)}")
        for index, corners, uv in unflipped.writes:
            obj, layer, _ = chosen[index]
            uv_maps.write(obj.data, layer, corners, uv)
        notes = [messages.ENDED_EARLY_FIXING] if unflipped.ended_early else []
        return Report(unflipped, [*refusals, *unflipped.refusals], notes)

    return Job(work, finish)


def _chosen(objects: Sequence[MeshObject], selected_only: bool) -> list[Chosen]:
    """(object, UV layer, surface) of those objects that have UVs and faces to look at."""
    layers = [(obj, layer) for obj in objects if (layer := uv_maps.active(obj))]
    read = [
        (obj, layer, meshes.read(obj, selected_only=selected_only, uv_layer=layer)) for obj, layer in layers
    ]
    return [entry for entry in read if len(entry[2].triangles)]


def _why_nothing(objects: Sequence[MeshObject], selected_only: bool, refusals: list[bridge.Refusal]) -> str:
    if refusals:
        return messages.listed(refusals)
    if not any(uv_maps.active(obj) for obj in objects):
        return "The selected objects have no UV map"
    return "No faces are selected" if selected_only else "The selected objects have no faces"


def _check_unchanged(chosen: Sequence[Chosen]) -> None:
    """Meshes may have changed since they were read, where a window was alive meanwhile."""
    for obj, layer, surface in chosen:
        is_there = meshes.has_corners(obj, len(surface.corner_vertex))
        if not is_there or not uv_maps.has(obj, layer):
            raise CannotFix(f"{surface.name} has changed meanwhile; nothing was written")
