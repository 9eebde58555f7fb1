# SPDX-License-Identifier: MIT OR Apache-2.0
"""Our layouts: one call for seams, maps and packing."""

import authalic
from bench.report import attempt
from bench.seams.layout import Failure, Layout

TARGETS = (1.25, 1.4)
"""The bounds of the mean shear: the two stops of the slider."""


def unwrapped(vertices, faces, target):
    """The layout with automatic seams."""
    outcome = attempt(authalic.unwrap, (authalic.Surface(vertices, faces),), {"target": target}, 1)
    if outcome.error:
        return Failure(outcome.error)
    result = outcome.result
    return Layout(result.uv[result.faces], outcome.seconds, result.status)
