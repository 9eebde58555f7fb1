# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces, vertices and edges of the library by the numbers that they have in Blender's mesh. No bpy."""

from collections.abc import Sequence
from typing import Any

from numpy.typing import NDArray

# One element: a number, or the two of an edge.
Index = int | tuple[int, ...]
# The number in the mesh of each face, or of each vertex.
Numbers = Sequence[int] | NDArray[Any]

_MANY = {"face": "triangles of faces", "vertex": "vertices", "edge": "edges"}
_FILLED = {
    "face": "faces of a filled hole",
    "vertex": "vertices that were filled in",
    "edge": "edges that were filled in",
}


def phrase(noun: str, indices: Sequence[Index], count: int, numbers: Numbers | None) -> str:
    """ "face 3", "9 vertices (5, 6, 7, …)", "edge (3, 4)": elements by their numbers in the mesh.

    `indices` are the first few of `count` elements of the library, an edge as a pair. `numbers` are those of
    all faces, or of all vertices, in the mesh; None where they are not known. Indices beyond the numbers, or
    with the number -1, are of filled holes and divided polygons, which the mesh does not have: they are left
    out.
    """
    if numbers is None:
        return f"some {'vertices' if noun == 'vertex' else noun + 's'}"
    names = list(dict.fromkeys(filter(None, (_name(index, numbers) for index in indices))))
    is_cut_short = count > len(indices)
    if not names:
        return _FILLED[noun]
    if len(names) == 1 and not is_cut_short:
        return f"{noun} {names[0]}"
    # Triangles are counted, not polygons.
    is_counted = noun != "face" and len(names) == len(indices)
    listing = ", ".join([*names, "…"] if is_cut_short else names)
    return f"{f'{count} ' if is_counted else ''}{_MANY[noun]} ({listing})"


def _name(index: Index, numbers: Numbers) -> str:
    """The name of one element, "3" or "(3, 4)" for an edge; empty if the mesh does not have it."""
    ends = index if isinstance(index, tuple) else (index,)
    if any(end >= len(numbers) or numbers[end] < 0 for end in ends):
        return ""
    named = ", ".join(str(int(numbers[end])) for end in ends)
    return f"({named})" if len(ends) > 1 else named
