# SPDX-License-Identifier: MIT OR Apache-2.0
"""Layouts of other tools, and Blender's packer on anyone's islands."""

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench.peers import methods, run
from bench.seams.figures import uv_areas
from bench.seams.layout import Failure, Layout

WORKER = ("-m", "bench.seams.in_blender")
ITERATIONS = 20
"""The iterations of Minimum Stretch, twice as many as by default."""
GAP = 0.002
"""The distance between the islands that Blender packs; its margin is half of it, all around each island."""
USUAL_SHARE = 0.55
"""The share of the square that most packed layouts take."""


@dataclass(frozen=True)
class Blender:
    """Blender as a module of another interpreter; every task runs in a process of its own."""

    python: str
    absent: str
    """Why there is no Blender, or an empty string."""
    folder: Path
    limit: float

    def unwrapped(self, vertices, faces):
        """The layout of Smart UV Project, relaxed by Minimum Stretch."""
        return self._task("unwrap", vertices=vertices, faces=faces, iterations=ITERATIONS)

    def packed(self, vertices, faces, corners):
        """A layout with its islands packed anew, and the packer's seconds."""
        # the packer adds the margin before it scales the islands, so they come at about the scale they get
        scaled = corners * np.sqrt(USUAL_SHARE / uv_areas(corners).sum())
        return self._task("pack", vertices=vertices, faces=faces, corners=scaled, margin=GAP / 2)

    def _task(self, name, **arrays):
        """The layout that a task in Blender leaves, or why it left none."""
        if not self.python:
            return Failure(f"not installed: {self.absent}")
        self.folder.mkdir(parents=True, exist_ok=True)
        source, target = self.folder / "task.npz", self.folder / "result.npz"
        np.savez(source, **arrays)
        target.unlink(missing_ok=True)
        command = [self.python, *WORKER, name, source, target]
        problem = run.finished(command, self.limit, self.folder / "log.txt")
        if problem:
            return Failure(problem)
        with np.load(target) as result:
            if "error" in result:
                return Failure(str(result["error"]))
            return Layout(result["corners"].astype(float), float(result["seconds"]))


def xatlas(vertices, faces):
    """The atlas with xatlas' own options, in the smallest square that holds it."""
    began = time.perf_counter()
    atlas = methods.xatlas_atlas(vertices, faces)
    seconds = time.perf_counter() - began
    return Layout((atlas.image / atlas.image.max())[atlas.faces], seconds)
