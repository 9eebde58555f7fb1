# SPDX-License-Identifier: MIT OR Apache-2.0
"""Names, signatures, results and documentation of the package."""

import inspect
import tomllib
from pathlib import Path

import numpy as np
import pytest

import authalic

from . import meshes

NAMES = {
    "ERROR_KINDS",
    "WARNING_KINDS",
    "Certificates",
    "DiskMap",
    "Distortion",
    "HyperbolicStructure",
    "Layout",
    "MeshError",
    "Packing",
    "Pants",
    "Patch",
    "Refinement",
    "Registration",
    "RegistrationWarning",
    "Repaired",
    "Result",
    "Seams",
    "SolverError",
    "SphereMap",
    "Strain",
    "Surface",
    "Untangled",
    "Unwrap",
    "__version__",
    "cut",
    "disk_map",
    "disk_maps",
    "distortion",
    "distortions",
    "homotopy",
    "hyperbolic_structure",
    "load",
    "pack",
    "register_disks",
    "register_hyperbolic",
    "register_spheres",
    "repair",
    "seams",
    "set_threads",
    "sphere_map",
    "stretch_hessian",
    "untangle",
    "unwrap",
}
REGISTRATION = {
    "source_landmarks": inspect.Parameter.empty,
    "target_landmarks": inspect.Parameter.empty,
    "energy": "surface",
    "weight": 1.0,
    "area_weight": 1.0,
    "angle_weight": None,
    "weights": None,
    "features": None,
    "feature_weight": None,
    "position_weight": 0.0,
    "fill_holes": False,
    "repair": False,
    "progress": None,
    "preview": None,
}
SEAMS = {
    "target": 1.4,
    "fixed": None,
    "weights": None,
    "front": None,
    "symmetry": "auto",
    "max_islands": None,
    "overlap": False,
    "diagonals": None,
}
KEYWORDS = {
    "disk_map": {
        "method": "gauss_newton",
        "boundary": "sliding",
        "density": None,
        "angle_weight": 0.0,
        "area_tolerance": None,
        "initial": None,
        "max_iterations": None,
        "tolerance": None,
        "fill_holes": False,
        "overlap": False,
        "corners": None,
        "aspect": None,
        "repair": False,
        "progress": None,
    },
    "sphere_map": {
        "method": "gauss_newton",
        "line_search": "interpolation",
        "density": None,
        "angle_weight": 0.0,
        "area_tolerance": None,
        "initial": None,
        "max_iterations": None,
        "tolerance": None,
        "refine": False,
        "unfold": True,
        "fill_holes": False,
        "repair": False,
        "progress": None,
    },
    "repair": {
        "merge": 0.0,
        "close_holes": "pinholes",
        "keep_outline": False,
        "close_handles": False,
        "keep": "all",
    },
    "stretch_hessian": {"density": None},
    "untangle": {"fixed": None, "tolerance": 0.01, "progress": None},
    "seams": {**SEAMS, "method": "search", "progress": None},
    "unwrap": {"seams": "auto", **SEAMS, "pack": True, "margin": 0.002, "rotate": True, "progress": None},
    "pack": {"margin": 0.002, "margin_unit": "square", "rotate": True, "aspect": 1.0, "progress": None},
    "distortion": {"density": None},
    "distortions": {"densities": None},
    "disk_maps": {
        "densities": None,
        "method": "gauss_newton",
        "boundary": "sliding",
        "angle_weight": 0.0,
        "area_tolerance": None,
        "max_iterations": None,
        "tolerance": None,
        "fill_holes": False,
        "overlap": False,
        "repair": False,
        "progress": None,
    },
    "cut": {"seams": None},
    "register_disks": REGISTRATION,
    "register_spheres": REGISTRATION | {"source_landmarks": None, "target_landmarks": None},
    "register_hyperbolic": {
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
    },
    "hyperbolic_structure": {"curves": inspect.Parameter.empty, "metric": "newton", "progress": None},
    "homotopy": {"align": False},
    "load": {},
}
POSITIONAL = {
    "disk_map": ["vertices", "faces"],
    "sphere_map": ["vertices", "faces"],
    "stretch_hessian": ["vertices", "faces", "image"],
    "disk_maps": ["surfaces"],
    "distortion": ["vertices", "faces", "image"],
    "distortions": ["surfaces", "images"],
    "untangle": ["surface", "image"],
    "seams": ["surface"],
    "unwrap": ["surface"],
    "pack": ["uv", "faces", "island_of"],
    "cut": ["vertices", "faces"],
    "repair": ["vertices", "faces"],
    "register_disks": ["source", "target"],
    "register_spheres": ["source", "target"],
    "register_hyperbolic": ["source", "target"],
    "hyperbolic_structure": ["vertices", "faces"],
    "homotopy": ["vertices", "registration", "t"],
    "load": ["path"],
}
FUNCTIONS = sorted(KEYWORDS)
DISK_METHODS = '"gauss_newton", "conjugate_gradient" or "fixed_point"'
SPHERE_METHODS = '"gauss_newton", "gradient_descent" or "fixed_point"'


