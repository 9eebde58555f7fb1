# SPDX-License-Identifier: MIT OR Apache-2.0
"""Registrations of real surfaces by curves, if there are data: AUTHALIC_DATA, or ../shared/data."""

import json

import numpy as np
import pytest

import authalic

from . import curves, meshes, real_meshes
from .test_registration_real import surface

HCP_CURVES = (
    "lm_central_sulcus_4|3a",
    "lm_V1_loop",
    "lm_medialwall_loop",
    "lm_STS_STSda+STSdp|STSva+STSvp",
    "lm_insula_Ig+PoI1..|OP",
)
OTHER_WAY_ROUND = (0, 4)
"""Curves of the hcp surfaces that are stored in opposite directions on the two sides."""


def sulci(side):
    """The twelve curves of the left or the mirrored right cortex."""
    stored = json.loads(real_meshes.file("brain/fsaverage5_curves.json").read_text(encoding="utf-8"))
    return [np.array(path) for path in stored[side]]


def cortex(side, field):
    return surface(f"brain/fsaverage5_{side}_10242.npz", field, mirror=side == "right")


def hcp(turned):
    """Left onto mirrored right midthickness by five curves, two of them reversed or all as stored."""
    (left, left_arrays), (right, right_arrays) = (
        surface(f"brain/hcp_s1200_{side}_32492.npz", "V_midthickness", side == "R") for side in "LR"
    )
    step = lambda k: -1 if k in turned else 1  # noqa: E731
    paths = [right_arrays[name][:: step(k)] for k, name in enumerate(HCP_CURVES)]
    return (
        curves.CurvePair(left, right, [left_arrays[name] for name in HCP_CURVES], paths),
        left_arrays,
        right_arrays,
    )


def assert_sound(result, pair, closed=()):
    """No fold, and the curves in place."""
    proof = result.certificates
    print(f"{proof}, {result.status}, {result.iterations} iterations, {result.seconds:.1f} s", end=", ")
    print(f"area distortion {np.minimum(result.area_distortion, 10).mean():.3f}", *result.warnings)
    assert proof.folded.tolist() == []
    assert proof.outside == 0
    assert proof.area_error < 1e-9
    assert max(proof.curve_error, proof.bank_error) <= 1e-9
    assert proof.cocycle_error < 1e-6
    assert result.status == "converged"
    curves.assert_located(result, pair)
    curves.assert_curves_meet(result, pair, skip=closed)
    for curve in closed:
        curves.assert_closed_curve_meets(result, pair, curve)


@pytest.mark.parametrize("field", ["V_white", "V_pial"])
@pytest.mark.parametrize("count", [4, 6, 10, 12])
def test_the_left_cortex_onto_the_mirrored_right(field, count):
    (left, left_arrays), (right, right_arrays) = cortex("left", field), cortex("right", field)
    pair = curves.CurvePair(left, right, sulci("left")[:count], sulci("mirrored_right")[:count])
    result = curves.register(pair)
    assert_sound(result, pair)
    assert result.warnings == []
    assert result.certificates.energy_ratio < 1.1
    correlation, difference = result.compare(left_arrays["sulc"], right_arrays["sulc"])
    print(f"sulc: correlation {correlation:.3f}, mean difference {difference:.3f}")
    assert correlation > 0.85


@pytest.mark.parametrize("count", [4, 10, 12])
@pytest.mark.parametrize("fields", [("V_white", "V_pial"), ("V_pial", "V_white")], ids=" onto ".join)
def test_the_white_surface_and_the_pial_one(fields, count):
    paths = sulci("left")[:count]
    (source, _), (target, _) = (cortex("left", field) for field in fields)
    pair = curves.CurvePair(source, target, paths, paths)
    result = curves.register(pair)
    assert_sound(result, pair)
    assert result.certificates.energy_ratio < 1.1
    # vertices of both have the same numbers
    away = np.linalg.norm(result.positions - target.vertices, axis=1)
    print(f"mean distance to the vertex of the same number: {away.mean():.2f} mm")
    assert away.mean() < 5


