# SPDX-License-Identifier: MIT OR Apache-2.0
"""Real meshes: the small ones in tests/data, and those of a data folder, AUTHALIC_DATA or ../shared/data."""

import importlib.util
import os
from pathlib import Path

import numpy as np
import pytest

from .meshes import ROOT, Mesh

FOLDERS = (
    ROOT / "tests" / "data",
    Path(os.environ.get("AUTHALIC_DATA") or ROOT.parent / "shared" / "data"),
)


def file(name):
    """The path of a file such as "disk/maze.npz"; skips the test if no folder has it."""
    for folder in FOLDERS:
        if (folder / name).exists():
            return folder / name
    pytest.skip(f"no data folder with {name} (AUTHALIC_DATA)")


def fsaverage5(name):
    """The path of a file of the cortex fsaverage5, such as "white_left.gii.gz", from the package nilearn."""
    package = importlib.util.find_spec("nilearn")
    if package is None:
        pytest.skip("no package nilearn, which has the cortex fsaverage5")
    return Path(package.origin).parent / "datasets" / "data" / "fsaverage5" / name


def each(*kinds):
    """A parameter `path` for every mesh of these kinds: "sphere", "disk", "hard" (only in a data folder)."""
    paths = {}
    for kind in kinds:
        for folder in FOLDERS:
            for path in sorted((folder / kind).glob("*.npz")):
                paths.setdefault(path.stem, path)
    return pytest.mark.parametrize("path", [pytest.param(paths[name], id=name) for name in sorted(paths)])


def load(path):
    with np.load(path) as arrays:
        return Mesh(arrays["V"].astype(np.float64), arrays["F"].astype(np.int64))
