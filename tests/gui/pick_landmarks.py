# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks are picked by clicking on two heads in a real window; see README.md beside this file."""

from collections.abc import Callable
from typing import Any

import bmesh
import bpy
from bl_ext.user_default.authalic.landmarks import points as landmark_points
from bl_ext.user_default.authalic.overlay import points as overlay_points
from driver import (
    Step,
    area,
    call,
    check,
    click,
    key,
    move,
    only_panels,
    picture,
    pixel,
    running,
    send,
    settled,
    sidebar,
)

A, B = "Suzanne", "Her Sister"


def scene() -> None:
    for name, x in ((A, -1.5), (B, 1.5)):
        call(bpy.ops.mesh.primitive_monkey_add, location=(x, 0, 0))
        bpy.context.object.name = name
    target = bpy.context.object
    target.scale = (0.8, 0.8, 1.1)
    target.modifiers.new("Subdivision", "SUBSURF")
    source = bpy.data.objects[A]
    source.authalic_target = target
    source.select_set(True)
    bpy.context.view_layer.objects.active = source
    call(bpy.ops.view3d.view_axis, type="FRONT")
    area().spaces.active.region_3d.view_distance = 8


def pick() -> None:
    assert call(bpy.ops.authalic.landmark_pick, "INVOKE_DEFAULT") == {"RUNNING_MODAL"}


def at(name: str, vertex: int) -> Callable[[], tuple[float, float]]:
    return lambda: pixel(name, vertex)


def drag(name: str, vertex: int, to: int, end: str = "LEFTMOUSE") -> list[Step]:
    """Steps that press on a marker, move the mouse to another vertex, and let go or strike a key."""
    value = "RELEASE" if end == "LEFTMOUSE" else "PRESS"
    return [
        move(at(name, vertex)),
        lambda: send("LEFTMOUSE", "PRESS", at(name, vertex)()),
        move(at(name, 409)),
        move(at(name, to)),
        settled,
        lambda: send(end, value, at(name, to)()),
    ]


def pairs() -> list[Any]:
    return [pair[1:] for pair in landmark_points.pairs(bpy.data.objects[A])]


def is_picking() -> bool:
    return "AUTHALIC_OT_landmark_pick" in running()


def hints() -> list[Any]:
    return [marker[:2] for marker in overlay_points.hints]


def delete_first_vertex() -> None:
    mesh = bpy.data.objects[A].data
    edit = bmesh.from_edit_mesh(mesh)
    edit.verts.ensure_lookup_table()
    bmesh.ops.delete(edit, geom=[edit.verts[198]], context="VERTS")
    bmesh.update_edit_mesh(mesh)
    bpy.data.objects[A].authalic_landmark_index = 1
    area().tag_redraw()


STEPS = [
    only_panels("Wrap and Morph", "Landmarks"),
    scene,
    *sidebar(),
    lambda: call(bpy.ops.ed.undo_push, message="Two heads"),
    pick,
    *click(at(A, 409)),
    check("one click is no pair", pairs, []),
    move(at(B, 409)),
    settled,
    check("the picked vertex and the one under the mouse", hints, [(A, 409), (B, 409)]),
    picture("hover"),
    *click(at(B, 409)),
    check("a pair, source first", pairs, [(409, 409, None)]),
    *click(at(B, 198)),
    *click(at(A, 198)),
    check("a pair, target first", pairs, [(409, 409, None), (198, 198, None)]),
    *key("BACK_SPACE"),
    check("the last pair taken back", pairs, [(409, 409, None)]),
    *click(at(A, 198)),
    *key("Z", ctrl=True),
    *click(at(B, 198)),
    check("the last click taken back", pairs, [(409, 409, None)]),
    lambda: send("WHEELUPMOUSE", "PRESS"),
    settled,
    *click(at(A, 198)),
    check("zoomed and picked", pairs, [(409, 409, None), (198, 198, None)]),
    picture("picked"),
    *drag(A, 198, 150)[:-1],
    picture("dragged"),
    lambda: send("ESC", "PRESS", at(A, 150)()),
    lambda: send("LEFTMOUSE", "RELEASE", at(A, 150)()),
    check("Esc puts a marker back", pairs, [(409, 409, None), (198, 198, None)]),
    *drag(A, 198, 150),
    check("a marker dragged", pairs, [(409, 409, None), (150, 198, None)]),
    check("still picking", is_picking, True),
    *key("ESC"),
    check("no longer picking", is_picking, False),
    check("nothing is left over", hints, []),
    lambda: call(bpy.ops.ed.undo),
    check("undo puts the marker back", pairs, [(409, 409, None), (198, 198, None)]),
    lambda: call(bpy.ops.ed.undo),
    check("undo takes one pair back", pairs, [(409, 409, None)]),
    lambda: call(bpy.ops.ed.redo),
    check("redo brings it again", pairs, [(409, 409, None), (198, 198, None)]),
    lambda: call(bpy.ops.object.mode_set, mode="EDIT"),
    lambda: call(bpy.ops.mesh.select_all, action="DESELECT"),
    delete_first_vertex,
    settled,
    check("a lost vertex is told", pairs, [(408, 409, None), (-1, 198, f"its vertex on {A} is gone")]),
    picture("lost"),
    lambda: call(bpy.ops.authalic.landmark_jump, index=0, side="TARGET"),
    settled,
    picture("jump"),
    lambda: call(bpy.ops.object.mode_set, mode="OBJECT"),
    pick,
    lambda: bpy.data.objects.remove(bpy.data.objects[B]),
    settled,
    move(at(A, 0)),
    settled,
    check("picking ends with its objects", is_picking, False),
]
