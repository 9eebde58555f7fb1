# SPDX-License-Identifier: GPL-3.0-or-later
"""The sphere shape keys of a context's objects: the one path of the operator and of scripts."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import bpy

from .. import bridge, messages
from ..blender import meshes, shape_keys
from ..blender.types import MeshObject
from ..bridge.progress import Progress
from ..surfaces.surface import Surface
from . import targets
from .job import Job

NAME = "Authalic Sphere"

Shape = bridge.SphereShape | bridge.Refusal


class CannotMap(Exception):
    """No object could get a shape key; nothing was changed."""


@dataclass
class Settings:
    """All options."""

    solver: bridge.Solver = field(default_factory=bridge.Solver)


@dataclass
class Report:
    """(object name, `bridge.SphereShape`) for each key, and the objects that were left as they were."""

    shapes: list[tuple[str, bridge.SphereShape]]
    refusals: list[bridge.Refusal]
    notes: list[str]
    seconds: float

    def __str__(self) -> str:
        done = "; ".join(f"{NAME} on {name}: {_figures(shape)}" for name, shape in self.shapes)
        left = [f"left as it was: {messages.listed(self.refusals)}"] if self.refusals else []
        return "; ".join([f"{done}, {self.seconds:.2f} s", *left, *self.notes])


def job(context: bpy.types.Context, settings: Settings) -> Job[list[Shape], Report]:
    """A `Job` for the selected meshes; its `apply` writes the shape keys and returns a `Report`.

    Raises `targets.NothingToDo` or `CannotMap` before anything is computed.
    """
    started = time.perf_counter()
    objects, refusals = targets.editable(context)
    chosen = []
    for obj in objects:
        reason = _why_not(obj)
        if reason is None:
            chosen.append((obj, shape_keys.read(obj)))
        else:
            refusals.append(bridge.Refusal(obj.name, None, reason))
    if not chosen:
        raise CannotMap(messages.listed(refusals)) if refusals else targets.NothingToDo("No mesh is selected")

    def work(progress: Progress) -> list[Shape]:
        return _shapes([surface for _, surface in chosen], settings, progress)

    def finish(shapes: list[Shape]) -> Report:
        _check_unchanged(chosen)
        done = [
            (obj, shape)
            for (obj, _), shape in zip(chosen, shapes, strict=True)
            if not isinstance(shape, bridge.Refusal)
        ]
        refusals.extend(shape for shape in shapes if isinstance(shape, bridge.Refusal))
        if not done:
            raise CannotMap(messages.listed(refusals))
        for obj, shape in done:
            shape_keys.write(obj, NAME, shape.positions)
        named = [(obj.name, shape) for obj, shape in done]
        return Report(named, refusals, _notes(done), time.perf_counter() - started)

    return Job(work, finish)


def _check_unchanged(chosen: Sequence[tuple[MeshObject, Surface]]) -> None:
    """Meshes may have changed since they were read, where a window was alive meanwhile."""
    for obj, surface in chosen:
        is_there = meshes.has_corners(obj, len(surface.corner_vertex))
        if not is_there or len(obj.data.vertices) != len(surface.positions):
            raise CannotMap(f"{surface.name} has changed meanwhile; nothing was written")


def _why_not(obj: MeshObject) -> str | None:
    if not meshes.has_faces(obj):
        return "has no faces"
    return shape_keys.why_not(obj.data, NAME)


def _shapes(surfaces: Sequence[Surface], settings: Settings, progress: Progress) -> list[Shape]:
    """A `bridge.SphereShape` for each surface, or the `Refusal` that says why there is none."""
    shapes: list[Shape] = []
    total, before = sum(len(surface.triangles) for surface in surfaces), 0
    for surface in surfaces:
        start, share = before / total, len(surface.triangles) / total
        if progress(start, surface.name) is False:
            shapes.append(bridge.Refusal(surface.name, None, "was not reached before the end"))
        else:
            shapes.append(_shape(surface, settings, _part(progress, start, share)))
        before += len(surface.triangles)
    return shapes


def _shape(surface: Surface, settings: Settings, progress: Progress) -> Shape:
    try:
        return bridge.sphere_shape(surface, settings.solver, progress)
    except bridge.Unsuitable as reason:
        return bridge.Refusal(surface.name, None, str(reason))


def _part(progress: Progress, start: float, share: float) -> Progress:
    return lambda fraction, message: progress(start + share * fraction, message)


def _figures(shape: bridge.SphereShape) -> str:
    flips = messages.count(shape.flips, "flip")
    return (
        f"area ratio SD {shape.deviation:.3g}, {flips}, angle distortion {shape.angle:.2f}, "
        f"radius {shape.radius:.3g}"
    )


def _notes(done: Sequence[tuple[MeshObject, bridge.SphereShape]]) -> list[str]:
    """Remarks on keys that were written but may not be as wanted."""
    early = [messages.ENDED_EARLY] if any(shape.ended_early for _, shape in done) else []
    notes = [f"{obj.name}: {shape.shortfall}" for obj, shape in done if shape.shortfall is not None]
    scaled = [
        f"{obj.name}: non-uniform scale, the sphere is that of the non-scaled mesh"
        for obj, _ in done
        if not meshes.has_uniform_scale(obj)
    ]
    shared = [
        f"{obj.name} shares its mesh, all {obj.data.users} users have the key"
        for obj, _ in done
        if obj.data.users > 1
    ]
    return [*early, *notes, *scaled, *shared]
