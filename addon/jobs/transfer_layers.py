# SPDX-License-Identifier: GPL-3.0-or-later
"""The layers that one object gets from its target: read, carried through the registration, and written."""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .. import bridge, messages
from ..blender import animation, drivers, layers, vertex_groups
from ..bridge.progress import Progress
from ..registration import elements, offsets, seams, weights
from ..registration.registered import Registered
from ..registration.settings import Settings as RegistrationSettings
from ..registration.sides import is_open
from ..surfaces.arrays import Floats, Integers
from . import last_registration, register, targets
from .couple import CannotRegister, Couple, check_unchanged
from .register_report import warnings

_PLURALS = {kind: f"{kind}s" for kind in (layers.UV_MAP, layers.GROUP, layers.COLOR, layers.KEY)}
_COARSER = 2  # times as few triangles: a target whose facets would show


@dataclass
class Settings:
    """The layers to transfer, and the registration; None is the latest, as the source remembers it.

    `offsets` of shape keys turn and grow with the "SURFACE", or as the whole target is to "ALIGN", or keep
    direction and length in the "WORLD". `smooth` is "ON", "OFF" or "AUTO": where the target is coarser.
    """

    uv_maps: bool = True
    active_uv_only: bool = False
    vertex_groups: bool = True
    colour_attributes: bool = True
    shape_keys: bool = True
    offsets: str = "SURFACE"
    smooth: str = "AUTO"
    registration: RegistrationSettings | None = None


@dataclass
class Task:
    """What one object is to get: `items` of its target, `refusals` of others, `last` the registration.

    `sharing` names the groups of the target whose weights share out each vertex, `to_world` (4, 4) is the
    target's matrix, `started` the time at which the task was made.
    """

    couple: Couple
    settings: Settings
    items: list[layers.Layer]
    refusals: list[str]
    last: RegistrationSettings
    sharing: set[str]
    to_world: Floats
    started: float


@dataclass
class Carried:
    """A registration, whether it is new and its values smoothed; for each item elements and their values."""

    registered: Registered
    is_new: bool
    is_smooth: bool
    values: list[tuple[Integers, Floats]]


@dataclass
class Report:
    """The layers (kind, name) that were written, and refusals.

    `by` names the registration, `moved` the drivers and key frames of shape keys that were copied.
    """

    source: str
    target: str
    by: str
    written: list[tuple[str, str]]
    moved: list[str]
    refusals: list[str]
    notes: list[str]
    seconds: float

    def __str__(self) -> str:
        kinds = dict.fromkeys(kind for kind, _ in self.written)
        parts = [_listed(kind, [layer[1] for layer in self.written if layer[0] == kind]) for kind in kinds]
        parts += self.moved
        line = f"{', '.join(parts)} from {self.target} to {self.source} {self.by}, {self.seconds:.2f} s"
        left = [f"left out: {messages.listed(self.refusals)}"] if self.refusals else []
        return "; ".join([line, *left, *self.notes])


def prepared(couple: Couple, settings: Settings) -> Task:
    """The task of an object; raises `targets.NothingToDo` or `CannotRegister` where there is none."""
    started = time.perf_counter()
    items, refusals = layers.writable(couple.source, _read(couple, settings))
    if settings.shape_keys and (reason := layers.why_no_shape_keys(couple.target)):
        refusals.append(reason)
    if not items:
        raise _nothing(couple, refusals)
    return Task(
        couple=couple,
        settings=settings,
        items=items,
        refusals=refusals,
        last=_last(couple),
        sharing=vertex_groups.sharing(couple.target),
        to_world=np.array(couple.target.matrix_world),
        started=started,
    )


def carried(task: Task, progress: Progress) -> Carried:
    """The values that the object gets; raises `CannotRegister`. Touches no data of Blender."""
    registered, is_new = _registration(task.couple, task.settings.registration, task.last, progress)
    fewer = _COARSER * len(registered.target.faces) <= len(registered.source.faces)
    is_smooth = task.settings.smooth == "ON" or (task.settings.smooth == "AUTO" and fewer)
    by_vertex = iter(_by_vertex(task, registered, is_smooth))
    values = [
        _by_corner(registered, item, is_smooth) if item.of_corners else next(by_vertex) for item in task.items
    ]
    return Carried(registered, is_new, is_smooth, values)


