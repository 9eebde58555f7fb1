# SPDX-License-Identifier: GPL-3.0-or-later
"""The registration of the active object onto its target: the one path of the operator and of scripts."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import bpy
import numpy as np

from .. import bridge, messages
from ..blender import animation, editability, meshes, shape_keys, uv_maps
from ..blender.appearance import deformers
from ..blender.types import Landmark, LandmarkCurve, MeshObject
from ..bridge.progress import Progress
from ..overlay.preview import Preview
from ..registration import elements, wires
from ..registration.registered import Registered
from ..registration.settings import Settings as RegistrationSettings
from ..registration.sides import Side, moved
from ..surfaces.arrays import Floats, Integers
from . import last_registration, reversed_curves, unjoined
from .couple import CannotRegister, Couple, check_unchanged, chosen, pair_lists
from .job import Job, Latest
from .register_report import Report, warnings

UV_MAP = "Authalic Registered"
STRAIN = "authalic_strain"
_PREFIX = "Morph → "
_NAME_BYTES = 63


@dataclass
class Settings:
    """All options; `frames` (first, last) of the key-framed morph, or None.

    `followers` says how pieces that are not matched follow: "RIGID", "BEND", or by their size, "AUTO".
    """

    registration: RegistrationSettings = field(default_factory=RegistrationSettings)
    align: bool = False
    target_uv: bool = False
    strain_attribute: bool = False
    frames: tuple[int, int] | None = None
    followers: str = "AUTO"


def job(context: bpy.types.Context, settings: Settings) -> Job[tuple[Registered, Floats], Report]:
    """A `Job` that registers the active object; its `apply` writes the shape key and returns a `Report`.

    Raises `CannotRegister` before anything is computed.
    """
    started = time.perf_counter()
    if settings.frames is not None and settings.frames[0] >= settings.frames[1]:
        raise CannotRegister(f"The morph has to end after frame {settings.frames[0]}, where it starts")
    couple = chosen(context, settings.registration.feature)
    couple.landmarks(settings.registration.method)
    couple.check_feature(settings.registration)
    key = key_name(couple.target)
    reason = shape_keys.why_not(couple.source.data, key)
    if reason is None and settings.frames is not None:
        reason = animation.why_not(couple.source)
    if reason is not None:
        raise CannotRegister(f"{couple.source.name}: {reason}")

    shown: Latest[Floats] = Latest()
    edges = wires.between_polygons(couple.sides[0])

    def preview() -> Preview | None:
        images = shown.take()
        return None if images is None else _preview(couple, images, edges, settings.align)

    def work(progress: Progress) -> tuple[Registered, Floats]:
        registered = registration(couple, settings.registration, progress, shown.put)
        return registered, _positions(couple, registered, settings)

    def finish(computed: tuple[Registered, Floats]) -> Report:
        registered, positions = computed
        check_unchanged(couple)
        shape_keys.write(couple.source, key, positions)
        notes = _write_uv_maps(couple, registered, settings.target_uv)
        if settings.strain_attribute:
            strain = elements.by_polygons(registered.source, bridge.strain(registered))
            meshes.write_face_attribute(couple.source.data, STRAIN, strain, registered.source.polygons)
        points, curves = pair_lists(couple.source)
        listed: Sequence[Landmark | LandmarkCurve] = curves if registered.by_curves else points
        for landmark, error in zip(listed, registered.errors.tolist(), strict=True):
            landmark.error = 100 * error
        last_registration.remember(couple.source, settings.registration)
        if settings.frames is not None:
            animation.rise(couple.source, key, *settings.frames)
        notes = [*warnings(registered), *notes, *_remarks(couple, key)]
        return Report(key, registered, notes, time.perf_counter() - started, _facts(couple, registered))

    return Job(work, finish, preview=preview)


def registration(
    couple: Couple,
    settings: RegistrationSettings,
    progress: Progress,
    preview: bridge.Preview | None = None,
) -> Registered:
    """The registration of a `Couple`; raises `CannotRegister`."""
    couple.check_feature(settings)
    try:
        registered = bridge.register(
            *couple.sides,
            couple.landmarks(settings.method),
            settings,
            progress,
            pulls=couple.pulls,
            preview=preview,
        )
    except bridge.MirroredCurves as reason:
        reversed_curves.remember(couple.sides[0].name, couple.curves)
        raise CannotRegister(str(reason)) from reason
    except bridge.UnjoinedSide as reason:
        unjoined.remember(reason.name)
        raise CannotRegister(str(reason)) from reason
    except bridge.Unsuitable as reason:
        raise CannotRegister(str(reason)) from reason
    if registered.by_curves:
        reversed_curves.remember(couple.sides[0].name, [couple.curves[k] for k in registered.backward])
    return registered


def key_name(target: MeshObject) -> str:
    """The name of the shape key that morphs into a target."""
    return (_PREFIX + target.name).encode()[:_NAME_BYTES].decode(errors="ignore")


def _preview(couple: Couple, images: Floats, edges: Integers, align: bool) -> Preview:
    """The source's points (u, 3) as they lie on the target by now, where the morph would end."""
    source, target = couple.sides
    if align:
        turn = elements.turn_and_scale(images, source.points)
        images = (images - images.mean(axis=0)) @ turn.T + source.points.mean(axis=0)
    points = moved(images, source.matrix if align else target.matrix)
    return Preview(couple.source.name, points, edges)


