# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmark curves are added, drawn and registered in a real window; see README.md beside this file."""

import os
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Any

import bmesh
import bpy
from bl_ext.user_default.authalic.landmarks import curves as landmark_curves
from driver import Pulse, area, call, check, only_panels, picture, say, settled, sidebar, start, until_done
from mathutils import Vector

A, B = "Ball", "Egg"
RESPONSE = 1.5
"""The most seconds in which the window may do nothing, on a slow machine that draws by software."""
ROWS = (0.45, -0.05, -0.55)  # heights of the curves


pulse = Pulse()


def scene() -> None:
    for name, x in ((A, -1.4), (B, 1.4)):
        call(bpy.ops.mesh.primitive_ico_sphere_add, subdivisions=4, location=(x, 0, 0))
        bpy.context.object.name = name
    target, source = bpy.data.objects[B], bpy.data.objects[A]
    for vertex in target.data.vertices:
        x, y, z = vertex.co.x, vertex.co.y, vertex.co.z
        vertex.co = (x * (0.8 - 0.2 * z), y * (0.8 - 0.2 * z), 1.2 * z)
    source.authalic_target = target
    source.select_set(True)
    target.select_set(True)
    bpy.context.view_layer.objects.active = source
    call(bpy.ops.view3d.view_axis, type="FRONT")
    area().spaces.active.region_3d.view_distance = 8


def route(edit: bmesh.types.BMesh, start: Sequence[float], end: Sequence[float]) -> list[Any]:
    """Vertices along edges from near one point to near another; each next one is nearest to the end."""

    def nearest(place: Sequence[float]) -> Any:
        return min(edit.verts, key=lambda vertex: (vertex.co - Vector(place)).length)

    path, last = [nearest(start)], nearest(end)
    while path[-1] != last:
        around = [edge.other_vert(path[-1]) for edge in path[-1].link_edges]
        path.append(min(around, key=lambda neighbor: (neighbor.co - last.co).length))
    return path


def select(name: str, height: float | None) -> Callable[[], None]:
    """A step that selects only the edges of a path across the front of an object."""

    def chosen() -> None:
        mesh = bpy.data.objects[name].data
        edit = bmesh.from_edit_mesh(mesh)
        for elements in (edit.faces, edit.edges, edit.verts):
            for element in elements:
                element.select = False
        if height is not None:
            wide = 0.6
            path = route(edit, (-wide, -0.9, height), (wide, -0.9, height))
            for first, second in pairwise(path):
                edit.edges.get((first, second)).select_set(True)
            edit.select_history.clear()
            edit.select_history.add(path[0])
        bmesh.update_edit_mesh(mesh)

    return chosen


def add() -> None:
    assert call(bpy.ops.authalic.landmark_curve_add, "INVOKE_DEFAULT") == {"FINISHED"}


def step(message: str) -> Callable[[], Any]:
    """Pushes a step of undo, which operators called from a timer do not."""
    return lambda: call(bpy.ops.ed.undo_push, message=message)


def mode(name: str) -> Callable[[], Any]:
    return lambda: call(bpy.ops.object.mode_set, mode=name)


def curves() -> list[tuple[bool, bool, str | None]]:
    pairs = landmark_curves.pairs(bpy.data.objects[A])
    return [(bool(pair.source.vertices), bool(pair.target.vertices), pair.problem) for pair in pairs]


def keys() -> list[str]:
    shape_keys = bpy.data.objects[A].data.shape_keys
    return [key.name for key in shape_keys.key_blocks] if shape_keys else []


def slide(value: float) -> None:
    bpy.data.objects[A].data.shape_keys.key_blocks[-1].value = value


def scrub() -> Iterator[None]:
    """Moves the slider of the morph from 0 to 1, drawing each time."""
    for step in range(11):
        slide(step / 10)
        settled()
        yield


def height() -> float:
    """The height of the source as it is shown."""
    shown = bpy.data.objects[A].evaluated_get(call(bpy.context.evaluated_depsgraph_get))
    heights = [vertex.co.z for vertex in shown.data.vertices]
    return round(max(heights) - min(heights), 2)


def is_halfway() -> bool:
    """Whether each vertex is shown in the middle of its places in the two shape keys."""
    source = bpy.data.objects[A]
    first, last = source.data.shape_keys.key_blocks[0].data, source.data.shape_keys.key_blocks[-1].data
    shown = source.evaluated_get(call(bpy.context.evaluated_depsgraph_get)).data.vertices
    places = zip(first, last, shown, strict=True)
    return all((a.co.lerp(b.co, 0.5) - vertex.co).length < 1e-5 for a, b, vertex in places)


def reopen() -> None:
    """Saves the file and opens it again."""
    path = os.path.join(os.environ["AUTHALIC_GUI_OUT"], "morph.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)


def steady() -> bool:
    say("longest time without an answer", round(pulse.longest, 2))
    return pulse.longest < RESPONSE


MISSING = f"has no edges on {B}"
PAIR = (True, True, None)

STEPS = [
    only_panels("Wrap and Morph", "Landmark Curves", "Wrap"),
    scene,
    *sidebar(),
    picture("panel"),
    mode("EDIT"),
    select(A, ROWS[0]),
    select(B, None),
    add,
    check("a curve on the source", curves, [(True, False, MISSING)]),
    settled,
    picture("half_a_pair"),
    select(B, ROWS[0]),
    add,
    check("its partner on the target", curves, [PAIR]),
    step("One curve"),
    select(A, ROWS[1]),
    select(B, ROWS[1]),
    add,
    check("both at once", curves, [PAIR, PAIR]),
    step("Two curves"),
    lambda: call(bpy.ops.ed.undo),
    check("undone", curves, [PAIR]),
    lambda: call(bpy.ops.ed.redo),
    check("redone", curves, [PAIR, PAIR]),
    select(A, ROWS[2]),
    select(B, ROWS[2]),
    add,
    lambda: call(bpy.ops.authalic.landmark_curve_reverse, index=2),
    settled,
    picture("edit_mode"),
    lambda: call(bpy.ops.authalic.landmark_curve_reverse, index=2),
    mode("OBJECT"),
    settled,
    picture("curves"),
    start("register", method="CURVES"),
    until_done("the registration ends"),
    check("the morph is there", keys, ["Basis", f"Morph → {B}"]),
    lambda: slide(0.0),
    check("at first the source has its own height", height, 2.0),
    pulse.start,
    scrub,
    check("the window stays alive while the slider moves", steady, True),
    pulse.stop,
    check("then it has nearly the target's", lambda: 2.3 < height() <= 2.4, True),
    picture("registered"),
    lambda: slide(0.5),
    check("halfway every vertex is halfway", is_halfway, True),
    reopen,
    settled,
    check("a file that is opened again has the curves", curves, [PAIR, PAIR, PAIR]),
    check("and the key of the morph", keys, ["Basis", f"Morph → {B}"]),
    check("which is still halfway", is_halfway, True),
    *sidebar(),
    picture("reopened"),
    lambda: call(bpy.ops.authalic.landmark_curve_select, index=1, side="TARGET"),
    settled,
    picture("selected"),
]
