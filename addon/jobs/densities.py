# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertex group or color attribute that says where more texture is wanted."""

from collections.abc import Sequence

import bpy

from ..blender import weights
from ..blender.types import MeshObject
from ..surfaces import density
from ..surfaces.surface import Surface


class NoDensity(Exception):
    """No object has the vertex group or color attribute that was named; nothing was changed."""


def check(objects: Sequence[MeshObject], source: str) -> None:
    """Raises `NoDensity` unless one of the objects at least has the source; an empty one is none."""
    if source and not any(source in weights.names(obj) for obj in objects):
        raise NoDensity(f'No selected object has the vertex group or color "{source}"; choose another')


def apply(obj: MeshObject, surface: Surface, source: str, shown: bpy.types.Mesh | None = None) -> None:
    """Raises the density of an object's surface where the source says so.

    The surface is that of the object's mesh, or of the mesh `shown` as its modifiers have made it.
    """
    if source:
        painted = weights.of_corners(obj, source, surface.corner_vertex, shown)
        if painted is not None:
            wanted = density.of_polygons(surface, painted)
            surface.density = wanted if surface.density is None else wanted * surface.density
