# SPDX-License-Identifier: MIT OR Apache-2.0
"""Arrays of any dtype and memory layout are accepted; objects that are no arrays of numbers are refused."""

from types import SimpleNamespace

import numpy as np
import pytest

import authalic

from . import meshes

# halves and whole numbers, so that every float type holds them exactly
VERTICES = np.hstack([meshes.grid(7, 9).vertices[:, :2] * 48, np.arange(63)[:, None] % 4 / 2])
FACES = meshes.grid(7, 9).faces

# the same for a closed surface
BALL = np.round(meshes.bumpy_ball(2).vertices * 48) / 2
BALL_FACES = meshes.ball(2).faces


def strided(array):
    """The values as every second entry of every third row, reversed in memory."""
    wide = np.full((3 * len(array), 2 * array.shape[1]), 99, array.dtype)[::-1]
    wide[::3, ::2] = array
    return wide[::3, ::2]


def read_only(array):
    array = array.copy()
    array.flags.writeable = False
    return array


def unaligned(array):
    buffer = np.zeros(array.nbytes + 1, np.uint8)[1:]
    view = buffer.view(array.dtype).reshape(array.shape)
    view[:] = array
    assert not view.flags.aligned
    return view


LAYOUTS = {
    "fortran": np.asfortranarray,
    "strided": strided,
    "read_only": read_only,
    "unaligned": unaligned,
    "byte_swapped": lambda array: array.astype(array.dtype.newbyteorder()),
    "nested_lists": lambda array: array.tolist(),
    "tuples": lambda array: tuple(map(tuple, array.tolist())),
    "list_of_rows": list,
    "matrix_subclass": lambda array: array.view(np.recarray),
}


@pytest.fixture(scope="module")
def expected():
    return authalic.disk_map(VERTICES, FACES).uv


@pytest.fixture(scope="module")
def expected_sphere():
    return authalic.sphere_map(BALL, BALL_FACES).positions


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", "longdouble"])
def test_closed_surfaces_of_any_real_dtype(dtype, expected_sphere):
    vertices = BALL.astype(dtype)
    assert np.array_equal(vertices, BALL)
    assert np.array_equal(authalic.sphere_map(vertices, BALL_FACES).positions, expected_sphere)


@pytest.mark.parametrize("layout", LAYOUTS.values(), ids=LAYOUTS)
def test_arrays_of_a_sphere_map_of_any_layout(layout, expected_sphere):
    assert np.array_equal(authalic.sphere_map(layout(BALL), layout(BALL_FACES)).positions, expected_sphere)
    density = np.asarray(layout(np.arange(1.0, len(BALL_FACES) + 1)[:, None]))[:, 0]
    options = {"density": density.copy(), "initial": expected_sphere, "max_iterations": 3}
    plain = authalic.sphere_map(BALL, BALL_FACES, **options).positions
    given = {**options, "density": density, "initial": layout(expected_sphere)}
    assert np.array_equal(authalic.sphere_map(BALL, BALL_FACES, **given).positions, plain)
    matrices = [authalic.stretch_hessian(BALL, BALL_FACES, image) for image in (BALL, layout(BALL))]
    assert all(np.array_equal(*pair) for pair in zip(*matrices, strict=True))


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", "longdouble", "i2", "i4", "i8"])
def test_vertices_of_any_real_dtype(dtype, expected):
    vertices = VERTICES.astype(dtype)
    if np.dtype(dtype).kind == "f":
        assert np.array_equal(vertices, VERTICES)
        assert np.array_equal(authalic.disk_map(vertices, FACES).uv, expected)
    else:
        like = authalic.disk_map(vertices.astype(float), FACES).uv
        assert np.array_equal(authalic.disk_map(vertices, FACES).uv, like)


@pytest.mark.parametrize("dtype", ["u1", "u2", "u4", "u8", "i1", "i2", "i4", "i8", "f4", "f8"])
def test_faces_of_any_integer_dtype_and_whole_reals(dtype, expected):
    assert np.array_equal(authalic.disk_map(VERTICES, FACES.astype(dtype)).uv, expected)


