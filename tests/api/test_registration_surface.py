# SPDX-License-Identifier: MIT OR Apache-2.0
"""Registrations that keep shapes: the descent on the energy between the surfaces."""

import numpy as np
import pytest

import authalic

from . import curves, meshes, pairs

SURFACES = ("bumpy_cap", "rough_cap", "slit_sphere", "octahedron", "ball", "bumpy_ball", "rough_ball")
NAMED = {name: {**meshes.DISKS, **meshes.SPHERES}[name] for name in SURFACES}
all_pairs = pytest.mark.parametrize("pair", pairs.PAIRS.values(), ids=pairs.PAIRS)
BALLS = pairs.SPHERE_PAIRS["ball_and_ellipsoid"]
CAPS = pairs.DISK_PAIRS["caps"]
both = pytest.mark.parametrize("pair", [CAPS, BALLS], ids=["disk", "sphere"])


def register(pair, **options):
    return pairs.register(pair, energy="surface", **options)


def area(mesh):
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def distortions(pair, positions):
    """(m,): the symmetric Dirichlet energy over 4 of each face, by singular values of edge matrices."""
    source = pair.source.vertices / np.sqrt(area(pair.source).sum())
    image = positions / np.sqrt(area(pair.target).sum())
    edges = [x[pair.source.faces[:, 1:]] - x[pair.source.faces[:, :1]] for x in (source, image)]
    # the map takes the edges of a face to those of its image: J = image edges · pseudo-inverse of the face's
    linear = np.einsum("mki,mkj->mij", edges[1], np.linalg.pinv(edges[0]).transpose(0, 2, 1))
    sigma = np.linalg.svd(linear, compute_uv=False)[:, :2]
    return (sigma**2 + 1 / np.maximum(sigma, 1e-7) ** 2).sum(axis=1) / 4


def mean_distortion(pair, positions):
    return np.average(distortions(pair, positions), weights=area(pair.source))


@all_pairs
def test_shapes_are_kept_better_than_by_areas_alone(pair):
    kept, areas = register(pair), pairs.register(pair)
    pairs.assert_embedding(kept.registered, kept.faces)
    assert kept.distortion.folded.tolist() == []
    pairs.assert_landmarks_meet(kept, pair)
    ours, papers = (mean_distortion(pair, result.positions) for result in (kept, areas))
    assert 1 <= ours <= papers * (1 + 1e-9)


@pytest.mark.parametrize("count", [2, 5])
@pytest.mark.parametrize("name", SURFACES)
def test_a_surface_onto_itself_is_the_identity(name, count):
    pair = pairs.identical(NAMED[name], count)
    result = register(pair)
    assert np.abs(result.positions - pair.source.vertices).max() <= 1e-6 * pairs.size(pair.source)
    assert result.status == "converged"


@all_pairs
def test_noise_moves_little(pair):
    rng = np.random.default_rng(3)
    noise = 1e-12 * pairs.size(pair.source) * rng.standard_normal(pair.source.vertices.shape)
    moved = pair._replace(source=meshes.Mesh(pair.source.vertices + noise, pair.source.faces))
    here, there = register(pair), register(moved)
    assert np.abs(here.positions - there.positions).max() <= 1e-6 * pairs.size(pair.target)


