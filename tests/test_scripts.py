# SPDX-License-Identifier: MIT OR Apache-2.0
"""The parts of scripts/ that could go wrong unnoticed."""

import ast
import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.sparse import coo_array, diags_array
from scipy.sparse.csgraph import shortest_path

import authalic
import bench.angle.front
import bench.angle.main
import bench.batch
import bench.default
import bench.fuzz.cases
import bench.fuzz.main
import bench.fuzz.rust
import bench.hyperbolic.harmonic
import bench.hyperbolic.main
import bench.hyperbolic.measures
import bench.hyperbolic.methods
import bench.hyperbolic.pairs
import bench.hyperbolic.solvers
import bench.meshes
import bench.peers.main
import bench.peers.methods
import bench.peers.run
import bench.report
import bench.seams.figures
import bench.seams.main
import bench.seams.meshes
import bench.seams.topology
import bench.tables.main
import bench.tables.stability
import bench.wrap.geodesics
import bench.wrap.main
import bench.wrap.measures
import bench.wrap.methods
import bench.wrap.pairs
import changes
import compatibility
import cross.bits
import cross.machine
import cross.main
import cross.platforms
import debian
import demo.figures
import demo.measure
import fuzz.python
import fuzz.report
import fuzz.rust
import manual
import pythons
import release.platforms
import steps
import web.shapes
import windows
from environment import REQUIREMENTS
from shell import ROOT, CommandFailed, Unavailable, run

ONLY_POSIX = pytest.mark.skipif(os.name == "nt", reason="Windows has no such programs, users or signals")


@pytest.fixture
def no_other_pythons(monkeypatch, tmp_path):
    """Only a folder `bin` on PATH and an empty pyenv, so that a test decides which Pythons exist."""
    (tmp_path / "bin").mkdir()
    monkeypatch.setattr(pythons, "_USUAL_FOLDERS", ())
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    monkeypatch.setenv("PYENV_ROOT", str(tmp_path / "pyenv"))
    monkeypatch.setenv("UV_PYTHON_INSTALL_DIR", str(tmp_path / "uv"))
    return tmp_path


def fake_python(path: Path, version: str, code: int = 0) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\necho {version}\nexit {code}\n")
    path.chmod(0o755)
    return path


@ONLY_POSIX
def test_a_shim_that_fails_is_passed_over(no_other_pythons):
    fake_python(no_other_pythons / "bin" / "python3.99", "3.99", code=127)
    real = fake_python(no_other_pythons / "pyenv" / "versions" / "3.99.1" / "bin" / "python", "3.99")
    assert pythons.find("3.99") == (real, "3.99")


@ONLY_POSIX
def test_the_newest_patch_release_is_taken(no_other_pythons):
    for patch in ("3.99.9", "3.99.10", "3.99.2"):
        fake_python(no_other_pythons / "pyenv" / "versions" / patch / "bin" / "python", "3.99")
    assert "3.99.10" in str(pythons.find("3.99")[0])


def test_a_missing_python_is_named_with_what_to_do(no_other_pythons):
    with pytest.raises(Unavailable, match=r"no Python 3\.98 or 3\.99 .*install python3\.99"):
        pythons.find("3.98", "3.99")


LAUNCHERS = sorted(path for path in (ROOT / "scripts").iterdir() if path.is_file() and not path.suffix)


@pytest.mark.parametrize("launcher", LAUNCHERS, ids=lambda path: path.name)
def test_launchers_start_with_an_old_python(launcher):
    """They look for the Python that they need. This one is the oldest that they are written for."""
    try:
        python, _ = pythons.find("3.8")
    except Unavailable as absence:
        pytest.skip(str(absence))
    assert "usage: " in run([python, launcher, "--help"], {"PYTHONDONTWRITEBYTECODE": "1"})


