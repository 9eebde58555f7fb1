# SPDX-License-Identifier: MIT OR Apache-2.0
"""register_hyperbolic: its arguments, results and refusals."""

import inspect
import re

import numpy as np
import pytest

import authalic

from . import curves, meshes

PAIR = curves.balls(4, target=meshes.radial(lambda x, y, z: 1 + 0.3 * x * y + 0.2 * z, 4))
BALL = meshes.bumpy_ball(3)
LINES = [[[1, 0.2, 0], [0.2, 1, 0]], [[-1, -0.2, 0.3], [-0.2, -1, 0.3]], [[0.3, 0.3, 1], [-0.5, 0.5, 0.8]]]
GOOD = [curve.tolist() for curve in curves.drawn(BALL, LINES)]
SIDES = ("source_curves", "target_curves")


@pytest.fixture(scope="module")
def result():
    return curves.register(PAIR)


# Arguments and results


def test_all_but_the_surfaces_is_keyword_only():
    parameters = inspect.signature(authalic.register_hyperbolic).parameters.values()
    assert [p.name for p in parameters if p.kind is p.POSITIONAL_OR_KEYWORD] == ["source", "target"]
    assert {p.name: p.default for p in parameters if p.kind is p.KEYWORD_ONLY} == {
        "source_curves": inspect.Parameter.empty,
        "target_curves": inspect.Parameter.empty,
        "energy": "surface",
        "area_weight": 1.0,
        "angle_weight": 1.0,
        "features": None,
        "feature_weight": None,
        "position_weight": 0.0,
        "fill_holes": False,
        "repair": False,
        "metric": "newton",
        "solver": "newton",
        "max_iterations": None,
        "tolerance": None,
        "source_sphere": None,
        "target_sphere": None,
        "progress": None,
        "preview": None,
    }


def test_every_parameter_and_attribute_is_documented():
    text = authalic.register_hyperbolic.__doc__
    for name in inspect.signature(authalic.register_hyperbolic).parameters:
        assert re.search(rf"^(\w+, )*{name}(, \w+)* : ", text, re.MULTILINE), name
    for section in ("Parameters\n------", "Returns\n------", "Raises\n------", "Examples\n------"):
        assert section in text
    for name in dir(authalic.Certificates):
        assert name.startswith("_") or getattr(authalic.Certificates, name).__doc__, name


def test_arrays_are_c_ordered_float64_and_int64(result):
    (n, m), (_, m_t) = ((len(mesh.vertices), len(mesh.faces)) for mesh in PAIR[:2])
    for array, shape, dtype in (
        (result.positions, (n, 3), np.float64),
        (result.triangles, (n,), np.int64),
        (result.barycentric, (n, 3), np.float64),
        (result.registered, (n, 3), np.float64),
        (result.target_registered, (len(PAIR.target.vertices), 3), np.float64),
        (result.faces, (m, 3), np.int64),
        (result.target_faces, (m_t, 3), np.int64),
        (result.landmark_error, (4,), np.float64),
        (result.missed, (0,), np.int64),
        (result.area_ratio, (m,), np.float64),
        (result.area_distortion, (m,), np.float64),
        (result.certificates.folded, (0,), np.int64),
        (result.energies[0], (result.iterations + 1,), np.float64),
    ):
        assert (array.shape, array.dtype) == (shape, dtype)
        assert array.flags.c_contiguous
        assert not array.flags.writeable


def test_the_certificates_are_plain_numbers(result):
    proof = result.certificates
    for name in ("area", "expected_area", "area_error", "curve_error", "bank_error", "cocycle_error"):
        assert type(getattr(proof, name)) is float, name
    assert type(proof.energy_ratio) is float
    assert type(proof.outside) is int
    assert [type(number) for number in proof.curvature] == [float, float]
    assert repr(proof).startswith("Certificates(folded=0, area_error=")
    assert "\n" not in repr(proof) + repr(result)
    with pytest.raises(AttributeError):
        proof.area = 0.0


