# SPDX-License-Identifier: GPL-3.0-or-later
"""The registration of the active object onto its target: the one path of the operator and of scripts."""

import time
from dataclasses import dataclass, field

import numpy as np

from .. import bridge, messages
from ..blender import animation, shape_keys
from ..blender import meshes as mesh_io
from ..landmarks import curves as landmark_curves
from ..landmarks import points as landmarks
from ..registration import points as registering
from .job import Job

UV_MAP = "Authalic Registered"
_PREFIX = "Morph → "
_NAME_BYTES = 63
_MIRRORED = 3  # so many landmarks on a disk tell front from back
_UNMOVED = 1e-6  # values of shape keys that change nothing
# Modifiers that leave the shape of a mesh as it is.
_SHAPELESS = {"COLLISION", "DATA_TRANSFER", "NORMAL_EDIT", "PARTICLE_SYSTEM", "WEIGHTED_NORMAL"} | {
    *("UV_PROJECT", "UV_WARP", "VERTEX_WEIGHT_EDIT", "VERTEX_WEIGHT_MIX", "VERTEX_WEIGHT_PROXIMITY")
}


class CannotRegister(Exception):
    """There is no registration, or nowhere to write it; nothing was changed."""


@dataclass
class Settings:
    """All options; `frames` (first, last) of the key-framed morph, or None."""

    registration: registering.Settings = field(default_factory=registering.Settings)
    align: bool = False
    target_uv: bool = False
    frames: tuple[int, int] | None = None


@dataclass
class Couple:
    """The two objects, both surfaces as they were read and as sides of a registration, and the landmarks.

    `pairs` are those of points, `curves` those of curves, `problems` for either method what is wrong with its
    pairs. `to_source` is the matrix (4, 4) from the world into the source's space.
    """

    source: object
    target: object
    surfaces: list
    sides: list
    pairs: list
    curves: list
    problems: dict
    to_source: np.ndarray

    def landmarks(self, method):
        """The pairs that a method goes by. Raises `CannotRegister` where they are not sound."""
        if self.problems[method]:
            raise CannotRegister(messages.listed(self.problems[method]))
        return self.pairs if method == "POINTS" else self.curves


@dataclass
class Report:
    """What was written: the shape key's name and figures of the registration."""

    key: str
    registered: registering.Registered
    notes: list
    seconds: float
    refusals: tuple = ()

    def __str__(self):
        one = self.registered
        figures = _figures_of_curves(one) if one.by_curves else _figures_of_points(one)
        ending = [one.status.replace("_", " "), f"{self.seconds:.2f} s"]
        line = ", ".join([*figures, *ending])
        return "; ".join([f"{self.key} on {one.source.name}: {line}", *self.notes])


def job(context, settings):
    """A `Job` that registers the active object; its `apply` writes the shape key and returns a `Report`.

    Raises `CannotRegister` before anything is computed.
    """
    started = time.perf_counter()
    if settings.frames is not None and settings.frames[0] >= settings.frames[1]:
        raise CannotRegister(f"The morph has to end after frame {settings.frames[0]}, where it starts")
    couple = chosen(context)
    couple.landmarks(settings.registration.method)
    key = key_name(couple.target)
    reason = shape_keys.why_not(couple.source.data, key)
    if reason is not None:
        raise CannotRegister(f"{couple.source.name}: {reason}")

    def work(progress):
        registered = registration(couple, settings.registration, progress)
        return registered, _positions(couple, registered, settings.align)

    def finish(found):
        registered, positions = found
        check_unchanged(couple)
        shape_keys.write(couple.source, key, positions)
        notes = _write_uv_maps(couple, registered, settings.target_uv)
        listed = _listed(couple.source)[1 if registered.by_curves else 0]
        for landmark, error in zip(listed, registered.errors.tolist(), strict=True):
            landmark.error = 100 * error
        couple.source.authalic_registered_by = registered.method
        if settings.frames is not None:
            animation.rise(couple.source, key, *settings.frames)
        notes = [*warnings(registered), *notes, *_remarks(couple, key)]
        return Report(key, registered, notes, time.perf_counter() - started)

    return Job(work, finish)