@all_pairs
def test_the_map_turns_and_grows_with_the_surfaces(pair):
    turn, _ = np.linalg.qr(np.random.default_rng(5).standard_normal((3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    place = lambda mesh: meshes.Mesh(3 * mesh.vertices @ turn + [1.0, -2.0, 0.5], mesh.faces)  # noqa: E731
    here = register(pair).positions
    there = register(pair._replace(source=place(pair.source))).positions
    assert np.abs(there - here).max() <= 1e-6 * pairs.size(pair.target)
    there = register(pair._replace(target=place(pair.target))).positions
    back = (there - [1.0, -2.0, 0.5]) @ turn.T / 3
    assert np.abs(back - here).max() <= 1e-6 * pairs.size(pair.target)


@both
def test_threads_change_no_bit(pair):
    try:
        authalic.set_threads(1)
        alone = register(pair)
    finally:
        authalic.set_threads(0)
    assert np.array_equal(alone.positions, register(pair).positions)


@both
def test_progress_grows_through_the_descent(pair):
    heard = []
    register(pair, progress=lambda *report: heard.append(report))
    fractions, messages = zip(*heard, strict=True)
    assert list(fractions) == sorted(fractions)
    assert fractions[-1] == 1
    assert "Keeping shapes" in messages


@both
def test_a_descent_that_is_cancelled_returns_a_map_without_folds(pair):
    def progress(_fraction, message):
        return message != "Keeping shapes"

    result = register(pair, progress=progress)
    assert result.status == "cancelled"
    pairs.assert_embedding(result.registered, result.faces)


@both
def test_a_run_cancelled_in_its_second_half_says_so(pair):
    """Spheres have a map from their first start by then, but the second is cut short."""
    heard = []
    register(pair, progress=lambda fraction, _message: heard.append(fraction) or True)
    later = [fraction for fraction in heard if 0.5 <= fraction < 1]
    result = register(pair, progress=lambda fraction, _message: fraction < later[0])
    assert result.status == "cancelled"
    pairs.assert_embedding(result.registered, result.faces)


@both
def test_previews_come_nearer_to_the_result_and_change_no_bit(pair):
    seen = []
    result = register(pair, preview=seen.append)
    assert len(seen) > 2
    assert all(positions.shape == result.positions.shape for positions in seen)
    ways = [np.abs(positions - result.positions).max() for positions in (seen[0], seen[-1])]
    assert ways[1] < ways[0]
    assert np.array_equal(result.positions, register(pair).positions)


def test_previews_of_filled_surfaces_have_the_given_vertices():
    ball = meshes.SPHERES["ball"]
    open_ball = meshes.Mesh(ball.vertices, ball.faces[:-1])
    marks = pairs.spread(ball, 4)
    seen = []
    stretched = meshes.Mesh(ball.vertices * [1.0, 1.3, 0.8], ball.faces)
    authalic.register_spheres(
        open_ball,
        stretched,
        source_landmarks=marks,
        target_landmarks=marks,
        fill_holes=True,
        preview=seen.append,
    )
    assert {positions.shape for positions in seen} == {ball.vertices.shape}


def test_an_error_in_a_preview_is_raised():
    def preview(_positions):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        register(BALLS, preview=preview)
    with pytest.raises(TypeError, match="preview must be callable"):
        register(BALLS, preview=3)


def test_a_map_that_converged_is_where_single_vertices_cannot_better_it():
    """By an independent route: many vertices moved a little in space gain nothing to first order."""
    pair = BALLS
    result = register(pair)
    assert result.status == "converged"
    best = mean_distortion(pair, result.positions)
    free = np.setdiff1d(np.arange(len(pair.source.vertices)), pair.source_landmarks)
    target = pair.target
    rng = np.random.default_rng(1)
    gains = []
    for vertex in rng.choice(free, 20, replace=False):
        corners = target.vertices[target.faces[result.triangles[vertex]]]
        for step in (corners[1] - corners[0], corners[2] - corners[0]):
            for sign in (-1, 1):
                moved = result.positions.copy()
                moved[vertex] += sign * 1e-3 * step
                gains.append(best - mean_distortion(pair, moved))
    assert max(gains) <= 1e-6 * best


@both
def test_soft_landmarks_come_nearer_the_more_they_weigh(pair):
    shifted = pair.target_landmarks.copy()
    neighbors = pair.target.faces[(pair.target.faces == shifted[0]).any(axis=1)]
    taken = [*pair.target_landmarks, *pairs.boundary_vertices(pair.target.faces)]
    shifted[0] = np.setdiff1d(neighbors, taken)[0]
    pair = pair._replace(target_landmarks=shifted)

    def gap(weight):
        weights = np.full(len(shifted), np.inf)
        weights[0] = weight
        result = register(pair, weights=weights)
        return np.linalg.norm(result.positions[pair.source_landmarks[0]] - pair.target.vertices[shifted[0]])

    loose, firm = gap(1e-3), gap(1e3)
    assert firm < 0.2 * loose


def test_features_steer_between_landmarks():
    """A painted spot on a ball lies elsewhere on the target; the map takes it there as its weight grows."""
    ball = meshes.SPHERES["ball"]
    marks = pairs.spread(ball, 4)
    pair = pairs.Pair(ball, ball, marks, marks)

    def spot(direction):
        return np.exp(-8 * ((ball.vertices - direction) ** 2).sum(axis=1))

    free = np.setdiff1d(np.arange(len(ball.vertices)), marks)
    gaps = np.linalg.norm(ball.vertices[free][:, None] - ball.vertices[marks], axis=2).min(axis=1)
    center = ball.vertices[free[np.argmax(gaps)]]
    center = center / np.linalg.norm(center)
    aside = center + 0.3 * np.cross(center, [0.3, 0.5, 0.8])
    signals = spot(center), spot(aside / np.linalg.norm(aside))
    agreements = [
        register(pair, features=signals, feature_weight=weight).compare(*signals)[0] for weight in (0.0, 3.0)
    ]
    assert agreements[1] > agreements[0] + 0.1


def test_curves_are_kept_where_they_are():
    pair = curves.balls(4, target=meshes.radial(lambda x, y, z: 1 + 0.3 * x * y + 0.2 * z, 4))
    harmonic, kept = curves.register(pair), curves.register(pair, energy="surface")
    curves.assert_curves_meet(kept, pair)
    both = [mean_distortion(pair, result.positions) for result in (harmonic, kept)]
    assert both[1] < both[0]
