# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that are computed one by one: the progress of the whole, and refusals."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Protocol, TypeVar

import numpy as np

import authalic

from ..messages import problems
from ..surfaces.arrays import Integers
from ..surfaces.suitability import Unsuitable
from .results import Refusal

Progress = Callable[[float, str], bool | None]
"""A callback with the fraction done and a message; False asks the computation to end."""

READING = 0.05
"""The part of the time after which meshes are cut into patches."""

NOT_REACHED = "was not reached before the end"


class Piece(Protocol):
    """An island to compute, with the mesh's polygons and vertices for its faces and vertices."""

    name: str
    polygons: Integers
    vertices: Integers

    @property
    def polygon(self) -> int: ...


class Result(Protocol):
    """The result of all islands together."""

    refusals: list[Refusal]
    ended_early: bool


SomePiece = TypeVar("SomePiece", bound=Piece)


def keep_going(_fraction: float, _message: str) -> bool:
    return True


def one_by_one(
    pieces: Sequence[SomePiece], do: Callable[[SomePiece, Progress], None], result: Result, progress: Progress
) -> None:
    """Calls `do(piece, progress)` for every piece; if that raises, the piece is refused in the result."""
    total = sum(len(piece.polygons) for piece in pieces)
    done = 0
    listen = noting_the_end(progress, result)
    for number, piece in enumerate(pieces):
        share = len(piece.polygons)
        message = f"Island {number + 1} of {len(pieces)}"
        if result.ended_early or not listen(done / total, message):
            result.refusals.append(refusal(piece, NOT_REACHED))
            continue
        step = _sub_progress(listen, done / total, share / total, message)
        with refused(piece, result):
            do(piece, step)
        done += share


def refusal(piece: Piece, reason: str) -> Refusal:
    """The refusal of a piece."""
    return Refusal(piece.name, piece.polygon, reason, np.unique(piece.polygons[piece.polygons >= 0]))


@contextmanager
def refused(piece: Piece, result: Result) -> Iterator[None]:
    """A piece for which the body raises what is wrong with it is refused in the result."""
    try:
        yield
    except Unsuitable as problem:
        result.refusals.append(refusal(piece, str(problem)))
    except (authalic.MeshError, authalic.SolverError) as error:
        reason = problems.in_words(error, piece.polygons, piece.vertices)
        result.refusals.append(refusal(piece, reason))


def share_of(progress: Progress, start: float, share: float) -> Progress:
    """A progress callback for a part of the whole."""
    return lambda fraction, message: progress(start + share * fraction, message)


def to_the_end(progress: Progress) -> Progress:
    """A progress callback for work that has to be finished: only an exception ends it."""

    def tell(fraction: float, message: str) -> bool:
        progress(fraction, message)
        return True

    return tell


def noting_the_end(progress: Progress, result: Result) -> Progress:
    """The progress callback, which also notes in the result that it was asked to end."""

    def listen(fraction: float, message: str) -> bool:
        result.ended_early |= progress(fraction, message) is False
        return not result.ended_early

    return listen


def _sub_progress(progress: Progress, start: float, share: float, name: str) -> Progress:
    """A progress callback for a part of the whole, with its name."""
    return share_of(lambda fraction, message: progress(fraction, f"{name}: {message}"), start, share)
