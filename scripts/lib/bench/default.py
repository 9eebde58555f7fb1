# SPDX-License-Identifier: MIT OR Apache-2.0
"""The default maps beside the papers' methods, with shear and reproducibility, in Markdown.

Usage: python -m bench.default TARGET_FILE [--meshes MESH ...]
"""

import argparse
from pathlib import Path

import numpy as np

import authalic
from bench import meshes
from bench.report import machine, row, timed

COLUMNS = (
    "mesh", "papers' E_A", "s", "default: E_A", "SD of the area ratio", "mean σ₁/σ₂", "moves under noise",
    "s", "more exact", "time",
)  # fmt: skip
DISK_PAPER = {"method": "conjugate_gradient", "boundary": "arc_length", "max_iterations": 50}
SPHERE_PAPER = {"method": "gradient_descent", "max_iterations": 100}
NOISE = 1e-12
"""The noise of the vertices, as a fraction of the surface's size."""


def main(words=None):
    """Measures every mesh by the papers' method and by the default, and prints the table as it grows."""
    parser = argparse.ArgumentParser()
    parser.add_argument("target", type=Path)
    parser.add_argument("--meshes", nargs="+", default=())
    options = parser.parse_args(words)
    lines = [f"Default maps, authalic {authalic.__version__}, {machine()}, single runs.\n"]
    lines += [row(COLUMNS), row("---" for _ in COLUMNS)]
    print("\n".join(lines), flush=True)
    for name, mesh, call, paper in chosen(options.meshes):
        lines.append(row(measured(name, mesh, call, paper)))
        print(lines[-1], flush=True)
    options.target.write_text("\n".join(lines) + "\n", encoding="utf-8")


def chosen(names):
    """The meshes with these names, or all, each with its function and the papers' method."""
    disks, spheres = meshes.disks(), meshes.spheres()
    meshes.check_names(names, {**disks, **spheres})
    for kind, call, paper in (
        (disks, authalic.disk_map, DISK_PAPER),
        (spheres, authalic.sphere_map, SPHERE_PAPER),
    ):
        for name, mesh in meshes.only(names, kind).items():
            yield name, mesh, call, paper


def measured(name, mesh, call, paper):
    """The cells of one mesh."""
    published, published_seconds = timed(call, mesh, paper, 1)
    result, seconds = timed(call, mesh, {}, 1)
    figures, energy = result.distortion, published.distortion.authalic_energy
    assert len(figures.folded) == 0
    return (
        name, f"{energy:.2e}", f"{published_seconds:.2f}", f"{figures.authalic_energy:.2e}",
        f"{figures.area_ratio_std:.4f}", f"{figures.angle_distortion_mean:.2f}",
        f"{moved(call, mesh, result):.0e}", f"{seconds:.2f}", f"{energy / figures.authalic_energy:.0f}×",
        f"{seconds / published_seconds:.2f}×",
    )  # fmt: skip


def moved(call, mesh, result):
    """The farthest that a vertex of the image moves when noise moves the vertices of the surface."""
    vertices, faces = mesh
    size = np.linalg.norm(np.ptp(vertices, axis=0))
    noise = NOISE * size * np.random.default_rng(1).standard_normal(vertices.shape)
    return np.abs(image(call(vertices + noise, faces)) - image(result)).max()


def image(result):
    """The image of either kind of map."""
    return result.uv if isinstance(result, authalic.DiskMap) else result.positions


if __name__ == "__main__":
    main()
