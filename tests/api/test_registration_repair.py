# SPDX-License-Identifier: MIT OR Apache-2.0
"""Registrations of surfaces that are repaired first: all that is given is that of the vertices given."""

import numpy as np
import pytest

import authalic

from . import meshes

POLES = [0, 7, 100, 200]


def spoiled(mesh, seed=0):
    """The mesh without a face, each face for itself, a loose vertex before and a piece behind."""
    rng = np.random.default_rng(seed)
    faces = mesh.faces[rng.permutation(len(mesh.faces))]
    apart = mesh.vertices[faces[1:]].reshape(-1, 3)
    speck = mesh.vertices[:3] * 0.01 + 50
    vertices = np.vstack([[[7.0, 7, 7]], apart, speck])
    numbers = np.arange(3 * len(faces)).reshape(-1, 3) + 1
    given = meshes.Mesh(vertices, numbers)
    # a copy of each vertex of the mesh
    first = np.full(len(mesh.vertices), -1)
    first[faces[1:].ravel()[::-1]] = np.arange(apart.shape[0], 0, -1)
    return given, first


@pytest.fixture(scope="module")
def balls():
    source = meshes.bumpy_ball(3)
    target = meshes.Mesh(source.vertices * [1, 1.3, 0.9], source.faces)
    return source, target


def test_spheres_are_repaired_and_landmarks_and_features_go_along(balls):
    source, target = balls
    given, first = spoiled(source)
    onto, first_onto = spoiled(target, seed=1)
    height = [mesh.vertices[:, 2] for mesh in (given, onto)]
    found = authalic.register_spheres(
        given,
        onto,
        source_landmarks=first[POLES],
        target_landmarks=first_onto[POLES],
        features=height,
        repair=True,
    )
    assert found.source_repaired.counts["closed_holes"] == found.target_repaired.counts["closed_holes"] == 1
    assert found.source_repaired.counts["dropped_pieces"] == 1
    assert len(found.positions) == len(found.source_repaired.vertices) == len(source.vertices)
    # the same as of the repaired surfaces themselves
    ours, theirs = authalic.repair(*given, keep="largest"), authalic.repair(*onto, keep="largest")
    assert np.array_equal(ours.vertices, found.source_repaired.vertices)
    expected = authalic.register_spheres(
        ours,
        theirs,
        source_landmarks=ours.vertex_to[first[POLES]],
        target_landmarks=theirs.vertex_to[first_onto[POLES]],
        features=[ours.vertices[:, 2], theirs.vertices[:, 2]],
    )
    assert np.array_equal(found.positions, expected.positions)
    # landmarks lie on their partners, by the vertices given
    places = found.positions[found.source_repaired.vertex_to[first[POLES]]]
    assert np.allclose(places, target.vertices[POLES], atol=1e-6)
    # data go there by the repaired target
    pulled = found.pull(found.target_repaired.carry(onto.vertices))
    assert np.allclose(pulled, found.positions, atol=1e-9)


def test_the_inverse_and_saved_ones_know_the_repaired_surfaces(balls, tmp_path):
    (source, target), (given, first) = balls, spoiled(balls[0])
    found = authalic.register_spheres(
        given, target, source_landmarks=first[POLES], target_landmarks=POLES, repair=True, energy="area"
    )
    inverse = found.inverse()
    assert inverse.target_repaired == found.source_repaired
    assert not inverse.source_repaired.is_changed
    found.save(tmp_path / "registration.npz")
    again = authalic.load(tmp_path / "registration.npz")
    assert again == found
    assert np.array_equal(again.source_repaired.vertex_to, found.source_repaired.vertex_to)
    record = found.provenance
    assert record["options"]["repair"] is True
    assert record["inputs"]["source"]["vertices"] == len(given.vertices)
    plain = authalic.register_spheres(
        source, target, source_landmarks=POLES, target_landmarks=POLES, energy="area"
    )
    assert plain.source_repaired is None and plain.target_repaired is None


