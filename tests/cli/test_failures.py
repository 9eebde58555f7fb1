# SPDX-License-Identifier: MIT OR Apache-2.0
"""Errors, interrupts and missing packages: exit codes, words, and no files."""

import importlib.metadata
import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from api import meshes

import authalic
from authalic.io import MeshData, write_mesh, write_values

from .conftest import names, start

ONLY_POSIX = pytest.mark.skipif(os.name == "nt", reason="Windows has no such signals")


@pytest.fixture
def hole(folder):
    """An octahedron that lacks a face."""
    vertices, faces = meshes.octahedron()
    write_mesh(folder / "hole.obj", MeshData(vertices, faces[1:]))
    return folder


def test_a_surface_that_does_not_suit_is_an_error_by_element(run, hole):
    vertices, faces = meshes.octahedron()
    write_mesh(hole / "twice.obj", MeshData(vertices, np.vstack([faces, faces[3:4]])))
    before = names(hole)
    result = run("sphere", "twice.obj")
    assert result.code == 4 and result.out == ""
    assert result.err.startswith("authalic: error: ") and "kind: duplicate_face" in result.err
    assert "elements: 8 (1 in all)" in result.err
    assert names(hole) == before


def test_errors_are_data_with_json(run, hole):
    result = run("sphere", "hole.obj", "--json")
    assert result.code == 4 and result.error["kind"] == "open_surface" and result.error["exit_code"] == 4
    assert result.error["count"] == len(result.error["indices"]) == 1


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["sphere", "nothing.obj"], 2, "nothing.obj"),
        (["sphere", "ball.obj", "nowhere/out.obj"], 3, "there is no folder"),
        (["sphere", "ball.obj", "out.xyz"], 3, "rename it or name a format"),
        (["sphere", "ball.obj", "--areal", "areal.xyz"], 3, "rename it or name a format"),
        (["sphere", "ball.obj", "--radius", "-1"], 2, "positive"),
        (["sphere", "ball.obj", "--angle-weight", "-1"], 2, "angle_weight"),
        (["sphere", "ball.obj", "--input-format", "npz"], 3, "cannot be read as npz"),
        (["nonsense"], 2, "nonsense"),
        (["disk", "ball.obj", "out.obj"], 4, "closed_surface"),
        (["register", "ball.obj", "cap.obj", "out.obj"], 4, "error"),
    ],
)
def test_each_kind_of_failure_has_its_code_and_leaves_no_file(words, code, said, run, folder):
    before = names(folder)
    result = run(*words)
    assert (result.code, result.out) == (code, "") and said in result.err
    assert names(folder) == before


@pytest.mark.parametrize(
    "words",
    [
        ("sphere", "ball.obj", "out.npz", "--areal", "out.npz"),
        ("sphere", "ball.obj", "out.npz", "--areal", "nowhere/out.npy"),
        ("disk", "cap.obj", "out.npz", "--areal", "./out.npz"),
        ("disk", "cap.obj", "nowhere/out.obj"),
        ("layout", "ball.obj", "nowhere/out.obj"),
        ("unwrap", "ball.obj", "nowhere/out.obj"),
        ("seams", "ball.obj", "nowhere/out.obj"),
        ("repair", "ball.obj", "nowhere/out.obj"),
        ("register", "ball.obj", "ball.obj", "out.npz", "--pull", "ball.npy", "out.npz"),
    ],
)
def test_files_that_cannot_be_written_are_errors_before_the_work_starts(words, run, folder, monkeypatch):
    from authalic.runs import disk, layout, register, repair, sphere, unwrap

    write_values(folder / "ball.npy", np.zeros(258))
    for module, name in (
        *((sphere, "sphere_map"), (disk, "disk_map"), (layout, "sphere_map"), (unwrap, "unwrap")),
        *((unwrap, "seams"), (repair, "repair"), (register, "_register")),
    ):
        monkeypatch.setattr(module, name, None)  # not to be called
    before = names(folder)
    result = run(*words)
    assert result.code == 3 and ("there is no folder" in result.err or "two results" in result.err)
    assert names(folder) == before


def test_a_folder_that_cannot_be_written_to_is_an_error(run, folder, monkeypatch):
    """As root, who may write anywhere, one cannot make such a folder."""
    monkeypatch.setattr("os.access", lambda place, mode: mode != os.W_OK)
    result = run("sphere", "ball.obj", "out.obj")
    assert result.code == 3 and "cannot be written to" in result.err