def chosen(context):
    """The `Couple` of the active object and its target; raises `CannotRegister` where there is none."""
    source = landmarks.source(context)
    if source is None or source.type != "MESH":
        raise CannotRegister("The active object is no mesh")
    problem = landmarks.target_problem(source)
    if problem:
        raise CannotRegister(f"{source.name}: {problem}")
    target = source.authalic_target
    objects = [source, target]
    for obj in objects:
        _check(obj)
    if source.data.library is not None:
        raise CannotRegister(f"{source.name}: its mesh is linked from another file; make it local")
    surfaces = [shape_keys.read(obj) for obj in objects]
    matrices = [np.array(obj.matrix_world) for obj in objects]
    points, curves = landmarks.pairs(source), landmark_curves.pairs(source)
    return Couple(
        source=source,
        target=target,
        surfaces=surfaces,
        sides=[registering.side(*part) for part in zip(surfaces, matrices, strict=True)],
        pairs=[pair[:3] for pair in points],
        curves=[(curve.name, curve.source.vertices, curve.target.vertices) for curve in curves],
        problems={"POINTS": _problems("Landmark", points), "CURVES": _problems("Curve", curves)},
        to_source=np.linalg.inv(matrices[0]),
    )


def registration(couple, settings, progress):
    """The registration of a `Couple`; raises `CannotRegister`."""
    try:
        return bridge.register(*couple.sides, couple.landmarks(settings.method), settings, progress)
    except bridge.Unsuitable as reason:
        raise CannotRegister(str(reason)) from reason


def key_name(target):
    """The name of the shape key that morphs into a target."""
    return (_PREFIX + target.name).encode()[:_NAME_BYTES].decode(errors="ignore")


def check_unchanged(couple):
    """Meshes and landmarks may have changed since they were read, where a window was alive meanwhile."""
    for obj, surface in zip((couple.source, couple.target), couple.surfaces, strict=True):
        is_there = mesh_io.has_corners(obj, len(surface.corner_vertex))
        if not is_there or len(obj.data.vertices) != len(surface.positions):
            raise CannotRegister(f"{surface.name} has changed meanwhile; nothing was written")
    counts = [len(couple.pairs), len(couple.curves)]
    if [len(listed) for listed in _listed(couple.source)] != counts:
        raise CannotRegister("The landmarks have changed meanwhile; nothing was written")


def _listed(source):
    """The lists of points and of curves."""
    return source.authalic_landmarks, source.authalic_landmark_curves


def _check(obj):
    if obj.data.is_editmode:
        raise CannotRegister(f"{obj.name} is in Edit Mode; leave that first")
    if len(obj.data.polygons) == 0:
        raise CannotRegister(f"{obj.name} has no faces")
    scale = np.abs(np.linalg.svd(np.array(obj.matrix_world)[:3, :3], compute_uv=False))
    if not scale.min() > 1e-9 * scale.max():
        raise CannotRegister(f"{obj.name} is scaled to nothing along an axis; clear its scale")


def _problems(kind, pairs):
    return [f'{kind} "{pair.name}": {pair.problem}' for pair in pairs if pair.problem]


def _positions(couple, registered, align):
    """All vertices (n, 3) of the source's mesh where the morph ends; loose ones stay."""
    positions, own = couple.surfaces[0].positions.copy(), registered.source.vertices
    images = registering.moved(bridge.morphed(registered, *couple.sides, align), couple.to_source)
    positions[own[own >= 0]] = images[own >= 0]
    if not np.isfinite(positions.astype(np.float32)).all():
        raise CannotRegister("The morph is not finite; nothing was changed")
    return positions


def _write_uv_maps(couple, registered, on_target):
    """Disks: the maps under which both surfaces coincide, as UV maps that do not become active ones."""
    if registered.domain != "DISK":
        return []
    wanted = [(couple.source, registered.source, registered.places[:, :2])]
    if on_target:
        wanted.append((couple.target, registered.target, registered.target_places[:, :2]))
    return [note for note in (_write_uv_map(*part) for part in wanted) if note is not None]


