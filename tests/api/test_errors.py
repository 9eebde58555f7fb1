# SPDX-License-Identifier: MIT OR Apache-2.0
"""Exceptions and warnings as data: no program need read their messages."""

import pickle
import re

import numpy as np
import pytest

import authalic

from . import curves, meshes

CAP, BALL, SHEET = meshes.bumpy_cap(), meshes.ball(2), meshes.grid(4, 4)
OPEN = curves.opened(BALL, [[0, 0, -1]], 0.6)
RIM = next(iter(authalic.cut(*OPEN))).boundary_loops[0].tolist()
POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 0]], float)
FLAT = SHEET.vertices[:, :2]
ARCS = [curve.tolist() for curve in curves.drawn(BALL, curves.arcs(3))]
RING = curves.ring(BALL, [0, 0, -1], 0.6)
RING = [*RING, RING[0]]
(INSIDE,) = (curve.tolist() for curve in curves.drawn(BALL, [[[0.4, 0, -1], [-0.4, 0.1, -1]]]))
(OUTSIDE,) = (curve.tolist() for curve in curves.drawn(BALL, [[[1, 0, 0.5], [0, 1, 0.5]]]))


def triangles(*faces):
    return POINTS[: np.max(faces) + 1], np.array(faces)


def changed(array, row, value):
    array = np.array(array, float)
    array[row] = value
    return array


def disk(surface, **options):
    return lambda: authalic.disk_map(*surface, **options)


def sphere(surface, **options):
    return lambda: authalic.sphere_map(*surface, **options)


def cut(seams):
    return lambda: authalic.cut(*BALL, seams=seams)


def untangle(image, **options):
    return lambda: authalic.untangle(SHEET, image, **options)


def by_points(source_landmarks, target_landmarks, source=BALL, target=BALL):
    return lambda: authalic.register_spheres(
        source, target, source_landmarks=source_landmarks, target_landmarks=target_landmarks
    )


def by_curves(source_curves, target_curves, source=BALL, target=BALL):
    return lambda: authalic.register_hyperbolic(
        source, target, source_curves=source_curves, target_curves=target_curves
    )


def facts(kind, indices=(), count=None, *, side=None, curve=None, second_curve=None):
    """The attributes of an exception; the count is that of the indices unless it is given."""
    count = len(indices) if count is None else count
    return {
        "kind": kind,
        "side": side,
        "curve": curve,
        "second_curve": second_curve,
        "indices": indices,
        "count": count,
    }


