# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmark pairs as JSON. Plain logic, no bpy.

    {"format": "authalic-landmarks", "version": 1, "source": "Head A", "target": "Head B",
     "pairs": [{"name": "Nose", "source": 12, "target": 345}]}

"source" and "target" of a pair are numbers of vertices, from 0, of the objects of those names.
"""

import json
from dataclasses import dataclass

FORMAT, VERSION = "authalic-landmarks", 1


class CannotRead(Exception):
    """The file is no file of landmarks; says why."""


@dataclass
class Landmarks:
    """The names of two objects and pairs (name, source vertex, target vertex)."""

    source: str
    target: str
    pairs: list


def to_text(landmarks):
    """The text of a file."""
    listed = [{"name": name, "source": a, "target": b} for name, a, b in landmarks.pairs]
    content = {
        "format": FORMAT,
        "version": VERSION,
        "source": landmarks.source,
        "target": landmarks.target,
        "pairs": listed,
    }
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def from_text(text):
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
    found = [_pair(item, number) for number, item in enumerate(listed, 1)]
    return Landmarks(_name(content, "source"), _name(content, "target"), found)


def _name(content, key):
    value = content.get(key, "")
    if not isinstance(value, str):
        raise CannotRead(f'"{key}" is {json.dumps(value)}, not the name of an object')
    return value


def _pair(item, number):
    if not isinstance(item, dict):
        raise CannotRead(f"pair {number} is {json.dumps(item)}, not an object with a name and two vertices")
    name = item.get("name", f"Landmark {number}")
    if not isinstance(name, str):
        raise CannotRead(f"the name of pair {number} is {json.dumps(name)}, not a text")
    return name, _vertex(item, number, "source"), _vertex(item, number, "target")


def _vertex(item, number, side):
    if side not in item:
        raise CannotRead(f'pair {number} has no "{side}"')
    value = item[side]
    if not isinstance(value, int) or isinstance(value, bool) or value < 0:
        raise CannotRead(f"the {side} of pair {number} is {json.dumps(value)}, not the number of a vertex")
    return value
