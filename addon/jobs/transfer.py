# SPDX-License-Identifier: GPL-3.0-or-later
"""The transfer of layers from the target to the active object, through their registration."""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from .. import bridge, messages
from ..blender import drivers, layers
from ..bridge.progress import Progress
from ..registration import elements, seams
from ..registration.registered import Registered
from ..registration.settings import Settings as RegistrationSettings
from ..registration.sides import is_open
from ..surfaces.arrays import Floats, Integers
from . import last_registration, register, targets
from .couple import CannotRegister, Couple, check_unchanged, chosen
from .job import Job
from .register_report import warnings

_PLURALS = {kind: f"{kind}s" for kind in (layers.UV_MAP, layers.GROUP, layers.COLOR, layers.KEY)}

Pulled = tuple[Registered, bool, list[tuple[Integers, Floats]]]
"""A registration, whether it is new, and for each layer elements and their values."""


@dataclass
class Settings:
    """The layers to transfer, and the registration; None is the latest, as the source remembers it."""

    uv_maps: bool = True
    active_uv_only: bool = False
    vertex_groups: bool = True
    colour_attributes: bool = True
    shape_keys: bool = True
    align: bool = False
    registration: RegistrationSettings | None = None


@dataclass
class Report:
    """The layers (kind, name) that were written, and refusals.

    `by` names the registration, `driven` the drivers of shape keys that were copied, or is "".
    """

    source: str
    target: str
    by: str
    written: list[tuple[str, str]]
    driven: str
    refusals: list[str]
    notes: list[str]
    seconds: float

    def __str__(self) -> str:
        kinds = dict.fromkeys(kind for kind, _ in self.written)
        parts = [_listed(kind, [layer[1] for layer in self.written if layer[0] == kind]) for kind in kinds]
        parts += [self.driven] if self.driven else []
        line = f"{', '.join(parts)} from {self.target} to {self.source} {self.by}, {self.seconds:.2f} s"
        left = [f"left out: {messages.listed(self.refusals)}"] if self.refusals else []
        return "; ".join([line, *left, *self.notes])


def job(context: bpy.types.Context, settings: Settings) -> Job[Pulled, Report]:
    """A `Job` that transfers to the active object; its `apply` writes the layers and returns a `Report`.

    Raises `targets.NothingToDo` or `CannotRegister` before anything is computed.
    """
    started = time.perf_counter()
    couple = chosen(context)
    items, refusals = layers.writable(couple.source, _read(couple, settings))
    if not items:
        raise _nothing(couple, refusals)
    last = _last(couple)
    to_world, from_world = np.array(couple.target.matrix_world)[:3, :3], couple.to_source[:3, :3]

    def work(progress: Progress) -> Pulled:
        registered, is_new = _registration(couple, settings.registration, last, progress)
        turn = _turn(registered, couple) if settings.align else np.identity(3)
        pulled = [_pulled(registered, item, from_world @ turn @ to_world) for item in items]
        return registered, is_new, pulled

    def finish(computed: Pulled) -> Report:
        registered, is_new, pulled = computed
        check_unchanged(couple)
        problems = [
            layers.write(couple.source, item, *values) for item, values in zip(items, pulled, strict=True)
        ]
        done = [item for item, problem in zip(items, problems, strict=True) if problem is None]
        notes = layers.relate(couple.source, done)
        keys = [item.name for item in done if item.kind == layers.KEY]
        driven = drivers.copy(couple.target, couple.source, keys)
        if settings.registration is not None:
            last_registration.remember(couple.source, settings.registration)
        left = refusals + [problem for problem in problems if problem is not None]
        if all(problems):
            raise _nothing(couple, left)
        return Report(
            source=couple.source.name,
            target=couple.target.name,
            by=_by(registered, is_new),
            written=[(item.kind, item.name) for item in done],
            driven=driven,
            refusals=left,
            notes=[*warnings(registered), *notes],
            seconds=time.perf_counter() - started,
        )

    return Job(work, finish)


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
    boundaries = any(is_open(side) for side in couple.sides)
    can = {"POINTS": bool(couple.pairs), "CURVES": bool(couple.curves) or boundaries}
    last = last_registration.settings(couple.source)
    if last is not None and can[last.method]:
        return last
    return RegistrationSettings(method=next((method for method in can if can[method]), "POINTS"))


def _by(registered: Registered, is_new: bool) -> str:
    """Which registration a transfer goes by, for the report."""
    curves = "landmark curves" if registered.names else "boundaries"
    by = f"by {curves if registered.by_curves else 'landmark points'}"
    return f"{by} (registered anew)" if is_new else by


def _turn(registered: Registered, couple: Couple) -> Floats:
    """The rotation and scale in the world that lay the target over the source."""
    ends = [bridge.morphed(registered, *couple.sides, align) for align in (False, True)]
    return elements.turn_and_scale(*ends)


def _pulled(registered: Registered, item: layers.Layer, to_source: Floats) -> tuple[Integers, Floats]:
    """The elements of the source's mesh (k,) and their values (k, d)."""
    source, target = registered.source, registered.target
    if not item.of_corners:
        values = bridge.pull(registered, elements.by_points(target, item.values), "vertex")
        vertices, values = elements.from_points(source, values)
        return vertices, values @ to_source.T if item.kind == layers.KEY else values
    values = bridge.pull(registered, elements.by_corners(target, item.values), "corner")
    if item.kind == layers.UV_MAP:
        values = seams.on_one_side(source, registered.places, values)
    return elements.from_corners(source, values)


def _listed(kind: str, names: list[str]) -> str:
    noun = kind if len(names) == 1 else _PLURALS[kind]
    return f"{len(names)} {noun} ({messages.listed(names)})"
