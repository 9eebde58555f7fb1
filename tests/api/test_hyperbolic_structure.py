# SPDX-License-Identifier: MIT OR Apache-2.0
"""The hyperbolic structure of surfaces with curves: group, pants and hexagons."""

import json
from itertools import pairwise

import numpy as np
import pytest

import authalic

from . import meshes, real_meshes


def meridian_slits(count, stacks=36, slices=48):
    """A closed ellipsoid and short open curves along some of its meridians, at various heights."""
    mesh, _ = meshes.sphere(stacks, slices)
    mesh = meshes.Mesh(mesh.vertices * [1, 0.8, 1.2], mesh.faces)
    rows = 8 + 5 * (np.arange(count) % 3)
    columns = slices * np.arange(count) // count
    slits = [
        [(row + k) * slices + column for k in range(7)] for row, column in zip(rows, columns, strict=True)
    ]
    return mesh, slits


@pytest.fixture(scope="module")
def five():
    mesh, slits = meridian_slits(5)
    return mesh, slits, authalic.hyperbolic_structure(*mesh, curves=slits)


def moved(isometry, z):
    a, b = isometry
    return (a * z + b) / (np.conj(b) * z + np.conj(a))


def distance(p, q):
    return 2 * np.arcsinh(np.abs(q - p) / np.sqrt((1 - np.abs(p) ** 2) * (1 - np.abs(q) ** 2)))


def plane(structure):
    return structure.positions @ [1, 1j]


def translation_length(isometries):
    return 2 * np.arccosh(np.abs(isometries[:, 0].real))


def test_arrays_have_the_documented_shapes(five):
    structure = five[2]
    n, m, d = len(structure.vertices), len(structure.faces), len(structure.positions)
    assert (
        structure.vertices.shape == (n, 3) and structure.faces.shape == (m, 3) == structure.disk_faces.shape
    )
    assert (
        structure.vertex_of.shape == (n,)
        and structure.positions.shape == (d, 2)
        and structure.disk_vertex_of.shape == (d,)
    )
    assert structure.generators.shape == (4, 2) and structure.generators.dtype == np.complex128
    assert sorted(structure.order) == [0, 1, 2, 3, 4] and structure.reversed.dtype == bool
    assert structure.boundary_lengths.shape == (5,) and len(structure.banks) == 5 and len(structure.arcs) == 4
    assert len(structure.pants) == 3 and len(structure.pants_curves) == 2 == len(structure.lengths)
    assert structure.pants[0].hexagons.shape == (2, 6, 2) and structure.pants[0].angles.shape == (2, 6)
    assert abs(structure.area - 6 * np.pi) < 1e-9 and structure.curvature < 1e-10
    assert "3 pairs of pants" in repr(structure)


def test_the_sliced_surface_is_the_one_given(five):
    mesh, slits, structure = five
    given = structure.vertex_of >= 0
    assert np.array_equal(structure.vertices[given], mesh.vertices[structure.vertex_of[given]])
    assert np.array_equal(np.unique(structure.vertex_of[given]), np.arange(len(mesh.vertices)))
    assert np.array_equal(structure.disk_vertex_of[structure.disk_faces], structure.faces)
    areas = [
        np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
        for a, b, c in (
            np.moveaxis(v[f], 1, 0)
            for v, f in ((mesh.vertices, mesh.faces), (structure.vertices, structure.faces))
        )
    ]
    assert abs(areas[0] / areas[1] - 1) < 1e-12
    for number, feature in enumerate(structure.order):
        for bank in structure.banks[number]:
            path = structure.vertex_of[structure.disk_vertex_of[bank]]
            path = path[path >= 0]
            assert list(path) == slits[feature][:: -1 if structure.reversed[number] else 1]


def test_no_face_of_the_domain_is_folded(five):
    structure = five[2]
    klein = 2 * structure.positions / (1 + (structure.positions**2).sum(axis=1))[:, None]
    a, b, c = np.moveaxis(klein[structure.disk_faces], 1, 0)
    assert (np.linalg.det(np.stack([b - a, c - a], axis=1)) > 0).all()


def test_generators_take_left_arcs_to_right_ones(five):
    structure = five[2]
    z = plane(structure)
    assert np.allclose(
        np.abs(structure.generators[:, 0]) ** 2 - np.abs(structure.generators[:, 1]) ** 2, 1, atol=1e-9
    )
    for generator, (left, right) in zip(structure.generators, structure.arcs, strict=True):
        assert distance(moved(generator, z[left]), z[right]).max() < 1e-7


def test_lengths_agree_with_traces(five):
    structure = five[2]
    traces = translation_length(structure.generators)
    assert np.allclose(traces[[0, -1]], structure.boundary_lengths[structure.order[[0, -1]]], atol=1e-8)
    assert np.allclose(traces[1:-1], structure.lengths, atol=1e-8)
    assert np.allclose(
        [p.boundary_lengths[1] for p in structure.pants], structure.boundary_lengths[structure.order[1:-1]]
    )


