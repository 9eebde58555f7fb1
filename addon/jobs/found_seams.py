# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams that were found, as edges of the meshes and in words."""

from collections.abc import Sequence

from .. import bridge, messages
from ..blender import edges
from ..blender.types import MeshObject
from ..surfaces.arrays import Edge, Integers


def marks(objects: Sequence[MeshObject], found: bridge.FoundSeams) -> list[list[int]]:
    """The edges to mark on each object. Raises `edges.NoEdge` if a mesh has changed meanwhile."""
    return [
        edges.edges_between(obj.data, pairs_of(new)) for obj, new in zip(objects, found.edges, strict=True)
    ]


def pairs_of(ends: Integers) -> list[Edge]:
    """Edges (k, 2) as pairs of vertices."""
    return [(first, second) for first, second in ends.tolist()]


def notes(found: bridge.FoundSeams) -> list[str]:
    """Remarks on seams that may not be as wanted."""
    early = [messages.ENDED_EARLY_SEEKING] if found.ended_early else []
    return early + ([messages.listed(found.notes)] if found.notes else [])
