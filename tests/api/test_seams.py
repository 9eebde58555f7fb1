# SPDX-License-Identifier: MIT OR Apache-2.0
"""Automatic seams: disks of little shear, wishes that are kept, and what is refused."""

import functools
import time

import numpy as np
import pytest

import authalic

from . import effort, meshes, oracle, real_meshes


def moved(mesh, shift):
    return meshes.Mesh(mesh.vertices + shift, mesh.faces)


def joined(*parts):
    """Several meshes as one."""
    first = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    faces = [part.faces + k for part, k in zip(parts, first, strict=True)]
    return meshes.Mesh(np.vstack([part.vertices for part in parts]), np.vstack(faces))


def bumpy_torus():
    mesh = meshes.torus(18, 14)
    x, y, _ = mesh.vertices.T
    return meshes.Mesh(mesh.vertices * (1 + 0.1 * np.sin(2 * x + y + 0.5))[:, None], mesh.faces)


def tube():
    """An open tube."""
    mesh = meshes.annulus(28, 9)
    radius = np.linalg.norm(mesh.vertices, axis=1)
    height = 4 * radius[:, None]
    return meshes.Mesh(np.hstack([mesh.vertices[:, :2] / radius[:, None], height]), mesh.faces)


BUMPY = meshes.bumpy_ball(3)
"""A round body without any symmetry."""

SURFACES = {
    "bumpy_ball": BUMPY,
    "limbed_ball": meshes.limbed_ball(4, 2.0),
    "torus": bumpy_torus(),
    "plate_with_holes": meshes.plate_with_holes(17),
    "tube": tube(),
    "grid": meshes.grid(),
    "bumpy_cap": meshes.bumpy_cap(10, 26),
    "tetrahedron": meshes.tetrahedron(),
    "octahedron": meshes.octahedron((1.0, 2.0, 3.0)),
    "two_pieces": joined(meshes.bumpy_ball(2), moved(meshes.torus(18, 14), [9, 0, 0])),
}
"""Meshes of every topology; 250 vertices are searched in a quarter of the time of 800 or of 200."""

every_surface = pytest.mark.parametrize("mesh", SURFACES.values(), ids=SURFACES)


@functools.cache
def bumpy_seams():
    return authalic.seams(BUMPY)


def edge_set(edges):
    return {tuple(sorted(edge)) for edge in np.asarray(edges).tolist()}


