# SPDX-License-Identifier: MIT OR Apache-2.0
"""Results as objects: compared, copied, pickled, saved and loaded, sent to other processes."""

import copy
import hashlib
import json
import multiprocessing
import os
import pickle
import subprocess
import sys
import zipfile

import numpy as np
import pytest

import authalic

from . import meshes
from .archives import npy

OLD_FILES = sorted((meshes.ROOT / "tests" / "data" / "results").glob("*.npz"))


def curves(seed=0):
    mesh, _ = meshes.sphere(20, 24)
    slits = [[24 * (6 + k) + column for k in range(5)] for column in (0, 8, 16)]
    return mesh, slits


def by_curves():
    mesh, slits = curves()
    target = meshes.Mesh(mesh.vertices * [1, 0.9, 1.1], mesh.faces)
    return authalic.register_hyperbolic(mesh, target, source_curves=slits, target_curves=slits)


def on_spheres():
    ball = meshes.bumpy_ball()
    target = meshes.Mesh(ball.vertices * [1, 1.2, 0.9], ball.faces)
    return authalic.register_spheres(ball, target, source_landmarks=[0, 40, 90], target_landmarks=[0, 41, 90])


def on_disks():
    cap = meshes.bumpy_cap()
    target = meshes.Mesh(cap.vertices * [1, 1.2, 0.9], cap.faces)
    return authalic.register_disks(cap, target, source_landmarks=[0, 40], target_landmarks=[0, 41])


def with_filled_holes():
    plate = meshes.plate_with_holes()
    target = meshes.Mesh(plate.vertices * [1, 1.2, 1], plate.faces)
    rims = np.concatenate(authalic.Surface(*plate).boundary_loops)
    inner = np.setdiff1d(np.arange(len(plate.vertices)), rims)[[5, 200]]
    return authalic.register_disks(
        plate, target, source_landmarks=inner, target_landmarks=inner, fill_holes=True, energy="area"
    )


def opened(mesh):
    return meshes.Mesh(mesh.vertices, mesh.faces[1:])


def folded_and_untangled():
    cap = meshes.bumpy_cap()
    uv = np.array(authalic.disk_map(*cap).uv)
    uv[3] += 0.4
    return authalic.untangle(cap, uv)


def packed():
    uv = np.array([[0, 0], [1, 0], [0, 1], [3, 0], [4, 0], [3, 1]], float)
    return authalic.pack(uv, [[0, 1, 2], [3, 4, 5]], [0, 1])


RESULTS = {
    "surface": lambda: authalic.Surface(*meshes.bumpy_cap()),
    "patch": lambda: authalic.cut(*meshes.annulus())[0],
    "distortion": lambda: authalic.disk_map(*meshes.bumpy_cap()).distortion,
    "disk": lambda: authalic.disk_map(*meshes.bumpy_cap()),
    "disk of many": lambda: authalic.disk_maps([meshes.bumpy_cap()])[0],
    "sphere": lambda: authalic.sphere_map(*meshes.bumpy_ball()),
    "refined sphere": lambda: authalic.sphere_map(*meshes.limbed_ball(3), refine=True),
    "refinement": lambda: authalic.sphere_map(*meshes.limbed_ball(3), refine=True).refinement,
    "layout": lambda: authalic.sphere_map(*meshes.bumpy_ball()).layout(precision="float32"),
    "untangled": folded_and_untangled,
    "repaired": lambda: authalic.repair(*meshes.bumpy_cap()),
    "repaired and mapped": lambda: authalic.sphere_map(*meshes.bumpy_ball(), repair=True),
    "layout of a sphere with a hole": lambda: authalic.sphere_map(
        *opened(meshes.bumpy_ball()), fill_holes=True
    ).layout(),
    "repaired registration": lambda: authalic.register_spheres(
        opened(meshes.bumpy_ball()),
        meshes.ball(2),
        source_landmarks=[0, 9],
        target_landmarks=[0, 5],
        repair=True,
    ),
    "sphere with a hole": lambda: authalic.sphere_map(*opened(meshes.bumpy_ball()), fill_holes=True),
    "seams": lambda: authalic.seams(meshes.octahedron(), target=1.1),
    "unwrap": lambda: authalic.unwrap(meshes.octahedron(), target=1.1),
    "packing": packed,
    "registration of disks": on_disks,
    "registration of spheres": on_spheres,
    "registration with filled holes": with_filled_holes,
    "registration by curves": by_curves,
    "inverse registration": lambda: on_spheres().inverse(),
    "strain": lambda: on_disks().strain,
    "certificates": lambda: by_curves().certificates,
    "structure": lambda: authalic.hyperbolic_structure(*curves()[0], curves=curves()[1]),
    "pants": lambda: authalic.hyperbolic_structure(*curves()[0], curves=curves()[1]).pants[0],
}
_MADE = {}