CASES = [
    (disk((np.empty((0, 3)), np.empty((0, 3), int))), facts("no_vertices")),
    (disk((POINTS, np.empty((0, 3), int))), facts("no_faces")),
    (disk((changed(CAP.vertices, 3, np.nan), CAP.faces)), facts("not_finite", (3,))),
    (disk((POINTS, [[0, 1, 2], [0, 2, 9]])), facts("index_out_of_range", (1,))),
    (disk(triangles([0, 1, 1])), facts("repeated_vertex", (0,))),
    (disk(triangles(*[[0, 1, 2]] * 12)), facts("duplicate_face", tuple(range(1, 9)), 11)),
    (disk((POINTS[[0, 1, 1]] * [[1], [1], [2]], [[0, 1, 2]])), facts("zero_area", (0,))),
    (disk(triangles([0, 1, 2], [1, 0, 3], [0, 1, 4])), facts("non_manifold_edge", ((0, 1),))),
    (disk(triangles([0, 1, 2], [0, 3, 4])), facts("non_manifold_vertex", (0,))),
    (disk((POINTS, [[0, 1, 2]])), facts("loose_vertex", (3, 4))),
    (disk(BALL), facts("closed_surface")),
    (sphere(meshes.torus()), facts("handles")),
    (cut([[5, 5]]), facts("seam_not_edge", ((5, 5),))),
    (cut([[0, 1], [0, 10**6]]), facts("index_out_of_range", (1,))),
    (disk((CAP.vertices[:, :2], CAP.faces)), facts("invalid_array")),
    (disk(CAP, angle_weight=-1.0), facts("invalid_option")),
    (disk(CAP, method="newton"), facts("invalid_option")),
    (disk(CAP, max_iterations=-1), facts("invalid_option")),
    (disk(CAP, density=changed(np.ones(len(CAP.faces)), 4, 0)), facts("invalid_density", (4,))),
    (untangle(changed(FLAT, 7, np.inf)), facts("map_not_finite", (7,))),
    (sphere(BALL, initial=changed(BALL.vertices, 7, 0)), facts("initial_sphere", (7,))),
    (by_points([1], [1, 2]), facts("landmark_counts")),
    (by_points([1], [1]), facts("too_few_landmarks")),
    (by_points([1, 2], [3, 3]), facts("repeated_landmark", (1,), side="target")),
    (by_points([1, -2], [3, 4]), facts("index_out_of_range", (1,), side="source")),
    (by_points([[1, 2]], [3, 4]), facts("invalid_array", side="source")),
    (by_points([1, 2], [1, 2], target=meshes.torus()), facts("handles", side="target")),
    (by_points([1, 2], [1, 2], source=7), facts("invalid_array", side="source")),
    (by_curves(ARCS, ARCS[:1]), facts("curve_counts", (1, 2))),
    (by_curves([], []), facts("no_curves")),
    (by_curves(ARCS[:2], [ARCS[0], ARCS[1][:2]]), facts("short_curve", side="target", curve=1)),
    (by_curves(["text"], ARCS[:1]), facts("invalid_array", side="source", curve=0)),
    (by_curves(ARCS, 7), facts("invalid_array", side="target")),
    (
        by_curves([ARCS[0], [*ARCS[1][:2], -5]], ARCS[:2]),
        facts("index_out_of_range", (2,), side="source", curve=1),
    ),
    (
        by_curves(ARCS[:1], [[curve[0] for curve in ARCS]]),
        facts("curve_off_edges", (ARCS[0][0], ARCS[1][0]), side="target", curve=0),
    ),
    (by_curves([[0, 0, 0, 1]], ARCS[:1]), facts("curve_meets_itself", (0,), side="source", curve=0)),
    (
        by_curves([ARCS[0], ARCS[0][::-1]], ARCS[:2]),
        facts("curves_meet", tuple(ARCS[0][::-1]), side="source", curve=0, second_curve=1),
    ),
    (
        by_curves([RIM[:4]], [RIM[:4]], OPEN, OPEN),
        facts("curve_on_boundary", tuple(RIM[:4]), side="source", curve=0),
    ),
    (by_curves([RING], ARCS[:1]), facts("curve_not_closed", side="target", curve=0)),
    (
        by_curves([RING, INSIDE], [RING, OUTSIDE]),
        facts("curve_sides", side="source", curve=1, second_curve=0),
    ),
    (by_curves(ARCS, ARCS, target=meshes.torus()), facts("handles", side="target")),
]


@pytest.mark.parametrize(("call", "expected"), CASES, ids=[expected["kind"] for _, expected in CASES])
def test_the_facts_of_an_error(call, expected):
    with pytest.raises((ValueError, authalic.SolverError)) as caught:
        call()
    assert vars(caught.value) == expected
    assert expected["kind"] in authalic.ERROR_KINDS


