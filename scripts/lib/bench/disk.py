# SPDX-License-Identifier: MIT OR Apache-2.0
"""The table of disk maps, in Markdown.

Usage: python -m bench.disk TARGET_FILE REPEATS [MESH ...]
"""

import sys
from pathlib import Path

import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import spsolve

import authalic
from bench import meshes, published
from bench.report import machine, row, scientific, timed

PAPER = "conjugate_gradient, arc_length, 50"
METHODS = {
    "fixed_point, arc_length, 50": {"method": "fixed_point", "boundary": "arc_length", "max_iterations": 50},
    PAPER: {"method": "conjugate_gradient", "boundary": "arc_length", "max_iterations": 50},
    "default": {},
}
PUBLISHED_METHODS = {PAPER: "conjugate_gradient", "fixed_point, arc_length, 50": "fixed_point"}
"""The names of the methods in Table 1."""
COLUMNS = (
    "mesh", "V", "folds of the harmonic start", "method", "E_A", "published", "SD", "folds",
    "iterations", "status", "s", "E_A / paper's", "s / paper's",
)  # fmt: skip


def main(target, repeats, names):
    """Measures every mesh with every method and prints the table as it grows."""
    lines = [f"Disk maps, authalic {authalic.__version__}, {machine()}, median of {repeats} run(s).\n"]
    lines += [row(COLUMNS), row("---" for _ in COLUMNS)]
    print("\n".join(lines), flush=True)
    for name, mesh in meshes.disks(names).items():
        for cells in measured(name, mesh, repeats):
            lines.append(row(cells))
            print(lines[-1], flush=True)
    target.write_text("\n".join(lines) + "\n", encoding="utf-8")


def measured(name, mesh, repeats):
    """The rows of one mesh; ratios are to the paper's method, measured in the same run."""
    start = len(harmonic_start_folds(*mesh))
    results = {
        method: timed(authalic.disk_map, mesh, options, repeats) for method, options in METHODS.items()
    }
    paper, paper_seconds = results[PAPER]
    for method, (result, seconds) in results.items():
        figures = result.distortion
        energy = figures.authalic_energy
        in_paper = published.DISKS.get((name, PUBLISHED_METHODS.get(method)), published.NONE)
        yield (
            name, len(mesh[0]), start, method, f"{energy:.2e}", scientific(in_paper.energy),
            f"{figures.area_ratio_std:.4f}", len(figures.folded), result.iterations, result.status,
            f"{seconds:.2f}", f"{energy / paper.distortion.authalic_energy:.3g}",
            f"{seconds / paper_seconds:.2f}",
        )  # fmt: skip


def harmonic_start_folds(vertices, faces):
    """The faces that fold in the harmonic map to arc length on the circle, computed by scipy."""
    (patch,) = authalic.cut(vertices, faces)
    loop = max(patch.boundary_loops, key=len)
    image = np.zeros((len(patch.vertices), 2))
    image[loop] = circle(patch.vertices[loop])
    inner = np.setdiff1d(np.arange(len(image)), loop)
    laplacian = cotangent_laplacian(patch.vertices, patch.faces)
    image[inner] = spsolve(laplacian[inner][:, inner].tocsc(), -laplacian[inner][:, loop] @ image[loop])
    a, b = (image[patch.faces[:, k]] - image[patch.faces[:, 0]] for k in (1, 2))
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return np.flatnonzero(area * np.sign(np.median(area)) <= 0)


def circle(points):
    """Places a closed polygon's vertices on the unit circle by arc length."""
    sides = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    angle = 2 * np.pi * (np.cumsum(sides) - sides) / sides.sum()
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def cotangent_laplacian(vertices, faces):
    """The positive semidefinite Laplacian with cotangent weights, (n, n)."""
    n, rows, columns, weights = len(vertices), [], [], []
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        a, b = vertices[faces[:, i]] - vertices[faces[:, k]], vertices[faces[:, j]] - vertices[faces[:, k]]
        rows.append(faces[:, i])
        columns.append(faces[:, j])
        weights.append(np.einsum("ij,ij->i", a, b) / np.linalg.norm(np.cross(a, b), axis=1) / 2)
    half = coo_matrix((np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns))), (n, n))
    weight = (half + half.T).tocsr()
    return (diags(np.asarray(weight.sum(axis=1)).ravel()) - weight).tocsr()


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3:])