def written(task: Task, carried_: Carried) -> Report:
    """Writes what was carried; raises `CannotRegister` if there is nothing to write, or nowhere any more."""
    couple, registered = task.couple, carried_.registered
    check_unchanged(couple)
    problems = [
        layers.write(couple.source, item, *values)
        for item, values in zip(task.items, carried_.values, strict=True)
    ]
    left = task.refusals + [problem for problem in problems if problem is not None]
    if all(problems):
        raise _nothing(couple, left)
    done = [item for item, problem in zip(task.items, problems, strict=True) if problem is None]
    notes = layers.relate(couple.source, done)
    keys = [item.name for item in done if item.kind == layers.KEY]
    driven, loose = drivers.copy(couple.target, couple.source, keys)
    framed, unframed = animation.copy(couple.target, couple.source, keys)
    if task.settings.registration is not None:
        last_registration.remember(couple.source, task.settings.registration)
    return Report(
        source=couple.source.name,
        target=couple.target.name,
        by=_by(carried_),
        written=[(item.kind, item.name) for item in done],
        moved=[phrase for phrase in (driven, framed) if phrase],
        refusals=left + loose + unframed,
        notes=[*warnings(registered), *notes, *_rests(couple)],
        seconds=time.perf_counter() - task.started,
    )


def _rests(couple: Couple) -> list[str]:
    """What is not matched on either side."""
    source, target = couple.sides
    return [
        *source.rest.in_words(source.name, "got nothing"),
        *target.rest.in_words(target.name, "gave nothing"),
    ]


def _read(couple: Couple, settings: Settings) -> list[layers.Layer]:
    """The target's layers that are wanted."""
    items = []
    if settings.uv_maps:
        items += layers.read_uv_maps(couple.target, settings.active_uv_only)
    if settings.vertex_groups:
        items += layers.read_vertex_groups(couple.target)
    if settings.colour_attributes:
        items += layers.read_color_attributes(couple.target)
    if settings.shape_keys:
        morphs = {register.key_name(obj) for obj in (couple.source, couple.target)}
        keys = layers.read_shape_keys(couple.target, but=morphs)
        items += [*_masks(couple, items, keys), *keys]
    return items


def _masks(couple: Couple, items: Sequence[layers.Layer], keys: Sequence[layers.Layer]) -> list[layers.Layer]:
    """The vertex groups that mask shape keys and that the source will not have otherwise."""
    there = {item.name for item in items if item.kind == layers.GROUP} | {*couple.source.vertex_groups.keys()}
    wanted = layers.masks(keys) - there
    if not wanted:
        return []
    return [group for group in layers.read_vertex_groups(couple.target) if group.name in wanted]


def _nothing(couple: Couple, refusals: list[str]) -> Exception:
    if refusals:
        return CannotRegister(messages.listed(refusals))
    return targets.NothingToDo(f"{couple.target.name} has no layers of the chosen kinds")


def _registration(
    couple: Couple, settings: RegistrationSettings | None, last: RegistrationSettings, progress: Progress
) -> tuple[Registered, bool]:
    """The registration with these settings, without any the latest of a method; and whether it is new.

    Where the session has none of the method, the last settings give it anew.
    """
    if settings is not None:
        return register.registration(couple, settings, progress), False
    registered = bridge.kept(*couple.sides, couple.pairs, couple.curves, last.method)
    if registered is not None:
        return registered, False
    return register.registration(couple, last, progress), True


def _last(couple: Couple) -> RegistrationSettings:
    """The settings of the last registration with the target, or a method for which there are landmarks."""
    boundaries = all(is_open(side) for side in couple.sides)
    last = last_registration.settings(couple.source)
    by_feature = last is not None and bool(last.that_count.feature)
    can = {"POINTS": bool(couple.pairs) or by_feature, "CURVES": bool(couple.curves) or boundaries}
    if last is not None and can[last.method]:
        return last
    return RegistrationSettings(method=next((method for method in can if can[method]), "POINTS"))