@ONLY_POSIX
def test_devices_and_pipes_are_not_replaced(run, folder):
    os.mkfifo(folder / "pipe")
    for place in ("pipe", os.path.relpath(os.devnull, folder)):
        result = run("sphere", "ball.obj", place, "--output-format", "obj")
        assert result.code == 3 and "a device or a pipe" in result.err
    with pytest.raises(ValueError, match="a device or a pipe"):
        authalic.disk_map(*meshes.bumpy_cap()).save(folder / "pipe")
    assert not os.path.isfile(folder / "pipe") and not os.path.isfile(os.devnull)


def test_errors_name_what_the_command_calls_things(run, folder):
    write_mesh(folder / "apart.stl", MeshData(*meshes.bumpy_ball()))
    vertices, faces = meshes.octahedron()
    write_mesh(folder / "twice.obj", MeshData(vertices, np.vstack([faces, faces[:1]])))
    write_mesh(folder / "hole.obj", MeshData(vertices, faces[1:]))
    failures = {
        ("sphere", "apart.stl"): "(--repair merges them)",
        ("disk", "ball.obj", "out.obj"): "by authalic sphere (authalic unwrap cuts any surface open",
        ("sphere", "torus.obj"): "authalic repair --close-handles all closes handles",
        ("sphere", "hole.obj"): "(--fill-holes fills them)",
        ("sphere", "twice.obj"): "(authalic repair mends this",
    }
    for words, said in failures.items():
        result = run(*words)
        assert result.code == 4 and said in result.err
        for python in ("=True", '="', "_map", "=("):
            assert python not in result.err
    assert "--repair" in run("sphere", "apart.stl", "--json").error["message"]


def test_a_damaged_result_is_an_error_of_its_file(run, folder):
    for table, said in (
        ('{"format": 1e400, "version": "1", "content": {}}', "info.npz: it is damaged: "),
        (
            '{"format": 1, "version": "1", "content": {"kind": "x", "provenance": 3}}',
            "info.npz: it is damaged",
        ),
        ('{"format": 9, "version": "7.0", "content": {}}', "info.npz: it was saved by authalic 7.0"),
    ):
        np.savez(folder / "info.npz", authalic=np.array(table))
        result = run("info", "info.npz")
        assert result.code == 3 and said in result.err
    np.savez(folder / "info.npz", a=np.zeros(3))
    assert "it lacks the arrays" in run("info", "info.npz").err


def test_wrong_words_are_data_too_with_json(run):
    error = run("sphere", "nothing.obj", "--json").error
    assert (error["kind"], error["exit_code"]) == ("usage", 2) and "nothing.obj" in error["message"]


@pytest.mark.parametrize(
    "words",
    [
        ["sphere", "ball.obj", "out.obj", "--threads", 10**20],
        ["sphere", "ball.obj", "out.obj", "--threads", 1025],
        ["sphere", "ball.obj", "out.obj", "--max-iterations", 10**20],
        ["unwrap", "ball.obj", "out.obj", "--max-islands", 10**20],
        ["repair", "ball.obj", "out.obj", "--close-holes", 10**20],
        ["repair", "ball.obj", "out.obj", "--merge", 10**20],
        ["batch", "sphere", "ball.obj", "--out", "out", "--workers", 10**20],
    ],
)
def test_numbers_beyond_use_are_wrong_words(words, run, folder):
    before = names(folder)
    result = run(*words)
    assert result.code == 2 and str(words[-2]) in result.err
    assert names(folder) == before


def test_a_file_that_cannot_be_written_leaves_the_other_one_out_too(run, folder):
    (folder / "areal.npy").mkdir()
    before = names(folder)
    code = run("sphere", "ball.obj", "out.obj", "--areal", "areal.npy").code
    assert code in (2, 3) and names(folder) == before


WAITING = """
import sys
import authalic.cli.progress as progress
from authalic.cli import main
progress.INTERVAL = 0
sys.exit(main(["sphere", "large.npz", "out.obj", "--areal", "out.npy"]))
"""


