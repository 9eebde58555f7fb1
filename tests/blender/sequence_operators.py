# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's operators with random options, and what must hold after each of them."""

import random
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import bpy
import meshes
import numpy as np
import states
from installed import part
from mathutils import Matrix
from sequence import Sequence
from sequence_edits import is_local, object_mode
from states import MeshState

_MOST = {"iterations": 30, "frame_start": 100, "frame_end": 300}
"""Largest values of some properties."""


def unwrap(sequence: Sequence) -> None:
    _ours(sequence, "unwrap", _options(sequence, "unwrap"), _changed_by_unwrap)


def mark_seams(sequence: Sequence) -> None:
    _ours(sequence, "mark_seams", _options(sequence, "mark_seams"), lambda *_: {"seams"})


def fix_flips(sequence: Sequence) -> None:
    _ours(sequence, "fix_flips", {}, _active_uv)


def measure(sequence: Sequence) -> None:
    _ours(sequence, "measure", {}, lambda *_: set())


def set_texel_density(sequence: Sequence) -> None:
    """Whole islands change, also where only some of their faces are selected."""
    options = _options(sequence, "set_texel_density")
    _ours(
        sequence, "set_texel_density", options, lambda before, _: {f"uv {before.active_uv}"}, is_strict=False
    )


def heat_map(sequence: Sequence) -> None:
    """Turns the heat map on or off, which changes no mesh, and lets it work."""
    before, manager = states.read(), bpy.context.window_manager
    manager.authalic_heat_map.show = not manager.authalic_heat_map.show
    for _ in range(5):
        part("operators.heat_map").tick(bpy.context)
        time.sleep(0.002)
    difference = states.difference(before, states.read())
    assert not difference, f"the heat map changed {difference}"


def live(sequence: Sequence) -> None:
    """Moves the slider that the UVs follow: those of the active object, where it can be written."""
    context, timer = bpy.context, part("operators.live")
    weight = round(sequence.random.random(), 2)
    sequence.say(f"  live, angle_weight={weight}")
    before, around = states.read(), _surroundings()
    active = context.view_layer.objects.active
    mesh = active.data.name_full if active is not None and active.type == "MESH" else None
    manager = context.window_manager
    manager.authalic_live, manager.authalic_live_figures = True, ""
    options = manager.operator_properties_last("authalic.unwrap")
    former = options.angle_weight
    timer.tick(context)
    options.angle_weight = weight
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        timer.tick(context)
        if timer._state.running is None:
            break
        time.sleep(0.002)
    manager.authalic_live = False
    timer.tick(context)
    options.angle_weight = former
    if manager.authalic_live_figures.startswith("Area"):
        sequence.pushed()
    after = states.read()
    assert _surroundings() == around, f"{around} became {_surroundings()}"
    for name in before:
        changes = {*states.changed(before[name], after[name])}
        permitted = _changed_by_unwrap(before[name], after[name]) - {"seams"} if name == mesh else set()
        assert changes <= permitted, f"{name}: changed {sorted(changes - permitted)}"
        _check_uv(before[name], after[name], in_edit_mode=around[0] == "EDIT_MESH")


def landmark_curve(sequence: Sequence) -> None:
    """Adds the edges that are selected as a landmark curve."""
    _ours(sequence, "landmark_curve_add", {}, lambda *_: set())


def sphere_shape_key(sequence: Sequence) -> None:
    object_mode()
    _ours(sequence, "sphere_shape_key", _options(sequence, "sphere_shape_key"), _changed_keys("Authalic"))


def register(sequence: Sequence) -> None:
    if _pair(sequence):
        keys = _changed_keys("Morph", "Basis")
        _ours(
            sequence,
            "register",
            _options(sequence, "register"),
            lambda *both: keys(*both) | _registered(both),
        )


def transfer(sequence: Sequence) -> None:
    if _pair(sequence):
        _ours(sequence, "transfer", {}, lambda before, after: {*states.changed(before, after)} - _SHAPE)


_SHAPE = {"vertices", "corners", "sizes", "seams"}
_Allowed = Callable[[MeshState, MeshState], set[str]]