def test_disks_keep_their_outlines():
    cap = meshes.bumpy_cap()
    given, first = spoiled(cap)
    marks = [0, 100, 170]
    found = authalic.register_disks(
        given, cap, source_landmarks=first[marks], target_landmarks=marks, repair=True
    )
    assert found.source_repaired.surface.is_disk
    assert found.status == "converged"
    to = found.source_repaired.vertex_to
    assert np.allclose(found.positions[to[first[marks]]], cap.vertices[marks], atol=1e-6)


def band():
    angle = 2 * np.pi * np.arange(24) / 24
    height = np.linspace(-0.9, 0.9, 13)
    radius = np.sqrt(1 - height**2)
    rings = [
        np.stack([r * np.cos(angle), r * np.sin(angle), 0 * angle + z], axis=1)
        for r, z in zip(radius, height, strict=True)
    ]
    return meshes.Mesh(np.concatenate(rings), meshes.quads(13, 24, wrap=True))


CURVES = [[76, 100, 124, 148], [88, 112, 136, 160, 184]]


def test_curves_go_along():
    mesh = band()
    # every face for itself but for those without area, and a loose vertex
    apart = meshes.Mesh(
        np.vstack([[[5.0, 5, 5]], mesh.vertices[mesh.faces].reshape(-1, 3)]),
        np.arange(mesh.faces.size).reshape(-1, 3) + 1,
    )
    first = np.zeros(len(mesh.vertices), int)
    first[mesh.faces.ravel()[::-1]] = np.arange(mesh.faces.size, 0, -1)
    curves = [first[curve] for curve in CURVES]
    found = authalic.register_hyperbolic(apart, mesh, source_curves=curves, target_curves=CURVES, repair=True)
    assert len(found.certificates.folded) == 0
    to = found.source_repaired.vertex_to
    assert np.allclose(found.positions[to[first]], mesh.vertices, atol=0.05)
    for curve in CURVES:
        assert np.allclose(found.positions[to[first[curve]]], mesh.vertices[curve], atol=1e-6)


def test_curves_follow_the_copies_of_split_vertices():
    """A curve through the vertex in which two parts touch takes the copy on its own part."""
    mesh = band()
    other = meshes.ball(1)
    shifted = other.vertices * 0.2 + mesh.vertices[124] - 0.2 * other.vertices[0]
    faces = other.faces + len(mesh.vertices)
    faces[faces == len(mesh.vertices)] = 124
    # the small part comes first, so that its copy of the vertex does
    touching = meshes.Mesh(np.vstack([mesh.vertices, shifted]), np.vstack([faces, mesh.faces]))
    found = authalic.register_hyperbolic(
        touching, mesh, source_curves=CURVES, target_curves=CURVES, repair=True, energy="harmonic"
    )
    assert found.source_repaired.counts["split_vertices"] == 1
    assert len(found.positions) == len(mesh.vertices)


def test_landmarks_that_a_repair_drops_are_named(balls):
    source, target = balls
    given, first = spoiled(source)
    speck = len(given.vertices) - 1
    marks = [*first[POLES[:2]], speck, 0]
    with pytest.raises(authalic.MeshError, match="no part of the repaired surface at 2 pairs") as caught:
        authalic.register_spheres(given, target, source_landmarks=marks, target_landmarks=POLES, repair=True)
    assert (caught.value.side, caught.value.indices) == ("source", (2, 3))
    assert f"vertex {speck}" in str(caught.value)
    mesh = band()
    loose = meshes.Mesh(np.vstack([mesh.vertices, [[9.0, 9, 9]]]), mesh.faces)
    curves = [CURVES[0], [*CURVES[1][:2], len(mesh.vertices), *CURVES[1][2:]]]
    with pytest.raises(
        authalic.MeshError, match="curve 1 is no part of the repaired surface at place 2"
    ) as caught:
        authalic.register_hyperbolic(mesh, loose, source_curves=CURVES, target_curves=curves, repair=True)
    assert (caught.value.side, caught.value.curve) == ("target", 1)


