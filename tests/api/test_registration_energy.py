# SPDX-License-Identifier: MIT OR Apache-2.0
"""Options of the energy between the surfaces: names, refusals before any work, and maps without folds."""

import inspect

import numpy as np
import pytest

import authalic

from . import curves, meshes, pairs

CAPS, BALLS = pairs.DISK_PAIRS["caps"], pairs.SPHERE_PAIRS["ball_and_ellipsoid"]
BOTH = {"disk": CAPS, "sphere": BALLS}
CURVES = curves.balls(4, target=meshes.radial(lambda x, y, z: 1 + 0.3 * x * y + 0.2 * z, 4))
both = pytest.mark.parametrize("pair", BOTH.values(), ids=BOTH)
OPTIONS = {
    **{"energy": "surface", "weight": 1.0, "area_weight": 1.0, "angle_weight": None, "weights": None},
    **{"features": None, "feature_weight": None, "position_weight": 0.0, "fill_holes": False},
}


def heights(mesh):
    return mesh.vertices[:, 2]


def features(pair):
    return heights(pair.source), heights(pair.target)


def refused(pair, error, words, **options):
    """The error of a registration that is refused before its first report of progress."""
    heard = []
    with pytest.raises(error, match=words) as caught:
        pairs.register(pair, progress=lambda *report: heard.append(report), **options)
    assert heard == []
    assert type(caught.value) is error
    return caught.value


@pytest.mark.parametrize("call", [authalic.register_disks, authalic.register_spheres])
def test_the_options_have_the_defaults_of_the_contract(call):
    parameters = inspect.signature(call).parameters
    assert {name: parameters[name].default for name in OPTIONS} == OPTIONS
    of_curves = inspect.signature(authalic.register_hyperbolic).parameters
    assert of_curves["energy"].default == "surface"
    assert set(OPTIONS) - set(of_curves) == {"weight", "weights"}


@both
def test_areas_alone_weigh_no_angles(pair):
    plain, named = pairs.register(pair), pairs.register(pair, energy="area", angle_weight=0.0)
    assert np.array_equal(plain.positions, named.positions)


@both
def test_an_energy_without_a_name_is_refused(pair):
    refused(pair, ValueError, 'energy must be "area" or "surface", but is "length"', energy="length")


@both
@pytest.mark.parametrize("name", ["area_weight", "angle_weight", "position_weight"])
@pytest.mark.parametrize("value", [-0.5, np.inf, np.nan])
def test_weights_out_of_range_are_plain_value_errors(pair, name, value):
    error = refused(
        pair, ValueError, f"{name} must be a finite number ≥ 0", energy="surface", **{name: value}
    )
    assert error.kind == "invalid_option"


@both
def test_one_of_areas_and_angles_must_count(pair):
    error = refused(
        pair,
        ValueError,
        "area_weight must be a finite number > 0 where angle_weight is 0, but is 0",
        energy="surface",
        area_weight=0.0,
        angle_weight=0.0,
    )
    assert error.kind == "invalid_option"


@both
def test_what_areas_alone_do_not_weigh_is_refused_with_the_remedy(pair):
    soft = np.full(len(pair.source_landmarks), np.inf)
    soft[1] = 2.0
    for option in (
        {"weights": soft},
        {"area_weight": 2.0},
        {"position_weight": 0.1},
        {"features": features(pair)},
    ):
        error = refused(pair, ValueError, '"surface"', energy="area", **option)
        assert error.kind == "invalid_option"


@both
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan])
def test_weights_of_pairs_are_positive(pair, value):
    weights = np.ones(len(pair.source_landmarks))
    weights[2] = value
    error = refused(
        pair, authalic.MeshError, "weights must be .* at pair 2", energy="surface", weights=weights
    )
    assert (error.kind, error.indices, error.count) == ("invalid_array", (2,), 1)


@both
@pytest.mark.parametrize("weights", [[1.0], [[1.0, 2.0]], ["a", "b"], []])
def test_there_is_one_weight_per_pair(pair, weights):
    refused(pair, authalic.MeshError, "^weights must be", energy="surface", weights=weights)