def edges_of(mesh):
    """All edges, the lower end first, ascending."""
    pairs = np.vstack([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def seam_length(mesh, edges):
    length = np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1).sum()
    return length / np.sqrt(oracle.face_areas(*mesh).sum())


def assert_sound(mesh, seams):
    """Every island is a disk, and all that the seams say of themselves is true."""
    patches = authalic.cut(*mesh, seams=seams.edges)
    assert all(patch.is_disk for patch in patches)
    assert len(patches) == seams.islands
    for island, patch in enumerate(patches):
        assert (seams.island_of[patch.face_of] == island).all()
    assert (seams.edges[:, 0] < seams.edges[:, 1]).all()
    assert seams.edges.tolist() == sorted(seams.edges.tolist())
    assert edge_set(seams.edges) <= edge_set(edges_of(mesh))
    assert seams.length == pytest.approx(seam_length(mesh, seams.edges), rel=1e-9)
    assert 1 - 1e-9 <= seams.predicted < np.inf
    assert seams.status in {"converged", "stalled"}
    assert seams.seconds > 0


# Disks of little shear


@every_surface
@pytest.mark.parametrize("method", ["search", "cones"])
def test_the_islands_of_any_surface_are_disks(mesh, method):
    assert_sound(mesh, authalic.seams(mesh, method=method))


def test_a_lower_target_has_longer_seams():
    lengths = [authalic.seams(BUMPY, target=target).length for target in (1.15, 1.4)]
    assert lengths[0] > lengths[1]


def test_a_flat_surface_needs_no_seams():
    seams = authalic.seams(meshes.grid())
    assert (seams.edges.shape, seams.islands, seams.length, seams.status) == ((0, 2), 1, 0.0, "converged")
    assert seams.predicted == pytest.approx(1)


def test_a_preview_is_good():
    assert authalic.seams(meshes.bumpy_ball(4), method="cones").predicted < 1.45


def test_surfaces_patches_and_arrays_have_the_same_seams():
    expected = bumpy_seams().edges
    (patch,) = authalic.Surface(*BUMPY).cut()
    for given in (patch, (BUMPY.vertices.tolist(), BUMPY.faces.tolist())):
        assert np.array_equal(authalic.seams(given).edges, expected)


# Wishes


@pytest.mark.parametrize("name", ["bumpy_ball", "torus", "plate_with_holes"])
def test_given_seams_stay(name):
    mesh = SURFACES[name]
    fixed = edges_of(mesh)[::97, ::-1]
    seams = authalic.seams(mesh, fixed=fixed)
    assert edge_set(fixed) <= edge_set(seams.edges)
    assert_sound(mesh, seams)


@pytest.mark.parametrize("per", ["vertex", "edge"])
@pytest.mark.parametrize("mesh", [BUMPY, meshes.bumpy_ball(4)], ids=["refined", "itself"])
def test_forbidden_places_have_no_seam(mesh, per):
    is_kept_off = mesh.vertices[:, 0] > 0.3
    edges = edges_of(mesh)
    marked = is_kept_off if per == "vertex" else is_kept_off[edges].any(axis=1)
    seams = authalic.seams(mesh, weights=np.where(marked, np.inf, 1.0))
    assert_sound(mesh, seams)
    assert not is_kept_off[seams.edges].any()


def test_weights_draw_seams_and_keep_them_off():
    mesh = BUMPY
    side = mesh.vertices[:, 0] > 0
    share = []
    for factor in (0.2, 5.0):
        seams = authalic.seams(mesh, weights=np.where(side, factor, 1.0))
        share.append(side[seams.edges].mean())
    assert share[0] > share[1]


def test_weights_of_one_change_nothing():
    expected = bumpy_seams().edges
    for n in (len(BUMPY.vertices), len(edges_of(BUMPY))):
        assert np.array_equal(authalic.seams(BUMPY, weights=np.ones(n)).edges, expected)


def test_the_front_is_spared():
    mesh = meshes.icosphere(2, turned=5)
    mesh = meshes.Mesh(mesh.vertices * [1.0, 1.1, 1.25], mesh.faces)

    def share_in_front(**options):
        edges = authalic.seams(mesh, **options).edges
        return (mesh.vertices[edges].mean(axis=1) @ [1, 0, 0]).mean()

    assert share_in_front(front=[1, 0, 0]) < 0 < share_in_front(front=(-4, 0, 0))


def test_diagonals_are_dear():
    mesh = meshes.torus(40, 24)
    index = np.arange(40 * 24).reshape(24, 40)
    corner = np.roll(np.roll(index, -1, 0), -1, 1)
    diagonals = np.stack([index.ravel(), corner.ravel()], axis=1)
    without, given = (
        len(edge_set(authalic.seams(mesh, diagonals=edges).edges) & edge_set(diagonals))
        for edges in (None, diagonals)
    )
    assert given <= min(without, 4)


@pytest.mark.parametrize("most", [1, 2])
@pytest.mark.parametrize("name", ["bumpy_ball", "limbed_ball", "torus"])
def test_there_are_no_more_islands_than_are_wanted(name, most):
    seams = authalic.seams(SURFACES[name], target=1.25, max_islands=most)
    assert seams.islands <= most
    assert_sound(SURFACES[name], seams)


def bean():
    """A smooth body that is its own mirror image under x ↦ −x, as is its triangulation."""
    mesh = meshes.ball(4)
    x, y, z = (mesh.vertices * [1.0, 1.6, 2.3]).T
    return meshes.Mesh(np.stack([x, y + 0.2 * z**2, z * (1 + 0.1 * y)], axis=1), mesh.faces)


def test_seams_of_a_symmetric_surface_mirror_each_other():
    mesh = bean()
    edges = edge_set(authalic.seams(mesh, target=1.25).edges)
    distance = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices * [-1, 1, 1], axis=2)
    image = distance.argmin(axis=1)
    assert distance.min(axis=1).max() < 1e-9
    assert edges == {tuple(sorted(image[list(edge)].tolist())) for edge in edges}


