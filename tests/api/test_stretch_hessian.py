# SPDX-License-Identifier: MIT OR Apache-2.0
"""The Hessian of the stretch energy against a gradient built from cotangents."""

import numpy as np
import pytest
from scipy import sparse

import authalic

from . import meshes, oracle

SURFACES = {
    "ball": meshes.ball(2),
    "bumpy_ball": meshes.bumpy_ball(2),
    "tetrahedron": meshes.tetrahedron(),
    "torus": meshes.torus(),
    "bumpy_cap": meshes.bumpy_cap(6, 10),
}
surfaces = pytest.mark.parametrize("name", SURFACES)


def bent(mesh):
    """A map into space that is neither the surface nor on a sphere."""
    x, y, z = mesh.vertices.T
    return np.stack([x + 0.2 * y**2, 1.4 * y - 0.3 * z, z + 0.1 * np.sin(x + y)], axis=1)


def hessian(mesh, image, **options):
    return sparse.csc_array(authalic.stretch_hessian(*mesh, image, **options))


def targets_of(mesh, image, density=None):
    targets = oracle.face_areas(*mesh) if density is None else density
    return targets * oracle.face_areas(image, mesh.faces).sum() / targets.sum()


def gradient(mesh, image, targets):
    """2 L_S f, (n, 3), with the weights cot θ · a/(2|τ|) of the edges."""
    square = oracle.edge_lengths(image, mesh.faces) ** 2
    weights = (square.sum(axis=1, keepdims=True) - 2 * square) / (8 * targets[:, None])
    out = np.zeros_like(image)
    for corner in range(3):
        i, j = mesh.faces[:, corner - 2], mesh.faces[:, corner - 1]
        pull = 2 * weights[:, corner, None] * (image[i] - image[j])
        np.add.at(out, i, pull)
        np.add.at(out, j, -pull)
    return out


def times(matrix, field):
    """The matrix, ordered all x, all y, all z, times a field (n, 3)."""
    return (matrix @ field.T.ravel()).reshape(3, -1).T


def close(left, right, scale):
    assert np.abs(left - right).max() < 1e-11 * scale


@surfaces
def test_it_is_a_symmetric_sparse_matrix(name):
    mesh = SURFACES[name]
    n = len(mesh.vertices)
    data, indices, indptr = authalic.stretch_hessian(*mesh, bent(mesh))
    assert (data.dtype, indices.dtype, indptr.dtype) == (np.float64, np.int64, np.int64)
    assert data.shape == indices.shape == (indptr[-1],)
    assert indptr.shape == (3 * n + 1,)
    matrix = sparse.csc_array((data, indices, indptr), shape=(3 * n, 3 * n))
    assert matrix.has_canonical_format
    assert abs(matrix - matrix.T).max() < 1e-13 * abs(matrix).max()


@surfaces
@pytest.mark.parametrize("weighted", [False, True])
def test_it_is_the_derivative_of_the_gradient(name, weighted):
    mesh = SURFACES[name]
    image, random = bent(mesh), np.random.default_rng(1)
    density = random.uniform(1, 5, len(mesh.faces)) if weighted else None
    targets = targets_of(mesh, image, density)
    field = random.standard_normal(image.shape)
    along = {step: gradient(mesh, image + step * field, targets) for step in (-0.2, -0.1, 0.1, 0.2)}
    # along a line the gradient is a cubic, of which this quotient is the exact slope
    slope = (8 * (along[0.1] - along[-0.1]) - (along[0.2] - along[-0.2])) / 1.2
    product = times(hessian(mesh, image, density=density), field)
    close(product, slope, max(np.abs(values).max() for values in along.values()))


@surfaces
def test_it_knows_translations_rotations_and_the_degree_of_the_energy(name):
    mesh = SURFACES[name]
    image = bent(mesh)
    matrix, force = hessian(mesh, image), gradient(mesh, image, targets_of(mesh, image))
    scale = abs(matrix).max() * np.abs(image).max()
    for axis in np.eye(3):
        close(times(matrix, np.tile(axis, (len(image), 1))), 0, scale)
        close(times(matrix, np.cross(axis, image)), np.cross(axis, force), scale)
    close(times(matrix, image), 3 * force, scale)
    # Euler: fᵀ H f = 12 E_S
    energy = (oracle.face_areas(image, mesh.faces) ** 2 / targets_of(mesh, image)).sum()
    assert np.vdot(image, times(matrix, image)) == pytest.approx(12 * energy, rel=1e-9)


def test_the_scale_of_the_density_does_not_matter():
    mesh = SURFACES["bumpy_ball"]
    image, density = bent(mesh), np.arange(1.0, len(mesh.faces) + 1)
    plain, scaled = (hessian(mesh, image, density=scale * density) for scale in (1, 1e9))
    close(plain.toarray(), scaled.toarray(), abs(plain).max())


def test_no_motion_of_inner_vertices_lowers_the_energy_of_a_flat_map():
    """In the plane their motion leaves the whole area alone, and out of it all areas grow."""
    mesh = meshes.grid(6, 7)
    inner = np.setdiff1d(np.arange(len(mesh.vertices)), oracle.boundary_loop(mesh.faces))
    unknowns = np.concatenate([inner + axis * len(mesh.vertices) for axis in range(3)])
    values = np.linalg.eigvalsh(hessian(mesh, mesh.vertices).toarray()[np.ix_(unknowns, unknowns)])
    assert values[0] > -1e-12 * values[-1]


BAD = {
    "short": (meshes.ball(1).vertices[:-1], "image must be of shape"),
    "planar": (meshes.ball(1).vertices[:, :2], "image must be of shape"),
    "not_finite": (np.where(np.arange(18)[:, None] == 4, np.nan, meshes.ball(1).vertices), "NaN or infinite"),
}


@pytest.mark.parametrize(("image", "words"), BAD.values(), ids=BAD)
def test_a_bad_image_is_refused(image, words):
    with pytest.raises(authalic.MeshError, match=words):
        authalic.stretch_hessian(*meshes.ball(1), image)


def test_a_bad_density_is_refused():
    density = np.ones(32)
    density[3] = 0
    with pytest.raises(authalic.MeshError, match="density must be positive") as caught:
        authalic.stretch_hessian(*meshes.ball(1), meshes.ball(1).vertices, density=density)
    assert caught.value.indices == (3,)
