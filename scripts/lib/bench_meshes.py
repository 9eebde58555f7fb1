# SPDX-License-Identifier: MIT OR Apache-2.0
"""Meshes for the benches: real ones from a data folder, or surfaces built on the spot."""

import os
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]


def data_folder(kind):
    """The folder of real meshes of a kind ("disk"), or None."""
    base = Path(os.environ.get("AUTHALIC_DATA") or ROOT.parent / "shared" / "data")
    return base / kind if (base / kind).is_dir() else None


def disks(names=()):
    """{name: (vertices, faces)}, smallest first; only the given names if there are any."""
    folder = data_folder("disk")
    found = built_disks() if folder is None else dict(map(_load, sorted(folder.glob("*.npz"))))
    unknown = set(names) - found.keys()
    if unknown:
        raise SystemExit(f"no mesh {', '.join(sorted(unknown))}; there are: {', '.join(sorted(found))}")
    chosen = {name: mesh for name, mesh in found.items() if not names or name in names}
    return dict(sorted(chosen.items(), key=lambda item: len(item[1][0])))


def built_disks():
    """Graphs over a square grid: gentle bumps, and one tall peak that needs much stretching."""
    bumps = _graph(140, lambda x, y: 0.15 * np.sin(5 * x) * np.cos(7 * y))
    peak = _graph(140, lambda x, y: 2.0 * np.exp(-12 * (x**2 + y**2)))
    return {"bumps (built)": bumps, "peak (built)": peak}


def _load(path):
    with np.load(path) as stored:
        return path.stem, (stored["V"], stored["F"])


def _graph(side, height):
    x, y = np.meshgrid(np.linspace(-1, 1, side), np.linspace(-1, 1, side), indexing="ij")
    vertices = np.stack([x, y, height(x, y)], axis=-1).reshape(-1, 3)
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    lower = np.stack([first, first + side, first + side + 1], axis=1)
    upper = np.stack([first, first + side + 1, first + 1], axis=1)
    return vertices, np.concatenate([lower, upper])
