# SPDX-License-Identifier: MIT OR Apache-2.0
"""Pairs of surfaces with landmarks, and checks of their registrations by independent formulas."""

from typing import NamedTuple

import numpy as np

import authalic

from . import meshes, oracle

MISSED = 1e-3
"""A landmark that ends farther than this from its partner, in a domain of radius 1, is missed."""


class Pair(NamedTuple):
    """Two surfaces and their landmarks, (k,) vertices of either."""

    source: meshes.Mesh
    target: meshes.Mesh
    source_landmarks: np.ndarray
    target_landmarks: np.ndarray


def register(pair, *, energy="area", **options):
    """Registers a pair of disks or of spheres, by default as the papers do."""
    return register_function(pair)(
        pair.source,
        pair.target,
        source_landmarks=pair.source_landmarks,
        target_landmarks=pair.target_landmarks,
        energy=energy,
        **options,
    )


def register_function(pair):
    closed = len(boundary_vertices(pair.source.faces)) == 0
    return authalic.register_spheres if closed else authalic.register_disks


def boundary_vertices(faces):
    """The vertices on the boundary, ascending."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    once = np.flatnonzero(np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)[1] == 1)
    return np.unique(np.unique(np.sort(edges, axis=1), axis=0)[once])


def spread(mesh, count):
    """Vertices (count,) inside the surface, each as far as possible from the ones before it."""
    inside = np.setdiff1d(np.arange(len(mesh.vertices)), boundary_vertices(mesh.faces))
    # away from the boundary as well, which every landmark has to stay clear of
    seen, chosen = [*boundary_vertices(mesh.faces)] or [inside[0]], []
    while len(chosen) < count:
        gaps = np.linalg.norm(mesh.vertices[inside][:, None] - mesh.vertices[seen], axis=2)
        chosen.append(inside[np.argmax(gaps.min(axis=1))])
        seen.append(chosen[-1])
    return np.array(chosen)


def nearest(mesh, points):
    """The vertex inside the surface nearest to each point, (k,)."""
    inside = np.setdiff1d(np.arange(len(mesh.vertices)), boundary_vertices(mesh.faces))
    gaps = np.linalg.norm(mesh.vertices[inside][None] - np.asarray(points, float)[:, None], axis=2)
    return inside[np.argmin(gaps, axis=1)]


def size(mesh):
    """The largest extent of the bounding box."""
    return np.ptp(mesh.vertices, axis=0).max()


def identical(mesh, count):
    landmarks = spread(mesh, count)
    return Pair(mesh, mesh, landmarks, landmarks)


def caps(count=5):
    """Two round caps with other bumps, other noise and another grid; landmarks over each other."""
    source, target = meshes.bumpy_cap(), meshes.bumpy_cap(rings=17, around=41, noise=0.02, seed=5)
    source_landmarks = spread(source, count)
    return Pair(source, target, source_landmarks, nearest(target, source.vertices[source_landmarks]))


def turned_caps(angle=0.7):
    """The landmarks of the target turned about the axis against those of the source, the middle one less."""
    source, target = meshes.bumpy_cap(), meshes.bumpy_cap(rings=17, around=41, noise=0.02, seed=5)
    source_landmarks = spread(source, 6)
    x, y, z = source.vertices[source_landmarks].T
    turn = angle * (1 - np.hypot(x, y))
    turned = [x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn), z]
    return Pair(source, target, source_landmarks, nearest(target, np.stack(turned, axis=1)))


def cap_and_square():
    """A round cap and a flat square: the pole and six vertices around it, and likewise the middle."""
    source, target = meshes.bumpy_cap(), meshes.grid(21, 21, aspect=1.0)
    source_landmarks = np.array([420, *range(120, 150, 5)])
    angle = np.pi / 3 * np.arange(6)
    around = 0.5 + 0.2 * np.stack([np.cos(angle), np.sin(angle), 0 * angle - 2.5], axis=1)
    return Pair(source, target, source_landmarks, nearest(target, np.vstack([[0.5, 0.5, 0], around])))


def balls(count=6, target=None):
    """A bumpy ball and an ellipsoid with landmarks in the same directions."""
    source, target = meshes.bumpy_ball(), target or meshes.Mesh(*meshes.SPHERES["ellipsoid"])
    source_landmarks = spread(source, count)
    directions = meshes.ball().vertices[source_landmarks]
    goals = target.vertices / np.linalg.norm(target.vertices, axis=1)[:, None]
    return Pair(source, target, source_landmarks, nearest(meshes.Mesh(goals, target.faces), directions))


DISK_PAIRS = {
    "caps": caps(),
    "turned_caps": turned_caps(),
    "cap_and_square": cap_and_square(),
    "one_landmark": caps(1),
}

SPHERE_PAIRS = {
    "ball_and_ellipsoid": balls(),
    "ball_and_parallels": balls(8, meshes.SPHERES["parallels"]),
    "two_landmarks": balls(2),
    "spikes": balls(5, meshes.SPHERES["spiky_ball"]),
}

PAIRS = {**DISK_PAIRS, **SPHERE_PAIRS}


# Checks of registrations


def lifted(points):
    """Points of the disk as points of the plane z = 1, points of the sphere unchanged: both span cones."""
    points = np.asarray(points)
    return points if points.shape[1] == 3 else np.hstack([points, np.ones((len(points), 1))])


def assert_embedding(image, faces):
    """No face folded by exact arithmetic; the whole sphere once, or a disk with its boundary once around."""
    if image.shape[1] == 3:
        assert np.abs(np.linalg.norm(image, axis=1) - 1).max() < 1e-14
        assert oracle.folded_on_sphere(image, faces) == []
        assert abs(oracle.solid_angles(image, faces).sum() - 4 * np.pi) < 1e-8
        return
    loop = oracle.boundary_loop(faces)
    assert oracle.folded(image, faces) == []
    assert np.hypot(*image.T).max() <= 1 + 1e-12
    arcs = oracle.boundary_arcs(image - image[loop].mean(axis=0), loop)
    assert (arcs > 0).all()
    assert abs(arcs.sum() - 2 * np.pi) < 1e-9


def assert_located(result, pair):
    """The locations in the result agree with its positions, and with both maps."""
    barycentric, corners = result.barycentric, result.target_faces[result.triangles]
    assert (barycentric >= 0).all()
    assert np.abs(barycentric.sum(axis=1) - 1).max() < 4e-16 * 4
    positions = np.einsum("ik,ikx->ix", barycentric, pair.target.vertices[corners])
    assert np.abs(positions - result.positions).max() <= 1e-14 * np.abs(pair.target.vertices).max()
    # this combination of the domain's corners points to the place of the source vertex
    directions = np.einsum("ik,ikx->ix", barycentric, lifted(result.target_registered)[corners])
    if result.registered.shape[1] == 3:
        directions /= np.linalg.norm(directions, axis=1)[:, None]
    assert np.linalg.norm(directions - lifted(result.registered), axis=1).max() < 1e-9
    if result.registered.shape[1] == 2:
        assert_on_the_boundary(result)


def assert_on_the_boundary(result):
    """The source's boundary lies on the target's, one coordinate exactly 0, except where it is named."""
    rim = oracle.boundary_loop(result.target_faces)
    edges = {tuple(edge) for edge in np.sort(np.stack([rim, np.roll(rim, -1)], axis=1), axis=1)}
    for vertex in np.setdiff1d(boundary_vertices(result.faces), result.off_boundary):
        carriers = result.target_faces[result.triangles[vertex]][result.barycentric[vertex] > 0]
        on_edge = len(carriers) == 2 and tuple(sorted(carriers)) in edges
        assert on_edge or (len(carriers) == 1 and carriers[0] in rim), vertex


def assert_figures(result, pair):
    """The figures in the result are those of its maps."""
    source, target = result.registered[pair.source_landmarks], result.target_registered[pair.target_landmarks]
    assert np.abs(result.landmark_error - np.linalg.norm(source - target, axis=1)).max(initial=0) < 1e-12
    assert set(np.flatnonzero(result.landmark_error > MISSED)) <= set(result.missed.tolist())
    assert result.missed.tolist() == sorted(set(result.missed.tolist()))
    if result.status != "cancelled":
        assert (result.status == "landmarks_missed") == (len(result.missed) > 0)
    targets = oracle.face_areas(pair.source.vertices, result.faces)
    energy = oracle.authalic_energy if source.shape[1] == 2 else oracle.sphere_energy
    expected = energy(result.registered, result.faces, targets)
    assert abs(result.distortion.authalic_energy - expected) < 1e-6 * expected + 1e-12
    assert len(result.distortion.folded) == 0
    a, b, c = np.moveaxis(result.positions[result.faces], 1, 0)
    image = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    ratio = (image / image.sum()) / (targets / targets.sum())
    assert np.allclose(result.area_ratio, ratio, rtol=1e-6, atol=1e-6)


def assert_registration(result, pair):
    """A one-to-one map of source onto target, whatever its status."""
    assert_embedding(result.registered, result.faces)
    assert_embedding(result.target_registered, result.target_faces)
    assert_located(result, pair)
    assert_figures(result, pair)


def assert_landmarks_meet(result, pair):
    assert result.landmark_error.max() <= MISSED
    assert len(result.missed) == 0
    assert result.status != "landmarks_missed"
    assert_the_others_meet(result, pair)


def assert_the_others_meet(result, pair):
    """Landmarks that are not named as missed meet, in the domain and on the target."""
    met = np.setdiff1d(np.arange(len(pair.source_landmarks)), result.missed)
    gap = result.positions[pair.source_landmarks] - pair.target.vertices[pair.target_landmarks]
    assert result.landmark_error[met].max(initial=0) <= MISSED
    assert np.linalg.norm(gap, axis=1)[met].max(initial=0) <= 0.005 * size(pair.target)
