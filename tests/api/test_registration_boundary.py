# SPDX-License-Identifier: MIT OR Apache-2.0
"""Registrations of disks carry boundary onto boundary, so that no face collapses on a coarser target."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from . import meshes, oracle, pairs, random_meshes


def round_disk(inside, around, seed):
    """A bumpy disk of random points with so many vertices inside and on its round boundary."""
    rng = np.random.default_rng(seed)
    turn = 2 * np.pi * (np.arange(around) + 0.3 * rng.random(around)) / around
    radius = 0.97 * np.cos(np.pi / around) * np.sqrt(rng.random(inside))
    angle = 2 * np.pi * rng.random(inside)
    points = np.concatenate([np.exp(1j * turn), radius * np.exp(1j * angle)])
    points = np.stack([points.real, points.imag], axis=1)
    faces = Delaunay(points).simplices.astype(int)
    turned = oracle.signed_areas(points, faces) < 0
    faces[turned] = faces[turned][:, ::-1]
    height = 0.15 * np.sin(3 * points[:, 0] + seed) * np.cos(2 * points[:, 1])
    return meshes.Mesh(np.column_stack([points, height]), faces)


def with_landmarks(source, target, count):
    marks = pairs.spread(source, count)
    return pairs.Pair(source, target, marks, pairs.nearest(target, source.vertices[marks]))


def toothed(teeth=20):
    """A round disk of two rings whose boundary is all ears: faces with two boundary edges."""
    angle = 2 * np.pi * np.arange(teeth) / teeth
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    half = np.stack([np.cos(angle + np.pi / teeth), np.sin(angle + np.pi / teeth), 0 * angle], axis=1)
    points = np.vstack([[0, 0, 0.1], 0.5 * ring, ring, 1.1 * half])
    k, after = np.arange(teeth), np.roll(np.arange(teeth), -1)
    inner, outer, tips = 1 + k, 1 + teeth + k, 1 + 2 * teeth + k
    faces = [
        np.stack([0 * k, inner, inner[after]], axis=1),
        np.stack([inner, outer, outer[after]], axis=1),
        np.stack([inner, outer[after], inner[after]], axis=1),
        np.stack([outer, tips, outer[after]], axis=1),
    ]
    return meshes.Mesh(points, np.concatenate(faces))


FINE, COARSE, HEXAGON = round_disk(1100, 150, 1), round_disk(60, 20, 2), round_disk(20, 6, 3)
GRIDS = meshes.grid(21, 21, 1.0), meshes.grid(8, 8, 1.0)
PAIRS = {
    "fine_onto_coarse": with_landmarks(FINE, COARSE, 4),
    "coarse_onto_fine": with_landmarks(COARSE, FINE, 4),
    "fine_onto_hexagon": with_landmarks(FINE, HEXAGON, 2),
    "hexagon_onto_fine": with_landmarks(HEXAGON, FINE, 2),
    "fine_grid_onto_coarse": with_landmarks(*GRIDS, 4),
    "coarse_grid_onto_fine": with_landmarks(*GRIDS[::-1], 4),
    "disk_onto_grid": with_landmarks(FINE, GRIDS[1], 1),
    "grid_onto_disk": with_landmarks(GRIDS[0], COARSE, 1),
    "teeth_onto_pyramid": pairs.Pair(toothed(), meshes.fan(4), [0], [0]),
    "teeth_onto_grid": with_landmarks(toothed(12), GRIDS[1], 1),
}
TEETH = ("teeth_onto_pyramid", "teeth_onto_grid")


@pytest.fixture(scope="module", params=PAIRS)
def registered(request):
    pair = PAIRS[request.param]
    return request.param, pair, pairs.register(pair)


def swapped(pair):
    return pairs.Pair(pair.target, pair.source, pair.target_landmarks, pair.source_landmarks)


def along_boundary(mesh, faces, points):
    """The distance of each point from the boundary of a mesh in space, and its place along it, in edges."""
    loop = oracle.boundary_loop(faces)
    start = mesh.vertices[loop]
    edge = np.roll(start, -1, axis=0) - start
    away = points[:, None] - start
    share = (np.einsum("ikx,kx->ik", away, edge) / np.einsum("kx,kx->k", edge, edge)).clip(0, 1)
    distance = np.linalg.norm(away - share[..., None] * edge, axis=2)
    nearest = distance.argmin(axis=1)
    row = np.arange(len(points))
    return distance[row, nearest], nearest + share[row, nearest]


def assert_faces_have_areas(result, pair):
    """In space and in the domain, by formulas of their own."""
    assert oracle.folded(result.registered, result.faces) == []
    images = oracle.face_areas(result.positions, result.faces)
    areas = oracle.face_areas(pair.source.vertices, result.faces)
    ratio = (images / images.sum()) / (areas / areas.sum())
    assert images.min() > 0
    assert ratio.min() > 1e-5
    assert np.isfinite(result.area_distortion).all()
    assert np.allclose(result.area_distortion, np.maximum(ratio, 1 / ratio), rtol=1e-6)


def test_no_face_collapses(registered):
    _, pair, result = registered
    assert_faces_have_areas(result, pair)
    pairs.assert_registration(result, pair)
    pairs.assert_landmarks_meet(result, pair)


def test_no_face_collapses_on_the_way_back(registered):
    _, pair, result = registered
    back = result.inverse()
    assert_faces_have_areas(back, swapped(pair))
    pairs.assert_located(back, swapped(pair))
    pairs.assert_landmarks_meet(back, swapped(pair))


def test_the_boundary_lies_on_the_boundary_in_order(registered):
    name, pair, result = registered
    loop = oracle.boundary_loop(result.faces)
    distance, place = along_boundary(pair.target, result.target_faces, result.positions[loop])
    on = ~np.isin(loop, result.off_boundary)
    assert distance[on].max() <= 1e-12 * pairs.size(pair.target)
    # a few are set inside where the target has too few corners
    assert distance.max() <= 0.1 * pairs.size(pair.target)
    assert on.all() or name in TEETH
    n = len(oracle.boundary_loop(result.target_faces))
    steps = np.diff(place[on], append=place[on][0]) % n
    assert (steps > 0).all()
    assert abs(steps.sum() - n) < 1e-9


def test_faces_at_the_boundary_are_near_their_share_of_the_area():
    result = pairs.register(PAIRS["fine_onto_coarse"])
    touches = np.isin(result.faces, oracle.boundary_loop(result.faces)).any(axis=1)
    assert np.median(result.area_distortion[touches]) < 1.1
    assert result.area_distortion.max() < 3


def test_there_and_back_on_the_boundary():
    """The boundary comes back along itself, within the length of an edge of the coarser surface."""
    pair = PAIRS["fine_onto_coarse"]
    result = pairs.register(pair)
    there_and_back = result.pull(result.inverse().positions)
    loop = oracle.boundary_loop(result.faces)
    moved = np.linalg.norm((there_and_back - pair.source.vertices)[loop], axis=1)
    assert moved.max() < 0.2


def test_a_registration_of_the_same_surface_stays_the_identity():
    pair = pairs.identical(FINE, 4)
    result = pairs.register(pair)
    assert np.abs(result.positions - FINE.vertices).max() < 1e-12
    assert np.array_equal(result.registered, result.target_registered)
    assert len(result.off_boundary) == 0


def inner_vertices(mesh):
    return np.setdiff1d(np.arange(len(mesh.vertices)), pairs.boundary_vertices(mesh.faces))


@pytest.mark.parametrize("seed", range(20))
def test_random_disks(seed):
    rng = np.random.default_rng(seed)
    drawn = []
    while len(drawn) < 2:
        mesh, _, _ = random_meshes.random_mesh(rng, 300, tuple(random_meshes.OPEN))
        if len(inner_vertices(mesh)) > 0:
            drawn.append(mesh)
    source, target = drawn
    pair = pairs.Pair(source, target, pairs.spread(source, 1), pairs.spread(target, 1))
    result = pairs.register(pair)
    assert oracle.folded(result.registered, result.faces) == []
    assert np.isfinite(result.area_distortion).all()
    pairs.assert_registration(result, pair)