@ONLY_POSIX
@pytest.mark.parametrize(
    ("name", "code"), [("SIGINT", 130), ("SIGTERM", 143), ("SIGHUP", 143), ("SIGKILL", -9)]
)
def test_a_run_that_is_stopped_leaves_nothing(name, code, tmp_path):
    write_mesh(tmp_path / "large.npz", MeshData(*meshes.limbed_ball(6)))
    process = start(WAITING, tmp_path)
    assert process.stderr.readline().startswith(b"sphere: ")
    process.send_signal(getattr(signal, name))
    _, said = process.communicate(timeout=60)
    assert process.returncode == code, said
    assert b"Traceback" not in said and (name != "SIGINT" or b"interrupted" in said)
    assert names(tmp_path) == ["large.npz"]


WITHOUT = """
import sys
class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {absent}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name.split(".")[0])
sys.meta_path.insert(0, Absent())
from authalic.cli import main
sys.exit(main({words}))
"""


@pytest.mark.parametrize(
    ("absent", "words", "extra"),
    [
        (["click"], ["info", "ball.obj"], "cli"),
        (["rich"], ["info", "ball.obj"], "cli"),
        (["nibabel"], ["sphere", "ball.obj", "out.surf.gii"], "neuro"),
        (["trimesh"], ["sphere", "ball.obj", "out.glb"], "io"),
        (["meshio"], ["sphere", "ball.obj", "out.vtu"], "io"),
    ],
)
def test_a_missing_package_is_an_error_that_says_which_extra_to_install(absent, words, extra, folder):
    process = start(WITHOUT.format(absent=absent, words=words), folder)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 6
    assert f"pip install 'authalic[{extra}]'" in said.decode() and absent[0] in said.decode()
    assert names(folder) == ["ball.obj", "cap.obj", "torus.obj"]


def test_the_package_and_its_readers_import_nothing_but_numpy(folder):
    optional = "click rich nibabel trimesh meshio dask distributed pyarrow scipy"
    code = f"""
import sys, authalic, authalic.io, authalic.cli
authalic.io.read_mesh("ball.obj")
assert not set(sys.modules) & set("{optional}".split()), set(sys.modules) & set("{optional}".split())
"""
    done = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_a_narrow_encoding_is_no_error(folder):
    """As pipes have it on Windows: without σ₁/σ₂."""
    done = subprocess.run(
        [sys.executable, "-m", "authalic", "sphere", "ball.obj"],
        cwd=folder,
        env={**os.environ, "PYTHONIOENCODING": "cp1252"},
        capture_output=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    assert b"\\u03c3\\u2081/\\u03c3\\u2082 mean" in done.stdout


def test_the_library_is_loaded_when_it_is_used_first():
    code = """
import sys, authalic
assert "numpy" not in sys.modules and "sphere_map" in dir(authalic)
authalic.sphere_map
assert "numpy" in sys.modules and authalic.sphere_map is authalic._native.sphere_map
assert set(authalic.__all__) <= set(vars(authalic))
try:
    authalic.nothing
except AttributeError as error:
    assert "nothing" in str(error)
else:
    raise AssertionError
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_a_command_loads_no_more_than_it_needs(folder):
    """What it loads takes the time from its start to the map."""
    write_mesh(folder / "lh.white", MeshData(*meshes.bumpy_ball()))
    code = """
import gc, os, sys
from authalic.cli import main
sys.argv = ["authalic", "sphere", "lh.white", "--quiet"]
assert main() == 0
slow = "nibabel trimesh meshio scipy dask pyarrow rich.console tempfile asyncio importlib.metadata"
assert not set(sys.modules) & set(slow.split()), set(sys.modules) & set(slow.split())
assert gc.isenabled() and gc.get_freeze_count()
print(os.environ["OPENBLAS_NUM_THREADS"])
"""
    for chosen in ({}, {"OPENBLAS_NUM_THREADS": "7"}):
        environment = {key: value for key, value in os.environ.items() if "THREADS" not in key} | chosen
        done = subprocess.run(
            [sys.executable, "-c", code], cwd=folder, env=environment, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        assert done.stdout.strip() == chosen.get("OPENBLAS_NUM_THREADS", "1")


def test_the_wheel_names_its_extras_and_its_command():
    metadata = importlib.metadata.metadata("authalic")
    assert {"cli", "io", "neuro", "batch"} <= set(metadata.get_all("Provides-Extra"))
    needed = [line for line in metadata.get_all("Requires-Dist") if "extra ==" not in line]
    assert len(needed) == 1 and needed[0].startswith("numpy")
    [entry] = importlib.metadata.entry_points(group="console_scripts", name="authalic")
    assert entry.load()(["--version"]) == 0