@pytest.mark.parametrize("field", ["V_white", "V_pial"])
@pytest.mark.parametrize("count", [6, 10])
def test_a_cortex_onto_itself_is_the_identity(field, count):
    mesh, _ = cortex("left", field)
    paths = sulci("left")[:count]
    pair = curves.CurvePair(mesh, mesh, paths, paths)
    result = curves.register(pair)
    assert_sound(result, pair)
    away = np.linalg.norm(result.positions - mesh.vertices, axis=1)
    print(f"from the identity: mean {away.mean():.4f} mm, at most {away.max():.3f} mm")
    assert away.mean() <= 0.05
    assert away.max() <= 0.3


def test_the_chain_of_arcs_does_not_matter():
    """Another order of the curves cuts other arcs, which moves the map by the discretization only."""
    (left, _), (right, _) = cortex("left", "V_pial"), cortex("right", "V_pial")
    left_curves, right_curves = sulci("left")[:6], sulci("mirrored_right")[:6]
    order = [3, 1, 4, 0, 5, 2]
    first = curves.register(curves.CurvePair(left, right, left_curves, right_curves))
    reordered = curves.CurvePair(
        left, right, [left_curves[k][::-1] for k in order], [right_curves[k][::-1] for k in order]
    )
    away = np.linalg.norm(curves.register(reordered).positions - first.positions, axis=1)
    print(f"mean {away.mean():.4f} mm, at most {away.max():.3f} mm")
    assert away.mean() < 0.05
    assert away.max() < 0.6


def test_the_spheres_of_the_data_lead_to_the_same_map():
    (left, left_arrays), (right, right_arrays) = cortex("left", "V_pial"), cortex("right", "V_pial")
    pair = curves.CurvePair(left, right, sulci("left")[:6], sulci("mirrored_right")[:6])
    spheres = {
        "source_sphere": left_arrays["V_sphere"],
        "target_sphere": right_arrays["V_sphere"] * [-1, 1, 1],
    }
    given = curves.register(pair, **spheres)
    assert_sound(given, pair)
    away = np.linalg.norm(given.positions - curves.register(pair).positions, axis=1)
    assert away.mean() < 0.05


@pytest.mark.parametrize("turned", [OTHER_WAY_ROUND, ()], ids=["matching_ends", "as_stored"])
def test_the_left_average_cortex_onto_the_mirrored_right(turned):
    """As stored, two curves run against each other: no fold, but the user is told which."""
    pair, left_arrays, right_arrays = hcp(turned)
    is_loop = [meets(pair, k) for k in range(5)]
    result = curves.register(pair)
    assert_sound(result, pair, closed=[k for k in range(5) if is_loop[k]])
    correlation, difference = result.compare(left_arrays["sulc_S1200"], right_arrays["sulc_S1200"])
    print(f"sulc: correlation {correlation:.3f}, mean difference {difference:.3f}")
    if turned:
        assert correlation > 0.7
        assert result.warnings == []
    else:
        for curve in OTHER_WAY_ROUND:
            assert any(f"curve {curve} " in warning for warning in result.warnings), result.warnings


def meets(pair, curve):
    """Whether both partners are loops: an edge joins the last vertex to the first."""
    ends = [
        (mesh, paths[curve][[0, -1]])
        for mesh, paths in ((pair.source, pair.source_curves), (pair.target, pair.target_curves))
    ]
    return all(
        (np.isin(mesh.faces, tips).sum(axis=1) == 2).any() and len(set(tips)) == 2 for mesh, tips in ends
    )


def test_a_mirrored_cortex_is_refused():
    (left, _), (right, _) = cortex("left", "V_pial"), cortex("right", "V_pial")
    unmirrored = meshes.Mesh(right.vertices * [-1, 1, 1], right.faces[:, ::-1])
    with pytest.raises(authalic.MeshError, match="mirror"):
        curves.register(curves.CurvePair(left, unmirrored, sulci("left"), sulci("mirrored_right")))