def test_symmetry_may_be_a_word_or_a_truth_value():
    mesh = meshes.octahedron((1.0, 2.0, 3.0))
    seams = {wish: authalic.seams(mesh, symmetry=wish).edges for wish in ("auto", "off", True, False, None)}
    assert np.array_equal(seams["auto"], seams[True])
    assert np.array_equal(seams["off"], seams[False])
    assert np.array_equal(seams["off"], seams[None])


def test_a_mirrored_surface_has_mirrored_seams():
    mirrored = (BUMPY.vertices * [-1, 1, 1], BUMPY.faces[:, [0, 2, 1]])
    assert np.array_equal(authalic.seams(mirrored).edges, bumpy_seams().edges)


def test_noise_and_units_change_no_seam():
    expected = bumpy_seams().edges
    noise = 1e-12 * np.random.default_rng(1).uniform(-1, 1, BUMPY.vertices.shape)
    assert np.array_equal(authalic.seams((BUMPY.vertices + noise, BUMPY.faces)).edges, expected)
    assert np.array_equal(authalic.seams((BUMPY.vertices * 1024, BUMPY.faces)).edges, expected)


DIGEST = """
import hashlib, authalic
from api import meshes
for mesh in (meshes.bumpy_ball(3), meshes.torus(18, 14)):
    result = authalic.unwrap(mesh)
    print(hashlib.sha256(result.edges.tobytes() + result.uv.tobytes()).hexdigest())
"""


def test_one_and_several_threads_give_the_same_bits(run_python):
    one = run_python(DIGEST, RAYON_NUM_THREADS="1")
    assert run_python(DIGEST, RAYON_NUM_THREADS="3") == one


# Runs


def test_progress_grows_with_messages():
    heard = []
    expected = bumpy_seams()
    seams = authalic.seams(BUMPY, progress=lambda *report: heard.append(report))
    fractions, messages = zip(*heard, strict=True)
    assert len(fractions) > 5
    assert list(fractions) == sorted(fractions)
    assert fractions[0] >= 0
    assert 0.5 < fractions[-1] <= 1
    assert all(isinstance(message, str) and message for message in messages)
    assert np.array_equal(seams.edges, expected.edges)


@pytest.mark.parametrize("patience", [0, 0.05, 0.2])
def test_a_false_answer_cancels_soon(patience):
    mesh = meshes.bumpy_ball(5)
    began, refused = time.perf_counter(), []

    def progress(fraction, message):
        if time.perf_counter() - began >= patience:
            refused.append(effort.spent())
        return not refused

    with effort.counted(), pytest.raises(authalic.SolverError, match="cancelled") as caught:
        authalic.seams(mesh, target=1.1, progress=progress)
    assert effort.spent() - refused[0] < 0.3
    assert (caught.value.kind, len(refused)) == ("cancelled", 1)


@pytest.mark.parametrize("error", [KeyError("mine"), KeyboardInterrupt()])
def test_an_exception_of_the_progress_function_comes_through(error):
    def progress(fraction, message):
        raise error

    with pytest.raises(type(error)) as caught:
        authalic.seams(BUMPY, progress=progress)
    assert caught.value is error


INTERRUPTED = """
import signal, threading, authalic
from api import effort, meshes
mesh = meshes.bumpy_ball(6)
began = []
authalic.set_threads(effort.THREADS)
# a shell's background job ignores it
signal.signal(signal.SIGINT, signal.default_int_handler)
def interrupt():
    began.append(effort.spent())
    signal.raise_signal(signal.SIGINT)
threading.Timer(0.5, interrupt).start()
try:
    while True:  # a fast machine may be done before it is stopped
        authalic.{call}(mesh, target=1.1)
except KeyboardInterrupt:
    print(effort.spent() - began[0])
"""


@pytest.mark.parametrize("call", ["seams", "unwrap"])
def test_ctrl_c_ends_the_call_soon(run_python, call):
    assert float(run_python(INTERRUPTED.format(call=call))) < 0.5