def test_errors_number_the_vertices_given(balls):
    source, target = balls
    given, first = spoiled(source)
    twin = np.flatnonzero((given.vertices == given.vertices[first[7]]).all(axis=1))[1]
    marks = [first[0], first[7], twin, first[200]]
    with pytest.raises(authalic.MeshError, match="repeat vertex") as caught:
        authalic.register_spheres(given, target, source_landmarks=marks, target_landmarks=POLES, repair=True)
    assert (caught.value.kind, caught.value.indices) == ("repeated_landmark", (2,))
    assert f"repeat vertex {first[7]} " in str(caught.value)
    cap = meshes.bumpy_cap()
    open_target, _ = spoiled(cap)
    with pytest.raises(authalic.MeshError) as caught:
        authalic.register_spheres(
            given, open_target, source_landmarks=first[POLES], target_landmarks=[1, 2, 3, 4], repair=True
        )
    assert (caught.value.kind, caught.value.side) == ("open_surface", "target")
    rim = np.concatenate(authalic.Surface(*cap).boundary_loops)
    assert (open_target.vertices[caught.value.indices[0]] == cap.vertices[rim]).all(axis=1).any()


@pytest.mark.parametrize("side", ["source", "target"])
def test_what_a_repair_mends_is_told_so(balls, side):
    sound = balls[0]
    for bad, words in (
        (
            meshes.Mesh(sound.vertices, np.vstack([sound.faces, sound.faces[:1]])),
            "authalic.repair mends this",
        ),
        (
            meshes.Mesh(sound.vertices[sound.faces].reshape(-1, 3), np.arange(1536).reshape(-1, 3)),
            "repair=True merges",
        ),
        (meshes.torus(), "repair with close_handles=True closes handles"),
    ):
        pair = [bad, sound] if side == "source" else [sound, bad]
        with pytest.raises(authalic.MeshError, match=f"^the {side}: .*{words}") as caught:
            authalic.register_spheres(*pair, source_landmarks=[0, 7, 100], target_landmarks=[0, 7, 100])
        assert caught.value.side == side


@pytest.mark.parametrize("ends", [(0, 0), (0.01, 0.02)], ids=["corners in one place", "on a line"])
def test_faces_without_area_are_named_and_mended(balls, ends):
    source, target = balls
    vertices = target.vertices.copy()
    first, *others = target.faces[300]
    for vertex, along in zip(others, ends, strict=True):
        vertices[vertex] = vertices[first] + [along, 0, 0]
    marks = {"source_landmarks": [0, 7, 100], "target_landmarks": [0, 7, 100]}
    words = r"^the target: no area in .*\b300\b.*: the corners lie on a line; .*authalic\.repair mends this"
    flat = meshes.Mesh(vertices, target.faces)
    with pytest.raises(authalic.MeshError, match=words) as caught:
        authalic.register_spheres(source, flat, **marks)
    assert (caught.value.kind, caught.value.side) == ("zero_area", "target")
    assert 300 in caught.value.indices
    found = authalic.register_spheres(source, flat, **marks, repair=True)
    assert found.target_repaired.counts["faces_without_area"] > 0
    assert found.status == "converged"


def test_maps_of_other_vertices_are_refused():
    mesh = band()
    sphere = mesh.vertices / np.linalg.norm(mesh.vertices, axis=1, keepdims=True)
    with pytest.raises(ValueError, match="source_sphere and target_sphere must be left out with repair=True"):
        authalic.register_hyperbolic(
            mesh,
            mesh,
            source_curves=CURVES,
            target_curves=CURVES,
            repair=True,
            source_sphere=sphere,
            target_sphere=sphere,
        )


def test_features_of_other_vertices_are_refused(balls):
    source, target = balls
    given, first = spoiled(source)
    with pytest.raises(authalic.MeshError, match=r"source: values must be of \d+ rows, one per given vertex"):
        authalic.register_spheres(
            given,
            target,
            source_landmarks=first[POLES],
            target_landmarks=POLES,
            repair=True,
            features=(source.vertices, target.vertices),
        )
