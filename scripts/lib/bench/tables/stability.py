# SPDX-License-Identifier: MIT OR Apache-2.0
"""Spheres: noise on the mesh, and the smallest eigenvalue of the stretch energy's Hessian.

Sutti & Yueh, Tables 3, 4, 7 and 8.
"""

import numpy as np
from scipy.sparse import csc_array, eye_array
from scipy.sparse.linalg import LinearOperator, eigsh, splu

import authalic
from bench import plots
from bench.published import LINE_SEARCHES, NOISE, NONE, SMALLEST_EIGENVALUES
from bench.report import fixed, plain, scientific
from bench.tables import sphere
from bench.tables.disk import label

NOISES = (1e-3, 5e-3)
NOISE_ITERATIONS = 100
SEED = 7
NOISE_COLUMNS = (
    "mesh", "σ", "SD/mean", "E_A", "folds", "folds, corrected", "E_A without noise", "err-E_A", "s",
    "published SD/mean", "published E_A", "published folds", "published folds, corrected",
    "published err-E_A", "published s",
)  # fmt: skip
NOISE_NOTE = f"""\
Sutti & Yueh, Tables 7 and 8: {NOISE_ITERATIONS} iterations of gradient descent (interpolation) on a mesh
whose vertices were moved along their normals (weighted by area) by σ times a Gaussian number (numpy's
`default_rng({SEED})`). The paper does not say how large the mesh is when the noise is added; here its
area is 4π, that of the unit sphere. That was chosen by plausibility: σ = 5e-3 then raises Bulldog's
energy by about as much as published, David Head's by less than half as much; with area 1 or longest side
1 both rise by two to six times as much. E_A and what stands before it are without the correction for
bijectivity. err-E_A is equation 6.6. The published ones cannot be compared: divided out, their mean |ṽ −
v|² is the same for both σ (David Head .36, Bulldog 800), so it is not that of the noise."""

SMALL = 13_000
"""Vertices up to which the eigenvalues are computed."""
START = {"method": "fixed_point", "max_iterations": 10, "unfold": False}
"""The options of the map from which gradient descent starts."""
COARSE = 1e-3
"""The relative tolerance of the Lanczos method."""
DESCENTS = {False: 1000, True: 10_000}
HESSIAN_COLUMNS = (
    "mesh", "V", "map", "iterations", "SD/mean", "E_A", "folds", "smallest eigenvalue", "s of the map",
    "published SD/mean", "published E_A", "published folds", "published smallest eigenvalue", "published s",
)  # fmt: skip


def write_noise(bench):
    """The table of maps of meshes with noise."""
    bench.report.section("Spheres: noise along the vertex normals", NOISE_NOTE)
    bench.report.columns(NOISE_COLUMNS)
    for name, mesh in bench.spheres.items():
        for deviation in NOISES:
            bench.report.row(_noise_cells(bench, name, mesh, deviation))


def with_noise(vertices, faces, deviation):
    """The vertices scaled to the unit sphere's area, and these with Gaussian noise along their normals."""
    normals = sphere.face_normals(vertices, faces)
    vertices = vertices * np.sqrt(4 * np.pi / np.linalg.norm(normals, axis=1).sum())
    at_vertices = np.zeros_like(vertices)
    np.add.at(at_vertices, faces, normals[:, None, :])
    at_vertices /= np.linalg.norm(at_vertices, axis=1, keepdims=True)
    amount = deviation * np.random.default_rng(SEED).standard_normal(len(vertices))
    return vertices, vertices + amount[:, None] * at_vertices


def relative_error(energy, noisy_energy, vertices, noisy):
    """err-E_A, equation 6.6."""
    return len(vertices) * abs(noisy_energy - energy) / ((noisy - vertices) ** 2).sum()


def _noise_cells(bench, name, mesh, deviation):
    vertices, noisy = with_noise(*mesh, deviation)
    noisy_mesh, noisy_name = (noisy, mesh[1]), f"{name} with noise {deviation}"
    published = NOISE.get((name, deviation), NONE)
    return (
        label(name), f"{deviation:g}", *_noise_figures(bench, name, mesh, noisy_name, noisy_mesh, vertices),
        fixed(published.deviation, 4), scientific(published.energy), plain(published.folds),
        plain(published.folds_corrected), scientific(published.error), fixed(published.seconds, 2),
    )  # fmt: skip


def _noise_figures(bench, name, mesh, noisy_name, noisy_mesh, vertices):
    search = "interpolation", NOISE_ITERATIONS
    without = sphere.descended(bench, name, mesh, *search)
    outcome = sphere.descended(bench, noisy_name, noisy_mesh, *search)
    if without.error or outcome.error:
        return (without.error or outcome.error, *[""] * 6)
    after = sphere.corrected(bench, noisy_name, noisy_mesh, outcome, *search)
    (_, energy), (even, noisy_energy) = sphere.evenness(mesh, without), sphere.evenness(noisy_mesh, outcome)
    return (
        fixed(even, 4), scientific(noisy_energy), sphere.folds(outcome), sphere.folds(after),
        scientific(energy), scientific(relative_error(energy, noisy_energy, vertices, noisy_mesh[0])),
        fixed(outcome.seconds, 2),
    )  # fmt: skip