@pytest.fixture(scope="module")
def result():
    return authalic.disk_map(*meshes.bumpy_cap())


@pytest.fixture(scope="module")
def sphere_result():
    return authalic.sphere_map(*meshes.bumpy_ball())


@pytest.fixture(params=["result", "sphere_result"])
def any_result(request):
    return request.getfixturevalue(request.param)


OF_ALL_RESULTS = {"provenance", "save"}


def public_attributes(value):
    """Those of its class alone, not of all results."""
    names = {name for name in dir(value) if not name.startswith("_")}
    assert names >= OF_ALL_RESULTS
    return names - OF_ALL_RESULTS


def test_the_package_tested_is_the_installed_one():
    assert meshes.ROOT / "rust" not in Path(authalic.__file__).resolve().parents


def test_the_package_has_the_names_of_the_contract_and_is_typed():
    assert set(authalic.__all__) == NAMES
    assert all(hasattr(authalic, name) for name in NAMES)
    folder = Path(authalic.__file__).parent
    assert (folder / "py.typed").exists()
    assert (folder / "_native.pyi").exists()


def test_the_version_is_that_of_the_workspace():
    manifest = tomllib.loads((meshes.ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    assert authalic.__version__ == manifest["workspace"]["package"]["version"]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_mesh_comes_first_and_all_else_is_keyword_only(name):
    parameters = inspect.signature(getattr(authalic, name)).parameters.values()
    positional = [p.name for p in parameters if p.kind is p.POSITIONAL_OR_KEYWORD]
    keywords = {p.name: p.default for p in parameters if p.kind is p.KEYWORD_ONLY}
    assert positional == POSITIONAL[name]
    assert keywords == KEYWORDS[name]
    assert len(parameters) == len(positional) + len(keywords)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_keyword_given_by_position_is_refused(name):
    arguments = [*meshes.single_quad(), np.zeros((4, 2))][: len(POSITIONAL[name])]
    with pytest.raises(TypeError, match="positional"):
        getattr(authalic, name)(*arguments, None)


@pytest.mark.parametrize(
    "name",
    [
        *FUNCTIONS,
        "DiskMap",
        "SphereMap",
        "Strain",
        "Distortion",
        "Surface",
        "Patch",
        "Refinement",
        "Registration",
        "Result",
        "Certificates",
        "HyperbolicStructure",
        "Untangled",
        "Seams",
        "Unwrap",
        "set_threads",
    ],
)
def test_everything_is_documented(name):
    assert len(getattr(authalic, name).__doc__) > 20


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_docstrings_have_all_sections_and_name_all_parameters(name):
    text = inspect.getdoc(getattr(authalic, name))
    for section in ("Parameters\n------", "Returns\n------", "Raises\n------", "Examples\n------"):
        assert section in text
    for parameter in [*POSITIONAL[name], *KEYWORDS[name]]:
        assert f"\n{parameter} : " in text


def test_all_results_have_one_base_class():
    for name in NAMES - {"Result", "MeshError", "SolverError", "RegistrationWarning"}:
        if isinstance(getattr(authalic, name), type):
            assert issubclass(getattr(authalic, name), authalic.Result)


def test_every_attribute_of_the_results_is_documented():
    maps = (authalic.DiskMap, authalic.SphereMap, authalic.Registration, authalic.HyperbolicStructure)
    for kind in (
        *maps,
        authalic.Untangled,
        authalic.Seams,
        authalic.Unwrap,
        authalic.Layout,
        authalic.Distortion,
        authalic.Surface,
        authalic.Patch,
        authalic.Certificates,
        authalic.Pants,
    ):
        for name in public_attributes(kind) | OF_ALL_RESULTS:
            assert getattr(kind, name).__doc__, f"{kind.__name__}.{name}"


def test_the_errors_are_of_the_builtin_kinds():
    assert issubclass(authalic.MeshError, ValueError)
    assert issubclass(authalic.SolverError, RuntimeError)
    assert authalic.MeshError.__module__ == authalic.SolverError.__module__ == "authalic"
    assert "MeshError" in repr(authalic.MeshError("text"))


def test_a_map_has_the_attributes_of_the_contract(any_result):
    special = {
        authalic.DiskMap: {"uv", "image"},
        authalic.SphereMap: {
            *("positions", "refinement", "layout", "equirectangular", "equal_area_grid", "resample")
        },
    }[type(any_result)]
    assert public_attributes(any_result) == {
        *(*special, "faces", "status", "iterations", "history", "distortion", "repaired", "seconds"),
        *("locate", "image_of", "sample"),
    }
    assert isinstance(any_result.distortion, authalic.Distortion)
    assert any_result.status in {"converged", "max_iterations", "stalled", "cancelled"}
    assert type(any_result.iterations) is int
    assert type(any_result.seconds) is float
    assert any_result.seconds > 0


def test_a_distortion_has_the_attributes_of_the_contract(result):
    numbers = {"authalic_energy", "area_ratio_mean", "area_ratio_std"}
    angles = {"angle_distortion_mean", "angle_distortion_p99", "angle_distortion_max"}
    arrays = {"log2_area_ratio", "folded", "angle_distortion"}
    assert public_attributes(result.distortion) == numbers | angles | arrays
    assert all(type(getattr(result.distortion, name)) is float for name in numbers | angles)


def test_a_patch_has_the_attributes_of_the_contract():
    (patch,) = authalic.cut(*meshes.bumpy_cap())
    arrays = {"vertices", "faces", "vertex_of", "corner_of", "face_of"}
    topology = {"euler_characteristic", "genus", "boundary_loops", "is_disk", "is_closed"}
    assert public_attributes(patch) == arrays | topology | {"surface"}
    assert type(patch.euler_characteristic) is int
    assert type(patch.boundary_loops) is list
    assert (patch.genus, patch.is_disk, patch.is_closed) == (0, True, False)


def test_seams_and_unwraps_have_the_attributes_of_the_contract():
    seams, result = (call(meshes.octahedron()) for call in (authalic.seams, authalic.unwrap))
    numbers = {"length", "seconds", "shear", "shear_p99", "area_ratio_std", "packed", "predicted"}
    both = {"edges", "islands", "island_of", "length", "status", "seconds"}
    figures = {"shear", "shear_p99", "area_ratio_std", "packed"}
    assert public_attributes(seams) == {*both, "predicted"}
    assert public_attributes(result) == {*both, *figures, "uv", "faces", "vertex_of"}
    for subject in (seams, result):
        assert type(subject.islands) is int
        assert subject.status in {"converged", "stalled"}
        for name in numbers & public_attributes(subject):
            assert type(getattr(subject, name)) is float
        with pytest.raises(AttributeError):
            subject.edges = None


def assert_array(array, shape, dtype):
    assert array.shape == shape
    assert array.dtype == dtype
    assert array.flags.c_contiguous
    assert array.flags.owndata or array.base is not None
    assert not array.flags.writeable


def test_arrays_of_maps_are_c_ordered_float64_and_int64(result):
    vertices, faces = meshes.bumpy_cap()
    assert_array(result.uv, (len(vertices), 2), np.float64)
    assert_array(result.faces, faces.shape, np.int64)
    assert_array(result.distortion.log2_area_ratio, (len(faces),), np.float64)
    assert_array(result.distortion.angle_distortion, (len(faces),), np.float64)
    assert_array(result.distortion.folded, (0,), np.int64)


def test_arrays_of_sphere_maps_are_c_ordered_float64_and_int64(sphere_result):
    vertices, faces = meshes.bumpy_ball()
    assert_array(sphere_result.positions, (len(vertices), 3), np.float64)
    assert_array(sphere_result.faces, faces.shape, np.int64)
    assert_array(sphere_result.distortion.log2_area_ratio, (len(faces),), np.float64)
    assert_array(sphere_result.distortion.angle_distortion, (len(faces),), np.float64)
    assert_array(sphere_result.distortion.folded, (0,), np.int64)


def test_arrays_of_patches_are_c_ordered_float64_and_int64():
    mesh = meshes.bumpy_cap()
    n, m = len(mesh.vertices), len(mesh.faces)
    (patch,) = authalic.cut(*mesh)
    assert_array(patch.vertices, (n, 3), np.float64)
    assert_array(patch.faces, (m, 3), np.int64)
    assert_array(patch.vertex_of, (n,), np.int64)
    assert_array(patch.corner_of, (m, 3), np.int64)
    assert_array(patch.face_of, (m,), np.int64)
    assert_array(patch.boundary_loops[0], (30,), np.int64)


def test_arrays_of_seams_and_unwraps_are_c_ordered_float64_and_int64():
    mesh = meshes.octahedron()
    seams, result = authalic.seams(mesh, target=1.1), authalic.unwrap(mesh, target=1.1)
    k, points = len(seams.edges), len(result.uv)
    for subject in (seams, result):
        assert_array(subject.edges, (k, 2), np.int64)
        assert_array(subject.island_of, (len(mesh.faces),), np.int64)
    assert_array(result.uv, (points, 2), np.float64)
    assert_array(result.faces, mesh.faces.shape, np.int64)
    assert_array(result.vertex_of, (points,), np.int64)


def test_the_history_is_a_structured_array_from_the_start_to_the_result(any_result):
    history = any_result.history
    assert history.dtype.names == ("iteration", "authalic_energy", "step", "gradient_norm", "seconds")
    assert history.dtype["iteration"] == np.int64
    assert all(history.dtype[name] == np.float64 for name in history.dtype.names[1:])
    assert history["iteration"].tolist() == list(range(any_result.iterations + 1))
    assert (np.diff(history["seconds"]) >= 0).all()
    assert 0 <= history["seconds"][0] <= history["seconds"][-1] <= any_result.seconds
    assert history["step"][0] == 0
    assert (history["step"][1:] > 0).all()


def test_the_last_energy_of_the_history_is_that_of_the_result(any_result):
    last = any_result.history["authalic_energy"][-1]
    assert last == pytest.approx(any_result.distortion.authalic_energy, rel=1e-9)


def test_results_cannot_be_changed(any_result):
    image = "uv" if isinstance(any_result, authalic.DiskMap) else "positions"
    for subject, name in ((any_result, image), (any_result, "status"), (any_result.distortion, "folded")):
        with pytest.raises(AttributeError):
            setattr(subject, name, None)


def test_results_are_printed_in_one_line_with_figures(result, sphere_result):
    assert repr(sphere_result).startswith("SphereMap(258 vertices, converged after ")
    assert "Distortion(authalic_energy=" in repr(sphere_result)
    assert "\n" not in repr(sphere_result)
    text = repr(result)
    assert text.startswith("DiskMap(421 vertices, converged after ")
    assert "Distortion(authalic_energy=" in text
    assert "\n" not in text
    (patch,) = authalic.cut(*meshes.annulus())
    assert repr(patch) == "Patch(200 vertices, 320 faces, 2 boundary loops, Euler characteristic 0)"


@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        ("method", "newton", f'method must be {DISK_METHODS}, but is "newton"'),
        (
            "boundary",
            "none",
            'boundary must be "sliding", "arc_length", "free" or "rectangle", but is "none"',
        ),
        ("max_iterations", -1, "max_iterations must be ≥ 0, but is -1"),
        ("tolerance", -1.0, "tolerance must be a finite number ≥ 0, but is -1"),
        ("tolerance", float("nan"), "tolerance must be a finite number ≥ 0, but is NaN"),
        ("angle_weight", -0.5, "angle_weight must be a finite number ≥ 0, but is -0.5"),
        ("angle_weight", float("inf"), "angle_weight must be a finite number ≥ 0, but is inf"),
        ("angle_weight", float("nan"), "angle_weight must be a finite number ≥ 0, but is NaN"),
        ("area_tolerance", 0.0, "area_tolerance must be a finite number > 0, but is 0"),
        ("area_tolerance", float("nan"), "area_tolerance must be a finite number > 0, but is NaN"),
    ],
)
def test_an_option_out_of_range_is_a_plain_value_error(option, value, words):
    with pytest.raises(ValueError, match=words) as caught:
        authalic.disk_map(*meshes.single_quad(), **{option: value})
    assert type(caught.value) is ValueError


