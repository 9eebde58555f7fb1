# SPDX-License-Identifier: MIT OR Apache-2.0
"""Numbers as words of text, and how many elements a file can hold."""

import numpy as np

from .._reading import short
from .mesh import Reals

_LONGEST_QUOTE = 40


def quoted(text: str) -> str:
    """A piece of a file for a message: not too long, and without control characters."""
    return f"'{short(text, _LONGEST_QUOTE)}'"


def check_plain(words: list[str]) -> None:
    """Refuses 1_0, which Python takes for 10, and digits of other scripts; other tools read neither."""
    text = "".join(words)
    if "_" in text or not text.isascii():
        odd = next(word for word in words if "_" in word or not word.isascii())
        raise ValueError(f"{quoted(odd)} is no number")


def whole(word: str, what: str) -> int:
    """The whole number of a word; `what` it is, for the message."""
    try:
        check_plain([word])
        return int(word)
    except ValueError as error:
        raise ValueError(f"{what} is {quoted(word)}, which is no whole number") from error


def reals(words: list[str]) -> Reals:
    """The numbers of words."""
    check_plain(words)
    return np.array(words, np.float64)


def check_count(count: int, what: str, room: int) -> None:
    """Refuses a number of elements that a file states and cannot hold."""
    if count < 0:
        raise ValueError(f"{what}: it states the number {count}, which is below 0")
    if count > room:
        raise ValueError(f"{what}: it states the number {count}, but what follows holds {room} at most")
