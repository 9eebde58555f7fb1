# SPDX-License-Identifier: MIT OR Apache-2.0
"""The licenses of the crates in the wheel: gathered by cargo-about, kept in THIRD-PARTY-LICENSES.md."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Collection

import distribution
from release import cargo_tools, places
from release.platforms import PLATFORMS
from release.problems import refuse_any
from shell import ROOT, run

NAME = distribution.THIRD_PARTY
CONFIGURATION = ROOT / "scripts" / "licenses.toml"
_TEMPLATE = ROOT / "scripts" / "licenses.hbs"
_FEATURES = ("--features", "metis")
_STANDARD = "## The standard library of Rust\n"
# Crates of the standard library by the paths of their sources in messages of panics.
_STANDARD_SOURCES = re.compile(rb"/rust/deps/([\w-]+?)-\d")


def gather(log: Path | None = None) -> str:
    """The text of the file: each license with the crates that are under it.

    The crates are those of all platforms; scripts/licenses.toml names these, and the licenses that are
    accepted. Another license is refused.
    """
    about = cargo_tools.installed("cargo-about", log)
    target = places.WORK / NAME
    target.parent.mkdir(parents=True, exist_ok=True)
    options = ["--config", CONFIGURATION, "--manifest-path", ROOT / "rust/python/Cargo.toml", *_FEATURES]
    command = [about, "generate", "--locked", "--offline", "--fail", *options]
    run(["cargo", "fetch", "--locked"], log=log)
    run([*command, "--output-file", target, _TEMPLATE], log=log)
    return _tidy(target.read_text(encoding="utf-8"))


def write(log: Path | None = None) -> Path:
    """Writes the file anew."""
    (ROOT / NAME).write_text(gather(log), encoding="utf-8")
    return ROOT / NAME


def check(log: Path | None = None) -> None:
    """Refuses a file that is not what the crates give."""
    is_new = gather(log) == (ROOT / NAME).read_text(encoding="utf-8")
    refuse_any([] if is_new else [f"{NAME} is not up to date: run `scripts/release licenses --write`"])


def listed(text: str | None = None) -> set[tuple[str, str]]:
    """The names and versions of the crates in the file, or in another text of its form."""
    if text is None:
        text = (ROOT / NAME).read_text(encoding="utf-8")
    return set(re.findall(r"(?m)^- (\S+) (\d\S*)$", text))


def of(crates: Collection[tuple[str, str]], text: str) -> str:
    """The file for some of its crates: the licenses that none of them is under are left out.

    The section of the standard library stays, which every wheel has.
    """
    head, *sections = re.split(r"(?m)^(?=## )", text)
    kept = [
        re.sub(r"(?m)^- (\S+) (\d\S*)\n", lambda row: row[0] if row.groups() in crates else "", section)
        for section in sections
        if listed(section) & set(crates) or section.startswith(_STANDARD)
    ]
    return (head + "".join(kept)).rstrip() + "\n"


def of_standard_library(text: str | None = None) -> set[str]:
    """The names of the crates in the section of the standard library, with `_` in the place of `-`."""
    text = (ROOT / NAME).read_text(encoding="utf-8") if text is None else text
    rows = re.findall(r"(?m)^- ((?:`\w+`(?:, )?)+): ", text.partition(_STANDARD)[2])
    return {name for row in rows for name in re.findall(r"\w+", row)}


def in_standard_library(code: bytes) -> set[str]:
    """The names, likewise, of the crates of the standard library that a compiled module tells of."""
    return {name.decode().replace("-", "_") for name in _STANDARD_SOURCES.findall(code)}


def compiled(targets: Collection[str] | None = None) -> set[tuple[str, str]]:
    """The names and versions of the crates that are compiled for targets, by default any, as cargo says."""
    targets = targets or [platform.target for platform in PLATFORMS.values()]
    command = ["cargo", "tree", "--locked", "--package", "authalic-python", *_FEATURES]
    command += ["--edges", "normal", "--prefix", "none", "--format", "{p}"]
    tree = run([*command, *(word for target in targets for word in ("--target", target))])
    crates = set(re.findall(r"(?m)^(\S+) v(\d\S*)", tree))
    return {(name, number) for name, number in crates if name not in ("authalic", "authalic-python")}


def _tidy(text: str) -> str:
    """The text without our own crate, its license, and space at the ends of lines and of blocks."""
    text = "\n".join(line.rstrip() for line in text.splitlines() if not line.startswith("- authalic "))
    text = re.sub(r"\n+```\n", "\n```\n", re.sub(r"```text\n+", "```text\n", text))
    return of(listed(text), text)