# Results and refusals


def test_the_result_is_printed_in_one_line():
    text = repr(bumpy_seams())
    assert text.startswith("Seams(") and "edges" in text and "1 islands, length" in text
    assert "converged" in text and "\n" not in text


BROKEN = [
    ({"target": 1.0}, ValueError, "invalid_option", "target must be a finite number > 1"),
    ({"target": float("nan")}, ValueError, "invalid_option", "target must be"),
    ({"target": float("inf")}, ValueError, "invalid_option", "target must be"),
    ({"max_islands": 0}, ValueError, "invalid_option", "max_islands must be ≥ 1, but is 0"),
    ({"front": [0, 0, 0]}, ValueError, "invalid_option", "front must be"),
    ({"front": [1, 0]}, authalic.MeshError, "invalid_array", "front must be of shape"),
    ({"method": "guess"}, ValueError, "invalid_option", 'method must be "search" or "cones"'),
    ({"symmetry": "x"}, ValueError, "invalid_option", 'symmetry must be "auto" or "off"'),
    ({"weights": np.ones(7)}, authalic.MeshError, "invalid_array", "weights must be of shape"),
    ({"weights": np.zeros(258)}, authalic.MeshError, "invalid_array", "weights must be positive"),
    ({"weights": np.full(258, np.nan)}, authalic.MeshError, "invalid_array", "weights"),
    ({"fixed": [[0, 1, 2]]}, authalic.MeshError, "invalid_array", "fixed"),
    ({"fixed": [[5, 5]]}, authalic.MeshError, "seam_not_edge", "not an edge"),
    ({"fixed": [[0, 10**6]]}, authalic.MeshError, "index_out_of_range", "1000000"),
    ({"diagonals": [[0, -1]]}, authalic.MeshError, "index_out_of_range", "diagonals"),
]


@pytest.mark.parametrize(("options", "error", "kind", "words"), BROKEN)
@pytest.mark.parametrize("call", [authalic.seams, authalic.unwrap], ids=["seams", "unwrap"])
def test_what_is_out_of_range_is_refused(call, options, error, kind, words):
    if call is authalic.unwrap and "method" in options:
        pytest.skip("unwrap has no methods")
    with pytest.raises(error, match=words) as caught:
        call(BUMPY, **options)
    assert caught.value.kind == kind


@pytest.mark.parametrize("options", [{"target": "low"}, {"max_islands": 1.5}, {"method": 3}, {"progress": 5}])
def test_an_option_of_the_wrong_type_is_a_type_error(options):
    with pytest.raises(TypeError):
        authalic.seams(BUMPY, **options)


def test_a_surface_that_cannot_be_oriented_is_refused():
    with pytest.raises(authalic.MeshError) as caught:
        authalic.seams(meshes.moebius())
    assert caught.value.kind == "not_orientable"
    across = authalic.seams(meshes.moebius(20), fixed=[[5, 25], [25, 45]])
    assert across.islands == 1


# Real meshes


@real_meshes.each("seams")
def test_real_surfaces_become_disks(path):
    mesh = real_meshes.load(path)
    if len(mesh.vertices) > 20_000:
        pytest.skip("takes long")
    assert_sound(mesh, authalic.seams(mesh))


@pytest.mark.parametrize("name", ["hand_1", "holes3", "horsequad", "max_planck", "suzanne", "torus"])
def test_mirrored_and_noisy_real_surfaces_have_the_same_seams(name):
    mesh = real_meshes.load(real_meshes.file(f"seams/{name}.npz"))
    expected = authalic.seams(mesh).edges
    mirrored = meshes.Mesh(mesh.vertices * [-1, 1, 1], mesh.faces[:, [0, 2, 1]])
    np.testing.assert_array_equal(authalic.seams(mirrored).edges, expected)
    noise = np.random.default_rng(3).uniform(-1e-12, 1e-12, mesh.vertices.shape)
    noisy = meshes.Mesh(mesh.vertices * (1 + noise), mesh.faces)
    np.testing.assert_array_equal(authalic.seams(noisy).edges, expected)