@both
@pytest.mark.parametrize("side", ["source", "target"])
def test_bad_features_are_refused_with_the_side(pair, side):
    def with_signal(change):
        signals = dict(zip(("source", "target"), features(pair), strict=True))
        signals[side] = change(signals[side].copy())
        return tuple(signals.values())

    def spoiled(signal, value):
        signal[[3, 5]] = value
        return signal

    for change, words in (
        (lambda signal: signal[:-1], r"of shape \(\d+, k\), one row per vertex"),
        (lambda signal: spoiled(signal, np.nan), r"NaN or infinite at 2 vertices \(3, 5\)"),
        (lambda signal: spoiled(signal, np.inf), r"NaN or infinite at 2 vertices \(3, 5\)"),
        (lambda signal: 0 * signal + 0.1, "constant in column 0"),
        (lambda signal: np.stack([signal] * 2, axis=1), "signals"),
        (lambda signal: signal[:, None, None], "of shape"),
        (lambda signal: signal + 1j, "real numbers"),
        (lambda signal: signal.astype(str), "real numbers"),
    ):
        error = refused(pair, authalic.MeshError, words, energy="surface", features=with_signal(change))
        assert error.kind == "invalid_array"
        assert error.side == side or "signals" in words
        assert (error.indices, error.count) == (((3, 5), 2) if "NaN" in words else ((), 0))


@both
def test_features_come_in_pairs(pair):
    for wrong in (heights(pair.source), 5, features(pair)[:1]):
        refused(pair, authalic.MeshError, "features must be a pair", energy="surface", features=wrong)


@both
@pytest.mark.parametrize("weight", [1.0, 0.0, np.nan, [1.0]])
def test_a_weight_of_features_that_are_not_given_is_refused(pair, weight):
    error = refused(pair, ValueError, "there are none", energy="surface", feature_weight=weight)
    assert error.kind == "invalid_option"


@both
@pytest.mark.parametrize("weight", [-1.0, np.nan, np.inf, [1.0, 2.0], []])
def test_weights_of_features_fit(pair, weight):
    refused(
        pair,
        ValueError,
        "feature_weight must be",
        energy="surface",
        features=features(pair),
        feature_weight=weight,
    )


@both
def test_a_map_between_surfaces_folds_nothing_and_keeps_exact_landmarks(pair):
    result = pairs.register(
        pair, energy="surface", features=features(pair), feature_weight=[0.1], position_weight=0.1
    )
    pairs.assert_registration(result, pair)
    pairs.assert_landmarks_meet(result, pair)


@both
def test_soft_landmarks_are_not_missed(pair):
    weights = np.full(len(pair.source_landmarks), np.inf)
    weights[1] = 1e-6
    result = pairs.register(pair, energy="surface", weights=weights)
    pairs.assert_embedding(result.registered, result.faces)
    assert len(result.missed) == 0
    exact = np.isinf(weights)
    assert result.landmark_error[exact].max() <= pairs.MISSED


def test_spheres_with_features_need_no_landmarks():
    with pytest.raises(authalic.MeshError, match=r"too few .* or features=") as caught:
        authalic.register_spheres(BALLS.source, BALLS.target, energy="surface")
    assert caught.value.kind == "too_few_landmarks"
    result = authalic.register_spheres(BALLS.source, BALLS.target, energy="surface", features=features(BALLS))
    pairs.assert_embedding(result.registered, result.faces)
    assert len(result.landmark_error) == len(result.missed) == 0


# By curves


def test_curves_refuse_what_the_harmonic_energy_does_not_weigh():
    signals = heights(CURVES.source), heights(CURVES.target)
    for option in (
        {"area_weight": 2.0},
        {"angle_weight": 0.0},
        {"position_weight": 1.0},
        {"features": signals},
    ):
        with pytest.raises(ValueError, match='"surface"') as caught:
            curves.register(CURVES, **option)
        assert caught.value.kind == "invalid_option"
    with pytest.raises(ValueError, match="where angle_weight is 0") as caught:
        curves.register(CURVES, energy="surface", area_weight=0.0, angle_weight=0.0)
    assert caught.value.kind == "invalid_option"
    with pytest.raises(authalic.MeshError, match="target features") as caught:
        curves.register(CURVES, energy="surface", features=(signals[0], signals[1][1:]))
    assert caught.value.side == "target"


def test_curves_stay_exact_between_the_surfaces():
    result = curves.register(CURVES, energy="surface", position_weight=0.1)
    curves.assert_located(result, CURVES)
    curves.assert_curves_meet(result, CURVES)
    assert result.distortion.folded.tolist() == []
