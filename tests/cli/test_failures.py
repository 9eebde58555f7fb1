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

from authalic.io import MeshData, write_mesh

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


def test_the_library_is_loaded_when_it_is_used_first():
    code = """
import sys, authalic
assert "numpy" not in sys.modules and "sphere_map" in dir(authalic)
authalic.sphere_map
assert "numpy" in sys.modules and authalic.sphere_map is authalic._native.sphere_map
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
