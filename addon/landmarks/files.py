# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmark pairs as JSON. Plain logic, no bpy.

    {"format": "authalic-landmarks", "version": 1, "source": "Head A", "target": "Head B",
     "pairs": [{"name": "Nose", "source": 12, "target": 345}],
     "curves": [{"name": "Brow", "source": [3, 4, 9], "target": [7, 8, 12]}]}

"source" and "target" of a pair are vertex numbers, from 0, on the objects of those names. A curve has the
numbers of all vertices along its edges; a closed one repeats the first at the end. A file without curves has
no "curves".
"""

import json
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeGuard

from ..surfaces.arrays import Path

FORMAT, VERSION = "authalic-landmarks", 1
_NUMBERS = re.compile(r"\[\n[\d,\s]+\]")  # lists of numbers, which are to be one line


class CannotRead(Exception):
    """The file is no file of landmarks; says why."""


@dataclass
class Landmarks:
    """The names of two objects, pairs (name, source vertex, target vertex), and pairs of curves.

    These are (name, source vertices, target vertices); None where a file says nothing about curves.
    """

    source: str
    target: str
    pairs: list[tuple[str, int, int]]
    curves: list[tuple[str, Path, Path]] | None = field(default=None)


def to_text(landmarks: Landmarks) -> str:
    """The text of a file."""
    listed = [{"name": name, "source": a, "target": b} for name, a, b in landmarks.pairs]
    content = {
        "format": FORMAT,
        "version": VERSION,
        "source": landmarks.source,
        "target": landmarks.target,
        "pairs": listed,
    }
    if landmarks.curves:
        content["curves"] = [
            {"name": name, "source": list(a), "target": list(b)} for name, a, b in landmarks.curves
        ]
    text = json.dumps(content, indent=2, ensure_ascii=False)
    return _NUMBERS.sub(lambda match: f"[{', '.join(match[0][1:-1].replace(',', ' ').split())}]", text) + "\n"


def from_text(text: str) -> Landmarks:
    """The landmarks in the text of a file. Raises `CannotRead`."""
    try:
        content = json.loads(text)
    except ValueError as problem:
        raise CannotRead(f"it is not JSON ({problem})") from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise CannotRead(f'it holds no landmarks: there is no "format": "{FORMAT}"')
    if content.get("version") != VERSION or isinstance(content["version"], bool):
        raise CannotRead(f"it is of version {content.get('version')}, and only {VERSION} is known")
    listed = content.get("pairs")
    if not isinstance(listed, list):
        raise CannotRead('"pairs" is missing or not a list')
    curves = content.get("curves")
    if curves is not None and not isinstance(curves, list):
        raise CannotRead('"curves" is not a list')
    return Landmarks(
        source=_name(content, "source"),
        target=_name(content, "target"),
        pairs=[_pair(item, f"pair {number}", _vertex, number) for number, item in enumerate(listed, 1)],
        curves=curves
        and [_pair(item, f"curve {number}", _path, number) for number, item in enumerate(curves, 1)],
    )


def _name(content: dict[str, object], key: str) -> str:
    value = content.get(key, "")
    if not isinstance(value, str):
        raise CannotRead(f'"{key}" is {json.dumps(value)}, not the name of an object')
    return value


def _pair(item: object, what: str, read: Callable[[object, str], object], number: int) -> Any:
    """(name, source, target) of one entry, of which `read` reads either end."""
    if not isinstance(item, dict):
        raise CannotRead(f"{what} is {json.dumps(item)}, not an object with a name, a source and a target")
    name = item.get("name", f"{'Curve' if read is _path else 'Landmark'} {number}")
    if not isinstance(name, str):
        raise CannotRead(f"the name of {what} is {json.dumps(name)}, not a text")
    for side in ("source", "target"):
        if side not in item:
            raise CannotRead(f'{what} has no "{side}"')
    return name, *(read(item[side], f"the {side} of {what}") for side in ("source", "target"))


def _vertex(value: object, what: str) -> int:
    if not _is_vertex(value):
        raise CannotRead(f"{what} is {json.dumps(value)}, not the number of a vertex")
    return value


def _path(value: object, what: str) -> Path:
    if not isinstance(value, list):
        raise CannotRead(f"{what} is {json.dumps(value)}, not a list of vertices")
    bad = [item for item in value if not _is_vertex(item)]
    if bad:
        raise CannotRead(f"{what} has {json.dumps(bad[0])}, not the number of a vertex")
    return tuple(value)


def _is_vertex(value: object) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0
