# SPDX-License-Identifier: MIT OR Apache-2.0
"""The shapes that the page offers, as OBJ files: `python -m web.shapes FOLDER`.

Knot and frame are made of quads. The knot has UVs of its own, those of the pipe that it is, for comparison.
"""

import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
SPOT = ROOT / "tests" / "data" / "sphere" / "spot_2930.npz"


def main(folder: Path) -> None:
    """Writes all shapes."""
    sys.path.insert(0, str(ROOT / "docs" / "examples"))
    import pictures  # it needs matplotlib

    folder.mkdir(parents=True, exist_ok=True)
    star, triangles = pictures.star()
    shapes = {
        "cow": (*cow(), None),
        "knot": knot(),
        "star": (star[:, [0, 2, 1]] * [1, 1, -1], triangles, None),
        "frame": (*frame(), None),
    }
    for name, (vertices, polygons, uv) in shapes.items():
        (folder / f"{name}.obj").write_text(obj(vertices, polygons, uv), encoding="ascii")


def cow() -> tuple[np.ndarray, np.ndarray]:
    """Spot by Keenan Crane, in the public domain, turned to the viewer."""
    with np.load(SPOT) as file:
        return file["V"] * [-1, 1, -1], file["F"]


def knot(along: int = 160, around: int = 14) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """A pipe along a trefoil knot: vertices, quads, and its UVs as points and the quads between them."""
    t = 2 * np.pi * np.arange(along) / along
    center = np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t)], axis=1)
    forward = np.roll(center, -1, axis=0) - np.roll(center, 1, axis=0)
    forward /= np.linalg.norm(forward, axis=1, keepdims=True)
    # the pipe thins out and swells
    radius = 0.42 + 0.12 * np.cos(3 * t)
    side = np.cross(forward, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, forward)
    angle = 2 * np.pi * np.arange(around) / around
    ring = np.cos(angle)[:, None] * side[:, None] + np.sin(angle)[:, None] * up[:, None]
    vertices = (center[:, None] + radius[:, None, None] * ring).reshape(-1, 3)
    row, column = (index.ravel() for index in np.mgrid[:along, :around])
    corners = [(row, column), (row + 1, column), (row + 1, column + 1), (row, column + 1)]
    quads = np.stack([i % along * around + j % around for i, j in corners], axis=1)
    points = np.stack(np.mgrid[: along + 1, : around + 1], axis=-1).reshape(-1, 2) / [along, around]
    uv_quads = np.stack([i * (around + 1) + j for i, j in corners], axis=1)
    return vertices, quads, (points, uv_quads)


def frame(size: int = 17, width: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """The edges of a cube as round bars, a surface of genus 5: vertices and quads."""
    is_outer = np.minimum(np.arange(size), np.arange(size)[::-1]) < width
    x, y, z = np.meshgrid(is_outer, is_outer, is_outer, indexing="ij")
    bars = (x & y) | (y & z) | (z & x)
    return smoothed(*boundary_of_cells(np.pad(bars, 1)))


def boundary_of_cells(inside: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The squares between cells inside and outside, counterclockwise from outside."""
    quads = []
    for axis in range(3):
        first, second = (np.eye(3, dtype=int)[(axis + k) % 3] for k in (1, 2))
        for step in (1, -1):
            seen = inside & ~np.roll(inside, -step, axis=axis)
            base = np.argwhere(seen) + (np.eye(3, dtype=int)[axis] if step == 1 else 0)
            square = [base, base + first, base + first + second, base + second]
            quads.append(np.stack(square if step == 1 else square[::-1], axis=1))
    places, index = np.unique(np.concatenate(quads).reshape(-1, 3), axis=0, return_inverse=True)
    return places.astype(float), index.reshape(-1, 4)


def smoothed(vertices: np.ndarray, quads: np.ndarray, rounds: int = 12) -> tuple[np.ndarray, np.ndarray]:
    """Every vertex moved halfway to the mean of its neighbors, again and again; then scaled to size 1."""
    ends = np.concatenate([quads, np.roll(quads, -1, axis=1)]).reshape(-1)
    neighbors = np.concatenate([np.roll(quads, -1, axis=1), quads]).reshape(-1)
    count = np.bincount(ends, minlength=len(vertices))[:, None]
    for _ in range(rounds):
        total = np.zeros_like(vertices)
        np.add.at(total, ends, vertices[neighbors])
        vertices = (vertices + total / count) / 2
    vertices = vertices - vertices.mean(axis=0)
    return vertices / np.abs(vertices).max(), quads


def obj(vertices: np.ndarray, polygons: np.ndarray, uv: tuple[np.ndarray, np.ndarray] | None) -> str:
    """The text of an OBJ file; decimals of six digits."""
    lines = ["# made for the page of Authalic", *(f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in vertices)]
    if uv is None:
        lines += ["f " + " ".join(map(str, polygon)) for polygon in (polygons + 1).tolist()]
    else:
        points, corners = uv
        lines += [f"vt {u:.6f} {v:.6f}" for u, v in points]
        pairs = np.stack([polygons, corners], axis=2) + 1
        lines += ["f " + " ".join(f"{a}/{b}" for a, b in polygon) for polygon in pairs.tolist()]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main(Path(sys.argv[1]))