def _ours(
    sequence: Sequence, name: str, options: dict[str, Any], allowed: _Allowed, is_strict: bool = True
) -> None:
    """Calls an operator of the extension and checks what it leaves behind.

    `allowed(before, after)` are the data of a selected mesh that may differ. If `is_strict`, UVs may differ
    in edit mode at selected faces only.
    """
    sequence.say(
        f"  bpy.ops.authalic.{name}({', '.join(f'{key}={value!r}' for key, value in options.items())})"
    )
    before, around = states.read(), _surroundings()
    writable = {obj.data.name_full for obj in part("jobs.targets").meshes(bpy.context) if is_local(obj.data)}
    try:
        getattr(bpy.ops.authalic, name)(**options)
    except RuntimeError as refusal:
        assert "Traceback" not in str(refusal), refusal
        sequence.say(f"  {refusal}")
    after = states.read()
    assert _surroundings() == around, f"{around} became {_surroundings()}"
    assert before.keys() == after.keys(), f"meshes {sorted(before)} became {sorted(after)}"
    for mesh in before:
        changes = {*states.changed(before[mesh], after[mesh])}
        permitted = allowed(before[mesh], after[mesh]) if mesh in writable else set()
        assert changes <= permitted, f"{mesh}: changed {sorted(changes - permitted)}"
        _check_uv(before[mesh], after[mesh], in_edit_mode=is_strict and around[0] == "EDIT_MESH")
        assert all(np.isfinite(values).all() for values in after[mesh].keys.values()), "NaN in a shape key"


def _check_uv(before: MeshState, after: MeshState, in_edit_mode: bool) -> None:
    """No UV is NaN; in edit mode those of faces that are not selected are as they were."""
    outside = np.repeat(~before.chosen, before.sizes)
    for name, uv in after.uv.items():
        assert np.isfinite(uv).all() or not np.isfinite(before.uv.get(name, uv[:0])).all(), f"NaN in {name}"
        if in_edit_mode and name in before.uv:
            assert _equal(before.uv[name][outside], uv[outside]), f"UVs in {name} outside the selection moved"


def _equal(first: meshes.Array, second: meshes.Array) -> bool:
    return first.tobytes() == second.tobytes()


def _surroundings() -> tuple[Any, ...]:
    """What no operator of the extension changes."""
    layer = bpy.context.view_layer
    modes = [(obj.name_full, obj.mode, obj.select_get()) for obj in layer.objects]
    return bpy.context.mode, layer.objects.active and layer.objects.active.name_full, modes


def _active_uv(before: MeshState, _after: MeshState) -> set[str]:
    return {f"uv {before.active_uv}"}


def _changed_by_unwrap(before: MeshState, after: MeshState) -> set[str]:
    new = {f"uv {name}" for name in after.uv.keys() - before.uv.keys()}
    return {"seams", f"uv {before.active_uv}"} | new | ({"active UV map"} if new else set())


def _changed_keys(*prefixes: str) -> _Allowed:
    """Shape keys with these prefixes may be new or differ, and the first one is new where there was none."""

    def allowed(before: MeshState, after: MeshState) -> set[str]:
        names = {name for name in after.keys if name.startswith(prefixes)}
        return {f"keys {name}" for name in names} | (set() if before.keys else {"keys Basis"})

    return allowed


def _registered(states_: tuple[MeshState, MeshState]) -> set[str]:
    return {f"uv {name}" for name in states_[1].uv if name.startswith("Authalic Registered")} | {
        "active UV map"
    }


def _pair(sequence: Sequence) -> bool:
    """Gives an object a target, mostly a copy of it, and landmarks; whether there are two objects."""
    object_mode()
    source = sequence.object(is_local)
    if source is None:
        return False
    if sequence.random.random() < 0.7:
        target = source.copy()
        target.data = source.data.copy()
        target.name = f"{source.name} Twin"
        bpy.context.collection.objects.link(target)
        target.matrix_world = Matrix.Translation((3, 0, 0))
    else:
        target = sequence.object(lambda obj: obj != source)
    if target is None:
        return False
    source.authalic_target = target
    points = part("landmarks.points")
    points.clear(source)
    most = min(len(source.data.vertices), len(target.data.vertices))
    for number, vertex in enumerate(sequence.random.sample(range(most), min(most, 4))):
        with suppress(part("landmarks.objects").CannotPair):
            points.add(source, vertex, vertex, f"L{number}")
    meshes.select(source)
    bpy.context.view_layer.update()
    return True


def _options(sequence: Sequence, name: str) -> dict[str, Any]:
    """Random values of a few properties of an operator."""
    chance = sequence.random
    properties = getattr(bpy.ops.authalic, name).get_rna_type().properties
    wanted = [item for item in properties if item.identifier != "rna_type"]
    options = {item.identifier: _value(item, chance) for item in wanted if chance.random() < 0.15}
    return {name: value for name, value in options.items() if value is not None}


def _value(item: Any, chance: random.Random) -> Any:
    """A value of a property; None for texts."""
    if item.type == "BOOLEAN":
        return chance.random() < 0.5
    if item.type == "ENUM" and not item.is_enum_flag:
        return chance.choice([choice.identifier for choice in item.enum_items])
    if item.type == "FLOAT" and not item.is_array:
        return chance.choice([item.soft_min, chance.uniform(item.soft_min, item.soft_max)])
    if item.type == "INT" and not item.is_array:
        most = _MOST.get(item.identifier, item.soft_max)
        return chance.randint(item.soft_min, max(item.soft_min, most))
    return None
