# SPDX-License-Identifier: GPL-3.0-or-later
"""The measurement of a context's objects: figures of their active UV layers and a face attribute."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from .. import bridge, messages
from ..blender import editability, meshes, uv_maps
from ..blender.types import MeshObject
from ..surfaces.surface import Surface
from . import densities, targets
from .job import Job
from .targets import NothingToDo

ATTRIBUTE = "authalic_log2_area_ratio"

Chosen = tuple[MeshObject, Surface]


@dataclass
class Report:
    """The figures of some objects, and of what belongs to them what could not be written."""

    names: list[str]
    figures: bridge.Measurement
    notes: list[str]

    @property
    def sentence(self) -> str:
        """The figures in words."""
        return f"{messages.named(self.names)}: {in_words(self.figures)}"

    @property
    def numbers(self) -> list[str]:
        """A phrase for each figure."""
        return [*phrases(self.figures), _shares(self.figures)]

    def __str__(self) -> str:
        return "; ".join([self.sentence, ", ".join(self.numbers), *self.notes])


def job(context: bpy.types.Context, density_source: str = "") -> Job[bridge.Measurement | None, Report]:
    """A `Job` that measures the active UV layers; its `apply` writes the attribute, returns a `Report`.

    In edit mode the selected faces only. Areas are those in the world, and count by the density that a vertex
    group or color attribute asks for. Raises `NothingToDo` where no object has faces and UVs, and
    `densities.NoDensity`.
    """
    selected_only = context.mode == "EDIT_MESH"
    objects = targets.meshes(context)
    chosen = read(objects, density_source, selected_only=selected_only)
    if not chosen:
        raise NothingToDo(_why_nothing(objects, selected_only))
    surfaces = [surface for _, surface in chosen]

    def finish(figures: bridge.Measurement | None) -> Report:
        if figures is None:
            raise NothingToDo("No face has an area, or all UVs lie in one point")
        notes = _write(chosen, figures)
        return Report([obj.name for obj, _ in chosen], figures, notes)

    return Job(lambda progress: bridge.measure(surfaces), finish)


def read(objects: Sequence[MeshObject], density_source: str, *, selected_only: bool) -> list[Chosen]:
    """Those of some objects that have faces to measure, with their surfaces in the world."""
    densities.check(objects, density_source)
    layers = [(obj, layer) for obj in objects if (layer := uv_maps.active(obj))]
    chosen = [
        (obj, meshes.read(obj, selected_only=selected_only, uv_layer=layer, world=True))
        for obj, layer in layers
    ]
    for obj, surface in chosen:
        densities.apply(obj, surface, density_source)
    return [(obj, surface) for obj, surface in chosen if len(surface.triangles)]


def _why_nothing(objects: Sequence[MeshObject], selected_only: bool) -> str:
    if not any(uv_maps.active(obj) for obj in objects):
        return "The selected objects have no UV map"
    return "No faces are selected" if selected_only else "The selected objects have no faces"


def _write(chosen: Sequence[Chosen], figures: bridge.Measurement) -> list[str]:
    """Writes the attribute where a mesh can be written; returns remarks on the others."""
    notes = []
    for (obj, surface), log2 in zip(chosen, figures.log2, strict=True):
        reason = editability.why_not_mesh(obj)
        if reason is None:
            meshes.write_face_attribute(obj.data, ATTRIBUTE, log2, surface.polygons)
        else:
            notes.append(f"{obj.name} gets no attribute: {reason}")
    return [messages.listed(notes)] if notes else []


def in_words(figures: bridge.Measurement) -> str:
    """Whether the UV areas are as they should be."""
    said = [f"{_percent(figures.fair)} of faces within ±10 % of their share"]
    said.append(f"{figures.flipped} flipped" if figures.flipped else "none flipped")
    if figures.mirrored:
        said.append(messages.count(figures.mirrored, "mirrored island"))
    return ", ".join(said)


def phrases(figures: bridge.Figures) -> list[str]:
    """A phrase for each figure."""
    said = [
        f"area ratio mean {figures.mean:.3f}",
        f"area ratio SD {figures.deviation:.3g}",
        f"log2 area ratio {figures.log2_min:.2f} to {figures.log2_max:.2f}",
        messages.count(figures.flips, "flip"),
        f"angle distortion {figures.angle:.2f}",
    ]
    if figures.without_area:
        said.append(f"{messages.count(figures.without_area, 'triangle')} without area left out")
    return said


def _shares(figures: bridge.Measurement) -> str:
    least, most = figures.shares
    return f"faces get {least:.3g} to {most:.3g} of their share"


def _percent(part: float) -> str:
    """A part as percents; those of all faces but a few are never rounded up to all."""
    percent = round(100 * part)
    return f"{99 if percent == 100 and part < 1 else percent} %"
