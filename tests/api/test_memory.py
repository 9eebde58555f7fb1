# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs for which there is no memory are refused before they start."""

import sys

import pytest

import authalic

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
        "register_disks, one large": 160_900,
    }
    lines = run_python(LIMITED).splitlines()
    assert lines == [*(f"{name} out_of_memory 0 {n}" for name, n in n_vertices.items()), "still alive"]


# Limits below what each call takes, some above what is refused before the work starts.
NARROW = """
import resource, numpy as np, authalic
from api.test_memory import LIMITED
exec(LIMITED.split("small, large")[0])

def limited(megabytes, call):
    [size] = [line for line in open("/proc/self/status") if line.startswith("VmSize")]
    most = 1024 * int(size.split()[1]) + 1_000_000 * megabytes
    resource.setrlimit(resource.RLIMIT_AS, (most, resource.RLIM_INFINITY))
    try:
        call()
        return "none"
    except (authalic.SolverError, authalic.MeshError) as error:
        return error.kind
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))

corners = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
pyramid = authalic.Surface(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]])
sphere = authalic.sphere_map(pyramid)
same = authalic.register_spheres(pyramid, pyramid, source_landmarks=[0, 1], target_landmarks=[0, 1])
large, ball = authalic.Surface(*grid(400)), authalic.Surface(*closed(400))
vertices, faces = grid(1500)
million, flat = authalic.Surface(vertices, faces), vertices[:, :2].copy()
many = np.broadcast_to(np.ones(3), (10_000_000, 3))
calls = {
    "disk_map": (900, lambda: authalic.disk_map(large)),
    "disk_map, free": (450, lambda: authalic.disk_map(large, boundary="free", angle_weight=1e-3)),
    "sphere_map": (900, lambda: authalic.sphere_map(ball)),
    "seams": (700, lambda: authalic.seams(large)),
    "Surface": (100, lambda: authalic.Surface(vertices, faces)),
    "Surface of repeated rows": (300, lambda: authalic.Surface(many, [[0, 1, 2]])),
    "cut": (400, lambda: million.cut()),
    "distortion": (250, lambda: authalic.distortion(million, flat)),
    "distortions": (250, lambda: authalic.distortions([million], [flat])),
    "stretch_hessian": (400, lambda: authalic.stretch_hessian(million, vertices)),
    "pack": (200, lambda: authalic.pack(flat, faces, np.zeros(len(faces), int))),
    "equirectangular": (1000, lambda: sphere.equirectangular(np.arange(4.0), (30_000, 10_000))),
    "equal_area_grid": (1000, lambda: sphere.equal_area_grid(np.arange(4.0), 20_000)),
    "sample": (1000, lambda: sphere.sample(np.zeros((4, 1_000_000)), corners.repeat(500, axis=0))),
    "locate": (400, lambda: sphere.locate(many)),
    "follow": (400, lambda: same.follow(many)),
    "pull": (100, lambda: same.pull(np.broadcast_to(np.zeros(1), (4, 10_000_000)))),
}
for name, (megabytes, call) in calls.items():
    print(name, "->", limited(megabytes, call), flush=True)
"""


def test_what_does_not_fit_into_memory_is_an_error_of_every_call(run_python):
    lines = run_python(NARROW).splitlines()
    assert len(lines) == 17
    assert [line for line in lines if not line.endswith("-> out_of_memory")] == []


def test_threads_beyond_reason_are_not_started(run_python):
    code = """
import os, authalic
from api import meshes
authalic.set_threads(2**40)
authalic.disk_map(*meshes.grid(40))
print(len(os.listdir("/proc/self/task")) < 1100)
"""
    assert run_python(code).strip() == "True"


def test_a_sequence_that_lies_about_its_length_is_read_to_its_end():
    class Long(list):
        def __len__(self):
            return 2**62

    square = ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    maps = authalic.disk_maps(Long([square]), densities=Long([[1.0, 2.0]]))
    assert len(maps) == 1 and maps[0].status == "converged"
    with pytest.raises(TypeError, match="string"):
        authalic.disk_maps("ab")


def test_the_message_has_the_numbers(run_python):
    code = LIMITED.replace("print(name, error.kind", "print(error); print(name, error.kind")
    assert "160000 vertices take 518 MB of memory at least, and 1" in run_python(code)
