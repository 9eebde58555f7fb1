# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface that a mesh becomes by its Subdivision Surface modifier, alone in a temporary scene."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bpy
import numpy as np

from ..surfaces import triangulation
from ..surfaces.arrays import Floats
from .types import MeshObject

_POLYGON = ".authalic_polygon"
_SETTINGS = ("subdivision_type", "quality", "boundary_smooth", "use_creases", "use_limit_surface")


def modifier(obj: MeshObject) -> bpy.types.Modifier | None:
    """The Subdivision Surface modifier, which counts if it is the first and shown; None if there is none."""
    first = obj.modifiers[0] if obj.modifiers else None
    return first if first is not None and first.type == "SUBSURF" and first.show_viewport else None


def smoothed(obj: MeshObject, mesh: bpy.types.Mesh, shape: float | Floats) -> tuple[Floats, Floats] | None:
    """Where a mesh's vertices lie on the subdivided surface, (n, 3), and its polygons' areas (p,) there.

    Both are those of an object that is scaled by `shape`, a factor or a matrix (3, 3). None without a
    modifier.
    """
    subdivision: Any = modifier(obj)
    if subdivision is None or not subdivision.levels:
        return None
    with _evaluated(mesh, subdivision) as fine:
        points = np.empty(3 * len(fine.vertices), np.float32)
        fine.vertices.foreach_get("co", points)
        fine.calc_loop_triangles()
        triangles = np.empty(3 * len(fine.loop_triangles), np.int32)
        owner = np.empty(len(fine.loop_triangles), np.int32)
        fine.loop_triangles.foreach_get("vertices", triangles)
        fine.loop_triangles.foreach_get("polygon_index", owner)
        coarse = np.empty(len(fine.polygons), np.int32)
        attribute: Any = fine.attributes[_POLYGON]
        attribute.data.foreach_get("value", coarse)
    matrix = shape * np.eye(3) if isinstance(shape, float) else shape
    positions = points.reshape(-1, 3).astype(float) @ matrix
    areas = triangulation.areas(positions[triangles.reshape(-1, 3)])
    # the vertices of the mesh come first
    return positions[: len(mesh.vertices)], np.bincount(coarse[owner], areas, len(mesh.polygons))


@contextmanager
def _evaluated(mesh: bpy.types.Mesh, subdivision: Any) -> Iterator[bpy.types.Mesh]:
    """The mesh that a modifier with the same settings makes of a copy of a mesh."""
    copy = mesh.copy()
    numbers: Any = copy.attributes.new(_POLYGON, "INT", "FACE")
    numbers.data.foreach_set("value", np.arange(len(mesh.polygons), dtype=np.int32))
    obj = bpy.data.objects.new(".authalic", copy)
    scene = bpy.data.scenes.new(".authalic")
    try:
        added: Any = obj.modifiers.new("", "SUBSURF")
        added.levels = subdivision.levels
        for name in _SETTINGS:
            setattr(added, name, getattr(subdivision, name))
        scene.collection.objects.link(obj)
        view = scene.view_layers[0]
        with bpy.context.temp_override(scene=scene, view_layer=view):
            evaluated: Any = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
            yield evaluated.data
    finally:
        bpy.data.scenes.remove(scene)
        bpy.data.objects.remove(obj)
        bpy.data.meshes.remove(copy)