@pytest.mark.parametrize(
    "file",
    [*LAUNCHERS, *sorted((ROOT / "scripts" / "lib").rglob("*.py"))],
    ids=lambda path: path.relative_to(ROOT / "scripts").as_posix(),
)
def test_what_launchers_import_has_generic_types_in_annotations_alone(file):
    """Elsewhere `list[int]` is evaluated, which fails before Python 3.9."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    places = {"annotation", "returns"}
    annotations = [getattr(node, place) for node in ast.walk(tree) for place in places & set(node._fields)]
    lazy = {part for note in annotations if note is not None for part in ast.walk(note)}
    evaluated = [
        f"line {node.lineno}: {ast.unparse(node)}"
        for node in ast.walk(tree)
        if isinstance(node, ast.Subscript) and node not in lazy and isinstance(node.value, ast.Name)
        if node.value.id in ("dict", "frozenset", "list", "set", "tuple", "type")
    ]
    assert evaluated == []


def test_cargo_results_are_summed():
    output = (
        "test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.1s\n"
        "test result: FAILED. 2 passed; 4 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.1s\n"
    )
    assert steps.count_cargo(output) == steps.Count(5, 4, 1)


def test_junit_results_are_summed(tmp_path):
    report = tmp_path / "report.xml"
    report.write_text('<testsuites><testsuite tests="7" failures="1" errors="1" skipped="2"/></testsuites>')
    assert steps.count_junit(report) == steps.Count(3, 2, 2)
    assert steps.count_junit(tmp_path / "absent.xml") == steps.Count()


def test_rust_is_checked_with_the_features_of_the_wheel():
    maturin = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["maturin"]
    options = steps.CARGO_OPTIONS
    assert options[options.index("--features") + 1 :] == tuple(maturin["features"])


@ONLY_POSIX
def test_without_root_there_is_no_window(monkeypatch, tmp_path):
    monkeypatch.setattr(debian.os, "geteuid", lambda: 1000)
    with pytest.raises(Unavailable, match="needs root"):
        windows.run_scripts(tmp_path / "authalic.zip", ["buttons"], tmp_path / "log")


@ONLY_POSIX
def test_a_debian_system_that_cannot_be_made_is_left_out(monkeypatch, tmp_path):
    def fail(command, *_):
        raise CommandFailed(command, 1, "cannot resolve the host")

    monkeypatch.setattr(debian.os, "geteuid", lambda: 0)
    monkeypatch.setattr(debian.shutil, "which", lambda name: name)
    monkeypatch.setattr(debian, "CACHE", tmp_path)
    monkeypatch.setattr(debian, "run", fail)
    with pytest.raises(Unavailable, match=r"cannot resolve the host"):
        windows.run_scripts(tmp_path / "authalic.zip", ["buttons"], tmp_path / "log")
    assert not [path for path in tmp_path.iterdir() if path.is_dir()]


@ONLY_POSIX
def test_a_debian_system_is_made_again_when_it_lacks_a_package(monkeypatch, tmp_path):
    made = []

    def make(command, *_):
        if command[0] == "mmdebstrap":
            made.append(command)
            status = Path(command[-1]) / "var" / "lib" / "dpkg" / "status"
            status.parent.mkdir(parents=True)
            names = next(word for word in command if word.startswith("--include=")).split("=")[1].split(",")
            text = "".join(f"Package: {name}\nStatus: install ok installed\nVersion: 1\n\n" for name in names)
            status.write_text(f"{text}Package: left\nStatus: deinstall ok config-files\n")
        return ""

    monkeypatch.setattr(debian.os, "geteuid", lambda: 0)
    monkeypatch.setattr(debian.shutil, "which", lambda name: name)
    monkeypatch.setattr(debian, "CACHE", tmp_path)
    monkeypatch.setattr(debian, "run", make)
    for packages, count in ((["a", "b"], 1), (["b"], 1), (["b", "c"], 2), (["a", "gone"], 3)):
        root = debian.system("x", "sid", packages, tmp_path / "log")
        assert root == tmp_path / "chroot-x" and len(made) == count, packages
    assert debian.installed(root) == {"a", "gone"}  # of "left" only the settings are left


@ONLY_POSIX
def test_a_command_in_a_debian_system_keeps_its_words_and_shares_folders(tmp_path):
    shared = tmp_path / "a folder"
    shared.mkdir()
    (tmp_path / "system" / "etc").mkdir(parents=True)
    (tmp_path / "system" / "etc" / "resolv.conf").symlink_to("/etc/passwd")
    words = debian.command(tmp_path / "system", ["echo", "two words"], [shared], {"NAME": "$x"}, shared)
    assert words[-2:] == ["echo", "two words"] and words[0] == "unshare"
    assert f"mount --bind '{shared}' '{tmp_path}/system{shared}'" in " ".join(words)
    assert (tmp_path / f"system{shared}").is_dir() and "'NAME=$x'" in " ".join(words)
    assert not (tmp_path / "system" / "etc" / "resolv.conf").is_symlink()


def test_scripts_that_fail_in_a_window_are_run_once_more(monkeypatch, tmp_path):
    runs = [
        ["ok one", "-- first: 1 s", "ok two", "FAILED late", "-- second: 1 s", "FAILED", "-- third: 1 s"],
        ["ok two", "ok three", "-- second: 1 s", "ok four", "FAILED again", "-- third: 1 s", "END"],
    ]
    seen = []

    def once(_system, _archive, names, _log):
        seen.append(list(names))
        return windows._by_script(runs[len(seen) - 1])

    monkeypatch.setattr(windows, "system", lambda suite, log: tmp_path)
    monkeypatch.setattr(windows, "_run_once", once)
    names = ["first", "second", "third", "lost"]
    assert windows.run_scripts(tmp_path / "authalic.zip", names, tmp_path / "log") == (4, 2)
    assert seen == [names, ["second", "third", "lost"]]


ALL = {step.name for step in steps.STEPS}
IN_BLENDER = {"blender-4.2", "blender-5"}
INSTALLED = IN_BLENDER | {"window"}
OF_THE_WHEEL = {"wheel", "types", "docstrings", "python", "extension", "docs"} | INSTALLED


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        ("README.md", {"python", "docs"}),
        ("docs/comparison.jpg", {"python", "docs"}),
        ("docs/tutorials/artist.md", {"python", "docs"} | IN_BLENDER),
        ("docs/conf.py", {"ruff", "python", "docs"}),
        ("docs/theory/energy.md", {"python", "docs"}),
        ("docs/blender.md", {"python", "extension", "docs"} | IN_BLENDER),
        ("rust/core/src/disk/mod.rs", ALL),
        ("rust/core/README.md", ALL),
        ("rust/core/tests/it/disk.rs", {"rustfmt", "clippy", "rust"}),
        ("rust/python/src/lib.rs", {"rustfmt", "clippy", "rustdoc"} | OF_THE_WHEEL),
        ("rust/python/authalic/_native.pyi", {"ruff"} | OF_THE_WHEEL),
        ("addon/ui/panels.py", {"ruff", "types", "python", "extension"} | INSTALLED),
        ("addon/blender_manifest.toml.in", {"ruff", "types", "python", "extension"} | INSTALLED),
        ("tests/api/test_cut.py", {"ruff", "python"}),
        ("tests/api/oracle.py", {"ruff", "python"}),
        ("tests/cli/test_formats.py", {"ruff", "python"}),
        ("tests/cli/conftest.py", {"ruff", "python"}),
        ("tests/blender/test_modal.py", {"ruff", "types"} | IN_BLENDER),
        ("tests/blender/meshes.py", {"ruff", "types"} | IN_BLENDER),
        ("tests/gui/driver.py", {"ruff", "types", "window"}),
        ("tests/gui/buttons.py", {"ruff", "types", "window"}),
        ("tests/test_scripts.py", {"ruff", "python"}),
        ("tests/test_docstrings.py", {"ruff", "docstrings"}),
        ("scripts/bench", {"ruff", "python"}),
        ("scripts/docs", {"ruff", "python"}),
        ("scripts/lib/bench/tables/main.py", {"ruff", "python"}),
        ("scripts/requirements/peer-lapy.txt", set()),
        ("scripts/requirements/surfaces.txt", {"python"}),
        ("scripts/requirements/docs.txt", {"docs"}),
        ("CITATION.cff", {"python"}),
        ("scripts/release", {"ruff", "python"}),
        ("scripts/lib/release/wheels.py", {"ruff", "python"}),
        ("scripts/licenses.toml", {"python"}),
        ("scripts/requirements/release.txt", set()),
        ("scripts/requirements/workflows.txt", {"workflows"}),
        (".github/workflows/release.yml", {"workflows", "python"}),
        ("THIRD-PARTY-LICENSES.md", {"wheel", "python", "extension"}),
        ("scripts/requirements/docstrings.txt", {"docstrings"}),
        ("scripts/requirements/dev.txt", ALL),
        ("scripts/lib/steps.py", ALL),
        ("Cargo.lock", ALL),
        ("pyproject.toml", ALL),
        (".ci/run", ALL),
        ("a file that nobody has thought of", ALL),
    ],
)
def test_a_change_runs_the_steps_that_it_can_touch(file, expected):
    assert changes.touched([file]).keys() == expected


def test_a_change_of_tests_runs_these_tests():
    assert changes.touched(["tests/api/test_cut.py"])["python"] == ("tests/api/test_cut.py",)
    assert changes.touched(["tests/blender/test_modal.py"])["blender-5"] == ("tests/blender/test_modal.py",)
    assert changes.touched(["tests/blender/test_modal.py", "addon/ui/panels.py"])["blender-5"] == ()
    assert changes.touched(["tests/gui/buttons.py"])["window"] == ("tests/gui/buttons.py",)
    together = changes.touched(["tests/api/test_cut.py", "tests/api/test_holes.py"])
    assert together["python"] == ("tests/api/test_cut.py", "tests/api/test_holes.py")
    assert "python" not in changes.touched(["tests/api/test_that_was_deleted.py"])


def test_a_change_of_the_lock_file_of_the_page_compares_it_with_that_of_the_package():
    selection = changes.touched(["rust/web/Cargo.lock"])
    assert selection["web"] == () and "tests/test_scripts.py" in selection["python"]


def test_what_has_changed_is_what_differs_from_the_main_branch(monkeypatch, tmp_path):
    def git(*words):
        author = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
        subprocess.run(["git", *author, *words], cwd=tmp_path, check=True, capture_output=True)

    monkeypatch.setattr(changes, "ROOT", tmp_path)
    with pytest.raises(Unavailable, match="git answers nothing"):
        changes.changed_files()
    git("init", "--initial-branch=main")
    for name in ("kept", "edited", "moved", "edited later"):
        (tmp_path / name).write_text(name)
    git("add", ".")
    git("commit", "--message=first")
    assert changes.changed_files() == []
    git("switch", "--create=branch")
    (tmp_path / "edited").write_text("in a commit")
    git("mv", "moved", "moved away")
    git("commit", "--all", "--message=second")
    (tmp_path / "edited later").write_text("in no commit")
    (tmp_path / "new").touch()
    assert changes.changed_files() == ["edited", "edited later", "moved", "moved away", "new"]


def test_a_command_that_hangs_after_its_report_is_killed(monkeypatch, tmp_path):
    monkeypatch.setattr("shell.EXIT_SECONDS", 0.1)
    report = tmp_path / "report.xml"
    script = f"import time; open({str(report)!r}, 'w').close(); time.sleep(60)"
    with pytest.raises(CommandFailed):
        run([sys.executable, "-c", script], report=report)


@pytest.fixture
def tiny_meshes(monkeypatch):
    """Gives the benches one small disk and one small closed mesh, whatever the data folder has."""
    vertices, faces = bench.meshes.built_spheres(level=2)["ellipsoid (built)"]
    cap = authalic.cut(vertices, faces[np.all(vertices[faces][:, :, 2] > 0, axis=1)])[0]
    monkeypatch.setattr(bench.meshes, "disks", lambda: {"cap": (cap.vertices, cap.faces)})
    monkeypatch.setattr(bench.meshes, "spheres", lambda: {"ellipsoid": (vertices, faces)})
    brain = {"V_white": vertices, "V_pial": 2 * vertices, "V_sphere": 100 * vertices, "F": faces}
    monkeypatch.setattr(bench.meshes, "brains", lambda: {"ellipsoid, radius 100": brain})


def test_every_part_of_the_tables_has_rows(tiny_meshes, tmp_path):
    for part in bench.tables.main.PARTS:
        target = tmp_path / part / "tables.md"
        bench.tables.main.main([str(target), "--parts", part])
        text = target.read_text(encoding="utf-8")
        assert re.search(r"(?m)^\| (cap|ellipsoid)", text) and "Error" not in text, text
        for picture in re.findall(r"!\[.*?\]\((.*?)\)", text):
            assert (target.parent / picture).stat().st_size > 0, picture


def test_the_command_line_and_batches_are_measured(tiny_meshes, tmp_path):
    bench.batch.main([str(tmp_path / "batch.md"), "--count", "2", "--level", "2"])
    text = (tmp_path / "batch.md").read_text(encoding="utf-8")
    assert re.search(r"(?m)^\| bumpy sphere \| 162 \|", text) and "| ellipsoid, radius 100 |" in text
    assert re.search(r"(?m)^\| 1 \| .*\| 1.00 \| 1.00 \|", text) and re.search(r"(?m)^\| 2 \|", text)


def test_the_default_is_measured_beside_the_papers_methods(tiny_meshes, tmp_path):
    target = tmp_path / "default.md"
    bench.default.main([str(target)])
    rows = [line for line in target.read_text(encoding="utf-8").splitlines() if line.startswith("|")]
    assert [line.split("|")[1].strip() for line in rows[2:]] == ["cap", "ellipsoid"]
    assert all("×" in line for line in rows[2:])


@ONLY_POSIX
def test_the_comparison_has_rows_with_figures_or_with_the_reason(tiny_meshes, tmp_path):
    target = tmp_path / "peers.md"
    absent = [f"{package}=no wheel" for package in ("libigl", "xatlas", "lapy", "bpy")]
    bench.peers.main.main([str(target), "--absent", *absent])
    text = target.read_text(encoding="utf-8")
    assert len(re.findall(r"(?m)^\| \w+ \| \d+ \| authalic[^|]*\| 0\.\d+ \|", text)) == 6, text
    assert len(re.findall(r"(?m)\| not installed: no wheel \|$", text)) == 13, text
    for picture in re.findall(r"!\[.*?\]\((.*?)\)", text):
        assert (tmp_path / picture).stat().st_size > 0, picture


@ONLY_POSIX
def test_the_comparison_survives_what_happens_to_a_method(monkeypatch, tmp_path):
    mesh, method = bench.meshes.icosphere(1), bench.peers.methods.named("authalic fixed_point", "sphere")
    start = bench.peers.run.Starter(tmp_path, 60, "", {})
    code = tmp_path / "worker.py"
    monkeypatch.setattr(bench.peers.run, "WORKER", (code,))
    code.write_text("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    assert start("sphere", "ball", mesh, method).remark == "crashed: SIGSEGV"
    code.write_text("raise SystemExit(3)")
    assert start("sphere", "ball", mesh, method).remark.startswith("ended with code 3")
    code.write_text("import time; time.sleep(60)")
    start.limit = 0.3
    assert start("sphere", "ball", mesh, method).remark == "stopped after 0.3 s"


def test_methods_are_chosen_by_name_or_by_a_part_of_it():
    def names(*words):
        return [method.name for method in bench.peers.methods.of_kind("disk", words)]

    assert names("authalic") == ["authalic"]
    assert names("slim", "xatlas") == ["libigl SLIM 10", "libigl SLIM 50", "xatlas"]
    assert len(names()) == 11


def test_a_mirrored_chart_is_no_fold_and_scale_does_not_count():
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    vertices = np.vstack([square, square + np.array([3, 0, 0])])
    both = np.vstack([faces, faces + 4])
    image = np.vstack([7 * square[:, :2], [-7, 7] * square[:, :2]])
    figures = bench.peers.run.measured(vertices, both, image)
    assert figures.folds == 0 and figures.deviation < 1e-12 and np.isclose(figures.angle_p99, 1)
    ball, triangles = bench.meshes.icosphere(2)
    mirrored = bench.peers.run.measured(ball, triangles, 100 * ball * [-1, 1, 1])
    assert mirrored.folds == 0 and mirrored.energy < 1e-12
    image[6] = image[5] + 0.5 * (image[4] - image[5])  # one face of the second square folds onto the other
    assert bench.peers.run.measured(vertices, both, image).folds == 1


@pytest.fixture
def tetrahedron():
    """A regular tetrahedron with edges of length 1: vertices, faces, and its net, a strip of four faces."""
    vertices = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / np.sqrt(8)
    faces = np.array([[0, 1, 2], [1, 3, 2], [2, 3, 0], [3, 1, 0]])
    strip = np.array([[k / 2, k % 2 * np.sqrt(0.75)] for k in range(6)])
    strip = strip @ [[1, 0], [0, -1]]  # seen from outside, the faces run counter-clockwise
    return vertices, faces, strip[np.array([[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]])]


def test_the_net_of_a_tetrahedron_is_an_isometry_with_three_seams(tetrahedron):
    vertices, faces, net = tetrahedron
    figures = bench.seams.figures.measured(vertices, faces, 7 * net)
    assert (figures.islands, figures.not_disks, figures.flips, figures.overlap) == (1, 0, 0, 0)
    assert np.isclose(figures.length, 3 / 3**0.25) and figures.deviation < 1e-12
    assert np.allclose([figures.shear, figures.shear_p99, figures.dirichlet], [1, 1, 4])
    assert np.isclose(figures.packed, 49 * np.sqrt(3))


def test_stretch_of_a_layout_is_measured_at_equal_area(tetrahedron):
    vertices, faces, net = tetrahedron
    figures = bench.seams.figures.measured(vertices, faces, net * [-2, 0.5])
    assert figures.flips == 0 and figures.deviation < 1e-12
    assert np.allclose([figures.shear, figures.dirichlet], [4, 8.5])


def test_folds_and_overlap_of_a_layout_are_counted_within_islands(tetrahedron):
    vertices, faces, net = tetrahedron
    folded = net.copy()
    folded[3, 1] = net[2, 0]  # the last face lies on the third
    figures = bench.seams.figures.measured(vertices, faces, folded)
    assert figures.flips == 1 and np.isclose(figures.overlap, 1 / 3, atol=1e-3)
    apart = np.tile(net[0], (4, 1, 1)) + 1e-3 * np.arange(4)[:, None, None]
    figures = bench.seams.figures.measured(vertices, faces, apart)
    assert (figures.islands, figures.flips, figures.overlap) == (4, 0, 0)


def test_an_island_that_is_closed_is_not_a_disk(tetrahedron):
    _, faces, net = tetrahedron
    islands = bench.seams.topology.islands(faces, net)
    assert len(islands.seams) == 3 and list(islands.euler) == [1]
    islands = bench.seams.topology.islands(faces, np.zeros((4, 3, 2)))  # all corners at one place
    assert len(islands.seams) == 0 and list(islands.euler) == [2]


def test_strain_between_surfaces_is_measured_at_equal_area():
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    image = 7 * (square * [2, 0.5, 0]) @ np.linalg.qr(np.arange(9.0).reshape(3, 3) + np.eye(3))[0]
    strain = bench.wrap.measures.strain(square, faces, image, 49.0)
    assert np.allclose(strain, (4 + 0.25 + 0.25 + 4) / 4)
    image[2] = image[0]  # both faces become lines
    assert np.isinf(bench.wrap.measures.strain(square, faces, image, 49.0)).all()
    assert bench.wrap.measures.quantiles(np.array([3.0, 1, 2]), np.array([1, 1, 8]), (0.05, 0.5)) == [1, 2]


def test_distances_on_a_ball_are_arcs():
    vertices, faces = bench.meshes.icosphere(4)
    ball = bench.wrap.geodesics.Geodesics(vertices, faces, exact=False)
    arcs = np.arccos((vertices @ vertices[0]).clip(-1, 1)) / ball.root
    ratio = ball.from_vertex(0)[1:] / arcs[1:]
    assert ratio.min() > 0.99 and ratio.max() < 1.09  # lines along edges and midlines are longer
    place = ball.to_place(0, 1000, np.full(3, 1 / 3))
    assert 0.99 < place / arcs[faces[1000]].mean() < 1.09
    beside = int(np.flatnonzero((faces == 0).any(axis=1))[0])
    corner = (faces[beside] == 0).astype(float)
    assert ball.to_place(0, beside, corner) == 0
    chosen = bench.wrap.geodesics.farthest(ball, np.arange(len(vertices)), 2)
    assert vertices[chosen[0]] @ vertices[chosen[1]] < -0.9


def test_maps_between_surfaces_have_rows_figures_and_pictures(monkeypatch, tmp_path):
    vertices, faces = bench.meshes.icosphere(2)
    ball = bench.wrap.pairs.Surface("ball", vertices, faces)
    egg = bench.wrap.pairs.Surface("egg", vertices * [1.2, 1, 1], faces)
    given, known = np.arange(0, 12, 3), np.arange(1, 160, 5)
    pair = bench.wrap.pairs.Pair(ball, egg, np.stack([given] * 2, 1), np.stack([known] * 2, 1))
    collection = bench.wrap.pairs.Collection("balls", "Balls", "", (), lambda: [pair] * 3)
    monkeypatch.setattr(bench.wrap.pairs, "COLLECTIONS", (collection,))
    target = tmp_path / "wrap.md"
    words = ["--pairs", "2", "--methods", "surface", "zoom", "--absent", "pyfmaps=no wheel"]
    bench.wrap.main.main([str(target), *words])
    text = target.read_text(encoding="utf-8")
    assert len(re.findall(r"(?m)^\| ball → egg .*\| 0 \| \d+\.\d \| converged \|$", text)) == 2, text
    assert len(re.findall(r"(?m)\| not installed: no wheel \|$", text)) == 2, text
    assert text.count("**mean of 2**") == 1
    rows = json.loads(target.with_suffix(".json").read_text(encoding="utf-8"))
    measures = rows[0]["measures"]
    assert measures["error"] < 0.05 and 1 <= measures["median"] < 1.05 and measures["landmarks"] < 1e-9
    for picture in re.findall(r"!\[.*?\]\((.*?)\)", text):
        assert (tmp_path / picture).stat().st_size > 0, picture


def test_a_map_of_vertices_to_vertices_lies_at_vertices():
    vertices, faces = bench.meshes.icosphere(1)
    images = np.random.default_rng(3).integers(0, len(vertices), 20)
    triangles, barycentric = bench.wrap.methods.at_vertices(images, faces)
    assert np.allclose(np.einsum("ik,ikx->ix", barycentric, vertices[faces[triangles]]), vertices[images])


def test_the_comparison_of_seams_has_rows_and_a_sheet(tetrahedron, monkeypatch, tmp_path):
    vertices, faces, net = tetrahedron
    net = (net - net.min(axis=(0, 1))) / 3
    result = SimpleNamespace(uv=net.reshape(-1, 2), faces=np.arange(12).reshape(-1, 3), status="converged")
    monkeypatch.setattr(authalic, "unwrap", lambda surface, target: result, raising=False)
    chosen = ({"tetrahedron": (vertices, faces)}, ["spot"])
    monkeypatch.setattr(bench.seams.meshes, "chosen", lambda names: chosen)
    target = tmp_path / "seams.md"
    bench.seams.main.main([str(target), "--absent", "xatlas=no wheel", "bpy=no wheel"])
    text = target.read_text(encoding="utf-8")
    assert (
        len(re.findall(r"(?m)^\| tetrahedron \| 4 \| authalic 1\.\d+ \| 2\.28 \| 1 \| 0\.0000 \|", text)) == 2
    )
    assert (
        len(re.findall(r"(?m)\| not installed: no wheel \|$", text)) == 2
        and "does not have them: spot" in text
    )
    for picture in re.findall(r"!\[.*?\]\((.*?)\)", text):
        assert (tmp_path / picture).stat().st_size > 0, picture


def test_the_start_of_other_tools_is_an_embedding():
    vertices, faces = bench.meshes.built_disks()["bumps (built)"]
    edge = np.flatnonzero(np.abs(vertices[:, :2]).max(axis=1) == 1)
    loop = edge[np.argsort(np.arctan2(vertices[edge, 1], vertices[edge, 0]))]
    angle = 2 * np.pi * np.arange(len(loop)) / len(loop)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    image = bench.peers.methods.tutte(faces, loop, circle, len(vertices))
    assert (bench.peers.methods.signed_areas(image, faces) > 0).all()


def test_the_curve_of_areas_against_angles_has_rows(tiny_meshes, monkeypatch, tmp_path):
    monkeypatch.setattr(bench.angle.main, "WEIGHTS", (0,))
    monkeypatch.setattr(bench.angle.front, "WEIGHTS", (1, 0.1))
    target = tmp_path / "angle.md"
    bench.angle.main.main([str(target)])
    text = target.read_text(encoding="utf-8")
    assert re.search(r"(?m)^\| cap \| \d+ \| 0 \| 0\.\d+ \|", text) and "| ellipsoid |" in text, text
    assert "Not measured: there is no Blender" in text
    number = r"0\.\d{4} \d\.\d\d\*?"
    for row in ("cap | sliding", "cap | arc_length", "cap | free", "ellipsoid | sphere"):
        assert re.search(rf"(?m)^\| {re.escape(row)} \| {number} \| {number} \|$", text), text
    for name in ("curve", "front"):
        assert (tmp_path / f"angle-{name}.png").stat().st_size > 0


def test_the_curve_is_read_at_equal_angles():
    points = [(1, 0.4, 1.2), (0.1, 0.1, 1.6), (0.01, 0.05, 2.0)]
    curve = [bench.angle.main.Point("", w, d, 0.0, angle, 9.0, 0, 0.0) for w, d, angle in points]
    assert np.allclose(bench.angle.main.at_angle(curve, 1.4), (0.2, 10**-0.5))
    blender = bench.angle.main.Point("Blender", np.nan, 0.8, 0.0, 1.4, 9.0, 0, 0.0)
    assert bench.angle.main.beside_cells("ear", 7, blender, curve)[-1] == "0.250"
    too_flat = bench.angle.main.Point("Blender", np.nan, 0.8, 0.0, 1.1, 9.0, 0, 0.0)
    assert bench.angle.main.beside_cells("ear", 7, too_flat, curve)[-3].startswith(
        "outside the curve, 1.200 to"
    )


def curved(vertices, faces):
    """Four paths along the edges of a ball."""
    ends = [
        ([2, 1, 0], [0, 2, 1]),
        ([-1, 2, 0], [-2, 0, 1]),
        ([-1, -1, 1], [1, -1, 0]),
        ([0, 1, -1], [1, 0, -1]),
    ]
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    graph = coo_array((np.ones(len(sides)), sides.T), shape=(len(vertices),) * 2)
    curves = []
    for start, end in ends:
        first, last = ((vertices @ direction).argmax() for direction in (start, end))
        _, before = shortest_path(graph, unweighted=True, indices=last, return_predecessors=True)
        path = [first]
        while path[-1] != last:
            path.append(before[path[-1]])
        curves.append(np.array(path))
    return curves


def curved_surface(name):
    vertices, faces = bench.meshes.icosphere(3)
    surface = bench.meshes.built_spheres(level=3)[name][0]
    fields = {"sulc": vertices[:, 0] + 0.1 * surface[:, 2]}
    return bench.hyperbolic.pairs.Surface(surface, faces, curved(vertices, faces), vertices, surface, fields)


@pytest.fixture
def curved_pair():
    """An ellipsoid onto a bumpy sphere."""
    source, target = curved_surface("ellipsoid (built)"), curved_surface("bumpy sphere (built)")
    return bench.hyperbolic.pairs.Pair("ellipsoid → bumps", source, target)


def test_the_registrations_by_curves_have_rows_and_pictures(curved_pair, monkeypatch, tmp_path):
    monkeypatch.setattr(bench.hyperbolic.pairs, "available", lambda: True)
    monkeypatch.setattr(bench.hyperbolic.pairs, "standard", lambda: [curved_pair])
    monkeypatch.setattr(bench.hyperbolic.pairs, "across", lambda kind, count: curved_pair)
    monkeypatch.setattr(bench.hyperbolic.main, "COUNTS", (4,))
    few = {"Newton (default)": {}, "heat diffusion": {"solver": "heat", "max_iterations": 20}}
    monkeypatch.setattr(bench.hyperbolic.solvers, "SOLVERS", few)
    target = tmp_path / "hyperbolic.md"
    bench.hyperbolic.main.main([str(target), "--parts", "pairs", "cuts", "curves", "solvers"])
    text = target.read_text(encoding="utf-8")
    assert "Error" not in text, text
    for method in bench.hyperbolic.methods.METHODS:
        assert re.search(rf"(?m)^\| ellipsoid → bumps \| 642 \| {method} \| \d", text), text
    assert re.search(r"(?m)^\| ellipsoid → bumps \| 4 \| \d\.\d+ / \d\.\d+ / \d", text), text
    pictures = re.findall(r"!\[.*?\]\((.*?)\)", text)
    assert len(pictures) == 6 and all((tmp_path / name).stat().st_size > 0 for name in pictures)


def test_without_cortices_the_bench_of_curves_says_what_is_missing(monkeypatch, tmp_path):
    monkeypatch.setattr(bench.meshes, "data_folder", lambda kind: None)
    target = tmp_path / "hyperbolic.md"
    bench.hyperbolic.main.main([str(target)])
    assert "Not measured: neither ../shared/data nor" in target.read_text(encoding="utf-8")


def test_the_conventional_registration_leaves_a_surface_where_it_is(curved_pair):
    same = bench.hyperbolic.pairs.Pair("same", curved_pair.source, curved_pair.source)
    location = bench.hyperbolic.methods.harmonic(same)
    image = bench.hyperbolic.measures.interpolated(same.target.vertices, same.target, location)
    assert np.allclose(image, same.source.vertices, atol=1e-9) and len(location.folded) == 0
    measures = bench.hyperbolic.measures.measured(same, location)
    assert measures.variation < 1e-9 and measures.correlation > 1 - 1e-9
    assert np.allclose(measures.areas, 1) and measures.turned == 0


def test_the_conventional_registration_takes_curves_to_their_places(curved_pair):
    location = bench.hyperbolic.methods.harmonic(curved_pair)
    image = bench.hyperbolic.measures.interpolated(curved_pair.target.vertices, curved_pair.target, location)
    for curve, partner in zip(curved_pair.source.curves, curved_pair.target.curves, strict=True):
        path = curved_pair.target.vertices[partner]
        assert bench.hyperbolic.measures.distance(image[curve], path).max() < 1e-9
        assert np.allclose(image[curve[[0, -1]]], path[[0, -1]])


def test_a_disk_that_folds_is_noticed():
    plane = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    assert (bench.hyperbolic.harmonic.signed_areas(plane, faces) > 0).all()
    folded = bench.hyperbolic.harmonic.signed_areas(plane[[0, 1, 3, 2]], faces)
    assert (folded > 0).tolist() == [True, False]


def test_a_closed_curve_is_begun_where_its_partner_begins():
    sphere = bench.meshes.icosphere(2)[0]
    ring = np.argsort(np.arctan2(sphere[:, 1], sphere[:, 0]))[::9]
    partner, moved = np.append(ring, ring[0]), np.roll(ring, 4)[::-1]
    assert np.array_equal(
        bench.hyperbolic.pairs.turned_to(np.append(moved, moved[0]), partner, sphere, sphere), partner
    )


def test_a_subdivided_surface_keeps_its_curves(curved_pair):
    coarse, fine = curved_pair.source, bench.hyperbolic.pairs.split(curved_pair.source)
    assert len(fine.faces) == 4 * len(coarse.faces)
    assert all(np.array_equal(a[::2], b) for a, b in zip(fine.curves, coarse.curves, strict=True))
    areas = [bench.hyperbolic.measures.face_areas(each.vertices, each.faces).sum() for each in (coarse, fine)]
    assert np.isclose(*areas)
    sides = np.sort(fine.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    steps = [np.sort(np.stack([curve[:-1], curve[1:]], axis=1), axis=1) for curve in fine.curves]
    assert {*map(tuple, np.concatenate(steps).tolist())} <= {*map(tuple, sides.tolist())}


def test_the_search_for_failures_has_a_table_and_a_replay(tmp_path, capsys):
    target = tmp_path / "fuzz.md"
    assert bench.fuzz.main.main([str(target), "--cases", "4"]) == 0
    assert re.search(r"(?m)^\| all \| 4 \| 0 \|", target.read_text(encoding="utf-8"))
    for number in (3, 4, 5):  # one of each kind
        assert bench.fuzz.main.main([str(target), "--seed", str(number)]) == 0
        assert f"case {number}: " in capsys.readouterr().out


def test_the_search_for_failures_notices_a_hang_and_goes_on():
    worker = bench.fuzz.cases.Worker(0.001)  # too short to start the process
    assert worker(0).failure == "not done after 0.001 s"
    worker.limit = 60
    assert worker(0).failure == ""
    worker._process.kill()
    assert worker(3).failure.startswith("crashed: ")
    worker.stop()


def test_the_property_tests_are_found():
    targets = bench.fuzz.rust.properties()
    assert targets["random_disks_are_mapped_one_to_one"] == ("--test", "it")
    assert targets["hostile_input_never_panics"] == ("--test", "it")


def test_an_error_of_the_package_is_a_row_of_the_table():
    outcome = bench.report.Runs()(authalic.disk_map, "tetrahedron", bench.meshes.icosphere(0))
    assert outcome.result is None and outcome.error.startswith("MeshError: ")


def test_the_built_sphere_is_closed_and_seen_counter_clockwise():
    vertices, faces = bench.meshes.icosphere(2)
    (patch,) = authalic.cut(vertices, faces)
    assert patch.genus == 0 and patch.is_closed and len(faces) == 320
    assert len(authalic.distortion(vertices, faces, vertices).folded) == 0


def test_the_smallest_eigenvalue_is_found_in_a_cluster_and_below_zero():
    values = np.concatenate([[-2.5], np.linspace(-1e-9, 1e-9, 300), np.linspace(1, 40, 300)])
    assert np.isclose(bench.tables.stability.smallest_eigenvalue(diags_array(values).tocsc()), -2.5)
    nonnegative = diags_array(values[1:]).tocsc()
    assert abs(bench.tables.stability.smallest_eigenvalue(nonnegative)) < 1e-8


def test_noise_has_its_deviation_and_lies_along_the_normals():
    vertices, faces = bench.meshes.icosphere(4)
    smooth, noisy = bench.tables.stability.with_noise(7 * vertices, faces, 1e-3)
    amount = np.einsum("ij,ij->i", noisy - smooth, vertices)
    assert np.isclose(amount.std(), 1e-3, rtol=0.05)
    assert np.allclose(np.linalg.norm(noisy - smooth, axis=1), np.abs(amount), rtol=1e-2, atol=1e-9)


def test_the_demo_measures_maps_onto_a_sphere():
    vertices, faces = bench.meshes.icosphere(2)
    same = demo.measure.Layout(3 * vertices[faces], vertices[faces], np.arange(len(faces)))
    figures = demo.measure.summary(same)
    assert figures["flipped_triangles"] == 0 and np.isclose(figures["angle_distortion_mean"], 1)
    assert np.allclose(demo.measure.area_ratio(same), 1)
    assert np.allclose(demo.measure.polygon_log2_ratio(same, len(faces)), 0, atol=1e-9)
    mirrored = demo.measure.Layout(vertices[faces], -vertices[faces], same.polygon)
    assert demo.measure.summary(mirrored)["flipped_triangles"] == len(faces)


def test_the_demo_and_the_package_agree_on_a_map_onto_a_sphere():
    vertices, faces = bench.meshes.icosphere(3)
    stretched = vertices * (1, 2, 3)
    layout = demo.measure.Layout(stretched[faces], vertices[faces], np.arange(len(faces)))
    summary, figures = demo.measure.summary(layout), authalic.distortion(stretched, faces, vertices)
    assert np.isclose(summary["area_ratio_std"], figures.area_ratio_std)
    assert np.isclose(summary["angle_distortion_mean"], figures.angle_distortion_mean)


def test_the_demo_finds_the_center_of_a_sphere():
    vertices, _ = bench.meshes.icosphere(1)
    cap = vertices[vertices[:, 2] > 0.3]
    assert np.allclose(demo.measure._center_of_sphere(2 * cap + (5, -3, 1)), (5, -3, 1))


def test_the_demo_draws_sphere_layouts_when_one_is_missing(tmp_path):
    corners = np.random.default_rng(1).random((20, 3, 2))
    arrays = {"uv": corners, "area_ratio": np.ones(20)}
    maps = {"one": {"Lambert": arrays, "Octahedral": arrays}, "other": {"Lambert": arrays}}
    demo.figures.draw_sphere_layouts(maps, tmp_path / "layouts.png")
    assert (tmp_path / "layouts.png").stat().st_size > 0


def test_the_manual_is_a_page_of_its_own():
    page = manual.to_html(
        "<!-- licence -->\n# A & B\n\n- [One](#part-one)\n- see\n  [far](far.md#x)\n\n## Part One\n"
        "Text with `a < b`, *words* and\n**more** 2 * 3.\n\n"
        "1. first\n2. second\n\n![picture](p.jpg)\n\n| a | b |\n|---|---|\n"
        "| *c* | `d` |\n\n    code <x>\n"
    )
    for part in (
        *('<h1 id="a--b">A &amp; B</h1>', '<ul><li><a href="#part-one">One</a></li><li>see far</li></ul>'),
        '<h2 id="part-one">Part One</h2>\n<p>Text with <code>a &lt; b</code>, <i>words</i> and',
        "<b>more</b> 2 * 3.</p>",
        *("<ol><li>first</li><li>second</li></ol>", "<tr><th>a</th><th>b</th></tr><tr><td><i>c</i></td>"),
        "<pre>code &lt;x&gt;</pre>",
    ):
        assert part in page, part
    assert "licence" not in page
    assert "picture" not in page


def test_what_a_fuzzer_says_is_read():
    output = (
        "#2\tINITED cov: 5 ft: 5 corp: 1/1b\n#1024\tNEW    cov: 17 ft: 30 corp: 3/9b exec/s: 10\n"
        "thread '<unnamed>' (1) panicked at core/src/map.rs:3:4:\nfolded: [7]\n"
        "SUMMARY: libFuzzer: deadly signal\n"
    )
    assert fuzz.report.runs_and_coverage(output) == (1024, 17)
    assert fuzz.report.problem_in(output) == "folded: [7] at core/src/map.rs:3:4"
    assert fuzz.report.problem_in("SUMMARY: libFuzzer: timeout\n") == "libFuzzer: timeout"
    raised = "=== Uncaught Python exception: ===\nKeyError: 'x'\nTraceback\nSUMMARY: libFuzzer: exited\n"
    assert fuzz.report.problem_in(raised) == "KeyError: 'x'"


def test_every_target_of_a_fuzzer_has_its_file():
    for name in fuzz.rust.TARGETS:
        assert (ROOT / "rust" / "fuzz" / "fuzz_targets" / f"{name}.rs").exists()
    manifest = tomllib.loads((ROOT / "rust" / "fuzz" / "Cargo.toml").read_text(encoding="utf-8"))
    assert {each["name"] for each in manifest["bin"]} == set(fuzz.rust.TARGETS)
    for name in fuzz.python.TARGETS:
        assert (ROOT / "scripts" / "lib" / "fuzz" / f"of_{name}.py").exists()


def test_the_page_is_built_of_the_crates_that_the_package_is_built_of():
    """Both lock files name the same versions, so that the page computes what the package does."""

    def versions(lock):
        found = {}
        for package in tomllib.loads((ROOT / lock).read_text(encoding="utf-8"))["package"]:
            found.setdefault(package["name"], set()).add(package["version"])
        return found

    of_package, of_page = versions("Cargo.lock"), versions("rust/web/Cargo.lock")
    common = (of_package.keys() & of_page.keys()) - {"hashbrown"}  # of bindgen alone
    assert {"authalic", "faer", "ndarray", "sprs"} <= common
    assert {name: of_page[name] for name in common} == {name: of_package[name] for name in common}


def test_the_shapes_of_the_page_are_closed_surfaces():
    genus = {"cow": 0, "knot": 1, "frame": 5}
    shapes = {"cow": web.shapes.cow(), "knot": web.shapes.knot()[:2], "frame": web.shapes.frame()}
    for name, (vertices, polygons) in shapes.items():
        faces = np.concatenate([polygons[:, [0, k, k + 1]] for k in range(1, polygons.shape[1] - 1)])
        [piece] = authalic.cut(vertices, faces)
        assert piece.is_closed and piece.genus == genus[name]
        [a, b, c] = np.moveaxis(vertices[faces], 1, 0)
        assert np.einsum("ij,ij", a, np.cross(b, c)) > 0, f"{name} is inside out"


def test_a_version_that_is_not_there_is_a_row_of_the_table():
    def missing():
        raise Unavailable("no Python 3.99")

    def failing():
        raise steps.TestsFailed(steps.Count(2, 1), "ended with code 1", "")

    rows = [compatibility._row("Python 3.99", "all tests", check) for check in (missing, failing)]
    assert [row.is_failed for row in rows] == [False, True]
    assert "| Python 3.99 | all tests | not run: no Python 3.99 |" in compatibility.table(rows)
    assert set(compatibility.BLENDERS) <= {
        path.stem.removeprefix("bpy-") for path in REQUIREMENTS.glob("bpy-*.txt")
    }


def test_bits_that_differ_are_counted_and_measured():
    one, next_to_one = "3ff0000000000000", "3ff0000000000001"
    here = cross.bits.read(f"   Compiling x: y\nmap: {one} {one}\nsame: {one}\ngone: {one}\n")
    there = cross.bits.read(f"same: {one}\r\nmap: {one} {next_to_one}\nnew: {one} {one}\n")
    assert here == {"map": (1.0, 1.0), "same": (1.0,), "gone": (1.0,)}
    found = {each.name: each for each in cross.bits.compare(here, there)}
    assert list(found) == ["map", "same", "gone", "new"]
    assert (found["map"].differing, found["map"].largest) == (1, 2.0**-52)
    assert found["same"].differing == 0 and found["same"].largest == 0
    assert (found["gone"].differing, found["new"].differing) == (1, 2)
    assert found["new"].largest == float("inf")
    assert "| map | 2 | 1 | 2.2e-16 |" in cross.bits.table(list(found.values()), "elsewhere")
    zeros = cross.bits.compare({"x": (0.0,)}, {"x": (-0.0,)})
    assert zeros[0].differing == 1 and zeros[0].largest == 0


def test_differences_are_summed_up_by_functions_and_results():
    one, other = (1.0, 2.0), (1.0, 2.5)
    here = {"function sin": one, "function exp": one, "disk": one}
    found = cross.bits.summary(cross.bits.compare(here, {**here, "function exp": other}))
    assert found == (
        "the same bits in 1 of 2 functions, the others within 2e-01; the same bits in 1 of 1 results"
    )
    assert cross.bits.summary([]) == "no results"


def test_libraries_that_not_everybody_has_are_noticed():
    windows_x64 = cross.platforms.PLATFORMS["windows-x64"]
    usual = ["python3.dll", "KERNEL32.dll", "api-ms-win-core-synch-l1-2-0.dll"]
    strange = ["python311.dll", "libgcc_s_seh-1.dll", "libwinpthread-1.dll"]
    assert windows_x64.strange_libraries(usual + strange) == strange
    arm = cross.platforms.PLATFORMS["linux-arm64"]
    assert arm.strange_libraries(["libc.so.6", "ld-linux-aarch64.so.1", "libpython3.11.so.1.0"]) == [
        "libpython3.11.so.1.0"
    ]


def test_a_step_that_cannot_be_had_is_a_row_and_the_others_go_on(monkeypatch, tmp_path, capsys):
    def missing(name, words, log):
        raise Unavailable("cannot resolve the host\nno wine")

    def failing(name, words, log):
        output = "test result: FAILED. 2 passed; 4 failed; 0 ignored; 0 measured; 0 filtered out; 0.1s"
        raise CommandFailed(["cargo"], 1, output)

    monkeypatch.setattr(cross.main, "FOLDER", tmp_path)
    monkeypatch.setattr(cross.main, "prepare", lambda platform, log: None)
    monkeypatch.setattr(cross.main, "versions", lambda log: ["rustc 1.99"])
    monkeypatch.setattr(cross.main, "STEPS", {"bits": missing, "tests": failing, "wheel": lambda *_: "built"})
    assert cross.main.check(["windows-x64"], ["bits", "tests", "wheel"], []) == 1
    text = (tmp_path / "table.md").read_text(encoding="utf-8")
    assert "| windows-x64 | bits | not done: no wine |" in text and text in capsys.readouterr().out
    assert "| windows-x64 | tests | FAILED: 2 passed, 4 failed; see windows-x64-tests.log |" in text
    assert "| windows-x64 | wheel | built |" in text
    assert cross.main.check(["windows-x64"], ["bits", "wheel"], []) == 0


def test_programs_that_cargo_runs_for_a_platform_get_only_their_own_words(monkeypatch, tmp_path):
    commands = []
    monkeypatch.setattr(cross.machine, "run_inside", lambda words, *_: commands.append(list(words)) or "")
    cross.main.run_tests("linux-arm64", ["disk"], tmp_path / "log")
    [command] = commands
    cut = command.index("--")
    assert command[:4] == ["cargo", "test", "--target", "aarch64-unknown-linux-gnu"]
    assert command[cut + 1 :] == ["disk"]


def test_every_platform_of_cross_has_a_wheel():
    assert set(cross.platforms.PLATFORMS) <= set(release.platforms.PLATFORMS)
    assert set(cross.main.STEPS) == set(cross.main.WHAT)
