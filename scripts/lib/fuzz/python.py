# SPDX-License-Identifier: MIT OR Apache-2.0
"""The targets of atheris: the checks of arrays, files of meshes and landmarks, and saved results."""

from __future__ import annotations

from pathlib import Path

import distribution
import environment
from fuzz.engine import run_for
from fuzz.report import Finding, Line
from shell import ROOT, run

TARGETS = {
    "arrays": "checks of arrays of any type, shape and layout",
    "files": "files of meshes and values",
    "json": "files of landmarks",
    "results": "saved results with changed entries",
}
_FOLDER = Path(__file__).parent
_VARIABLES = {"RAYON_NUM_THREADS": "1", "PYTHONPATH": str(ROOT / "addon"), "PYTHONWARNINGS": "ignore"}


def prepare() -> None:
    """Installs the wheel, and atheris beside it."""
    dev = environment.dev()
    distribution.install_wheel(distribution.build_wheel(dev), dev)
    environment.add(dev, "fuzz")


def search(name: str, folder: Path, seconds: float) -> tuple[Line, list[Finding]]:
    """Runs a target for some time; what it has found."""
    return run_for(name, _command(name), _VARIABLES, (_FOLDER / "none", folder), seconds)


def replay(name: str, file: Path) -> int:
    """Runs a target on one input; an error where that fails."""
    run([*_command(name), file], _VARIABLES)
    return 0


def _command(name: str) -> list:
    return [environment.dev().python, _FOLDER / f"of_{name}.py"]