def test_the_result_is_a_registration_with_more(result):
    assert isinstance(result, authalic.Registration)
    assert result.warnings == []
    assert len(result.energies) == 1
    assert type(result.seconds) is float
    assert result.seconds > 0
    assert isinstance(result.source_map, authalic.SphereMap)
    assert isinstance(result.distortion, authalic.Distortion)
    assert np.allclose(np.linalg.norm(result.registered, axis=1), 1, atol=1e-14)
    assert np.allclose(np.linalg.norm(result.target_registered, axis=1), 1, atol=1e-14)


def test_a_registration_by_points_has_no_certificates():
    registration = authalic.register_spheres(BALL, BALL, source_landmarks=[0, 9], target_landmarks=[0, 9])
    assert registration.certificates is None
    assert (registration.warnings, registration.energies) == ([], [])


def test_curves_are_taken_as_any_sequence_of_integers(result):
    kinds = (list, tuple, lambda c: np.array(c, np.int32), lambda c: np.array(c, np.uint64)[::1])
    given = [kind(curve.tolist()) for kind, curve in zip(kinds, PAIR.source_curves, strict=True)]
    registration = curves.register(PAIR._replace(source_curves=tuple(given)))
    assert np.array_equal(registration.positions, result.positions)


def test_surfaces_are_taken_in_any_order_and_precision(result):
    source = np.asfortranarray(PAIR.source.vertices), np.asfortranarray(PAIR.source.faces.astype(np.int32))
    registration = curves.register(PAIR._replace(source=source))
    assert np.array_equal(registration.positions, result.positions)


def test_the_arguments_are_left_as_they_are():
    before = [np.array(array) for array in (*PAIR.source, *PAIR.target, *PAIR.source_curves)]
    curves.register(PAIR)
    for old, new in zip(before, (*PAIR.source, *PAIR.target, *PAIR.source_curves), strict=True):
        assert np.array_equal(old, new)


# Refusals


def refused(mesh, bad, side, good=GOOD, other=None):
    """The error about curves given on one side; nothing may have been computed."""
    given = {name: bad if name == side else good for name in SIDES}
    heard = []
    with pytest.raises(authalic.MeshError) as caught:
        authalic.register_hyperbolic(
            mesh, other or mesh, **given, progress=lambda *report: heard.append(report)
        )
    assert heard == []
    return caught.value


def outward(mesh, start, used):
    """A path of four vertices from `start`, through vertices that no curve uses."""
    around, path = curves.neighbors(mesh.faces), [start]
    while len(path) < 4:
        last = [v for v in around[path[-1]] if v not in used and v not in path]
        path.append(max(last, key=lambda v: np.linalg.norm(mesh.vertices[v] - mesh.vertices[start])))
    return path