def _positions(couple: Couple, registered: Registered, settings: Settings) -> Floats:
    """All vertices (n, 3) of the source's mesh where the morph ends."""
    positions, vertices = couple.surfaces[0].positions.copy(), registered.source.vertices
    images = moved(bridge.morphed(registered, *couple.sides, settings.align), couple.to_source)
    positions[vertices[vertices >= 0]] = images[vertices >= 0]
    following = bridge.followed(registered, *couple.sides, settings.align, settings.followers)
    positions[couple.sides[0].rest.followers[0]] = moved(following, couple.to_source)
    if not np.isfinite(positions.astype(np.float32)).all():
        raise CannotRegister("The morph is not finite; nothing was changed")
    return positions


def _write_uv_maps(couple: Couple, registered: Registered, on_target: bool) -> list[str]:
    """For disks: writes the maps under which both surfaces coincide as UV maps that do not become active."""
    if registered.domain != "DISK":
        return []
    wanted = [(couple.source, registered.source, registered.places[:, :2])]
    if on_target:
        wanted.append((couple.target, registered.target, registered.target_places[:, :2]))
    return [note for note in (_write_uv_map(*layer) for layer in wanted) if note is not None]


def _write_uv_map(obj: MeshObject, side: Side, plane: Floats) -> str | None:
    """Writes a UV map in which the unit disk fills the square; returns why not, or None."""
    mesh = obj.data
    if reason := editability.why_not_mesh(obj):
        return f"{obj.name} has no UV map, because {reason}"
    if uv_maps.is_taken(obj, UV_MAP) or not uv_maps.has_room_for(mesh, UV_MAP):
        return f"{obj.name} has no room for the UV map {UV_MAP}; remove one or rename what has its name"
    real = side.corners >= 0
    uv = 0.5 + 0.5 * plane[side.faces[real]]
    with uv_maps.active_stays(mesh, UV_MAP):
        uv_maps.ensure(mesh, UV_MAP)
        uv_maps.write(mesh, UV_MAP, side.corners[real], uv.astype(np.float32))
    return None


def _facts(couple: Couple, registered: Registered) -> list[str]:
    """What came of other pieces, masks and holes."""
    source, target = couple.sides
    followed, left = (
        source.rest.in_words(source.name, "followed"),
        target.rest.in_words(target.name, "left out"),
    )
    loose = len(source.rest.loose)
    if loose:
        followed.append(f"{messages.count(loose, 'loose vertex')} of {source.name} followed")
    return [*registered.filled, *followed, *left]


def _remarks(couple: Couple, key: str) -> list[str]:
    """Which other objects are affected, and which modifiers and shape keys were ignored."""
    users = couple.source.data.users
    notes = [f"{couple.source.name} shares its mesh, all {users} users have the key"] if users > 1 else []
    for obj in (couple.source, couple.target):
        if ignored := deformers(obj, but=key if obj == couple.source else None):
            verb, them = ("was", "it") if len(ignored) == 1 else ("were", "them")
            notes.append(
                f"{obj.name}: {messages.listed(ignored)} {verb} ignored; apply {them} first to include {them}"
            )
    return notes
