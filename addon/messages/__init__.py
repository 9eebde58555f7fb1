# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts and lists in words. No bpy."""

from collections.abc import Iterable, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Integers = NDArray[np.integer[Any]]

ENDED_EARLY = "stopped early; a longer run gives more even areas"
ENDED_EARLY_BY_CURVES = "stopped early; a longer run preserves the shapes of faces better"
ENDED_EARLY_SEEKING = "stopped early; a longer run finds shorter seams"
ENDED_EARLY_FIXING = "stopped early; a longer run may fix more"
_NAMED = 3
_PLURALS = {
    "vertex": "vertices",
    "loose vertex": "loose vertices",
    "masked vertex": "masked vertices",
    "open boundary": "open boundaries",
}


class Note(Protocol):
    """What is remarkable about something: as a string, its name and the text."""

    @property
    def text(self) -> str: ...


def count(number: int, noun: str) -> str:
    """ "1 island", "2 islands"."""
    return f"{number} {noun if number == 1 else _PLURALS.get(noun, noun + 's')}"


def numbers(elements: Sequence[int] | Integers) -> str:
    """ "3, 4, 7, …": the first few of some elements (k,)."""
    return ", ".join(str(int(element)) for element in elements[:_NAMED]) + (", …" * (len(elements) > _NAMED))


def named(names: Sequence[str]) -> str:
    """The first few of some names, and how many there are."""
    more = len(names) - _NAMED
    return ", ".join(names[:_NAMED]) + (f" and {more} more" if more > 0 else "")


def listed(items: Sequence[object]) -> str:
    """The first few of some messages in one line, and how many there are."""
    named = "; ".join(str(item) for item in items[:_NAMED])
    more = len(items) - _NAMED
    return f"{named}; and {more} more" if more > 0 else named


def grouped(notes: Iterable[Note]) -> list[str]:
    """Notes in words, those with the same text as one."""
    groups: dict[str, list[Note]] = {}
    for note in notes:
        groups.setdefault(note.text, []).append(note)
    return [f"{same[0]}{f' (and {len(same) - 1} more)' if len(same) > 1 else ''}" for same in groups.values()]
