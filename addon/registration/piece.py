# SPDX-License-Identifier: GPL-3.0-or-later
"""The requirements of every registration: a piece without handles, its faces joined. Plain numpy, no bpy."""

from collections.abc import Sequence

import numpy as np

from .. import messages
from ..surfaces import coincident, suitability
from ..surfaces.suitability import Patch, Unjoined, Unsuitable
from .sides import Side, boundaries

# This part of the boundary lies on other vertices where faces were left unjoined by mistake.
_MOST = 0.5


class UnjoinedSide(Unjoined):
    """As `Unjoined`, with the name of the object."""

    def __init__(self, message: str, name: str) -> None:
        super().__init__(message)
        self.name = name


def check_piece(side: Side, patches: Sequence[Patch]) -> Patch:
    """The one piece (`authalic.Patch`) without handles that a side must be. Raises `Unsuitable`."""
    if len(boundaries(patches)) > 1 or len(side.rest.vertices):
        check_joined(side, patches)
    try:
        suitability.check_one_piece(side.points, patches)
        if patches[0].genus is None:
            raise Unsuitable("is one-sided, like a Moebius strip, and cannot be registered; remesh it")
        if patches[0].genus > 0:
            raise Unsuitable(f"has {suitability.handles(patches[0])}, like a torus; close it up or remesh it")
    except Unsuitable as problem:
        raise Unsuitable(f"{side.name}: {problem}") from problem
    return patches[0]


def check_joined(side: Side, patches: Sequence[Patch]) -> None:
    """Raises `UnjoinedSide` if most of a side's boundary lies on vertices of its own or of other pieces."""
    border = np.unique(np.concatenate([np.empty(0, int), *boundaries(patches)]))
    mesh = np.concatenate([side.points, side.rest.points])
    if not len(border) or not np.isfinite(mesh).all():
        return
    points = np.concatenate([side.points[border], side.rest.points])
    first = coincident.stands_for(points, coincident.distance(mesh))
    is_touching = np.bincount(first)[first[: len(border)]] > 1
    if is_touching.mean() >= _MOST:
        raise UnjoinedSide(
            f"{side.name} has {messages.count(coincident.count(mesh), 'vertex')} that lie on each other, but "
            "are not joined; press Merge by Distance in the panel Wrap and Morph, or join them yourself "
            "(Mesh > Merge > By Distance)",
            side.name,
        )
