# SPDX-License-Identifier: MIT OR Apache-2.0
"""Warnings, refusals and choices where curves alone do not say how surfaces lie over each other."""

import numpy as np
import pytest

import authalic

from . import curves, meshes

SPHERE = meshes.sphere(24, 32)[0]


def equator(mesh):
    """The closed curve at z = 0 of the sphere, its first vertex again at the end."""
    x, y, z = mesh.vertices.T
    flat = np.flatnonzero(abs(z) < 1e-9)
    around = flat[np.argsort(np.arctan2(y[flat], x[flat]))].tolist()
    return [*around, around[0]]


@pytest.mark.parametrize("seed", range(4))
def test_a_curve_that_halves_the_surface_leaves_both_halves_where_they_are(seed):
    noise = 1e-3 * np.random.default_rng(seed).standard_normal(SPHERE.vertices.shape)
    target = meshes.Mesh(SPHERE.vertices + noise, SPHERE.faces)
    around = equator(SPHERE)
    for path in (around, around[::-1]):
        registration = curves.register(curves.CurvePair(SPHERE, target, [around], [path]))
        assert (registration.positions * SPHERE.vertices).sum(axis=1).min() > 0.8
        assert len(registration.certificates.folded) == 0


def test_a_curve_inside_a_ring_on_one_surface_and_outside_on_the_other_is_refused():
    mesh = meshes.bumpy_ball(3)
    around = curves.ring(mesh, [0, 0, 1], 0.7)
    around = [*around, around[0]]
    (outside,) = curves.drawn(mesh, [[[1, 0, -0.5], [1, 0.6, -0.5]]])
    (inside,) = curves.drawn(mesh, [[[0.3, 0, 1], [-0.2, 0.2, 1]]])
    pair = curves.CurvePair(mesh, mesh, [around, outside], [around, inside])
    with pytest.raises(authalic.MeshError, match="curve 1 lies inside closed curve 0"):
        curves.register(pair)


def test_open_surfaces_that_look_to_opposite_sides_are_told():
    mesh = curves.opened(SPHERE, [[0, 0, -1]], 0.2)
    lines = curves.drawn(mesh, [[[1, 0, 1], [1, 0.5, 1]], [[-1, 0, 1], [-1, 0.4, 0.8]]])
    turned = meshes.Mesh(mesh.vertices, mesh.faces[:, ::-1])
    registration = curves.register(curves.CurvePair(mesh, turned, lines, lines))
    assert "opposite ways" in registration.warnings[0]
    assert curves.register(curves.CurvePair(mesh, mesh, lines, lines)).warnings == []


def test_limbs_that_no_curve_holds_are_told():
    capsule = meshes.capsule(40, 12)
    capsule = capsule if isinstance(capsule, meshes.Mesh) else capsule[0]
    mesh = meshes.Mesh(capsule.vertices * [1, 1, 5], capsule.faces)
    around = curves.neighbors(mesh.faces)
    top = np.argsort(-mesh.vertices[:, 2])
    paths, used = [], set()
    for start in map(int, top[1:]):
        down = [
            v for v in around[start] if v not in used and mesh.vertices[v, 2] < mesh.vertices[start, 2] - 1e-9
        ]
        further = [
            w
            for v in down[:1]
            for w in around[v]
            if w not in used and mesh.vertices[w, 2] < mesh.vertices[v, 2] - 1e-9
        ]
        if start not in used and further and len(paths) < 3:
            paths.append([start, down[0], further[0]])
            used.update(paths[-1])
    pair = curves.CurvePair(mesh, mesh, paths, paths)
    try:
        registration = curves.register(pair)
    except authalic.SolverError as error:
        assert "without folds" in str(error)
    else:
        assert len(registration.certificates.folded) == 0
        moved = abs(registration.positions - mesh.vertices).max()
        assert moved < 0.5 or any("tenfold" in words for words in registration.warnings)