USED = {v for curve in GOOD for v in curve}
FREE = outward(BALL, max(set(range(len(BALL.vertices))) - USED), USED)
TOUCHING = outward(BALL, GOOD[0][-1], USED)[::-1]
CROSSING = outward(BALL, GOOD[0][1], USED)[:0:-1] + outward(
    BALL, GOOD[0][1], USED | set(outward(BALL, GOOD[0][1], USED)[1:])
)
BAD = {
    "touching": (TOUCHING, f"curves 0 and 1 meet at vertex {GOOD[0][-1]}"),
    "crossing": (CROSSING, f"curves 0 and 1 meet at vertex {GOOD[0][1]}"),
    "self_crossing": ([*FREE[:3], FREE[1]], f"curve 1 meets itself at vertex {FREE[1]}"),
    "self_touching": ([*FREE[:3], FREE[0], FREE[1]], "curve 1 meets itself"),
    "there_and_back": ([*FREE[:3], *FREE[1::-1]], "curve 1 meets itself"),
    "one_edge": (FREE[:2], "curve 1 has 1 edges, but needs at least two"),
    "one_vertex": (FREE[:1], "curve 1 has 0 edges"),
    "empty": ([], "curve 1 has 0 edges"),
    "closed_by_two_edges": ([*FREE[:2], FREE[0]], "curve 1 has 2 edges.*a closed one three"),
    "off_edges": ([FREE[0], FREE[1], FREE[3]], f"curve 1 leaves the edges.*{FREE[1]}.*{FREE[3]}"),
    "standing_still": ([FREE[0], FREE[1], FREE[1], FREE[2]], "curve 1"),
    "out_of_range": ([*FREE[:2], 258], "curve 1.*258"),
    "negative": ([*FREE[:2], -1], "curve 1.*-1"),
    "huge": ([*FREE[:2], 2**62], f"curve 1.*{2**62}"),
    "nan": (np.array([*FREE[:2], np.nan]), "curve 1"),
    "fractions": (np.array([0.0, 1.5, 2.0]), "curve 1"),
    "table": (np.array([FREE, FREE]), "curve 1"),
    "text": ("abc", "curve 1"),
    "nothing": (None, "curve 1"),
}


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize(("bad", "words"), BAD.values(), ids=BAD)
def test_a_bad_curve_is_a_mesh_error_that_names_it(bad, words, side):
    error = refused(BALL, [GOOD[0], bad, GOOD[2]], side)
    assert re.search(words, str(error)), error
    assert side in str(error)


@pytest.mark.parametrize("side", SIDES)
def test_the_error_carries_the_vertices_at_fault(side):
    error = refused(BALL, [GOOD[0], BAD["crossing"][0], GOOD[2]], side)
    assert (error.count, list(error.indices)) == (1, [GOOD[0][1]])
    error = refused(BALL, [GOOD[0], GOOD[0], GOOD[2]], side)
    assert sorted(error.indices) == sorted(GOOD[0])


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("count", [0, 1, 2, 4])
def test_the_counts_must_agree(side, count):
    error = refused(BALL, [*GOOD, FREE][:count], side)
    numbers = (count, 3) if side == "source_curves" else (3, count)
    assert "{} on the source and {} on the target".format(*numbers) in str(error)
    assert str(min(count, 3)) in str(error).split("partner")[1]


def test_closed_surfaces_need_a_curve():
    assert "no curves" in str(refused(BALL, [], "source_curves", good=[]))


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("bad", [3, None, 1.5])
def test_what_is_no_list_of_curves_is_refused(side, bad):
    assert side in str(refused(BALL, bad, side))


@pytest.mark.parametrize("side", SIDES)
def test_curves_stay_clear_of_the_boundary(side):
    mesh = curves.opened(BALL, [[0, 0, -1]], 0.8)
    good = curves.drawn(mesh, LINES)
    rim = next(iter(authalic.cut(*mesh))).boundary_loops[0].tolist()
    used = {v for curve in good for v in curve}
    from_rim = outward(mesh, rim[0], used | set(rim))
    for bad, words in ((from_rim[::-1], f"vertex {rim[0]}"), (rim[:4], "4 vertices")):
        error = refused(mesh, [good[0], bad, good[2]], side, good=good)
        assert "curve 1 meets the boundary" in str(error)
        assert words in str(error)
        assert side in str(error)


@pytest.mark.parametrize("side", SIDES)
def test_of_a_pair_both_are_closed_or_none(side):
    loop = curves.ring(BALL, [0, 0, -1], 0.6)
    open_side = SIDES[1 - SIDES.index(side)]
    error = refused(BALL, [GOOD[0], [*loop, loop[0]]], side, good=[GOOD[0], GOOD[1]])
    assert f"{open_side}: curve 1 is open, but its partner is closed" in str(error)


def test_a_curve_on_the_other_side_of_a_closed_one_is_refused():
    loop = curves.ring(BALL, [0, 0, -1], 0.3)
    loop = [*loop, loop[0]]
    inside = curves.along(BALL, [[0.2, 0, -1], [-0.2, 0.2, -1]])
    error = refused(BALL, [loop, GOOD[2], GOOD[0]], "target_curves", good=[loop, inside, GOOD[0]])
    assert "curve 1" in str(error)
    assert "curve 0" in str(error)


