# SPDX-License-Identifier: MIT OR Apache-2.0
"""The most memory that each call takes, in bytes for each vertex or number, in Markdown. Linux only.

Usage: python -m bench.memory TARGET_FILE [--parts NAME ...]
"""

import argparse
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import authalic
from bench.report import Report, machine

SIDES = (100, 200, 400, 800)
"""Squares have so many vertices along each side; spheres have about as many vertices in all."""
MOST = 160_000
"""Calls that solve systems are measured up to so many vertices, apart from a few."""


@dataclass(frozen=True)
class Call:
    """A call, what it is given, and up to how many vertices it is measured."""

    prepare: object
    """Takes a side, and returns the arguments."""
    run: object
    most: int = 640_000
    per: str = "vertex"


def square(side):
    """A bumpy square of side² vertices."""
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.linspace(0, 1, side)] * 2))
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    faces = [np.stack([first, first + a, first + b], axis=1) for a, b in ((1, side + 1), (side + 1, side))]
    return np.stack([x, y, 0.1 * np.sin(9 * x) * np.cos(7 * y)], axis=1), np.concatenate(faces)


def surface(side):
    """The square as a surface."""
    return [authalic.Surface(*square(side))]


def flat(side):
    """The square, and its shadow as a map."""
    vertices, faces = square(side)
    return [authalic.Surface(vertices, faces), np.ascontiguousarray(vertices[:, :2])]