def _by(carried_: Carried) -> str:
    """Which registration a transfer goes by, and whether it is smooth, for the report."""
    registered = carried_.registered
    curves = "landmark curves" if registered.names else "boundaries"
    points = "landmark points" if registered.names else "a feature"
    by = f"by {curves if registered.by_curves else points}"
    by += ", smoothly" if carried_.is_smooth else ""
    return f"{by} (registered anew)" if carried_.is_new else by


def _by_vertex(task: Task, registered: Registered, is_smooth: bool) -> list[tuple[Integers, Floats]]:
    """For each layer by vertices the vertices of the source's mesh (k,) and their values (k, d)."""
    items = [item for item in task.items if not item.of_corners]
    if not items:
        return []
    given = elements.by_points(registered.target, np.concatenate([item.values for item in items], axis=1))
    ends = np.cumsum([item.values.shape[1] for item in items])[:-1]
    values = np.split(bridge.pull(registered, given, "vertex", is_smooth), ends, axis=1)
    if is_smooth:
        values = _in_bounds(task, registered, items, values)
    if any(item.kind == layers.KEY for item in items):
        turned = _offsets(task, registered)
        values = [
            turned(value) if item.kind == layers.KEY else value
            for item, value in zip(items, values, strict=True)
        ]
    return [elements.from_points(registered.source, value) for value in values]


def _in_bounds(
    task: Task, registered: Registered, items: Sequence[layers.Layer], values: Sequence[Floats]
) -> list[Floats]:
    """Smoothed values (u, d) within the range of their layers; weights that share out a vertex still do."""
    bounded = [
        value if item.kind == layers.KEY else weights.within(value, item.values)
        for item, value in zip(items, values, strict=True)
    ]
    shares = [
        number for number, item in enumerate(items) if item.kind == layers.GROUP and item.name in task.sharing
    ]
    if shares:
        given = np.sum([items[number].values for number in shares], axis=0)
        sums = bridge.pull(registered, elements.by_points(registered.target, given), "vertex")
        scaled = weights.with_sums([bounded[number] for number in shares], sums)
        for number, value in zip(shares, scaled, strict=True):
            bounded[number] = value
    return bounded


def _offsets(task: Task, registered: Registered) -> offsets.Turn:
    """How offsets of the target's shape keys (u, 3) become offsets of the source's."""
    couple = task.couple
    source, target = couple.sides
    if task.settings.offsets == "SURFACE":
        into = offsets.into_side(target, task.to_world)
        out = couple.to_source[:3, :3] @ source.matrix[:3, :3]
        return offsets.along_surface(out @ bridge.local_similarities(registered) @ into)
    turn = np.identity(3)
    if task.settings.offsets == "ALIGN":
        ends = [bridge.morphed(registered, source, target, align) for align in (False, True)]
        turn = elements.turn_and_scale(*ends)
    return offsets.everywhere(couple.to_source[:3, :3] @ turn @ task.to_world[:3, :3])


def _by_corner(registered: Registered, item: layers.Layer, is_smooth: bool) -> tuple[Integers, Floats]:
    """The corners of the source's mesh (k,) and their values (k, d).

    UV maps stay linear, as textures are on the target; so do colors that differ around a vertex.
    """
    given = elements.by_corners(registered.target, item.values)
    points = elements.joined(registered.target, given) if is_smooth and item.kind == layers.COLOR else None
    if points is not None:
        smooth = weights.within(bridge.pull(registered, points, "vertex", smooth=True), item.values)
        return elements.from_corners(registered.source, smooth[registered.source.faces])
    values = bridge.pull(registered, given, "corner")
    if item.kind == layers.UV_MAP:
        values = seams.on_one_side(registered.source, registered.places, values)
    return elements.from_corners(registered.source, values)


def _listed(kind: str, names: list[str]) -> str:
    noun = kind if len(names) == 1 else _PLURALS[kind]
    return f"{len(names)} {noun} ({messages.listed(names)})"
