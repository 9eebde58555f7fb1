# SPDX-License-Identifier: MIT OR Apache-2.0
"""Names, shapes and refusals of registrations."""

import inspect

import numpy as np
import pytest

import authalic

from . import meshes, pairs
from .test_arrays import LAYOUTS
from .test_contract import assert_array, public_attributes

CAPS, BALLS = pairs.DISK_PAIRS["caps"], pairs.SPHERE_PAIRS["ball_and_ellipsoid"]
BOTH = {"disk": CAPS, "sphere": BALLS}
both = pytest.mark.parametrize("pair", BOTH.values(), ids=BOTH)
ATTRIBUTES = {
    *("positions", "triangles", "barycentric", "registered", "target_registered", "faces", "target_faces"),
    *("source_map", "target_map", "landmark_error", "missed", "status", "distortion", "area_ratio"),
    *("area_distortion", "target_distortion", "iterations", "seconds", "pull", "inverse", "compare"),
    *("certificates", "warnings", "energies", "strain", "follow", "local_similarities"),
    *("off_boundary", "in_holes", "source_repaired", "target_repaired"),
}
STATUSES = {"converged", "landmarks_missed", "max_iterations", "stalled", "cancelled"}


@pytest.fixture(scope="module")
def results():
    return {name: pairs.register(pair) for name, pair in BOTH.items()}


@pytest.fixture(params=BOTH)
def both_results(request, results):
    return results[request.param], BOTH[request.param]


# Names, shapes, dtypes


@pytest.mark.parametrize("call", [authalic.register_disks, authalic.register_spheres])
def test_the_landmarks_are_keywords(call):
    parameters = inspect.signature(call).parameters
    keywords = [name for name, parameter in parameters.items() if parameter.kind is parameter.KEYWORD_ONLY]
    assert keywords[:2] == ["source_landmarks", "target_landmarks"]
    assert list(parameters)[:2] == ["source", "target"]
    required = {
        name for name, parameter in parameters.items() if parameter.default is inspect.Parameter.empty
    }
    only_features = call is authalic.register_spheres  # lay spheres over each other without landmarks
    assert required == {"source", "target"} | (set() if only_features else set(keywords[:2]))


def test_disks_need_landmarks():
    with pytest.raises(TypeError, match="source_landmarks"):
        authalic.register_disks(CAPS.source, CAPS.target)


def test_a_registration_has_the_attributes_of_the_contract(both_results):
    result, _ = both_results
    assert isinstance(result, authalic.Registration)
    assert public_attributes(result) == ATTRIBUTES
    assert result.status in STATUSES
    assert isinstance(result.distortion, authalic.Distortion)
    assert type(result.iterations) is int
    assert type(result.seconds) is float
    assert result.seconds > 0


def test_arrays_of_registrations_are_c_ordered_float64_and_int64(both_results):
    result, pair = both_results
    n, m = len(pair.source.vertices), len(pair.source.faces)
    n_target, m_target = len(pair.target.vertices), len(pair.target.faces)
    dimension = 2 if pair is CAPS else 3
    assert_array(result.positions, (n, 3), np.float64)
    assert_array(result.triangles, (n,), np.int64)
    assert_array(result.barycentric, (n, 3), np.float64)
    assert_array(result.registered, (n, dimension), np.float64)
    assert_array(result.target_registered, (n_target, dimension), np.float64)
    assert_array(result.faces, (m, 3), np.int64)
    assert_array(result.target_faces, (m_target, 3), np.int64)
    assert_array(result.landmark_error, (len(pair.source_landmarks),), np.float64)
    assert_array(result.missed, (0,), np.int64)
    assert_array(result.area_ratio, (m,), np.float64)


def test_a_registration_keeps_the_maps_of_both_surfaces(both_results):
    result, pair = both_results
    kind = authalic.DiskMap if pair is CAPS else authalic.SphereMap
    call = authalic.disk_map if pair is CAPS else authalic.sphere_map
    for kept, mesh in ((result.source_map, pair.source), (result.target_map, pair.target)):
        alone = call(*mesh)
        assert type(kept) is kind
        assert kept.status == alone.status
        assert kept.distortion.authalic_energy == alone.distortion.authalic_energy
    image = "uv" if pair is CAPS else "positions"
    assert np.array_equal(getattr(kept, image), getattr(alone, image))


