# SPDX-License-Identifier: GPL-3.0-or-later
"""The selection of the UV editor counts where it is not that of the mesh; see README.md beside this file."""

from typing import Any

import bmesh
import bpy
import numpy as np
from driver import (
    area,
    call,
    check,
    click_button,
    only_panels,
    picture,
    region,
    sidebar,
    until_done,
    uvs_in_view,
    window,
)

NAME = "Grids"
before: list[Any] = []


def scene() -> None:
    """Two islands of one mesh; both are selected in the mesh."""
    for x in (0.0, 3.0):
        call(bpy.ops.mesh.primitive_grid_add, x_subdivisions=4, y_subdivisions=4, location=(x, 0, 0))
    bpy.data.objects["Grid"].select_set(True)
    call(bpy.ops.object.join)
    obj = bpy.context.object
    obj.name = NAME
    values = uv()
    left = np.arange(len(values)) < len(values) // 2
    obj.data.attributes[obj.data.uv_layers.active.name].data.foreach_set(
        "vector", np.where(left[:, None], values * (0.2, 0.4), values * (0.2, 0.4) + (0.6, 0.1)).ravel()
    )
    call(bpy.ops.object.mode_set, mode="EDIT")
    call(bpy.ops.mesh.select_all, action="SELECT")
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    area().ui_type = "UV"


def uv() -> Any:
    """The UVs (c, 2) of all corners, in object mode and in edit mode."""
    mesh = bpy.data.objects[NAME].data if NAME in bpy.data.objects else bpy.context.object.data
    if mesh.is_editmode:
        edited = bmesh.from_edit_mesh(mesh)
        layer = edited.loops.layers.uv.active
        return np.array([loop[layer].uv[:] for face in edited.faces for loop in face.loops], np.float32)
    values = np.empty((len(mesh.loops), 2), np.float32)
    mesh.uv_layers.active.uv.foreach_get("vector", values.ravel())
    return values


def select_left() -> None:
    """Selects the island on the left, in the UV editor alone."""
    editor = {"window": window(), "area": area("UV"), "region": region("WINDOW", "UV")}
    with bpy.context.temp_override(**editor):
        bpy.ops.uv.select_all(action="DESELECT")
        bpy.ops.uv.select(location=(0.1, 0.2))
        bpy.ops.uv.select_linked()
    before.append(uv())


def moved() -> tuple[bool, bool]:
    """Whether UVs of the left island have moved, and of the right one."""
    changed = (uv() != before[0]).any(axis=1)
    middle = len(changed) // 2
    return bool(changed[:middle].any()), bool(changed[middle:].any())


STEPS = [
    only_panels("Authalic Unwrap"),
    scene,
    *sidebar("UV"),
    uvs_in_view,
    select_left,
    picture("uv_selection_before"),
    *click_button("authalic.unwrap", "UV"),
    until_done("the unwrap ends"),
    picture("uv_selection"),
    check("only what is selected in the UV editor has moved", moved, (True, False)),
]