def _write_uv_map(obj, side, plane):
    """Writes one, the unit disk filling the square; returns why not, or None."""
    mesh = obj.data
    if mesh.library is not None:
        return f"{obj.name} has no UV map, its mesh is linked from another file"
    if mesh_io.is_taken(obj, UV_MAP) or not mesh_io.has_room_for(mesh, UV_MAP):
        return f"{obj.name} has no room for the UV map {UV_MAP}; remove one or rename what has its name"
    before = mesh.uv_layers.active.name if mesh.uv_layers.active else UV_MAP
    mesh_io.ensure_layer(mesh, UV_MAP)
    real = side.corners >= 0
    uv = 0.5 + 0.5 * plane[side.faces[real]]
    mesh_io.write_uv(mesh, UV_MAP, side.corners[real], uv.astype(np.float32))
    mesh.uv_layers.active = mesh.uv_layers[before]
    return None


def warnings(registered):
    """What is not as it was asked for."""
    early = messages.ENDED_EARLY_BY_CURVES if registered.by_curves else messages.ENDED_EARLY
    notes = [early] if registered.ended_early else []
    if registered.missed and registered.by_curves and not registered.ended_early:
        notes.append(f"curves that do not meet: {messages.listed(registered.missed)}")
    elif registered.missed and not registered.ended_early:
        notes.append(f"pairs that do not meet without a fold: {messages.listed(registered.missed)}")
        if registered.domain == "DISK" and len(registered.names) >= _MIRRORED:
            notes.append("if most do not, the normals of the two may face opposite ways: flip those of one")
    return [*notes, *registered.remarks]


def _figures_of_points(one):
    mean, most = 100 * one.errors.mean(), 100 * one.errors.max()
    error = f"landmark error mean {mean:.3f} % and max {most:.3f} % of the size of {one.target.name}"
    return [
        messages.count(len(one.names), "landmark pair"),
        f"{error}{_worst(one)}",
        messages.count(one.folds, "fold"),
        f"authalic energy {one.energy:.3g}",
    ]


def _figures_of_curves(one):
    most = 100 * one.errors.max(initial=0)
    error = f"curve error max {most:.3f} % of the size of {one.target.name}{_worst(one)}"
    return [
        messages.count(len(one.names), "landmark curve") if one.names else "boundaries alone",
        *([error] if one.names else []),
        messages.count(one.folds, "fold"),
    ]


def _worst(registered):
    """The pairs that end furthest from each other, for a report."""
    named = [f'"{name}" {100 * error:.3f} %' for name, error in registered.worst]
    return f", worst at {messages.listed(named)}" if named else ""


def _remarks(couple, key):
    """What else is affected, and what is seen of the two that was not registered."""
    users = couple.source.data.users
    notes = [f"{couple.source.name} shares its mesh, all {users} users have the key"] if users > 1 else []
    for obj in (couple.source, couple.target):
        if ignored := _ignored(obj, but=key if obj == couple.source else None):
            notes.append(
                f"{obj.name} was registered without {messages.listed(ignored)}, which it is seen with; apply "
                "what is to count first"
            )
    return notes


def _ignored(obj, but):
    """The modifiers and shape keys, but the one of a name, that make an object look unlike its mesh."""
    blocks = obj.data.shape_keys.key_blocks[1:] if obj.data.shape_keys else ()
    shown = [key for key in blocks if key.name != but and not key.mute and abs(key.value) > _UNMOVED]
    shaping = [one for one in obj.modifiers if one.show_viewport and one.type not in _SHAPELESS]
    return [
        *(f'shape key "{key.name}"' for key in shown),
        *(f'modifier "{one.name}"' for one in shaping if not _smooths_only(one)),
    ]


def _smooths_only(modifier):
    """Whether it is Blender's own Shade Auto Smooth, which only splits normals."""
    group = getattr(modifier, "node_group", None)
    return group is not None and group.name.startswith("Smooth by Angle")