def test_holes_are_vertices_of_the_loops_with_the_option_that_fills_them():
    with pytest.raises(authalic.MeshError, match="fill_holes=True") as caught:
        authalic.disk_map(*meshes.annulus())
    assert (caught.value.kind, caught.value.count) == ("several_boundaries", 2)
    holed = meshes.annulus()
    with pytest.raises(authalic.MeshError, match=r"^the source: .*2 boundary loops") as caught:
        authalic.register_disks(holed, holed, source_landmarks=[1], target_landmarks=[1])
    assert (caught.value.kind, caught.value.side) == ("several_boundaries", "source")
    assert "fill_holes=True fills them for the time of the call" in str(caught.value)
    ball, open_ball = meshes.icosphere(2), meshes.bumpy_cap()
    with pytest.raises(authalic.MeshError, match=r"^the target: .*\(fill_holes=True") as caught:
        authalic.register_spheres(ball, open_ball, source_landmarks=[1, 2], target_landmarks=[1, 2])
    assert (caught.value.kind, caught.value.side) == ("open_surface", "target")
    with pytest.raises(authalic.MeshError, match=r"\(fill_holes=True fills them\)") as caught:
        authalic.sphere_map(*open_ball)
    assert (caught.value.kind, caught.value.side) == ("open_surface", None)


def test_failed_numerics_have_facts_too():
    with pytest.raises(authalic.SolverError, match="cancelled") as caught:
        authalic.hyperbolic_structure(*BALL, curves=ARCS, progress=lambda *_: False)
    assert vars(caught.value) == facts("cancelled")


def test_folds_that_cannot_be_removed_are_faces():
    with pytest.raises(authalic.SolverError) as caught:
        authalic.untangle(SHEET, changed(FLAT, 0, FLAT.max(axis=0) * 2))
    assert vars(caught.value) == facts("still_folded", (0, 1))
    with pytest.raises(authalic.MeshError) as caught:
        authalic.untangle(SHEET, changed(FLAT, [5, 6], FLAT[[6, 5]]), fixed=[5, 6, 9, 10])
    assert caught.value.kind == "fixed_fold"
    assert caught.value.count == len(caught.value.indices) > 0


def test_the_documentation_lists_exactly_the_kinds_of_the_core():
    text = authalic.MeshError.__doc__
    attributes, kinds = text.split("Attributes\n")[1].split("Notes\n")
    names = re.findall(r"^(\w+) : ", attributes, re.MULTILINE)
    assert set(names) == set(facts(""))
    listed = re.findall(r"^(\w+)\n    (.+)$", kinds, re.MULTILINE)
    assert listed == list(authalic.ERROR_KINDS.items())
    assert "MeshError" in authalic.SolverError.__doc__


@pytest.mark.parametrize("kinds", [authalic.ERROR_KINDS, authalic.WARNING_KINDS])
def test_every_kind_has_a_meaning(kinds):
    assert all(re.fullmatch("[a-z]+(_[a-z]+)*", kind) for kind in kinds)
    assert all(re.fullmatch(r"[A-Z].+\.", meaning) for meaning in kinds.values())


# Warnings


def reversed_curve():
    pair = curves.balls(6)
    target_curves = [pair.target_curves[0][::-1], *pair.target_curves[1:]]
    return curves.register(pair._replace(target_curves=target_curves))


def test_a_warning_is_its_message_with_facts():
    warning, *_ = reversed_curve().warnings
    assert isinstance(warning, authalic.RegistrationWarning) and isinstance(warning, str)
    assert (warning.kind, warning.curve, warning.side) == ("backward_curve", 0, None)
    assert (warning.indices, warning.count, warning.value) == ((), 0, None)
    assert warning.message == warning and type(warning.message) is str
    assert "curve 0" in warning
    assert vars(pickle.loads(pickle.dumps(warning))) == vars(warning)


def test_strain_has_the_energy_and_distorted_faces_their_share():
    pair = curves.balls(6)
    first, second, *others = pair.target_curves
    result = curves.register(pair._replace(target_curves=[second, first, *others]))
    warnings = {warning.kind: warning for warning in result.warnings}
    assert warnings.keys() <= authalic.WARNING_KINDS.keys()
    assert warnings["strained"].value == result.certificates.energy_ratio
    distorted = np.flatnonzero(abs(result.distortion.log2_area_ratio) > np.log2(10))
    if "distorted" in warnings:
        warning = warnings["distorted"]
        assert (warning.side, warning.count) == ("source", len(distorted))
        assert list(warning.indices) == distorted[:8].tolist()
        assert 0.05 < warning.value <= 1
