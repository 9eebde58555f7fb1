# SPDX-License-Identifier: MIT OR Apache-2.0
"""The crate `authalic` as the registry of crates would get it."""

from __future__ import annotations

from pathlib import Path

from release.problems import refuse_any
from shell import run

_NEEDED = ("Cargo.toml", "README.md", "LICENSE-MIT", "LICENSE-APACHE", "src/lib.rs")


def check(log: Path | None = None) -> None:
    """The files of the crate are complete, and cargo compiles the crate from the packed ones alone."""
    package = ["cargo", "package", "--package", "authalic", "--locked", "--allow-dirty"]
    files = run([*package, "--list"], log=log).split("\n")
    refuse_any([f"the crate lacks {name}" for name in _NEEDED if name not in files])
    run(package, log=log)
