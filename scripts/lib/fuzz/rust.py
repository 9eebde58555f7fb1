# SPDX-License-Identifier: MIT OR Apache-2.0
"""The targets in rust/fuzz/: built with the stable compiler, and run one after the other."""

from __future__ import annotations

import shutil
from pathlib import Path

from fuzz.engine import run_for
from fuzz.report import Finding, Line
from shell import ROOT, Unavailable, run, show

TARGETS = {
    "mesh": "construction of surfaces out of any arrays",
    "cut": "cuts along any seams",
    "repair": "repairs of any triangles",
    "disk_map": "maps to the disk",
    "sphere_map": "maps to the sphere",
    "seams": "seams, unwraps and packing",
    "registration": "registrations by points",
}
_PROJECT = ROOT / "rust" / "fuzz"
_BUILT = ROOT / "target" / "fuzz"
# One thread, because what libFuzzer counts should not depend on another; a stack trace says where.
_VARIABLES = {"RAYON_NUM_THREADS": "1", "RUST_BACKTRACE": "1"}


def prepare() -> None:
    """Builds the targets, our own crates with libFuzzer's counters."""
    if not shutil.which("cargo"):
        raise Unavailable("the targets of the crate need a Rust toolchain")
    wrapper = Path(__file__).with_name("rustc_with_coverage")
    variables = {"RUSTC_WRAPPER": str(wrapper), "CARGO_TARGET_DIR": str(_BUILT), "CARGO_INCREMENTAL": "0"}
    show(["cargo", "build", "--release", "--locked", "--manifest-path", _PROJECT / "Cargo.toml"], variables)


def search(name: str, folder: Path, seconds: float) -> tuple[Line, list[Finding]]:
    """Runs a target for some time; what it has found."""
    return run_for(name, [_program(name)], _VARIABLES, (_PROJECT / "corpus" / name, folder), seconds)


def replay(name: str, file: Path) -> int:
    """Runs a target on one input; an error where that fails."""
    run([_program(name), file], _VARIABLES)
    return 0


def _program(name: str) -> Path:
    return _BUILT / "release" / name