@pytest.mark.parametrize("layout", LAYOUTS.values(), ids=LAYOUTS)
def test_any_memory_layout(layout, expected):
    assert np.array_equal(authalic.disk_map(layout(VERTICES), layout(FACES)).uv, expected)


def test_a_memory_map(tmp_path, expected):
    np.save(tmp_path / "vertices.npy", VERTICES)
    mapped = np.load(tmp_path / "vertices.npy", mmap_mode="r")
    assert isinstance(mapped, np.memmap)
    assert np.array_equal(authalic.disk_map(mapped, FACES).uv, expected)


def test_an_object_with_the_array_protocol(expected):
    class Tensor:
        def __array__(self, dtype=None, copy=None):
            return VERTICES

    assert np.array_equal(authalic.disk_map(Tensor(), FACES).uv, expected)


@pytest.mark.parametrize("layout", LAYOUTS.values(), ids=LAYOUTS)
def test_images_and_densities_of_any_layout(layout, expected):
    density = np.arange(1.0, len(FACES) + 1)
    plain = authalic.distortion(VERTICES, FACES, expected, density=density)
    image, weights = layout(expected), layout(density[:, None])
    weights = np.asarray(weights)[:, 0]
    given = authalic.distortion(VERTICES, FACES, image, density=weights)
    assert given.authalic_energy == plain.authalic_energy


@pytest.mark.parametrize("layout", LAYOUTS.values(), ids=LAYOUTS)
def test_seams_and_start_maps_of_any_layout(layout, expected):
    seams = np.array([[2, 11], [11, 20]])
    assert len(authalic.cut(VERTICES, FACES, seams=layout(seams))[0].vertices) == len(VERTICES) + 2
    plain = authalic.disk_map(VERTICES, FACES, initial=expected, max_iterations=3).uv
    assert np.array_equal(
        authalic.disk_map(VERTICES, FACES, initial=layout(expected), max_iterations=3).uv, plain
    )


def test_memoryviews_are_arrays():
    start = BALL / np.linalg.norm(BALL, axis=1)[:, None]
    maps = [authalic.sphere_map(BALL, BALL_FACES, initial=given) for given in (start, memoryview(start))]
    assert (maps[0].positions == maps[1].positions).all()
    assert maps[0].provenance["options"] == maps[1].provenance["options"]
    with pytest.raises(authalic.MeshError, match="density must be of shape"):
        authalic.disk_map(VERTICES, FACES, density=memoryview(np.ones((len(FACES), 2))))


def test_lists_in_lists_without_end_are_refused():
    nested = []
    for _ in range(100_000):
        nested = [nested]
    with pytest.raises(authalic.MeshError, match="density must be") as caught:
        authalic.disk_map(VERTICES, FACES, density=nested)
    assert caught.value.kind == "invalid_array"


def test_inputs_are_left_unchanged():
    arrays = {
        "vertices": VERTICES.copy(),
        "faces": FACES.copy(),
        "density": np.ones(len(FACES)),
        "initial": authalic.disk_map(VERTICES, FACES).uv,
    }
    arrays["faces"][5] = arrays["faces"][5][::-1]  # turned, which the library repairs in its own copy
    before = {name: array.copy() for name, array in arrays.items()}
    result = authalic.disk_map(**arrays)
    authalic.distortion(arrays["vertices"], arrays["faces"], arrays["initial"], density=arrays["density"])
    authalic.cut(arrays["vertices"], arrays["faces"])
    assert all(np.array_equal(arrays[name], before[name]) for name in arrays)
    assert np.array_equal(np.sort(result.faces, axis=1), np.sort(FACES, axis=1))