def test_the_maps_of_a_start_turn_with_their_surfaces_and_have_the_figures_of_these():
    pair = pairs.SPHERE_PAIRS["ball_and_ellipsoid"]
    turn, _ = np.linalg.qr(np.random.default_rng(5).standard_normal((3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    moved = pair._replace(source=meshes.Mesh(pair.source.vertices @ turn, pair.source.faces))
    here, there = (pairs.register(each, energy="surface") for each in (pair, moved))
    for kept, mesh in ((here.source_map, pair.source), (here.target_map, pair.target)):
        measured = authalic.distortion(mesh.vertices, mesh.faces, kept.positions)
        assert abs(kept.distortion.authalic_energy - measured.authalic_energy) < 1e-12
        assert kept.distortion.folded.tolist() == measured.folded.tolist() == []
    assert np.abs(there.source_map.positions - here.source_map.positions @ turn).max() < 1e-6
    for name in ("registered", "target_registered"):
        assert np.abs(getattr(there, name) - getattr(here, name)).max() < 1e-6
    assert np.abs(there.target_map.positions - here.target_map.positions).max() < 1e-6


def test_a_registration_is_printed_in_one_line_with_figures(both_results):
    result, pair = both_results
    text = repr(result)
    assert text.startswith(
        f"Registration({len(pair.source.vertices)} onto {len(pair.target.vertices)} vertices"
    )
    assert f"{len(pair.source_landmarks)} landmarks" in text
    assert "Distortion(authalic_energy=" in text
    assert "\n" not in text


def test_results_cannot_be_changed(both_results):
    for name in ("positions", "status", "missed"):
        with pytest.raises(AttributeError):
            setattr(both_results[0], name, None)


def test_turned_faces_are_turned_and_reported():
    faces = CAPS.source.faces.copy()
    faces[50:90] = faces[50:90, [0, 2, 1]]
    result = pairs.register(CAPS._replace(source=meshes.Mesh(CAPS.source.vertices, faces)))
    assert np.array_equal(result.faces, CAPS.source.faces)
    assert np.array_equal(result.positions, pairs.register(CAPS).positions)


# Arrays in


@both
@pytest.mark.parametrize("dtype", ["u2", "i2", "i4", "u8", "f4", "f8"])
def test_landmarks_of_any_integer_dtype_and_whole_reals(pair, dtype):
    typed = [marks.astype(dtype) for marks in pair[2:]]
    result = pairs.register(with_landmarks(pair, *typed))
    assert np.array_equal(result.positions, pairs.register(pair).positions)


@both
@pytest.mark.parametrize("layout", LAYOUTS.values(), ids=LAYOUTS)
def test_any_memory_layout(pair, layout):
    source, target = ((layout(mesh.vertices), layout(mesh.faces)) for mesh in pair[:2])
    landmarks = [np.asarray(layout(marks[:, None]))[:, 0] for marks in pair[2:]]
    laid_out = pairs.register_function(pair)(
        source, target, source_landmarks=landmarks[0], target_landmarks=landmarks[1], energy="area"
    )
    assert np.array_equal(laid_out.positions, pairs.register(pair).positions)


def test_landmarks_as_lists_and_tuples():
    given = CAPS._replace(
        source_landmarks=CAPS.source_landmarks.tolist(), target_landmarks=tuple(CAPS.target_landmarks)
    )
    assert np.array_equal(pairs.register(given).positions, pairs.register(CAPS).positions)


def test_surfaces_as_lists():
    given = CAPS._replace(source=[array.tolist() for array in CAPS.source], target=list(CAPS.target))
    call = authalic.register_disks(
        *given[:2],
        source_landmarks=CAPS.source_landmarks,
        target_landmarks=CAPS.target_landmarks,
        energy="area",
    )
    assert np.array_equal(call.positions, pairs.register(CAPS).positions)


def test_inputs_are_left_unchanged():
    arrays = [array.copy() for mesh in CAPS[:2] for array in mesh] + [marks.copy() for marks in CAPS[2:]]
    before = [array.copy() for array in arrays]
    result = authalic.register_disks(
        arrays[:2], arrays[2:4], source_landmarks=arrays[4], target_landmarks=arrays[5]
    )
    result.pull(arrays[2])
    authalic.homotopy(arrays[0], result, 0.5, align=True)
    assert all(np.array_equal(*both) for both in zip(arrays, before, strict=True))


# Refusals: before anything is computed, with the pair and the vertex


def refused(pair, words, indices=None, **options):
    """The error of a registration that is refused before its first report of progress."""
    heard = []
    with pytest.raises(authalic.MeshError, match=words) as caught:
        pairs.register(pair, progress=lambda *report: heard.append(report), **options)
    assert heard == []
    assert len(str(caught.value)) > 30
    if indices is not None:
        assert (caught.value.indices, caught.value.count) == (indices, len(indices))
    return caught.value


def with_landmarks(pair, *both, **sides):
    sides |= dict(zip(("source", "target"), both, strict=False))
    return pair._replace(**{f"{side}_landmarks": landmarks for side, landmarks in sides.items()})


@both
def test_unequal_counts_are_refused(pair):
    k = len(pair.source_landmarks)
    refused(
        with_landmarks(pair, target=pair.target_landmarks[:-1]), f"{k} source and {k - 1} target landmarks"
    )
    refused(
        with_landmarks(pair, source=pair.source_landmarks[:-2]), f"{k - 2} source and {k} target landmarks"
    )


def test_too_few_landmarks_are_refused():
    for empty in ([], np.array([], int), np.zeros(0)):
        refused(with_landmarks(CAPS, empty, empty), "too few .* 0, give at least 1$")
        refused(with_landmarks(BALLS, empty, empty), "too few .* 0, give at least 2, or features")
    refused(
        with_landmarks(BALLS, *(marks[:1] for marks in BALLS[2:])),
        "too few .* 1, give at least 2",
    )


@both
def test_repeated_landmarks_are_refused_with_both_pairs(pair):
    for side in ("source", "target"):
        marks = pair._asdict()[f"{side}_landmarks"].copy()
        marks[4] = marks[1]
        error = refused(with_landmarks(pair, **{side: marks}), f"^{side}_landmarks", (4,))
        assert f"vertex {marks[1]} of pair 1" in str(error)
        assert "pair 4" in str(error)


@both
@pytest.mark.parametrize("value", [-1, 10**6, 2**40, -(2**40)])
def test_landmarks_out_of_range_are_refused_with_the_pair_and_the_number(pair, value):
    for side in ("source", "target"):
        marks = pair._asdict()[f"{side}_landmarks"].copy()
        marks[2] = value
        error = refused(with_landmarks(pair, **{side: marks}), f"^{side}_landmarks", (2,))
        n = len(pair._asdict()[side].vertices)
        assert "pair 2" in str(error)
        assert str(value) in str(error)
        assert f"{n} vertices" in str(error)


def test_the_number_of_vertices_is_no_vertex():
    for side, mesh in (("source", CAPS.source), ("target", CAPS.target)):
        marks = CAPS._asdict()[f"{side}_landmarks"].copy()
        marks[0] = len(mesh.vertices)
        refused(with_landmarks(CAPS, **{side: marks}), f"^{side}_landmarks .*{len(mesh.vertices)}", (0,))


def test_landmarks_on_the_boundary_of_a_disk_are_refused():
    for side in ("source", "target"):
        edge = pairs.boundary_vertices(CAPS._asdict()[side].faces)
        marks = CAPS._asdict()[f"{side}_landmarks"].copy()
        marks[[1, 3]] = edge[[2, 5]]
        error = refused(with_landmarks(CAPS, **{side: marks}), f"^{side}_landmarks on the boundary", (1, 3))
        assert f"vertex {edge[2]}" in str(error)


BAD_LANDMARKS = {
    "fractions": [1.5, 2, 3, 4, 5],
    "nan": [np.nan, 2, 3, 4, 5],
    "two_columns": [[1, 2], [3, 4]],
    "scalar": 3,
    "text": ["a", "b"],
    "none": None,
    "complex": np.arange(5) + 0j,
    "booleans": [True, False],
    "objects": np.array([1, 2], object),
    "ragged": [[1, 2], [3]],
}


@pytest.mark.parametrize("marks", BAD_LANDMARKS.values(), ids=BAD_LANDMARKS)
@pytest.mark.parametrize("side", ["source", "target"])
def test_landmarks_that_are_no_list_of_integers_are_refused(side, marks):
    refused(with_landmarks(CAPS, **{side: marks}), f"^{side}_landmarks must be ")


@pytest.mark.parametrize(
    "surface", [None, 3, CAPS.source.vertices, (CAPS.source.vertices,), (*CAPS.source, 1), "ab c"]
)
@pytest.mark.parametrize("side", ["source", "target"])
def test_a_surface_that_is_no_pair_of_vertices_and_faces_is_refused(side, surface):
    surfaces = {"source": CAPS.source, "target": CAPS.target, side: surface}
    with pytest.raises(authalic.MeshError, match=rf"^{side} must be .*\(vertices, faces\)"):
        authalic.register_disks(
            **surfaces, source_landmarks=CAPS.source_landmarks, target_landmarks=CAPS.target_landmarks
        )


BAD_MESHES = {
    "nan": (
        lambda mesh: meshes.Mesh(
            np.where(mesh.vertices == mesh.vertices[5], np.nan, mesh.vertices), mesh.faces
        ),
        "NaN",
    ),
    "planar": (lambda mesh: meshes.Mesh(mesh.vertices[:, :2], mesh.faces), "must be of shape"),
    "out_of_range": (lambda mesh: meshes.Mesh(mesh.vertices[:-1], mesh.faces), "indices of the"),
    "repeated_vertex": (lambda mesh: meshes.Mesh(mesh.vertices, np.vstack([mesh.faces, [3, 3, 4]])), "twice"),
    "loose": (lambda mesh: meshes.Mesh(np.vstack([mesh.vertices, [9, 9, 9]]), mesh.faces), "without a face"),
}


@both
@pytest.mark.parametrize("side", ["source", "target"])
@pytest.mark.parametrize(("spoil", "words"), BAD_MESHES.values(), ids=BAD_MESHES)
def test_a_bad_mesh_is_refused_and_named(pair, side, spoil, words):
    mesh = spoil(pair._asdict()[side])
    surfaces = {"source": pair.source, "target": pair.target, side: mesh}
    with pytest.raises(authalic.MeshError, match=words) as caught:
        pairs.register_function(pair)(
            **surfaces, source_landmarks=pair.source_landmarks, target_landmarks=pair.target_landmarks
        )
    error = caught.value
    array_at_fault = "must be" in str(error)
    assert str(error).startswith(f"{side} " if array_at_fault else f"the {side}: ")


WRONG_KINDS = {
    "closed": (CAPS, meshes.bumpy_ball(), "closed"),
    "several_boundaries": (CAPS, meshes.annulus(), "2 boundary loops"),
    "moebius": (CAPS, meshes.moebius(), "orientable"),
    "open": (BALLS, meshes.bumpy_cap(), "boundary loop"),
    "handles": (BALLS, meshes.torus(), "genus 1"),
}


@pytest.mark.parametrize(("pair", "mesh", "words"), WRONG_KINDS.values(), ids=WRONG_KINDS)
@pytest.mark.parametrize("side", ["source", "target"])
def test_a_surface_of_another_kind_is_refused_and_named(pair, mesh, words, side):
    call, heard = pairs.register_function(pair), []
    surfaces = {"source": pair.source, "target": pair.target, side: mesh}
    with pytest.raises(authalic.MeshError, match=rf"^the {side}: .*{words}"):
        call(
            **surfaces,
            source_landmarks=[3, 50],
            target_landmarks=[3, 50],
            progress=lambda *report: heard.append(report),
        )
    assert heard == []


@both
@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        *[("weight", value, "weight must be a finite number > 0") for value in (0.0, -1.0, np.inf, np.nan)],
        *[
            ("angle_weight", value, "angle_weight must be a finite number ≥ 0")
            for value in (-0.5, np.inf, np.nan)
        ],
    ],
)
def test_an_option_out_of_range_is_a_plain_value_error(pair, option, value, words):
    with pytest.raises(ValueError, match=words) as caught:
        pairs.register(pair, **{option: value})
    assert type(caught.value) is ValueError


@both
@pytest.mark.parametrize(("option", "value"), [("weight", "big"), ("angle_weight", "small"), ("progress", 5)])
def test_an_option_of_the_wrong_type_is_a_type_error(pair, option, value):
    with pytest.raises(TypeError):
        pairs.register(pair, **{option: value})


UNSTABLE = {"spikes"}
"""Known misses: noise moves these small coarse spheres by up to 4e-3 of the size."""


@pytest.mark.parametrize("name", pairs.PAIRS)
def test_noise_does_not_move_a_registration(name, request):
    """With a small weight of angles; if areas alone count, noise moves coarse surfaces by up to a tenth."""
    if name in UNSTABLE:
        request.applymarker(pytest.mark.xfail(reason="known: noise moves this registration", strict=False))
    pair = pairs.PAIRS[name]

    def noisy(mesh, seed):
        noise = np.random.default_rng(seed).standard_normal(mesh.vertices.shape)
        return meshes.Mesh(mesh.vertices + 1e-12 * pairs.size(mesh) * noise, mesh.faces)

    moved = pair._replace(source=noisy(pair.source, 1), target=noisy(pair.target, 2))
    plain, noisy_positions = (pairs.register(each, angle_weight=1e-3).positions for each in (pair, moved))
    assert np.abs(noisy_positions - plain).max() < 1e-6 * pairs.size(pair.target)
