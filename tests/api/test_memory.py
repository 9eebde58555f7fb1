# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs for which there is no memory are refused before they start."""

import sys

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux says how much memory is free")

# Grids of n × n vertices, one of them closed by a further vertex. The address space may grow by 150 MB only.
LIMITED = """
import re, resource, numpy as np, authalic

def grid(n):
    x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n)))
    first = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = [np.stack([first, first + a, first + b], axis=1) for a, b in ((1, n + 1), (n + 1, n))]
    return np.stack([x, y, 0.1 * np.sin(3 * x)], axis=1), np.concatenate(faces)

def closed(n):
    vertices, faces = grid(n)
    ring = np.arange(n * n).reshape(n, n)
    outline = np.concatenate([ring[0, :-1], ring[:-1, -1], ring[-1, :0:-1], ring[:0:-1, 0]])
    cap = np.stack([np.roll(outline, -1), outline, np.full(len(outline), n * n)], axis=1)
    return np.concatenate([vertices, [[0.5, 0.5, 1]]]), np.concatenate([faces, cap])

small, large = authalic.Surface(*grid(30)), authalic.Surface(*grid(400))
ball, huge = authalic.Surface(*closed(400)), authalic.Surface(*grid(800))
flat = huge.vertices[:, :2].copy()
curves = [[50_000, 50_001], [60_000, 60_001], [70_000, 70_001]]
authalic.disk_map(small)
used = int(next(line for line in open("/proc/self/status") if line.startswith("VmSize")).split()[1]) * 1024
resource.setrlimit(resource.RLIMIT_AS, (used + 150_000_000, resource.RLIM_INFINITY))
landmarks = dict(source_landmarks=[50_000], target_landmarks=[50_000])
calls = {
    "disk_map": lambda surface: authalic.disk_map(surface),
    "disk_maps": lambda surface: authalic.disk_maps([surface]),
    "seams": lambda surface: authalic.seams(surface),
    "unwrap": lambda surface: authalic.unwrap(surface),
    "register_disks": lambda surface: authalic.register_disks(surface, surface, **landmarks),
    "sphere_map": lambda _: authalic.sphere_map(ball),
    "register_spheres": lambda _: authalic.register_spheres(ball, ball, **landmarks),
    "register_hyperbolic": lambda _: authalic.register_hyperbolic(
        ball, ball, source_curves=curves, target_curves=curves
    ),
    "hyperbolic_structure": lambda _: authalic.hyperbolic_structure(ball, curves=curves),
    "repair": lambda _: authalic.repair(huge),
    "untangle": lambda _: authalic.untangle(huge, flat),
    "register_disks, one large": lambda surface: authalic.register_disks(
        small, surface, source_landmarks=[400], target_landmarks=[50_000]
    ),
}
for name, call in calls.items():
    try:
        call(large)
    except authalic.SolverError as error:
        print(name, error.kind, error.count, re.findall(r"\\d+(?= vertices take)", str(error))[0])
authalic.disk_map(small)
print("still alive")
"""


def test_a_run_without_memory_is_refused_and_python_lives_on(run_python):
    n_vertices = {
        **dict.fromkeys(("disk_map", "disk_maps", "seams", "unwrap"), 160_000),
        "register_disks": 320_000,
        "sphere_map": 160_001,
        **dict.fromkeys(("register_spheres", "register_hyperbolic"), 320_002),
        "hyperbolic_structure": 160_001,
        **dict.fromkeys(("repair", "untangle"), 640_000),
        "register_disks, one large": 160_000,
    }
    lines = run_python(LIMITED).splitlines()
    assert lines == [*(f"{name} out_of_memory 0 {n}" for name, n in n_vertices.items()), "still alive"]


def test_the_message_has_the_numbers(run_python):
    code = LIMITED.replace("print(name, error.kind", "print(error); print(name, error.kind")
    assert "160000 vertices take 0.4 GB of memory at least, and 0." in run_python(code)
