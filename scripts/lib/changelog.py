# SPDX-License-Identifier: MIT OR Apache-2.0
"""What CHANGELOG.md says of a version."""

from __future__ import annotations

import datetime
import re
from dataclasses import dataclass

from shell import ROOT, Unavailable, version

UNRELEASED = "unreleased"
# The first day of zip files, in every zone of time.
_NO_DATE = datetime.date(1980, 1, 2)


@dataclass(frozen=True)
class Entry:
    """The section of a version: `## 0.2.0 (2026-12-01)` and the text below."""

    version: str
    date: str
    """As written: a day such as "2026-12-01", or "unreleased"."""
    text: str

    @property
    def day(self) -> datetime.date | None:
        """The day of the release, or None if the date is no day."""
        try:
            return datetime.date.fromisoformat(self.date)
        except ValueError:
            return None


def entries(text: str | None = None) -> list[Entry]:
    """The sections of a changelog, the project's own by default, newest first."""
    if text is None:
        text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    heads = list(re.finditer(r"(?m)^## (\S+) \((.+)\)$", text))
    ends = [head.start() for head in heads[1:]] + [len(text)]
    return [Entry(head[1], head[2], text[head.end() : end].strip()) for head, end in zip(heads, ends)]


def entry() -> Entry:
    """The section of the project's version."""
    for section in entries():
        if section.version == version():
            return section
    raise Unavailable(f"CHANGELOG.md has no section `## {version()} (date)`: write it")


def source_date_epoch() -> str:
    """SOURCE_DATE_EPOCH of all that is built: the day of the release, whatever the clock says."""
    day = entry().day or _NO_DATE
    midnight = datetime.datetime(day.year, day.month, day.day, tzinfo=datetime.timezone.utc)
    return str(int(midnight.timestamp()))
