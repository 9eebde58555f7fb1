# SPDX-License-Identifier: MIT OR Apache-2.0
"""Holes that are filled for the time of a registration by curves."""

import numpy as np
import pytest

import authalic

from . import curves, meshes

SOUTH, EAST, UP = [0, 0, -1], [0.9, 0.3, -0.3], [0, 0, 1]
LINES = [
    [[0.5, 0.1, 0.8], [0.1, 0.5, 0.9]],
    [[-0.4, -0.4, 0.8], [0.2, -0.5, 0.9]],
    [[-0.8, 0.5, -0.2], [-0.5, 0.8, 0.1]],
]
BALL, EGG = meshes.bumpy_ball(4), meshes.radial(lambda x, y, z: 1 + 0.3 * z + 0.1 * np.cos(3 * x), 4)

energies = pytest.mark.parametrize("energy", ["surface", "harmonic"])


def pair_of(source_holes, target_holes):
    source, target = curves.opened(BALL, source_holes, 0.93), curves.opened(EGG, target_holes, 0.93)
    return curves.CurvePair(source, target, curves.drawn(source, LINES), curves.drawn(target, LINES))


def rim(mesh, center):
    """The closed path along the boundary around a direction."""
    (patch,) = authalic.cut(*mesh)
    loop = max(patch.boundary_loops, key=lambda loop: (curves.directions(mesh)[loop] @ center).mean())
    return np.append(loop, loop[0])


@energies
def test_an_open_surface_onto_a_closed_one_and_back(energy):
    for holes in ([[SOUTH, EAST], []], [[], [SOUTH]]):
        pair = pair_of(*(np.array(each).reshape(-1, 3) for each in holes))
        with pytest.raises(authalic.MeshError, match="fill_holes=True") as caught:
            curves.register(pair, energy=energy)
        assert caught.value.kind == "loop_counts"
        result = curves.register(pair, energy=energy, fill_holes=True)
        whole = curves.register(pair_of(np.empty((0, 3)), np.empty((0, 3))), energy=energy)
        curves.assert_curves_meet(result, pair)
        curves.assert_certified(result, len(LINES))
        for figures, side in ((result, pair.source), (result.inverse(), pair.target)):
            assert figures.positions.shape == side.vertices.shape
            assert figures.area_ratio.shape == figures.strain.symmetric_dirichlet.shape == (len(side.faces),)
            assert np.isfinite(figures.strain.mean) and figures.distortion.folded.tolist() == []
            assert figures.registered.shape == side.vertices.shape
        # where nothing is missing, as if nothing had been
        assert abs(result.strain.median - whole.strain.median) < 0.05
        there_and_back = result.inverse().inverse()
        np.testing.assert_array_equal(there_and_back.positions, result.positions)
        np.testing.assert_array_equal(there_and_back.triangles, result.triangles)


@energies
def test_what_lies_in_holes_has_data_from_beside_them(energy):
    pair = pair_of(np.empty((0, 3)), [SOUTH])
    result = curves.register(pair, energy=energy, fill_holes=True)
    (loop,) = authalic.cut(*pair.target)[0].boundary_loops
    assert 0 < len(result.in_holes) < 0.2 * len(pair.source.vertices)
    assert (curves.directions(pair.source)[result.in_holes] @ SOUTH > 0.7).all()
    assert result.inverse().in_holes.tolist() == []
    beside = pair.target.vertices[loop]
    nearest = curves.interpolated(result, pair.target)[result.in_holes]
    gaps = np.linalg.norm(nearest[:, None] - beside[None], axis=2).min(axis=1)
    assert gaps.max() < 2 * curves.edge_length(pair.target)
    outside = np.setdiff1d(np.arange(len(pair.source.vertices)), result.in_holes)
    np.testing.assert_allclose(
        curves.interpolated(result, pair.target)[outside], result.positions[outside], atol=1e-12
    )


@pytest.mark.parametrize("swapped", [False, True])
def test_a_rim_goes_onto_a_curve_of_a_closed_surface(swapped):
    pair = pair_of([SOUTH], np.empty((0, 3)))
    ring = curves.ring(pair.target, SOUTH, 0.93)
    pair = pair._replace(
        source_curves=[*pair.source_curves, rim(pair.source, SOUTH)],
        target_curves=[*pair.target_curves, np.append(ring, ring[0])],
    )
    if swapped:
        pair = curves.inverted(pair)
    with pytest.raises(authalic.MeshError):
        curves.register(pair)
    result = curves.register(pair, fill_holes=True)
    curves.assert_closed_curve_meets(
        result, pair, len(LINES)
    )  # the rim is a part of the surface, not of the hole
    assert not np.isin(pair.source_curves[-1], result.in_holes).any()
    assert bool(len(result.in_holes)) == swapped
    assert np.isfinite(result.strain.mean) and result.certificates.folded.tolist() == []


def test_rims_that_are_curves_on_both_sides_stay_open():
    pair = pair_of([SOUTH, EAST], [SOUTH])
    pair = pair._replace(
        source_curves=[*pair.source_curves, rim(pair.source, SOUTH)],
        target_curves=[*pair.target_curves, rim(pair.target, SOUTH)],
    )
    result = curves.register(pair, fill_holes=True)
    curves.assert_closed_curve_meets(result, pair, len(LINES))
    curves.assert_certified(result, len(LINES) + 1)
    assert result.in_holes.tolist() == []


def test_nothing_to_fill_changes_nothing():
    pair = pair_of(np.empty((0, 3)), np.empty((0, 3)))
    plain, filled = (curves.register(pair, energy="surface", fill_holes=fill) for fill in (False, True))
    np.testing.assert_array_equal(plain.positions, filled.positions)


def test_features_and_previews_are_those_of_the_given_vertices():
    pair = pair_of([SOUTH], np.empty((0, 3)))
    signals = pair.source.vertices[:, 2], pair.target.vertices[:, 2]
    shapes = set()
    result = curves.register(
        pair,
        energy="surface",
        fill_holes=True,
        features=signals,
        feature_weight=0.1,
        preview=lambda positions: shapes.add(positions.shape),
    )
    assert shapes == {pair.source.vertices.shape}
    assert result.compare(*signals)[0] > 0.9


def test_what_cannot_be_is_refused():
    pair = pair_of([SOUTH], np.empty((0, 3)))
    spheres = (curves.directions(pair.source), curves.directions(pair.target))
    with pytest.raises(ValueError, match="source_sphere must be left out"):
        curves.register(pair, fill_holes=True, source_sphere=spheres[0], target_sphere=spheres[1])
    bare = pair._replace(source_curves=[], target_curves=[])
    with pytest.raises(authalic.MeshError) as caught:
        curves.register(bare, fill_holes=True)
    assert caught.value.kind == "no_curves"
    beyond = [*pair.source_curves[:-1], [*pair.source_curves[-1][:-1], len(pair.source.vertices)]]
    with pytest.raises(authalic.MeshError) as caught:
        curves.register(pair._replace(source_curves=beyond), fill_holes=True)
    assert (caught.value.kind, caught.value.side) == ("index_out_of_range", "source")