def test_hexagons_are_right_angled_and_mirror_images(five):
    for pants in five[2].pants:
        assert np.abs(pants.angles - np.pi / 2).max() < 1e-8
        hexagon, mirrored = pants.hexagons
        assert np.allclose(hexagon, mirrored * [-1, 1], atol=1e-9)
        steps = np.roll(hexagon, -1, axis=0) - hexagon
        following = np.roll(steps, -1, axis=0)
        assert (steps[:, 0] * following[:, 1] > steps[:, 1] * following[:, 0]).all()


def test_pants_curves_lie_on_the_surface_and_close(five):
    structure = five[2]
    for curve in structure.pants_curves:
        assert np.array_equal(curve[0], curve[-1]) and len(curve) > 20
        radius = np.linalg.norm(curve / [1, 0.8, 1.2], axis=1)
        assert radius.max() < 1 + 1e-12 and radius.min() > 0.98
        assert np.linalg.norm(np.diff(curve, axis=0), axis=1).max() < 0.2


def test_copies_of_the_domain(five):
    structure = five[2]
    words, motions = structure.cover(50)
    assert words[0] == () and len(words) == 50 == len(set(words)) and motions.shape == (50, 2)
    for word, motion in zip(words, motions, strict=True):
        assert all(letter != -following for letter, following in pairwise(word))
        z = 0j
        for letter in reversed(word):
            a, b = structure.generators[abs(letter) - 1]
            z = moved((a, b) if letter > 0 else (np.conj(a), -b), z)
        assert distance(z, moved(motion, 0j)) < 1e-6
    with pytest.raises(ValueError, match="copies must be ≥ 1"):
        structure.cover(0)


def test_scale_and_place_of_the_surface_do_not_matter():
    mesh, slits = meridian_slits(3)
    structure = authalic.hyperbolic_structure(*mesh, curves=slits)
    for places, tolerance in ((2.0**17 * mesh.vertices, 1e-12), (1e5 * mesh.vertices + 3e5, 2e-3)):
        # rounding may lead the arcs along other edges of equal length, and divide other faces for them
        moved = authalic.hyperbolic_structure(places, mesh.faces, curves=slits)
        assert np.allclose(structure.boundary_lengths, moved.boundary_lengths, rtol=tolerance)
        given = moved.vertex_of >= 0
        assert np.array_equal(moved.vertices[given], places[moved.vertex_of[given]])


def test_the_flow_of_the_paper_gives_a_structure_too():
    mesh, slits = meridian_slits(3, 18, 24)
    slits = [slit[:4] for slit in [[(8 + k) * 24 + column for k in range(4)] for column in (0, 8, 16)]]
    structure = authalic.hyperbolic_structure(*mesh, curves=slits, metric="ricci_flow")
    assert np.abs(structure.pants[0].angles - np.pi / 2).max() < 1e-8


def test_bad_input_is_named():
    mesh, slits = meridian_slits(3)
    with pytest.raises(authalic.MeshError, match=r"2 features .* at least three"):
        authalic.hyperbolic_structure(*mesh, curves=slits[:2])
    with pytest.raises(authalic.MeshError, match="0 features"):
        authalic.hyperbolic_structure(*mesh, curves=[])
    ring = [30 * 48 + k for k in range(48)]
    with pytest.raises(authalic.MeshError, match="curve 3 is closed and divides"):
        authalic.hyperbolic_structure(*mesh, curves=[*slits, [*ring, ring[0]]])
    with pytest.raises(authalic.MeshError, match="curves: curve 1"):
        authalic.hyperbolic_structure(*mesh, curves=[slits[0], [0, 1], slits[2]])
    with pytest.raises(ValueError, match="metric must be"):
        authalic.hyperbolic_structure(*mesh, curves=slits, metric="flat")


def test_it_can_be_cancelled():
    mesh, slits = meridian_slits(5, 120, 160)
    with pytest.raises(authalic.SolverError, match="cancelled"):
        authalic.hyperbolic_structure(*mesh, curves=slits, progress=lambda *_: False)


def test_a_brain():
    path = real_meshes.file("brain/fsaverage5_left_10242.npz")
    curves = json.loads((path.parent / "fsaverage5_curves.json").read_text(encoding="utf-8"))["left"]
    with np.load(path) as file:
        vertices, faces = file["V_pial"].astype(float), file["F"].astype(np.int64)
    structure = authalic.hyperbolic_structure(vertices, faces, curves=curves)
    assert len(structure.pants) == 10 and abs(structure.area / (20 * np.pi) - 1) < 1e-10
    assert max(np.abs(pants.angles - np.pi / 2).max() for pants in structure.pants) < 1e-7
    z = plane(structure)
    for generator, (left, right) in zip(structure.generators, structure.arcs, strict=True):
        assert distance(moved(generator, z[left]), z[right]).max() < 1e-4
    assert np.abs(z).max() < 1
