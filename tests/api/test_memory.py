# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs for which there is no memory are refused before they start."""

import sys

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux says how much memory is free")

# A grid of n × n vertices, in a process whose address space may grow by 150 MB only.
LIMITED = """
import resource, numpy as np, authalic

def grid(n):
    x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n)))
    first = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = [np.stack([first, first + a, first + b], axis=1) for a, b in ((1, n + 1), (n + 1, n))]
    return np.stack([x, y, 0.1 * np.sin(3 * x)], axis=1), np.concatenate(faces)

small, large = authalic.Surface(*grid(30)), authalic.Surface(*grid(400))
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
}
for name, call in calls.items():
    try:
        call(large)
    except authalic.SolverError as error:
        print(name, error.kind, error.count, "0000 vertices" in str(error))
authalic.disk_map(small)
print("still alive")
"""


def test_a_run_without_memory_is_refused_and_python_lives_on(run_python):
    lines = run_python(LIMITED).splitlines()
    calls = ("disk_map", "disk_maps", "seams", "unwrap", "register_disks")
    assert lines == [*(f"{name} out_of_memory 0 True" for name in calls), "still alive"]


def test_the_message_has_the_numbers(run_python):
    code = LIMITED.replace("print(name, error.kind", "print(error); print(name, error.kind")
    assert "160000 vertices take 0.4 GB of memory at least, and 0." in run_python(code)
