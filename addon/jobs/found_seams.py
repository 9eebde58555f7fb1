# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams that were found, as edges of the meshes and in words."""

from collections.abc import Sequence

from .. import bridge, messages
from ..blender import edges
from ..blender.types import MeshObject
from ..bridge.settings import LOW_SHEAR
from ..surfaces.arrays import Edge, Integers


def marks(objects: Sequence[MeshObject], found: bridge.FoundSeams) -> list[list[int]]:
    """The edges to mark on each object. Raises `edges.NoEdge` if a mesh has changed meanwhile."""
    return [
        edges.edges_between(obj.data, pairs_of(new)) for obj, new in zip(objects, found.edges, strict=True)
    ]


def pairs_of(ends: Integers) -> list[Edge]:
    """Edges (k, 2) as pairs of vertices."""
    return [(first, second) for first, second in ends.tolist()]


def length(found: bridge.FoundSeams) -> str:
    """The length of seams in words."""
    return f"length of new seams {found.length:.2f}"


def shear(value: float, found: bridge.FoundSeams) -> str:
    """A shear in words, with the preset that was chosen for the meshes."""
    preset = _preset(found)
    return f"shear {value:.2f}{f' ({preset})' if preset else ''}"


def notes(found: bridge.FoundSeams) -> list[str]:
    """Remarks on seams that may not be as wanted."""
    early = [messages.ENDED_EARLY_SEEKING] if found.ended_early else []
    return early + ([messages.listed(messages.grouped(found.notes))] if found.notes else [])


def _preset(found: bridge.FoundSeams) -> str:
    """The preset that was chosen for the meshes; empty if it was not left to the search."""
    scans = [name for name, shear in found.presets.items() if shear > LOW_SHEAR]
    if not found.presets or not scans:
        return "Low Shear" if found.presets else ""
    few = "Few Seams" if len(found.presets) == 1 else f"Few Seams for {messages.named(scans)}"
    return few if len(scans) == len(found.presets) else f"Low Shear, {few}"
