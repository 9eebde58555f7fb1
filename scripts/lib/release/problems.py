# SPDX-License-Identifier: MIT OR Apache-2.0
"""What keeps a release from being made."""

from __future__ import annotations

from typing import Sequence


class Refused(Exception):
    """A release that must not be made; `problems` has a sentence for each reason."""

    def __init__(self, problems: Sequence[str]) -> None:
        super().__init__("; ".join(problems))
        self.problems = list(problems)


def refuse_any(problems: Sequence[str]) -> None:
    """Raises Refused if there are problems."""
    if problems:
        raise Refused(problems)