@pytest.mark.parametrize(
    ("option", "value"),
    [
        *[("method", 3), ("boundary", None), ("max_iterations", "many"), ("tolerance", "small")],
        *[("angle_weight", "some"), ("progress", 5)],
    ],
)
def test_an_option_of_the_wrong_type_is_a_type_error(option, value):
    with pytest.raises(TypeError):
        authalic.disk_map(*meshes.grid(), **{option: value})


@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        ("method", "newton", f'method must be {SPHERE_METHODS}, but is "newton"'),
        ("line_search", "none", 'line_search must be "interpolation" or "bounded", but is "none"'),
        ("max_iterations", -1, "max_iterations must be ≥ 0, but is -1"),
        ("tolerance", -1.0, "tolerance must be a finite number ≥ 0, but is -1"),
        ("tolerance", float("-inf"), "tolerance must be a finite number ≥ 0, but is -inf"),
        ("tolerance", float("nan"), "tolerance must be a finite number ≥ 0, but is NaN"),
        ("angle_weight", -0.5, "angle_weight must be a finite number ≥ 0, but is -0.5"),
        ("angle_weight", float("inf"), "angle_weight must be a finite number ≥ 0, but is inf"),
        ("angle_weight", float("nan"), "angle_weight must be a finite number ≥ 0, but is NaN"),
        ("area_tolerance", 0.0, "area_tolerance must be a finite number > 0, but is 0"),
        ("area_tolerance", float("nan"), "area_tolerance must be a finite number > 0, but is NaN"),
    ],
)
def test_an_option_of_sphere_maps_out_of_range_is_a_plain_value_error(option, value, words):
    with pytest.raises(ValueError, match=words) as caught:
        authalic.sphere_map(*meshes.octahedron(), **{option: value})
    assert type(caught.value) is ValueError


