# SPDX-License-Identifier: MIT OR Apache-2.0
"""Forked workers, as multiprocessing and joblib use them on Linux."""

import multiprocessing
import sys

import numpy as np
import pytest

import authalic

from . import meshes


def _solve(queue, vertices, faces):
    queue.put(authalic.disk_map(vertices, faces, max_iterations=5).uv)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no fork")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_forked_worker_maps_like_its_parent():
    vertices, faces = meshes.grid(120, 120)[:2]
    expected = authalic.disk_map(vertices, faces, max_iterations=5).uv
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    worker = context.Process(target=_solve, args=(queue, vertices, faces), daemon=True)
    worker.start()
    assert np.array_equal(queue.get(timeout=60), expected)
    worker.join(timeout=60)
    assert worker.exitcode == 0