def test_inputs_of_sphere_maps_are_left_unchanged(expected_sphere):
    arrays = {
        "vertices": BALL.copy(),
        "faces": BALL_FACES.copy(),
        "density": np.ones(len(BALL_FACES)),
        "initial": 3 * expected_sphere,  # rows are normalized, in a copy
    }
    arrays["faces"][5] = arrays["faces"][5][[0, 2, 1]]
    before = {name: array.copy() for name, array in arrays.items()}
    result = authalic.sphere_map(**arrays, max_iterations=0)
    authalic.stretch_hessian(arrays["vertices"], arrays["faces"], arrays["initial"])
    assert all(np.array_equal(arrays[name], before[name]) for name in arrays)
    assert np.array_equal(result.faces, BALL_FACES)
    assert not np.shares_memory(result.positions, arrays["initial"])


def test_results_do_not_share_memory_with_the_input():
    (patch,) = authalic.cut(VERTICES, FACES)
    assert np.array_equal(patch.vertices, VERTICES)
    assert not np.shares_memory(patch.vertices, VERTICES)
    assert not np.shares_memory(patch.faces, FACES)


BAD_VERTICES = {
    "flat": VERTICES.ravel(),
    "two_columns": VERTICES[:, :2],
    "four_columns": np.hstack([VERTICES, VERTICES[:, :1]]),
    "three_dimensions": VERTICES[None],
    "scalar": 3.0,
    "none": None,
    "complex": VERTICES.astype(complex),
    "objects": VERTICES.astype(object),
    "strings": VERTICES.astype(str),
    "text": "vertices",
    "dates": np.zeros((63, 3), "M8[s]"),
    "structured": np.zeros((63, 3), [("x", float)]),
    "ragged": [[0, 0, 0], [1, 0], [0, 1, 0]],
    "dictionary": {"x": 1},
}


@pytest.mark.parametrize("vertices", BAD_VERTICES.values(), ids=BAD_VERTICES)
def test_vertices_that_are_no_n_by_3_reals_are_refused(vertices):
    for call in (authalic.disk_map, authalic.sphere_map, authalic.cut):
        with pytest.raises(authalic.MeshError, match=r"^vertices must be ") as caught:
            call(vertices, FACES)
        assert (caught.value.indices, caught.value.count) == ((), 0)


BAD_FACES = {
    "flat": FACES.ravel(),
    "quads": np.zeros((4, 4), int),
    "three_dimensions": FACES[None],
    "scalar": 3,
    "none": None,
    "complex": FACES.astype(complex),
    "objects": FACES.astype(object),
    "strings": FACES.astype(str),
    "fractions": FACES + 0.5,
    "nan": np.where(FACES == 0, np.nan, FACES),
    "infinite": np.where(FACES == 0, np.inf, FACES),
    "ragged": [[0, 1, 2], [1, 2]],
}


@pytest.mark.parametrize("faces", BAD_FACES.values(), ids=BAD_FACES)
def test_faces_that_are_no_m_by_3_integers_are_refused(faces):
    for call in (authalic.disk_map, authalic.sphere_map, authalic.cut):
        with pytest.raises(authalic.MeshError, match=r"^faces must be "):
            call(VERTICES, faces)


@pytest.mark.parametrize(
    ("image", "words"),
    [
        (VERTICES[:5, :2], "of 5 rows"),
        (np.zeros((63, 4)), "image must be of shape"),
        (np.zeros(63), "image must be of shape"),
        (VERTICES[:, :2].astype(complex), "image must be real numbers, but is of dtype complex128"),
        (np.zeros((63, 2)), "image must be a map whose faces have area"),
    ],
)
def test_bad_images_are_refused(image, words):
    with pytest.raises(authalic.MeshError, match=words):
        authalic.distortion(VERTICES, FACES, image)


BAD_SPHERE_STARTS = {
    "short": (BALL[:-1], "initial must be of shape"),
    "planar": (BALL[:, :2], "initial must be of shape"),
    "flat": (BALL.ravel(), "initial must be of shape"),
    "complex": (BALL.astype(complex), "initial must be real numbers"),
    "text": ("start", "initial must be"),
}


