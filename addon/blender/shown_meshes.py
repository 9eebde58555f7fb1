# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as they are seen in the 3D view: moved by shape keys and modifiers, or as they are edited."""

from dataclasses import dataclass

import bpy

from ..surfaces.arrays import Booleans, Singles
from ..surfaces.surface import Surface
from . import meshes, vertex_positions
from .types import MeshObject


@dataclass
class ShownMesh:
    """What is seen of an object.

    `own` is the surface of its mesh. `points` (n, 3) are where the vertices of `seen` are seen, in the
    coordinates of the object: `seen` is `own`, or another surface if modifiers have changed more than the
    places of vertices. Of that the evaluated mesh is `evaluated`. `hidden` (p,) are the hidden polygons of
    `own` in edit mode.
    """

    own: Surface
    seen: Surface
    points: Singles
    hidden: Booleans | None = None
    evaluated: bpy.types.Mesh | None = None


def read(obj: MeshObject, uv_layer: str, graph: bpy.types.Depsgraph) -> ShownMesh:
    """An object as it is seen, with surfaces in the world that have the UVs of a layer."""
    with meshes.readable(obj.data) as mesh:
        own, points = meshes.read_from(obj, mesh, uv_layer), meshes.points(mesh)
        if mesh != obj.data:
            return ShownMesh(own, own, points, meshes.hidden(mesh))
    evaluated = obj.evaluated_get(graph).data
    if vertex_positions.keeps_topology(obj, evaluated):
        return ShownMesh(own, own, meshes.points(evaluated))
    if uv_layer not in evaluated.uv_layers:  # as after some geometry nodes
        return ShownMesh(own, own, points)
    seen = meshes.read_from(obj, evaluated, uv_layer)
    return ShownMesh(own, seen, meshes.points(evaluated), evaluated=evaluated)
