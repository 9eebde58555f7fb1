# SPDX-License-Identifier: GPL-3.0-or-later
"""What a person does to meshes and files with Blender's own operators, at random."""

from collections.abc import Callable
from typing import Any

import bpy
import linking
import meshes
import sequence_meshes
import states
from sequence import Sequence

_MOST_FACES = 900
"""Meshes with more are not subdivided."""


def quietly(operator: Callable[..., Any], **options: Any) -> None:
    """Calls one of Blender's own operators, which may refuse."""
    try:
        operator(**options)
    except RuntimeError:
        return


def object_mode() -> None:
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def add(sequence: Sequence) -> None:
    object_mode()
    make = sequence.random.choice(sequence_meshes.ALL)
    sequence.say(f"  {make.__name__}")
    make(sequence.random)
    obj = bpy.context.object
    obj.location = [sequence.random.uniform(-3, 3) for _ in range(3)]
    if sequence.random.random() < 0.3:
        obj.scale = [sequence.random.choice([1, 1, -1, 0.2, 3]) for _ in range(3)]
    if sequence.random.random() < 0.4 and len(obj.data.uv_layers) == 0:
        obj.data.uv_layers.new(name=sequence.random.choice(["UVMap", "Täxtur"]))


def choose(sequence: Sequence) -> None:
    """Selects objects at random."""
    object_mode()
    for obj in bpy.context.view_layer.objects:
        obj.select_set(sequence.random.random() < 0.6)
    bpy.context.view_layer.objects.active = sequence.object()


def switch_mode(sequence: Sequence) -> None:
    if bpy.context.object is not None:
        quietly(bpy.ops.object.mode_set, mode=sequence.random.choice(["EDIT", "OBJECT", "EDIT"]))


def choose_faces(sequence: Sequence) -> None:
    """Selects and hides faces at random, in edit mode."""
    _edit(sequence)
    share = sequence.random.choice([0, 0.3, 0.7, 1])
    for obj in bpy.context.objects_in_mode:
        hidden = {face for face in range(len(obj.data.polygons)) if sequence.random.random() < 0.05}
        meshes.select_faces(obj, lambda _face: sequence.random.random() < share, hidden)


def mark(sequence: Sequence) -> None:
    """Marks or clears seams at random edges."""
    object_mode()
    obj = sequence.object(is_local)
    if obj is not None:
        share = sequence.random.choice([0, 0.1, 0.5])
        for edge in obj.data.edges:
            edge.use_seam = sequence.random.random() < share


def subdivide(sequence: Sequence) -> None:
    _edit(sequence)
    if all(len(obj.data.polygons) < _MOST_FACES // 4 for obj in bpy.context.objects_in_mode):
        quietly(bpy.ops.mesh.subdivide)


def delete_faces(sequence: Sequence) -> None:
    choose_faces(sequence)
    quietly(bpy.ops.mesh.delete, type=sequence.random.choice(["FACE", "VERT", "ONLY_FACE"]))


def extrude(sequence: Sequence) -> None:
    _edit(sequence)
    quietly(bpy.ops.mesh.extrude_region_move, TRANSFORM_OT_translate={"value": (0, 0, 0.5)})


def flatten(sequence: Sequence) -> None:
    """Scales what is selected to a line or a point, so that faces lose their areas."""
    _edit(sequence)
    scale = sequence.random.choice([(0, 0, 0), (1, 0, 0), (1, 1, 0)])
    quietly(bpy.ops.transform.resize, value=scale)


def delete_object(sequence: Sequence) -> None:
    object_mode()
    obj = sequence.object()
    if obj is not None:
        bpy.data.objects.remove(obj)


def duplicate(sequence: Sequence) -> None:
    object_mode()
    quietly(bpy.ops.object.duplicate, linked=sequence.random.random() < 0.5)


def link(sequence: Sequence) -> None:
    """Links an object from another file, and overrides it or its mesh as well, or neither."""
    object_mode()
    obj = sequence.object(lambda obj: is_local(obj) and obj.data.library is None)
    if obj is None:
        return
    file = sequence.path(f"library{len(sequence.log)}.blend")
    bpy.data.libraries.write(file, {obj})
    with bpy.data.libraries.load(file, link=True) as (_, target):
        target.objects = [obj.name]
    linked: Any = target.objects[0]
    bpy.context.collection.objects.link(linked)
    kind = sequence.random.choice(["link", "override", "override with mesh"])
    sequence.say(f"  {kind} of {obj.name}")
    if kind != "link":
        linking.overridden(linked, is_mesh_too=kind != "override")
    sequence.forget()  # Blender's undo keeps what was linked


def undo(sequence: Sequence) -> None:
    sequence.step(-1, bpy.ops.ed.undo)


def redo(sequence: Sequence) -> None:
    sequence.step(1, bpy.ops.ed.redo)


def reopen(sequence: Sequence) -> None:
    """Saves the file and opens it again."""
    before, file = states.read(), sequence.path("file.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.open_mainfile(filepath=file)
    sequence.forget()
    difference = states.difference(before, states.read())
    assert not difference, f"not as it was saved: {difference}"


def is_local(obj: Any) -> bool:
    return obj.library is None and obj.override_library is None


def _edit(sequence: Sequence) -> None:
    """Enters edit mode, of an object that can be edited."""
    if bpy.context.mode == "EDIT_MESH":
        return
    obj = sequence.object(lambda obj: is_local(obj) and is_local(obj.data))
    if obj is not None:
        meshes.select(obj)
        quietly(bpy.ops.object.mode_set, mode="EDIT")
        sequence.push()  # undo needs a step between the modes