@pytest.mark.parametrize(
    ("call", "mesh", "method"),
    [
        *[(authalic.disk_map, meshes.single_quad(), name) for name in ("conjugate_gradient", "fixed_point")],
        *[(authalic.sphere_map, meshes.octahedron(), name) for name in ("gradient_descent", "fixed_point")],
    ],
)
def test_the_papers_methods_do_not_weigh_angles(call, mesh, method):
    call(*mesh, method=method, angle_weight=0)
    with pytest.raises(ValueError, match=r"angle_weight must be 0 for the papers' methods.*is 0\.5"):
        call(*mesh, method=method, angle_weight=0.5)


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_the_fixed_point_takes_any_tolerance_below_infinity(value):
    with pytest.raises(ValueError, match="tolerance must be below infinity"):
        authalic.sphere_map(*meshes.octahedron(), method="fixed_point", tolerance=value)
    for tolerance in (-np.inf, -1.0, 0.0, 1e300):
        authalic.sphere_map(*meshes.octahedron(), method="fixed_point", tolerance=tolerance)


@pytest.mark.parametrize(
    ("option", "value"),
    [
        *[("method", 3), ("line_search", None), ("max_iterations", "many"), ("tolerance", "small")],
        *[("angle_weight", None), ("unfold", "yes"), ("progress", 5)],
    ],
)
def test_an_option_of_sphere_maps_of_the_wrong_type_is_a_type_error(option, value):
    with pytest.raises(TypeError):
        authalic.sphere_map(*meshes.octahedron(), **{option: value})
