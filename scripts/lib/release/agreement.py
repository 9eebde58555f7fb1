# SPDX-License-Identifier: MIT OR Apache-2.0
"""The places that name the version: a release is made only where they agree."""

from __future__ import annotations

import re

import changelog
from shell import ROOT, version


def disagreements(tag: str | None = None) -> list[str]:
    """What keeps the version from being released, a sentence each.

    Without a tag this is a rehearsal: the changelog may still say "unreleased".
    """
    wrong = []
    number = version()
    if not re.fullmatch(r"\d+\.\d+\.\d+", number):
        wrong.append(f"Cargo.toml has the version {number}, which is not of the form 1.2.3")
    if tag is not None and tag != f"v{number}":
        wrong.append(f"the tag is {tag}, but Cargo.toml has the version {number}: the tag must be v{number}")
    return [*wrong, *_changelog(number, dated=tag is not None), *_citation(number), *_lock(number)]


def _changelog(number: str, dated: bool) -> list[str]:
    sections = changelog.entries()
    if not sections or sections[0].version != number:
        found = sections[0].version if sections else "none"
        return [f"the first section of CHANGELOG.md is {found}, but Cargo.toml has the version {number}"]
    section = sections[0]
    wrong = [] if section.text else [f"the section {number} of CHANGELOG.md is empty"]
    if section.day is None and (dated or section.date != changelog.UNRELEASED):
        wrong.append(
            f"the section {number} of CHANGELOG.md says `{section.date}`: write the day, as 2026-12-01"
        )
    return wrong


def _citation(number: str) -> list[str]:
    found = re.findall(r"(?m)^version: (.+)$", (ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    if found == [number]:
        return []
    return [f"CITATION.cff has the version {', '.join(found) or 'none'}, but Cargo.toml {number}"]


def _lock(number: str) -> list[str]:
    text = (ROOT / "Cargo.lock").read_text(encoding="utf-8")
    found = re.findall(r'(?m)^name = "(authalic(?:-python)?)"\nversion = "(.+)"$', text)
    return [
        f"Cargo.lock has {name} {locked}, but Cargo.toml {number}: run `cargo check`"
        for name, locked in found
        if locked != number
    ]