@pytest.mark.parametrize(("initial", "words"), BAD_SPHERE_STARTS.values(), ids=BAD_SPHERE_STARTS)
def test_start_maps_of_the_sphere_that_are_no_n_by_3_reals_are_refused(initial, words):
    with pytest.raises(authalic.MeshError, match=words):
        authalic.sphere_map(BALL, BALL_FACES, initial=initial)


@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_densities_that_are_not_positive_are_refused_by_face(value):
    density = np.ones(len(FACES))
    density[[4, 17]] = value
    for call in (
        lambda: authalic.disk_map(VERTICES, FACES, density=density),
        lambda: authalic.distortion(VERTICES, FACES, VERTICES[:, :2], density=density),
    ):
        with pytest.raises(authalic.MeshError, match="density must be positive, finite") as caught:
            call()
        assert (caught.value.indices, caught.value.count) == ((4, 17), 2)


@pytest.mark.parametrize("density", [np.ones(5), np.ones((128, 1)), 1.0, np.ones(128, complex)])
def test_densities_of_a_sphere_of_the_wrong_shape_or_dtype_are_refused(density):
    with pytest.raises(authalic.MeshError, match="density must be"):
        authalic.sphere_map(BALL, BALL_FACES, density=density)


@pytest.mark.parametrize("density", [np.ones(5), np.ones((96, 1)), 1.0, np.ones(96, complex), ["a"] * 96])
def test_densities_of_the_wrong_shape_or_dtype_are_refused(density):
    with pytest.raises(authalic.MeshError, match="density must be"):
        authalic.disk_map(VERTICES, FACES, density=density)


@pytest.mark.parametrize("seams", [[0, 1], [[0, 1, 2]], [["a", "b"]], [[0.5, 1]], 3])
def test_seams_that_are_no_k_by_2_integers_are_refused(seams):
    with pytest.raises(authalic.MeshError, match="seams must be"):
        authalic.cut(VERTICES, FACES, seams=seams)


def test_empty_seams_of_any_shape_cut_nothing():
    for seams in ([], np.zeros((0, 2)), np.zeros((0, 2), int)):
        assert len(authalic.cut(VERTICES, FACES, seams=seams)) == 1


def test_arrays_as_freesurfer_files_have_them(expected_sphere):
    vertices, faces = BALL.astype(">f4"), BALL_FACES.astype(">i4")
    assert np.array_equal(authalic.sphere_map(vertices, faces).positions, expected_sphere)


def test_masked_values_are_refused_and_not_unmasked(expected):
    masked = np.ma.masked_equal(VERTICES, VERTICES[5, 0])
    faces = np.ma.masked_equal(FACES, 7)
    density = np.ma.masked_less(np.arange(1.0, len(FACES) + 1), 3)
    for call, name in (
        (lambda: authalic.disk_map(masked, FACES), "vertices"),
        (lambda: authalic.disk_map(VERTICES, faces), "faces"),
        (lambda: authalic.disk_map(VERTICES, FACES, density=density), "density"),
        (lambda: authalic.repair(masked, FACES), "vertices"),
    ):
        with pytest.raises(authalic.MeshError, match=f"^{name} must be without masked values") as caught:
            call()
        assert caught.value.kind == "invalid_array"
    nothing = np.ma.masked_array(VERTICES, mask=False)
    assert np.array_equal(authalic.disk_map(nothing, FACES).uv, expected)


def test_points_of_the_plane_are_taken_where_that_is_asked_for():
    flat = meshes.grid(7, 9)
    hint = r"shape \(63, 2\); .* Surface\(vertices, faces, flat=True\)"
    with pytest.raises(authalic.MeshError, match=hint):
        authalic.disk_map(flat.vertices[:, :2], flat.faces)
    surface = authalic.Surface(flat.vertices[:, :2], flat.faces, flat=True)
    assert np.array_equal(surface.vertices, flat.vertices)
    assert np.array_equal(authalic.disk_map(surface).uv, authalic.disk_map(*flat).uv)
    words = r"vertices must be of shape \(n, 2\), but is of shape \(63, 3\)"
    with pytest.raises(authalic.MeshError, match=words):
        authalic.Surface(*flat, flat=True)