@pytest.fixture(params=sorted(RESULTS))
def result(request):
    if request.param not in _MADE:
        _MADE[request.param] = RESULTS[request.param]()
    return _MADE[request.param]


def arrays_of(value):
    """All arrays among the public attributes of a result, with their names."""
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, (list, tuple)):
        for entry in value:
            yield from arrays_of(entry)
    elif isinstance(value, authalic.Result):
        for name in dir(value):
            if not name.startswith("_"):
                yield from arrays_of(getattr(value, name))


def assert_same_attributes(one, other):
    """The same bits in all attributes, one by one."""
    assert type(one) is type(other)
    for name in dir(one):
        value = getattr(one, name)
        if name.startswith("_") or callable(value):
            continue
        assert_same(value, getattr(other, name), name)


def assert_same(one, other, name):
    if isinstance(one, authalic.Result):
        assert_same_attributes(one, other)
    elif isinstance(one, np.ndarray):
        assert one.dtype == other.dtype and one.shape == other.shape, name
        assert one.tobytes() == other.tobytes(), name
    elif isinstance(one, (list, tuple)):
        assert type(one) is type(other) and len(one) == len(other), name
        for pair in zip(one, other, strict=True):
            assert_same(*pair, name)
    else:
        assert type(one) is type(other), name
        assert repr(one) == repr(other), name


def test_every_class_of_results_is_tested():
    public = [getattr(authalic, name) for name in authalic.__all__]
    kinds = {kind for kind in public if isinstance(kind, type)}
    results = {kind for kind in kinds if issubclass(kind, authalic.Result)} - {authalic.Result}
    assert {type(make()) for make in RESULTS.values()} == results


@pytest.mark.parametrize("protocol", range(2, pickle.HIGHEST_PROTOCOL + 1))
def test_pickles_are_the_same_bit_for_bit(result, protocol):
    again = pickle.loads(pickle.dumps(result, protocol))
    assert_same_attributes(again, result)
    assert again == result and hash(again) == hash(result)


def test_files_are_the_same_bit_for_bit(result, tmp_path):
    file = tmp_path / "result.npz"
    result.save(file)
    again = authalic.load(file)
    assert_same_attributes(again, result)
    assert again == result
    assert [each.name for each in tmp_path.iterdir()] == ["result.npz"]


def test_copies_are_the_result_itself(result):
    assert copy.copy(result) is result
    assert copy.deepcopy({"a": [result]})["a"][0] is result


def test_no_array_can_be_written_to(result, tmp_path):
    result.save(tmp_path / "result.npz")
    for each in (result, pickle.loads(pickle.dumps(result)), authalic.load(tmp_path / "result.npz")):
        arrays = list(arrays_of(each))
        assert arrays and not any(array.flags.writeable for array in arrays)


def test_results_have_a_repr_after_loading(result):
    assert repr(pickle.loads(pickle.dumps(result))) == repr(result)


def test_the_same_call_gives_an_equal_result():
    one, other = (authalic.sphere_map(*meshes.bumpy_ball()) for _ in range(2))
    assert one == other
    assert one.seconds != other.seconds or one.history["seconds"][-1] != other.history["seconds"][-1]
    assert len({one, other}) == 1


def test_results_differ_where_anything_but_time_differs():
    one = authalic.disk_map(*meshes.bumpy_cap())
    cap = meshes.bumpy_cap()
    moved = authalic.disk_map(cap.vertices * [1, 1, 1.01], cap.faces)
    assert one != moved
    assert one != authalic.disk_map(*cap, max_iterations=1)
    assert one != one.distortion and one != "text" and one is not None
    assert on_disks() != on_disks().inverse()