@pytest.mark.parametrize("name", ["source", "target"])
@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        (meshes.torus(30, 20), "genus 1"),
        (meshes.Mesh(BALL.vertices * np.nan, BALL.faces), "vertices"),
        (meshes.Mesh(BALL.vertices, BALL.faces.astype(float) * np.nan), "faces"),
        (meshes.Mesh(BALL.vertices, BALL.faces[1:]), "loop"),
        (meshes.Mesh(np.vstack([BALL.vertices] * 2), np.vstack([BALL.faces, BALL.faces + 258])), "2 sep"),
        (meshes.Mesh(BALL.vertices * [1, 1, 0] * 0, BALL.faces), "area|zero|same"),
    ],
    ids=["torus", "nan", "nan_faces", "one_more_hole", "two_pieces", "a_point"],
)
def test_a_bad_surface_is_a_mesh_error_that_names_it(name, mesh, words):
    meshes_given = (mesh, BALL) if name == "source" else (BALL, mesh)
    heard = []
    with pytest.raises(authalic.MeshError, match=words) as caught:
        authalic.register_hyperbolic(
            *meshes_given,
            source_curves=GOOD,
            target_curves=GOOD,
            progress=lambda *report: heard.append(report),
        )
    assert name in str(caught.value)
    assert heard == []


def test_mirrored_surfaces_are_refused():
    """A map that keeps the orientation would have to take every curve around the others."""
    source = meshes.bumpy_ball(4)
    lines = curves.drawn(source, curves.arcs(6))
    target = meshes.Mesh(source.vertices * [-1, 1, 1], source.faces[:, ::-1])
    with pytest.raises(authalic.MeshError, match="mirror"):
        authalic.register_hyperbolic(source, target, source_curves=lines, target_curves=lines)


@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        ("metric", "flow", 'metric must be "newton" or "ricci_flow", but is "flow"'),
        ("solver", "gauss_newton", 'solver must be "newton" or "heat", but is "gauss_newton"'),
        ("max_iterations", -1, "max_iterations must be ≥ 0, but is -1"),
        ("tolerance", -1.0, "tolerance must be a finite number ≥ 0, but is -1"),
        ("tolerance", float("nan"), "tolerance must be a finite number ≥ 0, but is NaN"),
        ("tolerance", float("inf"), "tolerance must be a finite number ≥ 0, but is inf"),
        ("source_sphere", PAIR.source.vertices, "source_sphere and target_sphere go together"),
        ("target_sphere", PAIR.target.vertices, "source_sphere and target_sphere go together"),
    ],
)
def test_an_option_out_of_range_is_a_plain_value_error(option, value, words):
    with pytest.raises(ValueError, match=words) as caught:
        curves.register(PAIR, **{option: value})
    assert type(caught.value) is ValueError


@pytest.mark.parametrize(
    ("option", "value"),
    [
        *[("metric", 3), ("solver", None), ("max_iterations", "many"), ("tolerance", "small")],
        *[("progress", 5)],
    ],
)
def test_an_option_of_the_wrong_type_is_a_type_error(option, value):
    with pytest.raises(TypeError):
        curves.register(PAIR, **{option: value})


@pytest.mark.parametrize("name", ["source_sphere", "target_sphere"])
def test_spheres_must_be_points_around_the_origin(name):
    spheres = {"source_sphere": PAIR.source.vertices, "target_sphere": PAIR.target.vertices}
    some_nan, some_zero = np.array(spheres[name]), np.array(spheres[name])
    some_nan[7], some_zero[7] = np.nan, 0
    for bad in (spheres[name][1:], spheres[name][:, :2], some_nan, some_zero, "sphere"):
        with pytest.raises(authalic.MeshError, match=name):
            curves.register(PAIR, **{**spheres, name: bad})
