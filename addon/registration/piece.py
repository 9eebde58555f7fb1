# SPDX-License-Identifier: GPL-3.0-or-later
"""The requirement of every registration: one piece without handles. Plain numpy, no bpy."""

from collections.abc import Sequence

from ..surfaces import suitability
from ..surfaces.suitability import Patch, Unsuitable
from .sides import Side


def check_piece(side: Side, patches: Sequence[Patch]) -> Patch:
    """The one piece (`authalic.Patch`) without handles that a side must be. Raises `Unsuitable`."""
    try:
        suitability.check_one_piece(side.points, patches)
        if patches[0].genus is None:
            raise Unsuitable("is one-sided, like a Moebius strip, and cannot be registered; remesh it")
        if patches[0].genus > 0:
            raise Unsuitable(f"has {suitability.handles(patches[0])}, like a torus; close it up or remesh it")
    except Unsuitable as problem:
        raise Unsuitable(f"{side.name}: {problem}") from problem
    return patches[0]
