# SPDX-License-Identifier: GPL-3.0-or-later
"""The native library's messages with the numbers of Blender's mesh. Plain logic, no bpy."""

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Integers = NDArray[np.integer[Any]]

# "face 3", "12 vertices (0, 1, 2, …)", "edge (3, 4)", "2 edges ((0, 4), (4, 7))".
_ELEMENTS = re.compile(r"\b(\d+ )?(faces?|vertex|vertices|edges?)( \((?:[\d, …]|\(\d+, \d+\))+\)| \d+\b)")
ENDED_EARLY = "ended early, more time makes areas more even"
ENDED_EARLY_BY_CURVES = "ended early, more time keeps the shapes of faces better"
ENDED_EARLY_FIXING = "ended early, more time may fix more"
_NAMED = 3
_PLURALS = {"vertex": "vertices", "loose vertex": "loose vertices", "open boundary": "open boundaries"}
_ONE = {"faces": "face", "vertices": "vertex", "edges": "edge"}
_MANY = {"face": "triangles of faces", "vertex": "vertices", "edge": "edges"}


def in_mesh_terms(message: str, polygons: Integers, vertices: Integers) -> str:
    """The message with polygons (m,) and vertices (n,) of the mesh in place of a patch's faces and vertices.

    Numbers beyond the arrays, or that they answer with -1, are of filled holes and divided polygons, which
    the mesh does not have: they are left out.
    """

    def translate(match: re.Match[str]) -> str:
        count, noun, listing = match[1] or "", _ONE.get(match[2], match[2]), match[3]
        own = polygons if noun == "face" else vertices
        found = re.findall(r"\d+, \d+" if noun == "edge" else r"\d+", listing)
        names = list(dict.fromkeys(filter(None, (_name(item, own) for item in found))))
        rest = ["…"] if "…" in listing else []
        if not names:
            return "faces of a filled hole" if noun == "face" else f"{_MANY[noun]} that were filled in"
        if len(names) == 1 and not rest:
            return f"{noun} {names[0]}"
        # Triangles are counted, not polygons.
        count = count if noun != "face" and len(names) == len(found) else ""
        return f"{count}{_MANY[noun]} ({', '.join(names + rest)})"

    return _ELEMENTS.sub(translate, message)


def _name(item: str, own: Integers) -> str:
    """The name of one element, "3" or "3, 4" for an edge; empty if the mesh does not have it."""
    numbers = [int(digits) for digits in item.split(", ")]
    if any(number >= len(own) or own[number] < 0 for number in numbers):
        return ""
    named = ", ".join(str(own[number]) for number in numbers)
    return f"({named})" if len(numbers) > 1 else named


def count(number: int, noun: str) -> str:
    """ "1 island", "2 islands"."""
    return f"{number} {noun if number == 1 else _PLURALS.get(noun, noun + 's')}"


def numbers(elements: Sequence[int] | Integers) -> str:
    """ "3, 4, 7, …": the first few of some elements (k,)."""
    return ", ".join(str(int(element)) for element in elements[:_NAMED]) + (", …" * (len(elements) > _NAMED))


def listed(items: Sequence[object]) -> str:
    """The first few of some messages in one line, and how many there are."""
    named = "; ".join(str(item) for item in items[:_NAMED])
    more = len(items) - _NAMED
    return f"{named}; and {more} more" if more > 0 else named
