# SPDX-License-Identifier: MIT OR Apache-2.0
"""The Debian system with compilers for other platforms, and cargo in it."""

from __future__ import annotations

import os
import platform
from pathlib import Path
from typing import Mapping, Sequence

import debian
from cross.platforms import Platform
from shell import ROOT, CommandFailed, Unavailable, run, tail

SUITE = os.environ.get("AUTHALIC_CROSS_SUITE") or "sid"
"""The release of Debian: one with wine, and with a compiler as new as `rust-version` in Cargo.toml."""
_PACKAGES = (
    *("rustc", "cargo", "rust-src", "gcc", "libc6-dev", "ca-certificates"),
    *("gcc-mingw-w64-x86-64", "wine", "wine64"),
    *("gcc-aarch64-linux-gnu", "libc6-dev-arm64-cross", "qemu-user"),
)
# Crates that have been fetched before are there already.
_CRATES = Path(os.environ.get("CARGO_HOME") or Path.home() / ".cargo")
_TARGET = ROOT / "target" / "cross"
_VARIABLES = {
    "CARGO_HOME": str(_CRATES),
    "CARGO_TARGET_DIR": str(_TARGET),
    "CARGO_INCREMENTAL": "0",
    # Wine is told to say nothing, and neither to look for .NET and a browser nor for a screen.
    "WINEDEBUG": "-all",
    "WINEDLLOVERRIDES": "mscoree=;mshtml=",
    "DISPLAY": "",
}
# Debian has the sources of the standard library, and it compiled for few platforms: cargo compiles it along.
_STANDARD_LIBRARY = {"RUSTC_BOOTSTRAP": "1", "CARGO_UNSTABLE_BUILD_STD": "std,panic_unwind,test"}
# What programs for Windows begin and end with, which cargo does not compile along.
_OBJECTS = """
folder=/usr/lib/rustlib/x86_64-pc-windows-gnu/lib
mkdir -p $folder
for name in rsbegin rsend; do
    RUSTC_BOOTSTRAP=1 rustc --target x86_64-pc-windows-gnu --emit=obj -O -o $folder/$name.o \\
        /usr/lib/rustlib/src/rust/library/rtstartup/$name.rs || exit 1
done
"""


def run_inside(
    words: Sequence[object], log: Path, variables: Mapping[str, str] | None = None, seconds: int = 7200
) -> str:
    """Runs a command in the Debian system, in the project's folder, and returns its output.

    Raises Unavailable where there can be no such system.
    """
    if platform.machine() != "x86_64":
        raise Unavailable("the Debian system with wine is for x86-64")
    root = debian.system("cross", SUITE, _PACKAGES, log)
    _CRATES.mkdir(parents=True, exist_ok=True)
    limited = ["timeout", str(seconds), *words]
    settings = {**_VARIABLES, **(variables or {})}
    return run(debian.command(root, limited, [ROOT, _CRATES], settings, ROOT), log=log)


def cargo(platform: Platform, words: Sequence[object], log: Path, program: str = "cargo") -> str:
    """Runs cargo, or a program that calls it, for a platform; returns the output."""
    variables = {**platform.variables, **_STANDARD_LIBRARY}
    command, *options = words
    # After the command: what follows `--` is for the programs that it runs.
    return run_inside([program, command, "--target", platform.triple, *options], log, variables)


def prepare(platform: Platform, log: Path) -> None:
    """Makes what programs of a platform need. Raises Unavailable where its programs do not run here."""
    run_inside(["sh", "-c", _OBJECTS], log)
    first, *rest = platform.runner.split()
    words = [first, "cmd", "/c", "ver"] if first == "wine" else [first, *rest, "--version"]
    try:
        run_inside(words, log, seconds=300)
    except CommandFailed as failure:
        reason = tail(failure.output, 3)
        raise Unavailable(f"{first} of Debian {SUITE} does not start:\n{reason}") from failure


def versions(log: Path) -> list[str]:
    """The versions of Debian's compiler and of what runs the programs."""
    lines = [["rustc", "--version"], ["wine", "--version"], ["qemu-aarch64", "--version"]]
    return [run_inside(words, log).splitlines()[0] for words in lines]
