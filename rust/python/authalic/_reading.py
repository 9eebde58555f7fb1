# SPDX-License-Identifier: MIT OR Apache-2.0
"""What all readers of files share: which files are read, numpy's archives, and words on what is wrong."""

import contextlib
import os
import stat
from collections.abc import Iterator
from typing import Any

import numpy as np

_LONGEST = 300

_GUESSERS = ("chardet", "charset_normalizer")
"""Libraries that guess how text is encoded; some readers load them for damaged files only."""


def check_regular(path: str | os.PathLike[str]) -> None:
    """Refuses devices and pipes, which may never end, with `ValueError`. Folders fail as they are opened."""
    mode = os.stat(path).st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise ValueError("it is a device or a pipe, which cannot be read twice; copy it into a file first")


@contextlib.contextmanager
def open_numpy(path: str | os.PathLike[str]) -> Iterator[Any]:
    """What numpy reads from an npz or npy file: the entries of an archive, or one array. No pickles.

    Raises `OSError` where the file cannot be opened, and what zip files and numpy raise where it is damaged.
    """
    with open(path, "rb") as file:
        try:
            found = np.load(file, allow_pickle=False)
        except OSError as problem:  # seeks beyond the end
            raise ValueError(str(problem)) from problem
        with found if isinstance(found, np.lib.npyio.NpzFile) else contextlib.nullcontext():
            yield found


def words(problem: BaseException) -> str:
    """What is wrong with a file, from what a reader raises: one line, not too long, no control characters."""
    said = short(str(problem)) or type(problem).__name__
    match problem:
        case MemoryError():
            return f"there is not enough memory for what it states ({said})"
        case OverflowError():
            return f"it has a number that is too large ({said})"
        case UnicodeDecodeError():
            return f"it is no text in {problem.encoding}: byte {problem.start} is not"
        case ImportError(name=name) if name in _GUESSERS:
            return "it is damaged, or of another format"
        case ImportError():
            return f"it needs a further library ({said})"
    if "allow_pickle" in said:  # numpy says so of all that it does not know, and how to load it unsafely
        return "it is no npz or npy, or holds Python objects (pickles), which can run code and are never read"
    if said.startswith("cannot reshape array"):
        return f"it does not hold as many numbers as it states ({said})"
    return said if str(problem) else f"it is damaged ({said})"


def short(text: str, longest: int = _LONGEST) -> str:
    """The text on one line, cut where it is long, with control characters escaped."""
    line = " ".join(text[: 4 * longest].split())
    line = "".join(each if each.isprintable() else ascii(each)[1:-1] for each in line)
    return line if len(line) <= longest else f"{line[:longest]}…"


def there_is(count: int, noun: str, nouns: str) -> str:
    """How many there are, in words: there is 1 vertex, there are 2 vertices."""
    return f"there is 1 {noun}" if count == 1 else f"there are {count} {nouns}"
