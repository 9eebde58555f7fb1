# SPDX-License-Identifier: MIT OR Apache-2.0
"""Forked workers, as multiprocessing and joblib use them on Linux."""

import multiprocessing
import sys

import numpy as np
import pytest

import authalic

from . import meshes


def disk(vertices, faces):
    return authalic.disk_map(vertices, faces, max_iterations=5).uv


def sphere(vertices, faces):
    return authalic.sphere_map(vertices, faces, max_iterations=5).positions


def _solve(queue, solve, vertices, faces):
    queue.put(solve(vertices, faces))


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no fork")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize(
    ("solve", "mesh"), [(disk, meshes.grid(120, 120)), (sphere, meshes.bumpy_ball(5))], ids=["disk", "sphere"]
)
def test_a_forked_worker_maps_like_its_parent(solve, mesh):
    expected = solve(*mesh)
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    worker = context.Process(target=_solve, args=(queue, solve, *mesh), daemon=True)
    worker.start()
    assert np.array_equal(queue.get(timeout=60), expected)
    worker.join(timeout=60)
    assert worker.exitcode == 0