def test_methods_work_on_what_was_loaded(tmp_path):
    def loaded(result):
        result.save(tmp_path / "result.npz")
        return authalic.load(tmp_path / "result.npz")

    for make in (RESULTS["sphere"], RESULTS["refined sphere"]):
        sphere = make()
        points = np.random.default_rng(1).normal(size=(50, 3))
        assert (loaded(sphere).locate(points)[1] == sphere.locate(points)[1]).all()
        assert loaded(sphere).layout() == sphere.layout()
    for make in (on_disks, on_spheres, by_curves, with_filled_holes):
        registration = make()
        again = loaded(registration)
        values = np.random.default_rng(2).normal(size=len(registration.target_registered))
        assert (again.pull(values) == registration.pull(values)).all()
        assert (again.pull(values, smooth=True) == registration.pull(values, smooth=True)).all()
        assert again.inverse() == registration.inverse()
        assert again.inverse().inverse() == registration
        assert loaded(registration.inverse()).inverse() == registration
    structure = RESULTS["structure"]()
    words, motions = structure.cover(9)
    again, other = loaded(structure).cover(9)
    assert words == again and (motions == other).all()
    surface = RESULTS["surface"]()
    assert authalic.disk_map(loaded(surface)) == authalic.disk_map(surface)
    seams = RESULTS["seams"]()
    assert authalic.unwrap(meshes.octahedron(), seams=loaded(seams)) == authalic.unwrap(
        meshes.octahedron(), seams=seams
    )


def test_warnings_and_errors_survive_pickles():
    mesh, slits = curves()
    registration = authalic.register_hyperbolic(
        mesh, mesh, source_curves=slits, target_curves=[slits[0][::-1], *slits[1:]]
    )
    again = pickle.loads(pickle.dumps(registration))
    assert again.warnings == registration.warnings
    assert [vars(warning) for warning in again.warnings] == [
        vars(warning) for warning in registration.warnings
    ]
    with pytest.raises(authalic.MeshError) as caught:
        authalic.disk_map(*meshes.octahedron())
    error = pickle.loads(pickle.dumps(caught.value))
    assert type(error) is authalic.MeshError and str(error) == str(caught.value)
    assert (error.kind, error.indices, error.count) == ("closed_surface", (), 0)


@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_workers_of_every_kind_take_surfaces_and_return_results(method):
    surfaces = [authalic.Surface(*meshes.bumpy_ball(level)) for level in (2, 3)]
    expected = [authalic.sphere_map(surface) for surface in surfaces]
    with multiprocessing.get_context(method).Pool(2) as pool:
        results = pool.map_async(authalic.sphere_map, surfaces).get(timeout=120)
    assert results == expected


def test_another_process_loads_a_pickle_without_an_import(tmp_path):
    result = authalic.disk_map(*meshes.bumpy_cap())
    (tmp_path / "result.pickle").write_bytes(pickle.dumps(result))
    program = "import pickle, sys; print(repr(pickle.load(open(sys.argv[1], 'rb'))))"
    command = [sys.executable, "-c", program, str(tmp_path / "result.pickle")]
    done = subprocess.run(command, check=True, capture_output=True, text=True, timeout=120)
    assert done.stdout.strip() == repr(result)


# Files


def test_numpy_reads_the_arrays_of_a_file_by_the_names_of_the_attributes(tmp_path):
    result = authalic.sphere_map(*meshes.bumpy_ball())
    result.save(tmp_path / "ball.npz")
    with np.load(tmp_path / "ball.npz", allow_pickle=False) as entries:
        assert (entries["positions"] == result.positions).all()
        assert (entries["distortion/log2_area_ratio"] == result.distortion.log2_area_ratio).all()
        table = json.loads(str(entries["authalic"]))
    assert table["format"] == 1 and table["version"] == authalic.__version__
    assert table["content"]["kind"] == "SphereMap"
    assert table["content"]["state"]["status"] == result.status


def test_a_path_is_taken_as_it_is(tmp_path):
    result = authalic.disk_map(*meshes.bumpy_cap())
    for name in (str(tmp_path / "text"), tmp_path / "a path", tmp_path / "lh.sphere.result"):
        result.save(name)
        assert authalic.load(name) == result


