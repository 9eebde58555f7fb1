# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces that are computed one by one: the progress of the whole, and pieces that are refused."""

import authalic

from .. import messages
from ..surfaces.suitability import Unsuitable
from .results import Refusal

NOT_REACHED = "was not reached before the end"


def keep_going(_fraction, _message):
    return True


def one_by_one(pieces, do, result, progress):
    """Calls `do(piece, progress)` for every piece; one that it raises for is refused in the result."""
    total = sum(len(piece.polygons) for piece in pieces)
    done = 0
    listen = _noting_the_end(progress, result)
    for number, piece in enumerate(pieces):
        share = len(piece.polygons)
        message = f"Island {number + 1} of {len(pieces)}"
        if result.ended_early or not listen(done / total, message):
            result.refusals.append(Refusal(piece.name, piece.polygon, NOT_REACHED))
            continue
        step = _sub_progress(listen, done / total, share / total, message)
        try:
            do(piece, step)
        except (Unsuitable, authalic.MeshError, authalic.SolverError) as error:
            reason = messages.in_mesh_terms(str(error), piece.polygons, piece.vertices)
            result.refusals.append(Refusal(piece.name, piece.polygon, reason))
        done += share


def _noting_the_end(progress, result):
    """The progress callback, which also notes in a `Mapping` that it was asked to end."""

    def listen(fraction, message):
        result.ended_early |= progress(fraction, message) is False
        return not result.ended_early

    return listen


def _sub_progress(progress, start, share, name):
    """A part of the whole as a progress callback of its own."""
    return lambda fraction, message: progress(start + share * fraction, f"{name}: {message}")
