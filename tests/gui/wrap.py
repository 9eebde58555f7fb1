# SPDX-License-Identifier: GPL-3.0-or-later
"""Two objects are put side by side and registered in a real window; see README.md beside this file."""

import time
import types
from typing import Any

import bpy
import numpy as np
from bl_ext.user_default.authalic.blender import places
from bl_ext.user_default.authalic.bridge import registrations
from bl_ext.user_default.authalic.landmarks import points as landmark_points
from bl_ext.user_default.authalic.overlay import preview as overlay_preview
from bpy_extras.view3d_utils import location_3d_to_region_2d
from driver import (
    Until,
    area,
    call,
    check,
    only_panels,
    picture,
    region,
    running,
    settled,
    sidebar,
    until_done,
)
from mathutils import Vector

A, B = "Ball", "Egg"
KEY = f"Morph → {B}"
PREVIEWS = 12


def scene() -> None:
    for name in (A, B):
        call(bpy.ops.mesh.primitive_uv_sphere_add, segments=24, ring_count=12, location=(0, 0, 0))
        bpy.context.object.name = name
    target, source = bpy.data.objects[B], bpy.data.objects[A]
    for vertex in target.data.vertices:
        x, y, z = vertex.co.x, vertex.co.y, vertex.co.z
        vertex.co = (x * (0.8 - 0.2 * z), y * (0.8 - 0.2 * z), 1.2 * z)
    source.authalic_target = target
    for vertex in (0, 60, 140, 200, 250):
        landmark_points.add(source, vertex, vertex)
    target.select_set(False)
    source.select_set(True)
    bpy.context.view_layer.objects.active = source
    call(bpy.ops.view3d.view_axis, type="FRONT")
    area().spaces.active.region_3d.view_distance = 4
    call(bpy.ops.ed.undo_push, message="Two objects")


def is_in_view(name: str) -> bool:
    """Whether the box about an object is in the view, beside the sidebar."""
    obj, part, wide = bpy.data.objects[name], region(), region().width - region("UI").width
    for corner in obj.bound_box:
        place = location_3d_to_region_2d(
            part, area().spaces.active.region_3d, obj.matrix_world @ Vector(tuple(corner))
        )
        if place is None or not (0 <= place.x <= wide and 0 <= place.y <= part.height):
            return False
    return True


def side_by_side() -> None:
    assert call(bpy.ops.authalic.side_by_side, "INVOKE_DEFAULT", True) == {"FINISHED"}


def beside() -> tuple[bool, bool]:
    """Whether the target stands beside the source, and away from it."""
    target = bpy.data.objects[B]
    return places.is_beside(target), target.location.x > 1.5


def slowly() -> None:
    """Makes the library show how the map comes about; it does so once it takes `preview`."""
    library = types.SimpleNamespace(**vars(registrations.authalic))
    spheres = library.register_spheres

    def register_spheres(*given: Any, preview: Any = None, progress: Any = None, **options: Any) -> Any:
        found = spheres(*given, progress=progress, **options)
        start = np.asarray(given[0].vertices) if hasattr(given[0], "vertices") else None
        goal = np.asarray(found.positions)
        for k in range(PREVIEWS):
            share = (k + 1) / PREVIEWS
            preview(goal * (0.5 + 0.5 * share) if start is None else (1 - share) * start + share * goal)
            progress(share, "Improving")
            time.sleep(0.25)
        return found

    library.register_spheres = register_spheres
    registrations.authalic = library


def register() -> None:
    bpy.data.objects[A].authalic_wrap.align = True
    assert call(bpy.ops.authalic.register, "INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}


def has_preview() -> bool:
    return overlay_preview.shown() is not None


def key_of_morph() -> tuple[str, float, bool]:
    """The active shape key, the value of the morph, and whether the options are kept."""
    obj: Any = bpy.data.objects[A]
    return (
        obj.active_shape_key.name,
        obj.data.shape_keys.key_blocks[KEY].value,
        obj.authalic_wrap.align and obj.authalic_registration.energy == "SURFACE",
    )


STEPS = [
    only_panels("Wrap and Morph", "Landmarks", "Wrap"),
    scene,
    *sidebar(),
    picture("wrap_panel"),
    check("both stand in one place", beside, (False, False)),
    side_by_side,
    settled,
    check("the target is put beside", beside, (True, True)),
    check("and both are in view", lambda: is_in_view(A) and is_in_view(B), True),
    picture("side_by_side"),
    slowly,
    register,
    Until("a preview is shown", has_preview),
    settled,
    settled,
    picture("preview"),
    until_done("the registration ends"),
    check("the preview is gone", has_preview, False),
    check("no running operator", running, []),
    check("the morph waits, and the options are kept", key_of_morph, ("Basis", 0.0, True)),
    settled,
    picture("wrapped"),
    side_by_side,
    check("the target is put back", beside, (False, False)),
    lambda: call(bpy.ops.ed.undo),
    check("which is a step of undo", beside, (True, True)),
]
