# SPDX-License-Identifier: MIT OR Apache-2.0
"""The ways of unwrapping that the demo compares, each timed as one operator call."""

import time
from dataclasses import dataclass
from typing import Callable

import bpy

MARGIN = 0.005
LONG_RUN_LIMIT = 20_000
"""Minimum Stretch with 200 iterations takes minutes on meshes with more triangles than this."""


@dataclass(frozen=True)
class Method:
    """A way of unwrapping: `call` runs the operator on the selection in edit mode."""

    name: str
    call: Callable
    limit: int | None = None
    """The number of triangles above which the demo leaves it out."""


def _blender(method, **options):
    return lambda: bpy.ops.uv.unwrap(method=method, fill_holes=True, margin=MARGIN, **options)


def available():
    """The methods that this Blender has, Authalic last."""
    known = bpy.ops.uv.unwrap.get_rna_type().properties["method"].enum_items.keys()
    methods = [Method("Blender ABF", _blender("ANGLE_BASED"))]
    if "MINIMUM_STRETCH" in known:
        stretch = {"method": "MINIMUM_STRETCH", "no_flip": True}
        methods.append(Method("Minimum Stretch, 10", _blender(**stretch, iterations=10)))
        methods.append(Method("Minimum Stretch, 200", _blender(**stretch, iterations=200), LONG_RUN_LIMIT))
    else:
        print("  this Blender has no Minimum Stretch (it came with 4.3)")
    if hasattr(bpy.types, "AUTHALIC_OT_unwrap"):
        methods.append(Method("Authalic", lambda: bpy.ops.authalic.unwrap()))
    else:
        print("  Authalic is left out: its extension is not installed in this profile")
    return methods


PROJECTION, LAMBERT, OCTAHEDRAL = "Blender sphere projection", "Lambert", "Octahedral"


def of_closed_meshes():
    """The methods for closed meshes without seams, each with a UV map of its name."""
    return [
        Method(PROJECTION, lambda: bpy.ops.uv.sphere_project(direction="ALIGN_TO_OBJECT")),
        Method(LAMBERT, lambda: bpy.ops.authalic.unwrap(domain="AUTO", sphere_layout="LAMBERT")),
        Method(OCTAHEDRAL, lambda: bpy.ops.authalic.unwrap(domain="AUTO", sphere_layout="OCTAHEDRAL")),
    ]


SHAPE_KEY = Method("Authalic Sphere", lambda: bpy.ops.authalic.sphere_shape_key())
"""The method that adds a shape key of its own name, in object mode."""


def timed(shape, method, mode="EDIT"):
    """Runs a method on an object; returns the seconds of the call and the problem it reported, or None."""
    bpy.ops.object.select_all(action="DESELECT")
    shape.select_set(True)
    bpy.context.view_layer.objects.active = shape
    bpy.ops.object.mode_set(mode=mode)
    if mode == "EDIT":
        bpy.ops.mesh.select_all(action="SELECT")
    problem = None
    began = time.perf_counter()
    try:
        outcome = method.call()
        problem = None if "FINISHED" in outcome else f"the operator ended with {outcome}"
    except RuntimeError as error:  # bpy passes on an error report so
        problem = str(error).strip()
    seconds = time.perf_counter() - began
    bpy.ops.object.mode_set(mode="OBJECT")
    return seconds, problem
