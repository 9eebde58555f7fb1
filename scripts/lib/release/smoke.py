# SPDX-License-Identifier: MIT OR Apache-2.0
"""Installs the wheel in empty environments, of the oldest and the newest Python there is, and runs it."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pythons
from release import places
from release.platforms import FREE_THREADED
from shell import ROOT, run, version

_PROGRAM = ROOT / "scripts" / "lib" / "release" / "first_maps.py"


def test(free_threaded: bool = False, log: Path | None = None) -> None:
    """Maps computed by the installed wheel are right; `pip check` finds nothing missing.

    pip chooses the wheel for the Python and the system at hand.
    """
    orders = [(FREE_THREADED,)] if free_threaded else [pythons.NEWEST_FIRST, pythons.NEWEST_FIRST[::-1]]
    for python in dict.fromkeys(pythons.find(*order)[0] for order in orders):
        _test(python, log)


def _test(python: Path, log: Path | None) -> None:
    folder = places.WORK / "empty"
    shutil.rmtree(folder, ignore_errors=True)
    run([python, "-m", "venv", folder], log=log)
    own = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    pip = [own, "-m", "pip", "--disable-pip-version-check"]
    install = [*pip, "install", "--quiet", "--only-binary", ":all:"]
    run([*install, "numpy"], log=log)
    run([*install, "--no-index", "--find-links", places.FILES, f"authalic=={version()}"], log=log)
    run([*pip, "check"], log=log)
    run([own, "-I", _PROGRAM], log=log)
    shutil.rmtree(folder)
