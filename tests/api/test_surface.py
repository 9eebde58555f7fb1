# SPDX-License-Identifier: MIT OR Apache-2.0
"""Surfaces give the results of their arrays, are checked once, and never change."""

import threading

import numpy as np
import pytest

import authalic

from . import meshes

BALL = meshes.bumpy_ball(2)
CAP = meshes.bumpy_cap(rings=6, around=14)
SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
HALVES = [[0, 1, 2], [0, 2, 3]]
FIN = [[0, 1, 2], [0, 1, 3], [0, 1, 4]]
FIN_POINTS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, -1]]


def band(stacks=12, slices=24):
    """A ball without its poles."""
    height, angle = np.linspace(-0.9, 0.9, stacks + 1), np.linspace(0, 2 * np.pi, slices, endpoint=False)
    z, angle = (grid.ravel() for grid in np.meshgrid(height, angle, indexing="ij"))
    radius = np.sqrt(1 - z * z)
    below = np.arange(stacks * slices)
    beside = below - below % slices + (below + 1) % slices
    lower = np.stack([below, beside, beside + slices], 1)
    upper = np.stack([below, beside + slices, below + slices], 1)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], 1), np.vstack([lower, upper])


def same(first, second):
    """Whether two results of any kind hold the same bits, except for times."""
    if isinstance(first, np.ndarray):
        return first.dtype == second.dtype and first.tobytes() == second.tobytes()
    if isinstance(first, (list, tuple)):
        return len(first) == len(second) and all(map(same, first, second))
    if isinstance(first, (int, float, str, bool, type(None))):
        return first == second or first != first
    names = [name for name in dir(first) if not name.startswith("_")]
    values = [(getattr(first, name), getattr(second, name)) for name in names if name not in TIMES]
    return all(same(*pair) for pair in values if not callable(pair[0]))


TIMES = {"seconds", "history"}
SQUASHED = BALL.vertices * [1, 1, 0.5] / np.linalg.norm(BALL.vertices * [1, 1, 0.5], axis=1)[:, None]
CURVES = {"curves": [[76, 100, 124, 148], [88, 112, 136, 160, 184]]}
LANDMARKS = {"source_landmarks": [0, 5], "target_landmarks": [0, 7]}
ON_BOTH = {"source_curves": CURVES["curves"], "target_curves": CURVES["curves"]}

# For every function: the mesh, the further arguments, and the options.
CALLS = {
    "cut": (authalic.cut, CAP, (), {}),
    "cut_seams": (authalic.cut, CAP, (), {"seams": CAP.faces[:3, :2]}),
    "disk_map": (authalic.disk_map, CAP, (), {"boundary": "free"}),
    "sphere_map": (authalic.sphere_map, BALL, (), {"refine": True}),
    "distortion": (authalic.distortion, CAP, (CAP.vertices[:, :2],), {}),
    "distortion_density": (
        authalic.distortion,
        BALL,
        (SQUASHED,),
        {"density": np.arange(1, len(BALL.faces) + 1)},
    ),
    "stretch_hessian": (authalic.stretch_hessian, BALL, (SQUASHED,), {}),
    "hyperbolic_structure": (authalic.hyperbolic_structure, band(), (), CURVES),
}
PAIRED = {
    "untangle": lambda surface: authalic.untangle(surface, CAP.vertices[:, :2] + tangle()),
    "register_disks": lambda surface: authalic.register_disks(surface, surface, **LANDMARKS),
}


def tangle():
    moved = np.zeros((len(CAP.vertices), 2))
    moved[0] = 0.5
    return moved


@pytest.mark.parametrize("name", CALLS)
def test_a_surface_gives_the_same_bits_as_its_arrays(name):
    call, mesh, rest, options = CALLS[name]
    surface = authalic.Surface(*mesh)
    expected = call(*mesh, *rest, **options)
    for _ in range(2):
        assert same(call(surface, *rest, **options), expected)


@pytest.mark.parametrize("name", PAIRED)
def test_a_surface_gives_the_same_bits_as_a_pair(name):
    surface = authalic.Surface(*CAP)
    expected = PAIRED[name](tuple(CAP))
    assert same(PAIRED[name](surface), expected)


def test_registrations_take_surfaces_and_pairs_side_by_side():
    ball, turned = authalic.Surface(*BALL), (BALL.vertices[:, [1, 2, 0]], BALL.faces)
    landmarks = {"source_landmarks": [0, 5], "target_landmarks": [0, 5]}
    expected = authalic.register_spheres(tuple(BALL), turned, **landmarks)
    assert same(authalic.register_spheres(ball, turned, **landmarks), expected)
    inverse = authalic.register_spheres(turned, ball, **landmarks)
    assert same(inverse, authalic.register_spheres(turned, tuple(BALL), **landmarks))
    assert same(authalic.homotopy(ball, expected, 0.5), authalic.homotopy(BALL.vertices, expected, 0.5))