def test_a_file_that_cannot_be_written_leaves_what_was_there(tmp_path):
    result = authalic.disk_map(*meshes.bumpy_cap())
    with pytest.raises(FileNotFoundError):
        result.save(tmp_path / "no folder" / "result.npz")
    folder = tmp_path / "folder"
    folder.mkdir()
    with pytest.raises(OSError):
        result.save(folder)
    assert [each.name for each in tmp_path.iterdir()] == ["folder"]


def test_a_later_file_replaces_an_earlier_one(tmp_path):
    file = tmp_path / "result.npz"
    for result in (authalic.disk_map(*meshes.bumpy_cap()), authalic.sphere_map(*meshes.bumpy_ball())):
        result.save(file)
    assert authalic.load(file) == result


def test_a_file_of_a_later_format_is_refused_by_its_version(tmp_path):
    table = json.dumps({"format": 2, "version": "9.9.9", "content": {}})
    np.savez(tmp_path / "later.npz", authalic=np.array(table))
    with pytest.raises(ValueError, match=r"saved by authalic 9\.9\.9 in format 2.*install a newer one"):
        authalic.load(tmp_path / "later.npz")


def test_damaged_files_are_refused_by_their_names(tmp_path):
    path = tmp_path / "ball.npz"
    authalic.sphere_map(*meshes.ball(2)).save(path)
    whole = path.read_bytes()
    with np.load(path) as entries:
        arrays = dict(entries)
    damaged = tmp_path / "damaged.npz"
    for length in (0, 1, 10, 100, len(whole) // 2, len(whole) - 5):
        damaged.write_bytes(whole[:length])
        with pytest.raises(ValueError, match=r"damaged\.npz is no result of authalic") as caught:
            authalic.load(damaged)
        assert type(caught.value) is ValueError
    for place in (len(whole) // 4, len(whole) // 2):
        changed = bytearray(whole)
        changed[place] ^= 0xFF
        damaged.write_bytes(changed)
        with pytest.raises(ValueError, match=r"damaged\.npz is damaged"):
            authalic.load(damaged)
    np.savez(damaged, **{name: array for name, array in arrays.items() if name != "positions"})
    with pytest.raises(ValueError, match=r"damaged\.npz is damaged"):
        authalic.load(damaged)
    for table in (
        "{}",
        "no table",
        '{"format": "x"}',
        "[]",
        '{"format": 1}',
        '{"format": 1, "content": {"kind": 3}}',
    ):
        np.savez(damaged, **{**arrays, "authalic": np.array(table)})
        try:
            loaded = authalic.load(damaged)
        except ValueError as refusal:
            assert "damaged.npz" in str(refusal)
        else:
            raise AssertionError(f"loaded {loaded!r} from the table {table}")


def zip_with(content, place, value, in_names_too=None):
    """An archive with a field of two bytes changed for all entries, in its list and in front of them."""
    changed = bytearray(content)
    for mark, offset in ((b"PK\x01\x02", place), (b"PK\x03\x04", in_names_too)):
        start = changed.find(mark)
        while start >= 0 and offset is not None:
            changed[start + offset : start + offset + 2] = value.to_bytes(2, "little")
            start = changed.find(mark, start + 4)
    return bytes(changed)


# The place of a field in the list of entries, its value, and its place in front of each entry.
ZIP_FIELDS = {
    "unknown method": (10, 99, 8),
    "broken bzip2": (10, 12, 8),
    "broken lzma": (10, 14, 8),
    "encrypted": (8, 1, None),
    "patched": (8, 0x20, None),
    "strong encryption": (8, 0x40, None),
    "version": (6, 99, None),
}


@pytest.mark.parametrize("field", ZIP_FIELDS)
def test_archives_with_changed_fields_are_refused(field, tmp_path):
    authalic.sphere_map(*meshes.ball(2)).save(tmp_path / "a.npz")
    path = tmp_path / "changed.npz"
    path.write_bytes(zip_with((tmp_path / "a.npz").read_bytes(), *ZIP_FIELDS[field]))
    with pytest.raises(ValueError, match=r"changed\.npz is (damaged|no result of authalic): \w"):
        authalic.load(path)


def test_arrays_without_memory_are_refused_by_their_size(tmp_path):
    for head in (npy((10**15,)), npy((10**30,)), npy((), "|V2000000000")):
        (tmp_path / "one.npz").write_bytes(head)
        with zipfile.ZipFile(tmp_path / "entry.npz", "w") as archive:
            archive.writestr("authalic.npy", head)
        for name in ("one.npz", "entry.npz"):
            with pytest.raises(ValueError, match=name):
                authalic.load(tmp_path / name)
    (tmp_path / "one.npz").write_bytes(npy((10**15,)))
    with pytest.raises(ValueError, match=r"not enough memory .*1000000000000000,"):
        authalic.load(tmp_path / "one.npz")


def test_the_format_of_a_result_is_a_number(tmp_path):
    path = tmp_path / "a.npz"
    for number in ("1e400", "NaN", "-5", "0", "true", '"1"', "[1]", "9" * 5000):
        table = f'{{"format": {number}, "version": "1", "content": {{}}}}'
        np.savez(path, authalic=np.array(table))
        with pytest.raises(ValueError, match=r"a\.npz is damaged: \w"):
            authalic.load(path)


def test_messages_quote_little_of_a_file(tmp_path):
    kind = {"kind": "x" * 10**6, "state": {}, "provenance": {}}
    tables = [{"format": 99, "version": "x" * 10**6, "content": 0}]
    tables += [{"format": 99, "version": "\x1b[2J", "content": 0}]
    tables += [{"format": 1, "version": "1", "content": kind}]
    for table in tables:
        np.savez(tmp_path / "a.npz", authalic=np.array(json.dumps(table)))
        with pytest.raises(ValueError) as caught:
            authalic.load(tmp_path / "a.npz")
        said = str(caught.value).removeprefix(str(tmp_path))
        assert len(said) < 600 and said.isprintable()


def test_no_message_advises_to_load_pickles(tmp_path):
    (tmp_path / "a.npz").write_bytes(pickle.dumps([1]))
    np.savez(tmp_path / "b.npz", authalic=np.array([{}], dtype=object))
    for name in ("a.npz", "b.npz"):
        with pytest.raises(ValueError, match="never read") as caught:
            authalic.load(tmp_path / name)
        assert "allow_pickle" not in str(caught.value)


@pytest.mark.skipif(os.name != "posix", reason="needs pipes")
def test_pipes_and_devices_are_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.npz")
    for path in (tmp_path / "a.npz", "/dev/zero"):
        with pytest.raises(ValueError, match="a device or a pipe"):
            authalic.load(path)


def test_files_that_cannot_be_opened_are_errors_of_the_system(tmp_path):
    with pytest.raises(FileNotFoundError):
        authalic.load(tmp_path / "nothing.npz")
    with pytest.raises(OSError):
        authalic.load(tmp_path)


def test_what_is_no_result_is_refused(tmp_path):
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    np.save(tmp_path / "one.npy", np.zeros(3))
    (tmp_path / "text.npz").write_text("no file of numpy")
    (tmp_path / "empty.npz").write_bytes(b"")
    np.savez(tmp_path / "objects.npz", authalic=np.array([{}], dtype=object))
    for file in sorted(tmp_path.iterdir()):
        with pytest.raises(ValueError):
            authalic.load(file)
    with pytest.raises(FileNotFoundError):
        authalic.load(tmp_path / "nothing.npz")


@pytest.mark.parametrize("file", OLD_FILES, ids=lambda file: file.stem)
def test_files_of_earlier_versions_are_read(file):
    """Files stay in the folder for good: one of each kind for each format that was ever written."""
    result = authalic.load(file)
    assert file.stem.split("-")[0] == type(result).__name__
    assert pickle.loads(pickle.dumps(result)) == result
    assert list(arrays_of(result))


def test_there_is_an_old_file_of_every_kind_that_is_saved():
    kinds = {file.stem.split("-")[0] for file in OLD_FILES}
    assert kinds >= {"DiskMap", "SphereMap", "Registration", "Unwrap", "HyperbolicStructure", "Surface"}


# Where results come from


def digest(vertices, faces):
    vertices, faces = np.asarray(vertices, "<f8"), np.asarray(faces, "<i8")
    return hashlib.sha256(vertices.tobytes() + faces.tobytes()).hexdigest()


def test_the_provenance_names_versions_options_and_input():
    mesh = meshes.bumpy_cap()
    density = np.linspace(1, 2, len(mesh.faces))
    result = authalic.disk_map(mesh.vertices.astype("f4"), mesh.faces, density=density, angle_weight=0.01)
    record = result.provenance
    assert record["function"] == "disk_map"
    assert record["authalic"] == authalic.__version__ and record["numpy"] == np.__version__
    assert record["python"] == ".".join(map(str, sys.version_info[:3]))
    given = {
        "sha256": digest(mesh.vertices.astype("f4"), mesh.faces),
        "vertices": 421,
        "faces": len(mesh.faces),
    }
    assert record["inputs"] == {"surface": given}
    options = record["options"]
    assert options["angle_weight"] == 0.01 and options["method"] == "gauss_newton"
    assert options["initial"] is None
    expected = {
        "shape": [len(density)],
        "dtype": "float64",
        "sha256": hashlib.sha256(density.tobytes()).hexdigest(),
    }
    assert options["density"] == expected
    json.dumps(record)


def test_the_provenance_of_a_layout_and_of_a_packing_names_what_was_laid_out():
    ball = authalic.sphere_map(*meshes.bumpy_ball())
    inputs = ball.layout().provenance["inputs"]
    assert inputs["map"]["sha256"] == digest(ball.positions, ball.faces)
    uv = np.array([[0, 0], [1, 0], [0, 1.5]])
    packing = authalic.pack(uv, [[0, 1, 2]], [0], rotate="cardinal")
    assert packing.provenance["inputs"]["uv"] == {
        "sha256": digest(uv, [[0, 1, 2]]),
        "vertices": 3,
        "faces": 1,
    }
    assert packing.provenance["options"]["rotate"] == "cardinal"
    assert authalic.pack(uv, [[0, 1, 2]], [0], rotate=False).provenance["options"]["rotate"] is False


def test_the_provenance_of_a_registration_names_both_surfaces():
    source = meshes.bumpy_cap()
    registration = on_disks()
    record = registration.provenance
    assert record["function"] == "register_disks"
    assert record["inputs"]["source"]["sha256"] == digest(*source)
    assert record["inputs"]["target"]["sha256"] == digest(source.vertices * [1, 1.2, 0.9], source.faces)
    assert record["options"]["source_landmarks"] == [0, 40]
    assert registration.inverse().provenance == record


def test_the_provenance_is_that_of_the_computation_after_saving(tmp_path):
    result = authalic.sphere_map(*meshes.bumpy_ball(), max_iterations=3)
    result.save(tmp_path / "ball.npz")
    again = authalic.load(tmp_path / "ball.npz")
    assert again.provenance == result.provenance
    assert pickle.loads(pickle.dumps(again)).provenance == result.provenance
    again.provenance["options"]["max_iterations"] = 99
    assert again.provenance["options"]["max_iterations"] == 3


def test_all_functions_leave_their_options_in_the_provenance():
    from .test_contract import KEYWORDS

    for name, function in (
        ("disk", "disk_map"),
        ("sphere", "sphere_map"),
        ("seams", "seams"),
        ("unwrap", "unwrap"),
    ):
        record = RESULTS[name]().provenance
        assert record["function"] == function
        assert record["options"].keys() == KEYWORDS[function].keys() - {"progress", "preview"}
    layout, packing = RESULTS["layout"]().provenance, packed().provenance
    assert (layout["function"], packing["function"]) == ("layout", "pack")
    assert packing["options"].keys() == {"island_of"} | KEYWORDS["pack"].keys() - {"progress"}
    assert layout["options"] == {
        "kind": "lambert",
        "pole": "z",
        "seam": 0.0,
        "polygons": None,
        "density": None,
        "candidates": None,
        "precision": "float32",
    }
    for make, function in ((on_disks, "register_disks"), (by_curves, "register_hyperbolic")):
        options = make().provenance["options"]
        assert options.keys() == KEYWORDS[function].keys() - {"progress", "preview"}


def test_figures_and_surfaces_have_no_provenance():
    surface = authalic.Surface(*meshes.bumpy_cap())
    assert surface.provenance is None
    assert authalic.disk_map(surface).distortion.provenance is None