def folded(side):
    """The square, and its shadow with two folds."""
    square_surface, image = flat(side)
    image[[side * side // 2, side * side // 3]] += 3 / side
    return [square_surface, image]


def ball(side):
    """A bumpy sphere of about side² vertices."""
    rows = round(side / 2**0.5)
    polar, azimuth = (np.pi * np.arange(1, rows) / rows)[:, None], np.pi * np.arange(2 * rows) / rows
    points = [np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar) + 0 * azimuth]
    inner = np.stack(points, axis=-1).reshape(-1, 3)
    vertices = np.concatenate([inner, [[0, 0, 1], [0, 0, -1]]])
    ring = np.arange(len(inner)).reshape(rows - 1, 2 * rows)
    right = np.roll(ring, -1, axis=1)
    quads = [(ring[:-1], ring[1:], right[1:]), (ring[:-1], right[1:], right[:-1])]
    caps = [
        (0 * ring[0] + len(inner), ring[0], right[0]),
        (0 * ring[0] + len(inner) + 1, right[-1], ring[-1]),
    ]
    faces = np.concatenate([np.stack(corners, axis=-1).reshape(-1, 3) for corners in [*quads, *caps]])
    x, y, z = vertices.T
    return [authalic.Surface(vertices * (1 + 0.2 * np.sin(3 * x) * np.cos(2 * y + z))[:, None], faces)]


def radial(side):
    """The sphere, and the directions of its vertices as a map."""
    [one] = ball(side)
    return [one, one.vertices / np.linalg.norm(one.vertices, axis=1)[:, None]]


def pair(make):
    """Two of the same surface, and three landmarks on each."""

    def prepared(side):
        [one] = make(side)
        marks = [one.n_vertices // part + side // 3 for part in (2, 4, 5)]
        return [one, one, marks]

    return prepared


def tube(side):
    """The sphere, and three short curves on it."""
    [one] = ball(side)
    return [one, [[one.n_vertices // part + step for step in range(4)] for part in (2, 3, 5)]]


def mapped(side):
    """The map of a sphere, and a value for each vertex. The sphere is small: cells count."""
    [one] = ball(60)
    return [authalic.sphere_map(one), np.arange(one.n_vertices) * 1.0, side]


def points(side):
    """The map of a small sphere, and side² points around it."""
    found, values, _ = mapped(60)
    return [found, values, np.random.default_rng(1).normal(size=(side * side, 3))]


def register(function, source, target, marks, **options):
    """A registration by points."""
    return function(source, target, source_landmarks=marks, target_landmarks=marks, **options)


CALLS = {
    "`Surface`": Call(lambda side: list(square(side)), authalic.Surface),
    "`Surface.cut`, without seams": Call(surface, lambda one: one.cut()),
    "`distortion`": Call(flat, authalic.distortion),
    "`stretch_hessian`": Call(radial, authalic.stretch_hessian),
    "`pack`, one island": Call(
        lambda side: [square(side)[0][:, :2], square(side)[1]],
        lambda uv, faces: authalic.pack(uv, faces, np.zeros(len(faces), int)),
    ),
    "`untangle`, two folds": Call(folded, authalic.untangle),
    "`repair`": Call(surface, authalic.repair),
    "`disk_map`": Call(surface, authalic.disk_map),
    "`disk_map`, free outline, weight 1e-3": Call(
        surface, lambda one: authalic.disk_map(one, boundary="free", angle_weight=1e-3), 40_000
    ),
    "`disk_maps`, one surface": Call(surface, lambda one: authalic.disk_maps([one]), MOST),
    "`sphere_map`": Call(ball, authalic.sphere_map, MOST),
    "`seams` of a disk": Call(surface, authalic.seams, MOST),
    "`seams` of a closed surface": Call(ball, authalic.seams, 40_000),
    "`unwrap` of a disk": Call(surface, authalic.unwrap, 40_000),
    "`unwrap` of a closed surface": Call(ball, authalic.unwrap, 40_000),
    "`register_disks`, both surfaces of so many vertices": Call(
        pair(surface), lambda *given: register(authalic.register_disks, *given), 40_000
    ),
    "`register_spheres`, both of so many": Call(
        pair(ball), lambda *given: register(authalic.register_spheres, *given), MOST
    ),
    "`register_hyperbolic`, both of so many": Call(
        tube,
        lambda one, curves: authalic.register_hyperbolic(
            one, one, source_curves=curves, target_curves=curves
        ),
        40_000,
    ),
    "`hyperbolic_structure`, three curves": Call(
        tube, lambda one, curves: authalic.hyperbolic_structure(one, curves=curves), MOST
    ),
    "`equirectangular`, for each cell": Call(
        mapped, lambda found, values, side: found.equirectangular(values, (side, side)), per="number"
    ),
    "the same, `conservative=True`": Call(
        mapped,
        lambda found, values, side: found.equirectangular(values, (side, side), conservative=True),
        per="number",
    ),
    "`sample`, for each point": Call(
        points, lambda found, values, places: found.sample(values, places), per="number"
    ),
    "`locate`, for each point": Call(
        points, lambda found, values, places: found.locate(places), per="number"
    ),
}
"""The rows of the table."""


def main(words=None):
    """Measures each call in a process of its own."""
    parser = argparse.ArgumentParser()
    parser.add_argument("target", type=Path)
    parser.add_argument("--parts", nargs="+", default=[])
    options = parser.parse_args(words)
    if sys.platform != "linux":
        parser.error("the most memory of a call is read from /proc, which only Linux has")
    report = Report(options.target)
    report.line(f"Memory, authalic {authalic.__version__}, {machine()}.")
    report.section(
        "Memory",
        "The most memory beyond what the process had before the call, in bytes for each vertex of a surface, "
        "or for each number where the row says so.",
    )
    report.columns(["call", *(f"{side * side:,}" for side in SIDES)])
    for name, call in CALLS.items():
        if not options.parts or any(part in name for part in options.parts):
            report.row([name, *(measured(name, side, call.most) for side in SIDES)])


def measured(name, side, most):
    """The bytes for each vertex as a cell of the table; empty where it is not measured."""
    if side * side > most:
        return ""
    command = [sys.executable, "-m", "bench.memory", "--child", name, str(side)]
    answer = subprocess.run(command, capture_output=True, text=True, check=False)
    if answer.returncode == 0:
        return f"{int(answer.stdout):,}"
    # a process that the system ends says nothing
    said = answer.stderr.strip().splitlines()
    return said[-1] if said else f"ended with code {answer.returncode}"


def child(name, side):
    """Runs a call, and prints the bytes that it took for each vertex."""
    call = CALLS[name]
    given = call.prepare(side)
    # the most so far is forgotten
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    before = kilobytes("VmRSS")
    kept = call.run(*given)
    taken = 1024 * (kilobytes("VmHWM") - before)
    del kept
    is_surface = call.per == "vertex" and isinstance(given[0], authalic.Surface)
    count = given[0].n_vertices if is_surface else side * side
    print(round(taken / count))


def kilobytes(name):
    """A number of the process from the system's table."""
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return int(next(line for line in lines if line.startswith(f"{name}:")).split()[1])


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        child(sys.argv[2], int(sys.argv[3]))
    else:
        main()