def test_curves_are_registered_between_surfaces():
    pair = tuple(band())
    surface = authalic.Surface(*pair)
    expected = authalic.register_hyperbolic(pair, pair, **ON_BOTH)
    assert same(authalic.register_hyperbolic(surface, surface, **ON_BOTH), expected)


def test_an_image_goes_by_its_name_too():
    surface, uv = authalic.Surface(*CAP), CAP.vertices[:, :2]
    expected = authalic.distortion(*CAP, uv)
    assert same(authalic.distortion(surface, image=uv), expected)
    assert same(authalic.distortion(vertices=CAP.vertices, faces=CAP.faces, image=uv), expected)


@pytest.mark.parametrize(
    "call",
    [
        lambda surface: authalic.disk_map(surface, CAP.faces),
        lambda surface: authalic.distortion(surface, CAP.faces, CAP.vertices[:, :2]),
        lambda surface: authalic.Surface(surface, CAP.faces),
    ],
)
def test_a_surface_beside_faces_is_refused(call):
    with pytest.raises((TypeError, authalic.MeshError)):
        call(authalic.Surface(*CAP))


def test_missing_faces_and_images_are_named():
    with pytest.raises(authalic.MeshError, match=r"^faces must be .*, but is missing"):
        authalic.disk_map(CAP.vertices)
    for arguments in (tuple(CAP), (authalic.Surface(*CAP),)):
        with pytest.raises(authalic.MeshError, match=r"^image must be .*, but is missing"):
            authalic.distortion(*arguments)


BAD_ARRAYS = {
    "empty": ([], []),
    "no_faces": (SQUARE, []),
    "nan": ([[0, 0, 0], [1, 0, 0], [np.nan, 1, 0], [0, 1, 0]], HALVES),
    "out_of_range": (SQUARE, [[0, 1, 9]]),
    "repeated": (SQUARE, [[0, 1, 1]]),
    "flat": (np.zeros((4, 2)), HALVES),
    "real_faces": (SQUARE, [[0, 1, 1.5]]),
}


@pytest.mark.parametrize("arrays", BAD_ARRAYS.values(), ids=BAD_ARRAYS)
def test_bad_arrays_raise_what_the_functions_raise(arrays):
    with pytest.raises(authalic.MeshError) as expected:
        authalic.cut(*arrays)
    with pytest.raises(authalic.MeshError) as caught:
        authalic.Surface(*arrays)
    assert_same_error(caught.value, expected.value)


NO_MESHES = {
    "fin": (FIN_POINTS, FIN),
    "duplicate": (SQUARE, [*HALVES, [1, 2, 0]]),
    "line": ([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]),
    "loose": ([*SQUARE, [5, 5, 5]], HALVES),
    "moebius": meshes.moebius(),
    "two": (np.vstack([SQUARE, np.add(SQUARE, 3)]), np.vstack([HALVES, np.add(HALVES, 4)])),
    "closed": BALL,
}


@pytest.mark.parametrize("mesh", NO_MESHES.values(), ids=NO_MESHES)
def test_a_surface_that_a_map_refuses_raises_what_its_arrays_raise_each_time(mesh):
    surface = authalic.Surface(*mesh)
    with pytest.raises(authalic.MeshError) as expected:
        authalic.disk_map(*mesh)
    for _ in range(2):
        with pytest.raises(authalic.MeshError) as caught:
            authalic.disk_map(surface)
        assert_same_error(caught.value, expected.value)


def test_errors_of_a_registration_name_the_surface_at_fault():
    good, bad = authalic.Surface(*CAP), authalic.Surface(FIN_POINTS, FIN)
    for pair in ((good, bad), (bad, good)):
        arrays = [(CAP if is_good is good else (FIN_POINTS, FIN)) for is_good in pair]
        with pytest.raises(authalic.MeshError) as expected:
            authalic.register_disks(*map(tuple, arrays), **LANDMARKS)
        with pytest.raises(authalic.MeshError) as caught:
            authalic.register_disks(*pair, **LANDMARKS)
        assert_same_error(caught.value, expected.value)


def assert_same_error(caught, expected):
    attributes = [name for name in dir(expected) if not name.startswith("_")]
    assert str(caught) == str(expected)
    for name in set(attributes) - {"add_note", "with_traceback", "args"}:
        assert getattr(caught, name) == getattr(expected, name), name


