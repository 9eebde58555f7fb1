# SPDX-License-Identifier: MIT OR Apache-2.0
"""Programs that cargo builds once, into .venv/cargo/."""

from __future__ import annotations

from pathlib import Path

from shell import VENVS, CommandFailed, Unavailable, run, say, tail

_VERSIONS = {"cargo-about": ("0.9.3", ("--features", "cli")), "cargo-audit": ("0.22.2", ())}
_FOLDER = VENVS / "cargo"


def installed(name: str, log: Path | None = None) -> Path:
    """A program of a fixed version, which cargo builds if it is not there."""
    number, options = _VERSIONS[name]
    say(f"looking for {name} {number} (cargo builds it the first time) ...")
    command = ["cargo", "install", name, "--version", number, "--locked", "--root", _FOLDER, *options]
    try:
        run(command, log=log)
    except (CommandFailed, OSError) as problem:
        reason = tail(getattr(problem, "output", "") or str(problem), 3)
        raise Unavailable(f"cargo cannot install {name}: {reason}") from problem
    return _FOLDER / "bin" / name