def vtk(faces):
    """Triangles as VTK has them: the number of corners before the corners."""
    return np.hstack([np.full((len(faces), 1), 3), faces])


@pytest.mark.parametrize("given", [vtk(FACES), vtk(FACES).ravel()], ids=["rows", "flat"])
def test_faces_in_the_layout_of_vtk_are_refused_with_a_hint(given, expected):
    with pytest.raises(authalic.MeshError, match="faces must be") as caught:
        authalic.disk_map(VERTICES, given)
    hint = "take np.reshape(faces, (-1, 4))[:, 1:]"
    assert hint in str(caught.value)
    assert np.array_equal(authalic.disk_map(VERTICES, np.reshape(given, (-1, 4))[:, 1:]).uv, expected)


def test_quads_are_refused_with_a_hint():
    with pytest.raises(authalic.MeshError, match="quads: split each into two triangles"):
        authalic.disk_map(VERTICES, [[0, 1, 10, 9], [1, 2, 11, 10]])


class Container:
    """As Open3D's vectors: no array, but numpy makes one of it."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array


OBJECTS = {
    "trimesh": SimpleNamespace(vertices=VERTICES, faces=FACES),
    "open3d": SimpleNamespace(vertices=Container(VERTICES), triangles=Container(FACES.astype("i4"))),
    "pyvista": SimpleNamespace(points=VERTICES, faces=vtk(FACES).ravel()),
    "pyvista_rows": SimpleNamespace(points=VERTICES, faces=vtk(FACES)),
    "vtk_grid": SimpleNamespace(points=VERTICES, cells_dict={5: FACES, 3: [[0, 1]]}),
    "meshio": SimpleNamespace(points=VERTICES, cells_dict={"line": np.array([[0, 1]]), "triangle": FACES}),
}


@pytest.mark.parametrize("mesh", OBJECTS.values(), ids=OBJECTS)
def test_meshes_of_other_libraries_are_taken_by_their_attributes(mesh, expected):
    assert np.array_equal(authalic.disk_map(mesh).uv, expected)
    assert np.array_equal(authalic.Surface(mesh).faces, FACES)
    assert not authalic.repair(mesh).is_changed
    figures = authalic.distortion(mesh, expected)
    assert figures.authalic_energy == authalic.distortion(VERTICES, FACES, expected).authalic_energy
    [pairwise] = authalic.disk_maps([mesh])
    assert np.array_equal(pairwise.uv, expected)
    with pytest.raises(TypeError, match="faces go with vertices"):
        authalic.disk_map(mesh, FACES)


@pytest.mark.parametrize(
    "mesh",
    [
        SimpleNamespace(points=VERTICES, cells_dict={"quad": FACES[:, [0, 1, 2, 2]], "triangle": FACES}),
        SimpleNamespace(points=VERTICES, cells_dict={9: FACES[:, [0, 1, 2, 2]]}),
        SimpleNamespace(points=VERTICES, cells_dict={"line": [[0, 1]]}),
        SimpleNamespace(points=VERTICES, faces=[4, 0, 1, 10, 9]),
        SimpleNamespace(points=VERTICES, faces=[4, 0, 1, 10, 9, 3, 1, 2]),
    ],
    ids=["mixed", "quads", "lines", "vtk_quads", "vtk_mixed"],
)
def test_meshes_of_other_polygons_are_refused(mesh):
    with pytest.raises(authalic.MeshError, match=r"^the mesh must be of triangles"):
        authalic.disk_map(mesh)


def test_objects_that_are_no_meshes_are_told_that_faces_are_missing():
    for given in (VERTICES, SimpleNamespace(vertices=VERTICES), SimpleNamespace(points=VERTICES)):
        with pytest.raises(authalic.MeshError, match="faces must be integers of shape"):
            authalic.disk_map(given)