def test_figures_and_cuts_need_no_manifold():
    surface = authalic.Surface(FIN_POINTS, FIN)
    image = np.array(FIN_POINTS, float)[:, :2] + [[0, 0], [0, 0], [0, 0], [0, 1], [0, 3]]
    assert same(authalic.distortion(surface, image), authalic.distortion(FIN_POINTS, FIN, image))
    assert len(surface.cut()) == 3
    with pytest.raises(authalic.MeshError, match="edge"):
        _ = surface.genus


def test_the_arrays_are_those_given_and_read_only():
    vertices, faces = np.array(SQUARE, np.float32), np.array([[0, 1, 2], [2, 0, 3]], np.int32)[::-1]
    surface = authalic.Surface(vertices, faces)
    assert surface.vertices.dtype == np.float64
    assert surface.faces.dtype == np.int64
    assert (surface.vertices == vertices).all()
    assert (surface.faces == faces).all()
    for array in (surface.vertices, surface.faces):
        assert array.flags.c_contiguous
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_the_arrays_are_made_once():
    surface = authalic.Surface(*CAP)
    assert surface.vertices is surface.vertices
    assert surface.faces is surface.faces
    (patch,) = surface.cut()
    assert patch.surface is patch.surface


def test_a_surface_does_not_change_with_the_arrays_it_was_made_of():
    vertices, faces = CAP.vertices.copy(), CAP.faces.copy()
    surface = authalic.Surface(vertices, faces)
    vertices[:], faces[:] = np.nan, 0
    assert same(authalic.disk_map(surface), authalic.disk_map(*CAP))


def test_a_surface_knows_its_topology():
    surface = authalic.Surface(*meshes.annulus())
    assert (surface.n_vertices, surface.n_faces, surface.n_components) == (200, 320, 1)
    assert (surface.euler_characteristic, surface.genus) == (0, 0)
    assert (surface.is_disk, surface.is_closed) == (False, False)
    (patch,) = surface.cut()
    assert same(surface.boundary_loops, patch.boundary_loops)
    torus = authalic.Surface(*meshes.torus())
    assert (torus.genus, torus.is_closed, torus.boundary_loops) == (1, True, [])


def test_surfaces_are_printed_in_one_line_with_figures():
    assert repr(authalic.Surface(*meshes.annulus())) == "Surface(200 vertices, 320 faces)"


def test_a_patch_and_its_surface_are_as_good_as_its_arrays():
    patches = authalic.Surface(*CAP).cut(seams=CAP.faces[:, :2])
    patch = max(patches, key=lambda patch: len(patch.faces))
    assert same(patch.surface.vertices, patch.vertices)
    assert same(patch.surface.faces, patch.faces)
    uv = patch.vertices[:, :2]
    expected = authalic.distortion(patch.vertices, patch.faces, uv)
    for surface in (patch, patch.surface):
        assert same(authalic.distortion(surface, uv), expected)


def test_maps_of_patches_are_those_of_their_arrays():
    halves = (
        np.vstack([CAP.vertices, CAP.vertices + 5]),
        np.vstack([CAP.faces, CAP.faces + len(CAP.vertices)]),
    )
    for patch in authalic.Surface(*halves).cut():
        assert same(authalic.disk_map(patch), authalic.disk_map(patch.vertices, patch.faces))


def test_a_patch_with_flat_faces_knows_its_topology_and_is_refused_by_maps():
    line = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]]
    (patch,) = authalic.Surface(line, [[0, 1, 2], [0, 2, 3]]).cut()
    assert (patch.is_disk, patch.euler_characteristic) == (True, 1)
    with pytest.raises(authalic.MeshError, match="area"):
        authalic.disk_map(patch)


def test_images_in_single_precision_are_certified_as_they_are():
    surface = authalic.Surface(*CAP)
    uv = np.asarray(authalic.disk_map(surface).uv).astype(np.float32)
    assert same(authalic.distortion(surface, uv), authalic.distortion(*CAP, uv.astype(float)))
    # beside 1 a step of 1e-9 is lost in single precision, and the triangle with it
    triangle = authalic.Surface([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0]], [[0, 1, 2], [1, 0, 3]])
    image = np.array([[0, 1], [1, 1], [0, 1 + 1e-9], [0, 0]])
    assert len(authalic.distortion(triangle, image).folded) == 0
    assert authalic.distortion(triangle, image.astype(np.float32)).folded.tolist() == [0]


def test_threads_share_a_surface():
    surface, results = authalic.Surface(*CAP), {}

    def work(number):
        results[number] = authalic.disk_map(surface).uv

    threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    expected = authalic.disk_map(*CAP).uv
    assert len(results) == 4
    assert all(same(uv, expected) for uv in results.values())


def test_a_surface_cannot_be_changed():
    surface = authalic.Surface(*CAP)
    for name in ("vertices", "faces", "genus", "anything"):
        with pytest.raises(AttributeError):
            setattr(surface, name, None)
