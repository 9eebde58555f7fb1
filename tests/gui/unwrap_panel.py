# SPDX-License-Identifier: GPL-3.0-or-later
"""The unwrap's panel, its presets, and Fix Flips behind a living window; see README.md beside this file."""

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
from driver import area, call, check, only_panels, picture, settled, sidebar, start, until_done, uvs_in_view

NAME = "Suzanne"


def scene() -> None:
    call(bpy.ops.mesh.primitive_monkey_add)
    call(bpy.ops.object.mode_set, mode="EDIT")
    call(bpy.ops.mesh.select_all, action="SELECT")
    call(bpy.ops.uv.select_all, action="SELECT")
    call(bpy.ops.uv.seams_from_islands)
    call(bpy.ops.object.mode_set, mode="OBJECT")
    modifier = bpy.context.object.modifiers.new("Subdivision", "SUBSURF")
    call(bpy.ops.object.modifier_apply, modifier=modifier.name)


def options() -> Any:
    return bpy.context.window_manager.operator_properties_last("authalic.unwrap")


def choose(name: str) -> Callable[[], None]:
    """A step that chooses a preset in the panel."""

    def act() -> None:
        options().angle_preset = name
        area().tag_redraw()

    return act


def seek(seams: str) -> Callable[[], None]:
    """A step that says in the panel where seams come from."""

    def act() -> None:
        options().seams = seams
        area().tag_redraw()

    return act


def uv() -> Any:
    mesh = bpy.data.objects[NAME].data
    values = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers.active.uv.foreach_get("vector", values)
    return values.reshape(-1, 2)


def flips() -> Any:
    """The number of flipped triangles of the UV map."""
    mesh = bpy.data.objects[NAME].data
    mesh.calc_loop_triangles()
    x, y = uv()[np.array([tuple(t.loops) for t in mesh.loop_triangles])].astype(float).transpose(2, 0, 1)
    areas = (x * (np.roll(y, -1, axis=1) - np.roll(y, 1, axis=1))).sum(axis=1)
    return int(np.count_nonzero(areas <= 0))


def tangle() -> None:
    """Moves the UVs of one inner vertex of the largest island across its neighbors."""
    mesh = bpy.data.objects[NAME].data
    vertices, values = np.array([loop.vertex_index for loop in mesh.loops]), uv()
    ears = {v for edge in mesh.edges if edge.use_seam for v in edge.vertices}
    chosen = next(v for v in range(len(mesh.vertices)) if v not in ears and np.sum(vertices == v) == 4)
    values[vertices == chosen] += 0.06
    mesh.attributes[mesh.uv_layers.active.name].data.foreach_set("vector", values.ravel())
    mesh.update()


def uv_editor() -> None:
    """Turns the 3D view into a UV editor of the mesh in edit mode."""
    call(bpy.ops.object.mode_set, mode="EDIT")
    call(bpy.ops.mesh.select_all, action="SELECT")
    area().ui_type = "UV"


STEPS = [
    only_panels("Authalic Unwrap", "Distortion"),
    scene,
    *sidebar(),
    picture("panel"),
    check("the preset at first", lambda: (options().angle_preset, options().outline), ("EVEN", "FREE")),
    choose("CIRCLE"),
    check("the outline of a circle", lambda: (options().outline, options().angle_weight), ("CIRCLE", 0.0)),
    picture("circle"),
    choose("EVEN"),
    seek("AUTOMATIC"),
    *[settled] * 5,  # the panels below move down
    picture("new_seams"),
    seek("GIVEN"),
    start("unwrap"),
    until_done("the unwrap ends"),
    check("the unwrap flips nothing", flips, 0),
    tangle,
    check("now there are flips", lambda: flips() > 0, True),
    start("fix_flips"),
    until_done("the fix ends"),
    check("flips are fixed", flips, 0),
    picture("fixed"),
    uv_editor,
    *sidebar("UV"),
    uvs_in_view,
    settled,
    picture("uv_editor"),
]
