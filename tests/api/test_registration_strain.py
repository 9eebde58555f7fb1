# SPDX-License-Identifier: MIT OR Apache-2.0
"""The strain of registrations against singular values computed by numpy."""

import numpy as np
import pytest

import authalic

from . import curves, meshes, pairs

NAMES = ("caps", "turned_caps", "ball_and_ellipsoid")


def areas(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def singular_values(vertices, images, faces):
    """σ (m, 2) of the linear map of each face, by orthonormal bases of its plane."""
    edges = np.stack([vertices[faces[:, k]] - vertices[faces[:, 0]] for k in (1, 2)], axis=2)
    image_edges = np.stack([images[faces[:, k]] - images[faces[:, 0]] for k in (1, 2)], axis=2)
    _, upper = np.linalg.qr(edges)
    return np.linalg.svd(image_edges @ np.linalg.inv(upper), compute_uv=False)


@pytest.fixture(scope="module", params=NAMES)
def both(request):
    pair = pairs.PAIRS[request.param]
    return pairs.register(pair), pair


def test_singular_values_between_surfaces_of_one_area(both):
    result, pair = both
    area = areas(pair.source.vertices, pair.source.faces)
    target_area = areas(pair.target.vertices, pair.target.faces).sum()
    sigma = singular_values(pair.source.vertices, result.positions, pair.source.faces)
    sigma *= np.sqrt(area.sum() / target_area)
    strain = result.strain
    assert np.allclose(strain.sigma, sigma, rtol=1e-9, atol=1e-9)
    energy = ((sigma**2 + sigma**-2.0).sum(axis=1)) / 4
    assert np.allclose(strain.symmetric_dirichlet, energy, rtol=1e-6)
    share = area / area.sum()
    assert strain.mean == pytest.approx(share @ strain.symmetric_dirichlet)
    assert strain.stretched == pytest.approx(share[(sigma[:, 0] > 2) | (sigma[:, 1] < 0.5)].sum())
    for value, part in ((strain.median, 0.5), (strain.p95, 0.95)):
        below = share[strain.symmetric_dirichlet < value].sum()
        upto = share[strain.symmetric_dirichlet <= value].sum()
        assert below <= part <= upto + 1e-12


def test_no_strain_between_a_mesh_and_its_turned_copy():
    mesh = meshes.bumpy_ball()
    copy = meshes.Mesh(3 * mesh.vertices @ meshes.rotation(2).T - 1, mesh.faces)
    marks = pairs.spread(mesh, 4)
    strain = pairs.register(pairs.Pair(mesh, copy, marks, marks)).strain
    assert 1 <= strain.median < 1.01 and strain.stretched < 0.01
    assert repr(strain).startswith("Strain(mean=1.0")


def test_a_wrong_pair_is_found():
    mesh = meshes.bumpy_ball()
    marks = pairs.spread(mesh, 12)
    wrong = marks.copy()
    wrong[5] = pairs.nearest(
        mesh, mesh.vertices[[marks[5]]] @ meshes.rotation(1).T * 0.2 + mesh.vertices[[marks[2]]]
    )[0]
    assert wrong[5] not in marks
    right, strained = (
        authalic.register_spheres(
            mesh, mesh, source_landmarks=marks, target_landmarks=ends, angle_weight=10
        ).strain
        for ends in (marks, wrong)
    )
    assert right.stretched < 0.01 < 0.05 < strained.stretched
    assert strained.mean > 1.15 * right.mean
    assert strained.worst_landmark in (2, 5)


def test_the_inverse_has_the_landmarks_of_the_target(both):
    result, pair = both
    strain = result.inverse().strain
    assert len(strain.sigma) == len(pair.target.faces)
    assert 0 <= strain.worst_landmark < len(pair.source_landmarks)


def test_curves_have_a_strain_too():
    pair = curves.balls(3)
    result = curves.register(pair)
    area = areas(pair.source.vertices, pair.source.faces).sum()
    target_area = areas(pair.target.vertices, pair.target.faces).sum()
    sigma = singular_values(pair.source.vertices, result.positions, pair.source.faces)
    assert np.allclose(result.strain.sigma, sigma * np.sqrt(area / target_area), rtol=1e-9, atol=1e-9)
    assert result.strain.worst_landmark in range(3)
    assert len(result.inverse().strain.sigma) == len(pair.target.faces)