def write_hessian(bench):
    """The table of the smallest eigenvalues, and the convergence of the long descents."""
    iterations = DESCENTS[bench.long]
    bench.report.section("Spheres: smallest eigenvalue of the Hessian", _hessian_note(bench.long))
    bench.report.columns(HESSIAN_COLUMNS)
    small = {name: mesh for name, mesh in bench.spheres.items() if len(mesh[0]) <= SMALL}
    for name, mesh in small.items():
        start = bench.run(authalic.sphere_map, name, mesh, **START)
        bench.report.row(_hessian_cells(name, mesh, "fixed point", start))
        outcome = sphere.descended(bench, name, mesh, "interpolation", iterations)
        bench.report.row(_hessian_cells(name, mesh, "gradient descent", outcome, iterations))
    if small:
        _draw(bench, small, iterations)


def _draw(bench, meshes, iterations):
    curves, dots = {}, {}
    for name, mesh in meshes.items():
        outcome = sphere.descended(bench, name, mesh, "interpolation", iterations)
        curves[name] = plots.histories({"gradient descent": outcome})
        published = LINE_SEARCHES.get((name, "interpolation", iterations), NONE)
        dots[name] = [(iterations, published.energy)] if published.energy else []
    path = bench.folder / "tables-sphere-long.png"
    plots.draw_convergence(path, f"Gradient descent, {iterations} iterations", curves, dots)
    bench.report.figure(path, f"Authalic energy in {iterations} iterations of gradient descent")


def _hessian_note(long):
    less = "" if long else f" (the paper: 10,000; `--long` runs these, {DESCENTS[False]} are the default)"
    return f"""\
Sutti & Yueh, Tables 3 and 4, Figure 7: the Hessian of the stretch energy (their appendix B, (3n, 3n),
areas of the surface scaled to those of the image) at the map that gradient descent starts from, up to
{START["max_iterations"]} steps of the fixed-point iteration, and after {DESCENTS[long]} iterations of
gradient descent with interpolation{less}, both without the correction for bijectivity. The paper takes
the smallest of the 2,000 eigenvalues nearest to 0; here it is the smallest of all, by the Lanczos method.
Meshes up to {SMALL:,} vertices."""


def _hessian_cells(name, mesh, method, outcome, iterations=None):
    key = iterations or method
    figures = LINE_SEARCHES.get((name, "interpolation", iterations), NONE)
    eigenvalue = SMALLEST_EIGENVALUES.get((name, key))
    return (
        label(name), len(mesh[0]), method, *_at_map(mesh, outcome), fixed(outcome.seconds, 2),
        fixed(figures.deviation, 4), scientific(figures.energy), plain(figures.folds),
        "" if eigenvalue is None else f"{eigenvalue:.4e}", fixed(figures.seconds, 2),
    )  # fmt: skip


def _at_map(mesh, outcome):
    if outcome.error:
        return (outcome.error, "", "", "", "")
    even, energy = sphere.evenness(mesh, outcome)
    eigenvalue = smallest_eigenvalue(hessian(*mesh, outcome.result.positions))
    return (
        outcome.result.iterations, fixed(even, 4), scientific(energy), sphere.folds(outcome),
        f"{eigenvalue:.4e}",
    )  # fmt: skip


def hessian(vertices, faces, image):
    """The Hessian of the stretch energy, (3n, 3n), areas of the surface scaled to those of the image."""
    return csc_array(authalic.stretch_hessian(vertices, faces, image), (image.size, image.size))


def smallest_eigenvalue(matrix):
    """The algebraically smallest eigenvalue of a symmetric sparse matrix, to 1e-9 of the largest magnitude.

    Many eigenvalues may lie close together there, above all at 0. So the first estimate is coarse, of the
    matrix shifted until the end of its spectrum is far from 0; the next are nearest to shifts from below.
    """
    largest = abs(_extreme(matrix, COARSE))
    smallest = _extreme(matrix - largest * eye_array(matrix.shape[0]), COARSE) + largest
    gap = 3 * COARSE * largest
    for _ in range(3):
        smallest = _nearest(matrix, smallest - gap)
        gap /= 100
    return smallest


def _nearest(matrix, shift):
    """The eigenvalue nearest to a shift; its error is COARSE times its distance from the shift."""
    moved = (matrix - shift * eye_array(matrix.shape[0])).tocsc()
    factors = splu(moved, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True})
    inverse = LinearOperator(matrix.shape, matvec=factors.solve, dtype=float)
    return shift + 1 / _extreme(inverse, COARSE)


def _extreme(matrix, tolerance):
    """The eigenvalue of largest magnitude."""
    # a fixed start gives the same figure in every run
    start = np.random.default_rng(SEED).standard_normal(matrix.shape[0])
    return float(eigsh(matrix, k=1, v0=start, tol=tolerance, return_eigenvectors=False)[0])
