# SPDX-License-Identifier: MIT OR Apache-2.0
"""Known vulnerabilities of the crates, by RustSec's database."""

from __future__ import annotations

import subprocess
from pathlib import Path

from release import cargo_tools
from shell import ROOT, Unavailable, run

DATABASE = "https://github.com/RustSec/advisory-db.git"
_SECONDS = 30


def check(log: Path | None = None) -> None:
    """Fails on an advisory for a crate of Cargo.lock. Raises Unavailable where the database cannot be had."""
    if not _reachable():
        raise Unavailable(
            f"advisories were NOT checked: {DATABASE} cannot be reached; the workflow checks them"
        )
    audit = cargo_tools.installed("cargo-audit", log)
    # A crate without a maintainer is shown, and does not hold a release back.
    refused = ("--deny", "unsound", "--deny", "yanked")
    run([audit, "audit", *refused, "--file", ROOT / "Cargo.lock"], log=log)


def _reachable() -> bool:
    command = ["git", "ls-remote", "--exit-code", DATABASE, "HEAD"]
    try:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            timeout=_SECONDS,
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0
