# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmark pairs as JSON. Plain logic, no bpy.

    {"format": "authalic-landmarks", "version": 1, "source": "Head A", "target": "Head B",
     "pairs": [{"name": "Nose", "source": 12, "target": 345},
               {"name": "Chin", "source": 17, "target": 350, "weight": 10.0}],
     "curves": [{"name": "Brow", "source": [3, 4, 9], "target": [7, 8, 12]}]}

"source" and "target" of a pair are vertex numbers, from 0, on the objects of those names. A pair with a
"weight" is soft. A curve has the numbers of all vertices along its edges; a closed one repeats the first at
the end. A file without curves has no "curves".
"""

import json
import os
import re
from collections.abc import Callable, Sized
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any, NamedTuple, TypeGuard

from ..surfaces.arrays import Path

FORMAT, VERSION = "authalic-landmarks", 1
# A file may come from a stranger. These are far beyond what people pair: 10,000 pairs take 1.2 MB, and 1,000
# curves of 100 vertices 1.7 MB. The worst of 4 MB are read in about a second, while Blender waits.
MOST_BYTES, MOST_PAIRS, MOST_CURVES = 4_000_000, 10_000, 1_000
_MOST_VERTICES = 2**31  # of a mesh in Blender
_LONGEST_NAME, _LONGEST_QUOTE = 200, 40
_MOST_WEIGHT = 1e38  # single precision has no larger ones
_NUMBERS = re.compile(r"\[\n[\d,\s]+\]")  # lists of numbers, which are to be one line


class CannotRead(Exception):
    """The file is no file of landmarks; says why."""


class TooLarge(Exception):
    """There are more landmarks than a file may hold; says how many."""


class Point(NamedTuple):
    """A pair of vertices; the weight of a soft one, None for one that meets exactly."""

    name: str
    source: int
    target: int
    weight: float | None = None


@dataclass
class Landmarks:
    """The names of two objects, pairs of points, and pairs of curves.

    These are (name, source vertices, target vertices); None where a file says nothing about curves.
    """

    source: str
    target: str
    pairs: list[Point]
    curves: list[tuple[str, Path, Path]] | None = field(default=None)


def to_text(landmarks: Landmarks) -> str:
    """The text of a file."""
    content: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "source": landmarks.source,
        "target": landmarks.target,
        "pairs": [_entry(pair) for pair in landmarks.pairs],
    }
    if landmarks.curves:
        content["curves"] = [
            {"name": name, "source": list(a), "target": list(b)} for name, a, b in landmarks.curves
        ]
    text = json.dumps(content, indent=2, ensure_ascii=False)
    return _NUMBERS.sub(lambda match: f"[{', '.join(match[0][1:-1].replace(',', ' ').split())}]", text) + "\n"


def write(path: FilePath, landmarks: Landmarks) -> None:
    """Writes a file whole: where that fails, with `OSError`, a file that was there stays as it was.

    Raises `TooLarge` rather than to write what `read` refuses.
    """
    if said := _too_many(landmarks.pairs, landmarks.curves):
        raise TooLarge(said)
    data = to_text(landmarks).encode("utf-8")
    if len(data) > MOST_BYTES:
        raise TooLarge(f"they take {len(data) / 1e6:.1f} MB, and {MOST_BYTES // 1_000_000} MB are the most")
    path = path.resolve()
    # A new file, under a name that no link can have been put at before.
    beside = path.with_name(f".{path.name[-40:]}.{os.urandom(8).hex()}")
    try:
        with beside.open("xb") as file:
            file.write(data)
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def read(path: FilePath) -> Landmarks:
    """The landmarks in a file. Raises `CannotRead`, or `OSError` where it cannot be opened."""
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise CannotRead("it is a device or a pipe, which may never end; copy it into a file first")
    with path.open("rb") as file:
        data = file.read(MOST_BYTES + 1)
    if len(data) > MOST_BYTES:
        raise CannotRead(f"it has more than {MOST_BYTES // 1_000_000} MB, and so is no file of landmarks")
    try:
        return from_text(data.decode("utf-8-sig"))
    except UnicodeDecodeError as problem:
        raise CannotRead(f"it is not text in UTF-8 ({problem.reason} at byte {problem.start})") from None


def from_text(text: str) -> Landmarks:
    """The landmarks in the text of a file. Raises `CannotRead`."""
    try:
        content = json.loads(text)
    except ValueError as problem:
        raise CannotRead(f"it is not JSON ({problem})") from None
    except RecursionError:
        raise CannotRead("it is nested too deeply") from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise CannotRead(f'it holds no landmarks: there is no "format": "{FORMAT}"')
    if content.get("version") != VERSION or isinstance(content["version"], bool):
        raise CannotRead(f"it is of version {_quoted(content.get('version'))}, and only {VERSION} is known")
    listed = content.get("pairs")
    if not isinstance(listed, list):
        raise CannotRead('"pairs" is missing or not a list')
    curves = content.get("curves")
    if curves is not None and not isinstance(curves, list):
        raise CannotRead('"curves" is not a list')
    if said := _too_many(listed, curves):
        raise CannotRead(said)
    return Landmarks(
        source=_name(content, "source"),
        target=_name(content, "target"),
        pairs=[_point(item, number) for number, item in enumerate(listed, 1)],
        curves=curves
        and [_pair(item, f"curve {number}", _path, number) for number, item in enumerate(curves, 1)],
    )


def _too_many(pairs: Sized, curves: Sized | None) -> str | None:
    """What is said of more pairs or curves than a file may hold."""
    for entries, most, what in ((pairs, MOST_PAIRS, "pairs"), (curves or (), MOST_CURVES, "curves")):
        if len(entries) > most:
            return f"there are {len(entries)} {what}; {most} are the most that a file may hold"
    return None


def _entry(pair: Point) -> dict[str, Any]:
    entry = {"name": pair.name, "source": pair.source, "target": pair.target}
    return entry if pair.weight is None else {**entry, "weight": pair.weight}


def _name(content: dict[str, object], key: str) -> str:
    return _checked_name(content.get(key, ""), f'"{key}"', "the name of an object")


def _checked_name(value: object, what: str, expected: str) -> str:
    """A text that Blender can keep as a name."""
    if not isinstance(value, str):
        raise CannotRead(f"{what} is {_quoted(value)}, not {expected}")
    if len(value) > _LONGEST_NAME:
        raise CannotRead(f"{what} has {len(value)} characters; {_LONGEST_NAME} are the most that are read")
    if any(character == "\0" or "\ud800" <= character <= "\udfff" for character in value):
        raise CannotRead(f"{what} is {_quoted(value)}, which has characters that are no text")
    return value


def _quoted(value: object) -> str:
    """A value as the file has it, not too long for a message; of lists and objects only what they are."""
    if isinstance(value, dict | list):
        return "an object" if isinstance(value, dict) else "a list"
    text = json.dumps(value)
    return text if len(text) <= _LONGEST_QUOTE else f"{text[:_LONGEST_QUOTE]}…"


def _point(item: object, number: int) -> Point:
    name, source, target = _pair(item, f"pair {number}", _vertex, number)
    weight = item.get("weight") if isinstance(item, dict) else None
    if weight is not None and not _is_weight(weight):
        raise CannotRead(f"the weight of pair {number} is {_quoted(weight)}, not a number above 0")
    return Point(name, source, target, weight)


def _pair(item: object, what: str, read: Callable[[object, str], object], number: int) -> Any:
    """(name, source, target) of one entry, of which `read` reads either end."""
    if not isinstance(item, dict):
        raise CannotRead(f"{what} is {_quoted(item)}, not an object with a name, a source and a target")
    name = item.get("name", f"{'Curve' if read is _path else 'Landmark'} {number}")
    name = _checked_name(name, f"the name of {what}", "a text")
    for side in ("source", "target"):
        if side not in item:
            raise CannotRead(f'{what} has no "{side}"')
    return name, *(read(item[side], f"the {side} of {what}") for side in ("source", "target"))


def _vertex(value: object, what: str) -> int:
    if not _is_vertex(value):
        raise CannotRead(f"{what} is {_quoted(value)}, not the number of a vertex")
    return value


def _path(value: object, what: str) -> Path:
    if not isinstance(value, list):
        raise CannotRead(f"{what} is {_quoted(value)}, not a list of vertices")
    bad = [item for item in value if not _is_vertex(item)]
    if bad:
        raise CannotRead(f"{what} has {_quoted(bad[0])}, not the number of a vertex")
    return tuple(value)


def _is_vertex(value: object) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < _MOST_VERTICES


def _is_weight(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and 0 < value < _MOST_WEIGHT
