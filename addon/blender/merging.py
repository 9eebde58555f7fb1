# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices of meshes that are merged where faces were left unjoined."""

from collections.abc import Collection
from typing import Any

import bmesh
import numpy as np

from ..surfaces import coincident
from ..surfaces.arrays import Integers
from .types import MeshObject


def merge_open_edges(obj: MeshObject, kept: Collection[int]) -> int:
    """Merges the vertices of open edges that lie on each other; returns how many are gone.

    Of those that lie on each other one of `kept` stays, or else the first. UVs and all other data of face
    corners stay as they are. The mesh is not in edit mode.
    """
    mesh = obj.data
    edit = bmesh.new()
    try:
        edit.from_mesh(mesh)
        pairs = _pairs(edit, kept)
        if pairs:
            bmesh.ops.weld_verts(edit, targetmap=pairs)
            edit.to_mesh(mesh)
            mesh.update()
        return len(pairs)
    finally:
        edit.free()


def _pairs(edit: bmesh.types.BMesh, kept: Collection[int]) -> dict[Any, Any]:
    """{vertex: the vertex that it is merged into}."""
    edit.verts.ensure_lookup_table()
    border = [vertex for vertex in edit.verts if any(edge.is_boundary for edge in vertex.link_edges)]
    if not border:
        return {}
    points = np.array([vertex.co for vertex in edit.verts], float)
    numbers = np.array([vertex.index for vertex in border])
    first = coincident.stands_for(points[numbers], coincident.distance(points))
    stays = _staying(numbers, first, kept)
    targets = numbers[stays[first]]
    changed = np.flatnonzero(targets != numbers)
    return {border[place]: edit.verts[int(targets[place])] for place in changed.tolist()}


def _staying(numbers: Integers, first: Integers, kept: Collection[int]) -> Integers:
    """For the first (k,) of those that lie on each other the place of the one that stays."""
    stays = np.arange(len(numbers))
    for place in np.flatnonzero(np.isin(numbers, list(kept)))[::-1].tolist():
        stays[first[place]] = place
    return stays
