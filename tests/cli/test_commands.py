# SPDX-License-Identifier: MIT OR Apache-2.0
"""Each command on small files: what it writes is what the library returns."""

import json
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from api import meshes, real_meshes

import authalic.io
from authalic.io import MeshData, read_mesh, read_values, write_mesh, write_values

from .conftest import names, start


def test_sphere_writes_the_librarys_map(run, folder):
    result = run("sphere", "ball.obj", "--json")
    expected = authalic.sphere_map(*meshes.bumpy_ball())
    assert result.code == 0 and result.err == ""
    assert np.array_equal(read_mesh(folder / "ball.sphere.obj").vertices, expected.positions)
    record = result.record
    assert record["output"] == "ball.sphere.obj" and record["status"] == expected.status
    assert record["area_ratio_std"] == expected.distortion.area_ratio_std and record["folded"] == 0
    assert (record["vertices"], record["faces"], record["command"]) == (258, 512, "sphere")


def test_a_cortex_becomes_a_sphere_that_freesurfer_and_nibabel_read(run, folder):
    nibabel_io = pytest.importorskip("nibabel.freesurfer.io")
    mesh = meshes.bumpy_ball()
    nibabel_io.write_geometry("lh.white", 50 * mesh.vertices, mesh.faces)
    assert run("sphere", "lh.white", "--areal", "lh.areal").code == 0
    points, faces = nibabel_io.read_geometry("lh.authalic.sphere")
    assert np.array_equal(faces, mesh.faces)
    assert np.allclose(np.linalg.norm(points, axis=1), 100, atol=1e-4)
    # the areas of the vertices, face by face
    areas = np.zeros((2, len(points)))
    for row, place in zip(areas, (mesh.vertices, points), strict=True):
        for face in faces:
            a, b, c = place[face].astype(float)
            row[face] += np.linalg.norm(np.cross(b - a, c - a)) / 6
    shares = areas / areas.sum(axis=1, keepdims=True)
    expected = np.log2(shares[1] / shares[0])
    assert np.allclose(nibabel_io.read_morph_data("lh.areal"), expected, atol=1e-4)


def test_the_cortex_of_fsaverage5_keeps_its_areas(run, folder):
    nibabel_io = pytest.importorskip("nibabel.freesurfer.io")
    for name in ("white", "sphere"):
        mesh = read_mesh(real_meshes.fsaverage5(f"{name}_left.gii.gz"))
        nibabel_io.write_geometry(f"lh.{name}", mesh.vertices, mesh.faces)
    assert mesh.vertices.shape == (10242, 3)
    record = run("sphere", "lh.white", "--json").record
    measured = run("measure", "lh.white", "lh.authalic.sphere", "--json").record
    theirs = run("measure", "lh.white", "lh.sphere", "--json").record
    assert record["folded_in_file"] == 0 and measured["folded"] == 0
    assert record["area_ratio_std"] < 0.005 and measured["area_ratio_std"] < 0.005 < theirs["area_ratio_std"]


def test_gifti_goes_in_and_out_with_values(run, folder):
    nibabel = pytest.importorskip("nibabel")
    write_mesh(folder / "lh.white.surf.gii", MeshData(*meshes.bumpy_ball()))
    assert run("sphere", "lh.white.surf.gii", "--areal", "lh.shape.gii").code == 0
    points, faces = nibabel.load("lh.white.sphere.surf.gii").agg_data(("pointset", "triangle"))
    assert np.allclose(np.linalg.norm(points, axis=1), 100, atol=1e-4) and faces.shape == (512, 3)
    assert nibabel.load("lh.shape.gii").agg_data().shape == (258,)


def test_gifti_says_what_a_map_is(run, folder):
    """The kind of geometry is that of the map; the transform of the surface's place is not for it."""
    nibabel = pytest.importorskip("nibabel")
    gifti = nibabel.gifti
    left = {"AnatomicalStructurePrimary": "CortexLeft"}
    meta = gifti.GiftiMetaData(
        left | {"AnatomicalStructureSecondary": "GrayWhite", "GeometricType": "Anatomical"}
    )
    for name, mesh in (("ball", meshes.bumpy_ball()), ("cap", meshes.bumpy_cap())):
        space = gifti.GiftiCoordSystem(xform=np.diag([2.0, 3, 4, 1]))
        points = gifti.GiftiDataArray(
            mesh.vertices.astype("f4"),
            "NIFTI_INTENT_POINTSET",
            coordsys=space,
            meta=gifti.GiftiMetaData(meta),
        )
        faces = gifti.GiftiDataArray(mesh.faces.astype("i4"), "NIFTI_INTENT_TRIANGLE")
        nibabel.save(gifti.GiftiImage(darrays=[points, faces]), f"{name}.surf.gii")
    assert run("sphere", "ball.surf.gii").code == run("disk", "cap.surf.gii", "flat.surf.gii").code == 0
    for name, kind in (("ball.sphere", "Spherical"), ("flat", "Flat")):
        points = nibabel.load(f"{name}.surf.gii").darrays[0]
        assert dict(points.meta) == left | {"GeometricType": kind}
        assert np.array_equal(points.coordsys.xform, np.eye(4))


@pytest.mark.parametrize(
    ("surface", "format", "name", "areal"),
    [
        ("ball.obj", None, "ball.sphere.obj", "ball.sphere.areal.npy"),
        ("BALL.OBJ", None, "BALL.sphere.OBJ", "BALL.sphere.areal.npy"),
        ("a.b.ply", "obj", "a.b.sphere.obj", "a.b.sphere.areal.npy"),
        ("lh.white", None, "lh.authalic.sphere", "lh.authalic.areal"),
        ("lh.white", "gifti", "lh.white.sphere.surf.gii", "lh.white.sphere.areal.shape.gii"),
        ("s.surf.gii.gz", None, "s.sphere.surf.gii.gz", "s.sphere.areal.shape.gii"),
        ("s.surf.gii", "obj", "s.sphere.obj", "s.sphere.areal.npy"),
        ("s.gii", None, "s.sphere.gii", "s.sphere.areal.shape.gii"),
    ],
)
def test_maps_are_named_after_their_surfaces(surface, format, name, areal):
    from authalic.runs.names import areal_output, map_output

    output = map_output(Path("folder", surface), "sphere", format)
    assert output == Path("folder", name)
    written = format or authalic.io.mesh_format(surface).name
    assert areal_output(output, written) == Path("folder", areal)


def test_radius_and_options_reach_the_library(run, folder):
    words = ("--radius", 2.5, "--angle-weight", 0.1, "--max-iterations", 3, "--threads", 1)
    result = run("sphere", "ball.obj", "out.npz", *words, "--json")
    expected = authalic.sphere_map(*meshes.bumpy_ball(), angle_weight=0.1, max_iterations=3)
    assert np.array_equal(read_mesh(folder / "out.npz").vertices, 2.5 * expected.positions)
    assert result.record["options"] == {"angle_weight": 0.1, "max_iterations": 3}
    authalic.set_threads(0)


def test_npz_records_how_it_was_made(run, folder):
    run("sphere", "ball.obj", "out.npz")
    record = json.loads(str(np.load(folder / "out.npz")["record"]))
    assert record["authalic"] == authalic.__version__ and record["command"] == "sphere"
    digest = subprocess.run(["sha256sum", "ball.obj"], capture_output=True, text=True, cwd=folder)
    assert digest.returncode != 0 or record["input_sha256"] == digest.stdout.split()[0]


def test_disk_writes_uvs_or_the_flat_map(run, folder):
    expected = authalic.disk_map(*meshes.bumpy_cap())
    assert run("disk", "cap.obj", "uv.obj").code == 0
    mesh = read_mesh(folder / "uv.obj")
    assert np.array_equal(mesh.uv, expected.uv) and np.array_equal(mesh.vertices, meshes.bumpy_cap().vertices)
    assert run("disk", "cap.obj", "flat.off", "--areal", "areal.npy").code == 0
    flat = read_mesh(folder / "flat.off").vertices
    assert np.array_equal(flat[:, :2], expected.uv) and not flat[:, 2].any()
    assert np.abs(read_values(folder / "areal.npy")).max() < 0.1


def test_disk_takes_a_rectangle(run, folder):
    assert run("disk", "cap.obj", "uv.npz", "--boundary", "rectangle", "--aspect", 2).code == 0
    assert np.allclose(np.ptp(read_mesh(folder / "uv.npz").uv, axis=0), [1, 0.5])


def test_unwrap_writes_the_librarys_uvs_at_each_corner(run, folder):
    result = run("unwrap", "torus.obj", "uv.obj", "--json")
    expected = authalic.unwrap(tuple(meshes.torus()))
    mesh = read_mesh(folder / "uv.obj")
    assert np.array_equal(mesh.uv[mesh.uv_faces], expected.uv[expected.faces])
    assert result.record["islands"] == expected.islands and result.record["shear"] == expected.shear


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (("sphere", "ball.obj"), "out.surf.gii"),
        (("disk", "cap.obj"), "out.surf.gii"),
        (("layout", "ball.obj"), "out.glb"),
        (("unwrap", "torus.obj"), "out.glb"),
    ],
)
def test_folds_by_the_precision_of_the_file_are_counted(words, name, run, folder):
    assert run(*words, name, "--json").record["folded_in_file"] == 0
    assert "folded_in_file" not in run(*words, "out.npz", "--json").record


def test_folds_by_the_precision_of_the_file_are_told(run, folder, monkeypatch):
    """A cap so far from the origin of the plane that single precision has no place for its faces."""
    from authalic.runs import disk

    mapped = authalic.disk_map(*meshes.bumpy_cap())
    far = SimpleNamespace(uv=mapped.uv + 1e6, repaired=None)
    monkeypatch.setattr(disk, "disk_map", lambda *_, **__: far)
    monkeypatch.setattr(disk, "map_figures", lambda _: {})
    expected = authalic.distortion(*meshes.bumpy_cap(), far.uv.astype("f4").astype("f8")).folded
    result = run("disk", "cap.obj", "out.surf.gii")
    assert len(expected) > 50 and f"single precision of the file: {len(expected)} faces" in result.err


def test_unwrap_leaves_islands_where_they_are_or_apart(run, folder):
    for words, options in ((["--no-pack"], {"pack": False}), (["--margin", "0.05"], {"margin": 0.05})):
        result = run("unwrap", "torus.obj", "uv.obj", *words, "--json")
        expected = authalic.unwrap(tuple(meshes.torus()), **options)
        assert np.array_equal(read_mesh(folder / "uv.obj").uv, expected.uv)
        assert result.record["options"] == options


def test_seams_are_written_as_a_table_as_arrays_and_as_lines(run, folder):
    expected = authalic.seams(tuple(meshes.torus())).edges
    for name in ("seams.csv", "seams.npz", "seams.obj"):
        assert run("seams", "torus.obj", name).code == 0
    assert np.array_equal(np.loadtxt("seams.csv", delimiter=",", skiprows=1), expected)
    assert np.array_equal(np.load("seams.npz")["edges"], expected)
    lines = [
        line.split()[1:]
        for line in (folder / "seams.obj").read_text(encoding="utf-8").splitlines()
        if line[0] == "l"
    ]
    assert np.array_equal(np.array(lines, int) - 1, expected)
    assert run("seams", "torus.obj", "seams.ply").code == 3


def test_layout_covers_its_rectangle_with_the_areas_of_the_surface(run, folder):
    result = run("layout", "ball.obj", "flat.obj", "--kind", "octahedral", "--json")
    mesh = read_mesh(folder / "flat.obj")
    assert result.code == 0 and len(mesh.uv) > len(mesh.vertices)
    figures = authalic.distortion(*_cut(mesh))
    assert result.record["area_ratio_std"] == pytest.approx(figures.area_ratio_std, rel=1e-9)


def _cut(mesh):
    cut = mesh.split_at_seams()
    return cut.vertices, cut.faces, cut.uv


def test_register_carries_landmarks_and_values(run, folder):
    source, target = meshes.bumpy_ball(), meshes.radial(lambda x, y, z: 1 + 0.2 * x)
    write_mesh(folder / "target.obj", MeshData(*target))
    landmarks = np.array([[0, 0], [1, 1], [2, 2], [5, 5]])
    (folder / "landmarks.csv").write_text("source,target\n" + "".join(f"{a},{b}\n" for a, b in landmarks))
    write_values(folder / "height.npy", target.vertices[:, 2])
    words = ("--landmarks", "landmarks.csv", "--pull", "height.npy", "pulled.npy", "--json")
    result = run("register", "ball.obj", "target.obj", "out.npz", *words)
    assert result.code == 0, result.err
    expected = authalic.register_spheres(
        source, target, source_landmarks=landmarks[:, 0], target_landmarks=landmarks[:, 1]
    )
    assert np.array_equal(read_mesh(folder / "out.npz").vertices, expected.positions)
    arrays = np.load(folder / "out.npz")
    places = target.vertices[target.faces[arrays["triangles"]]] * arrays["barycentric"][:, :, None]
    assert np.allclose(places.sum(axis=1), expected.positions, atol=1e-9)
    assert np.allclose(read_values(folder / "pulled.npy"), expected.positions[:, 2], atol=1e-9)
    assert result.record["folded"] == 0


def test_register_repairs_first(run, folder):
    """Landmarks and values are those of the vertices in the files, which have a loose vertex in front."""
    source, target = meshes.bumpy_ball(), meshes.radial(lambda x, y, z: 1 + 0.2 * x)
    loose = [[9.0, 9, 9]]
    for name, mesh in (("source", source), ("target", target)):
        given = MeshData(np.vstack([loose, mesh.vertices]), mesh.faces[1:] + 1)
        write_mesh(folder / f"{name}.obj", given)
    (folder / "pairs.txt").write_text("1 1\n2 2\n3 3\n6 6\n")
    write_values(folder / "height.npy", np.append(9, target.vertices[:, 2]))
    words = ("--landmarks", "pairs.txt", "--pull", "height.npy", "pulled.npy", "--json")
    assert run("register", "source.obj", "target.obj", "out.npz", *words).code != 0
    result = run("register", "source.obj", "target.obj", "out.npz", *words, "--repair")
    assert result.code == 0, result.err
    assert result.record["repairs"] == {"loose_vertices": 1, "closed_holes": 1}
    mesh = read_mesh(folder / "out.npz")
    assert authalic.Surface(mesh.vertices, mesh.faces).is_closed
    assert np.allclose(mesh.vertices[[0, 1, 2, 5]], target.vertices[[0, 1, 2, 5]], atol=1e-6)
    assert np.allclose(read_values(folder / "pulled.npy"), mesh.vertices[:, 2], atol=1e-9)


def test_register_takes_the_librarys_options(run, folder):
    source, target = meshes.bumpy_ball(), meshes.radial(lambda x, y, z: 1 + 0.2 * x)
    write_mesh(folder / "target.obj", MeshData(*target))
    rows = ["0,0,inf", "1,1,2.5", "2,2,inf", "5,5,1"]
    (folder / "landmarks.csv").write_text("\n".join(rows))
    pairs = {"source_landmarks": [0, 1, 2, 5], "target_landmarks": [0, 1, 2, 5]}
    words = ("--landmarks", "landmarks.csv", "--fill-holes", "--position-weight", "0.5", "--json")
    soft = run("register", "ball.obj", "target.obj", "soft.npz", *words)
    expected = authalic.register_spheres(
        source, target, **pairs, weights=[np.inf, 2.5, np.inf, 1], position_weight=0.5, fill_holes=True
    )
    assert soft.code == 0 and np.array_equal(read_mesh(folder / "soft.npz").vertices, expected.positions)
    (folder / "landmarks.csv").write_text("0 0\n1 1\n2 2\n5 5\n")
    words = ("--landmarks", "landmarks.csv", "--energy", "area", "--json")
    exact = run("register", "ball.obj", "target.obj", "area.npz", *words)
    expected = authalic.register_spheres(source, target, **pairs, energy="area")
    assert exact.code == 0 and np.array_equal(read_mesh(folder / "area.npz").vertices, expected.positions)


def test_what_is_registered_lies_in_the_volume_of_the_target(run, folder):
    nibabel_io = pytest.importorskip("nibabel.freesurfer.io")
    volume = {
        **{"head": np.array([2, 0, 20]), "valid": "1  # volume info valid", "filename": "orig.mgz"},
        **{"volume": np.array([256, 256, 256]), "voxelsize": np.ones(3), "xras": np.array([-1.0, 0, 0])},
        **{"yras": np.array([0.0, 0, -1]), "zras": np.array([0.0, 1, 0])},
    }
    mesh = meshes.bumpy_ball()
    for name, center in (("source", [1.0, 2, 3]), ("target", [5.0, 6, 7])):
        nibabel_io.write_geometry(
            f"lh.{name}", mesh.vertices, mesh.faces, volume_info=volume | {"cras": np.array(center)}
        )
    (folder / "pairs.txt").write_text("0 0\n1 1\n2 2\n5 5\n")
    assert run("register", "lh.source", "lh.target", "lh.there", "--landmarks", "pairs.txt").code == 0
    kept = nibabel_io.read_geometry("lh.there", read_metadata=True)[2]
    assert np.array_equal(kept["cras"], [5, 6, 7])


@pytest.mark.parametrize(
    ("words", "content", "said"),
    [
        (["--landmarks", "file.csv"], "1,2,3,4\n", "counted from 0"),
        (["--landmarks", "file.csv"], "", "counted from 0"),
        (["--landmarks", "file.csv"], "a b\n0 0\n1\n", "line 3 has 1 numbers, those before have 2"),
        (["--landmarks", "file.csv"], "a b\n\n0 0\nc d\n", "line 4 is no row of numbers: 'c d'"),
        (["--curves", "file.csv"], "{nope", "it is no JSON"),
        (["--curves", "file.csv"], "[]", "it must hold"),
        (["--pull", "file.csv", "out.npy"], "1\n2\n3\n", "it has 3 rows, but the target has 258 vertices"),
    ],
)
def test_register_refuses_files_that_make_no_sense(words, content, said, run, folder):
    (folder / "file.csv").write_text(content)
    result = run("register", "ball.obj", "ball.obj", "out.obj", *words)
    assert result.code == 3 and said in result.err


def test_measure_finds_a_folded_face_in_any_tools_map(run, folder):
    run("sphere", "ball.obj", "sphere.ply")
    whole = run("measure", "ball.obj", "sphere.ply", "--json").record
    expected = authalic.sphere_map(*meshes.bumpy_ball()).distortion
    assert (
        whole["area_ratio_std"] == pytest.approx(expected.area_ratio_std, rel=1e-9) and whole["folded"] == 0
    )
    mesh = read_mesh(folder / "sphere.ply")
    mesh.vertices[0] *= -1
    write_mesh(folder / "folded.ply", mesh)
    result = run("measure", "ball.obj", "folded.ply", "--json")

    def refuse(word):
        raise AssertionError(f"{word} is no JSON")

    record = json.loads(result.out, parse_constant=refuse)
    assert record["folded"] > 0 and record["angle_distortion_max"] is None
    assert "σ₁/σ₂ mean inf" in run("measure", "ball.obj", "folded.ply").out


def test_measure_takes_the_uvs_of_the_file_with_their_seams(run, folder):
    run("unwrap", "torus.obj", "uv.obj")
    result = run("measure", "uv.obj", "--json")
    assert result.code == 0, result.err
    assert result.record["folded"] == 0
    shear = authalic.unwrap(tuple(meshes.torus())).shear
    assert result.record["angle_distortion_mean"] == pytest.approx(shear, rel=0.05)
    assert run("measure", "torus.obj").code == 3
    assert run("measure", "torus.obj", "ball.obj").code == 3


@pytest.mark.parametrize("name", ["uv.obj", "uv.ply", "uv.glb", "uv.vtu", "uv.npz"])
def test_measure_takes_uvs_of_any_format(name, run, folder):
    """Some formats have vertices on seams several times, and some have single precision."""
    run("unwrap", "torus.obj", name)
    expected = run("unwrap", "torus.obj", "uv.obj", "--json").record
    measured = run("measure", "torus.obj", name, "--json").record
    assert measured["vertices"] == len(meshes.torus().vertices) and measured["folded"] == 0
    assert measured["area_ratio_std"] == pytest.approx(expected["area_ratio_std"], rel=1e-3)
    assert run("measure", "ball.obj", name).code == 3


def test_info_says_what_suits(run, folder):
    assert run("info", "ball.obj", "--json").record["suits"] == ["sphere", "layout", "unwrap", "seams"]
    assert run("info", "cap.obj", "--json").record["suits"] == ["disk", "unwrap", "seams"]
    torus = run("info", "torus.obj", "--json").record
    assert torus["suits"] == ["unwrap", "seams"] and torus["genus"] == 1 and torus["boundary_loops"] == 0
    assert "genus: 1" in run("info", "torus.obj").out


def test_info_says_what_a_saved_result_was_computed_from(run, folder):
    result = authalic.sphere_map(*meshes.bumpy_ball(), angle_weight=0.5)
    result.save(folder / "ball.npz")
    record = run("info", "ball.npz", "--json").record
    assert record["result"] == "SphereMap" and record["function"] == "sphere_map"
    assert record["options"]["angle_weight"] == 0.5
    assert record["authalic"] == authalic.__version__
    digests = [entry["sha256"] for entry in record["inputs"].values()]
    assert all(len(digest) == 64 for digest in digests) and digests
    assert json.loads(run("info", "ball.npz").out) == record


def test_info_says_what_is_wrong(run, folder):
    vertices, faces = meshes.octahedron()
    vertices[2] = np.nan
    write_mesh(folder / "bad.obj", MeshData(vertices, faces))
    result = run("info", "bad.obj", "--json")
    assert result.code == 0 and result.record["suits"] == []
    assert result.record["problem"]["kind"] == "not_finite" and result.record["problem"]["indices"] == [2]


COMMAND = "import sys; from authalic.cli import main; sys.exit(main(sys.argv[1:]))"


def piped(folder, words, content):
    done = subprocess.run(
        [sys.executable, "-m", "authalic", *words],
        cwd=folder,
        input=content,
        capture_output=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    return done


def test_meshes_go_through_pipes(folder):
    words = ["sphere", "-", "-", "--input-format", "obj", "--output-format", "ply"]
    first = piped(folder, words, (folder / "ball.obj").read_bytes())
    assert b"area ratio SD" in first.stderr and first.stdout.startswith(b"ply")
    second = piped(folder, ["info", "-", "--input-format", "ply", "--json"], first.stdout)
    record = json.loads(second.stdout)
    assert record["input"] == "-" and np.allclose(record["highest"], 1, atol=0.02)
    assert names(folder) == ["ball.obj", "cap.obj", "torus.obj"]


def test_seams_and_registrations_go_through_pipes(folder):
    content = (folder / "ball.obj").read_bytes()
    seams = piped(folder, ["seams", "-", "-", "--input-format", "obj", "--output-format", "obj"], content)
    assert b"\nl " in seams.stdout and b"islands" in seams.stderr
    (folder / "pairs.txt").write_text("0 0\n1 1\n2 2\n5 5\n")
    words = ["register", "ball.obj", "ball.obj", "-", "--landmarks", "pairs.txt", "--output-format", "off"]
    assert piped(folder, words, b"").stdout.startswith(b"OFF\n258 512")


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such pipes")
def test_pipes_with_names_are_read_once(folder):
    """As `authalic info <(zcat ball.obj.gz)` in a shell."""
    os.mkfifo(folder / "pipe")
    command = [sys.executable, "-m", "authalic", "info", "pipe", "--json"]
    assert subprocess.run(command, cwd=folder, capture_output=True, timeout=60).returncode == 2
    with subprocess.Popen([*command, "--input-format", "obj"], cwd=folder, stdout=subprocess.PIPE) as process:
        (folder / "pipe").write_bytes((folder / "ball.obj").read_bytes())
        record = json.loads(process.communicate(timeout=60)[0])
    assert (record["vertices"], record["faces"]) == (258, 512)
    with pytest.raises(authalic.io.FileError, match="cannot be read twice"):
        read_mesh(folder / "pipe", "obj")


def test_a_stream_needs_the_name_of_its_format(run):
    assert run("sphere", "-", "out.obj").code == 2
    assert run("sphere", "ball.obj", "-").code == 2


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such pipes")
def test_a_reader_that_goes_early_is_no_error(folder):
    process = start("import sys; from authalic.cli import main; sys.exit(main(['info', 'ball.obj']))", folder)
    process.stdout.close()
    assert process.wait(timeout=60) == 0, process.stderr.read()
    assert process.stderr.read() == b""


def test_progress_is_lines_where_there_is_no_terminal(capsys):
    from authalic.cli import progress

    bar = progress.ProgressBar("sphere")
    bar._shown -= progress.INTERVAL
    with bar:
        bar(0.25, "lowering areas")
        bar(0.5, "at once after it")
    assert capsys.readouterr().err == "sphere: 25 % lowering areas\n"


@pytest.mark.skipif(os.name == "nt", reason="Windows has no pseudo-terminals")
def test_progress_is_a_bar_on_a_terminal(folder):
    import pty

    leader, follower = pty.openpty()
    done = subprocess.run(
        [sys.executable, "-m", "authalic", "sphere", "ball.obj"],
        cwd=folder,
        stderr=follower,
        stdout=subprocess.PIPE,
        env={**os.environ, "TERM": "xterm"},
        timeout=120,
    )
    os.close(follower)
    shown = os.read(leader, 100_000)
    os.close(leader)
    assert done.returncode == 0 and b"sphere" in shown and b"\x1b[" in shown


def test_repair_merges_what_stl_keeps_apart(run, folder):
    mesh = meshes.bumpy_ball()
    write_mesh(folder / "apart.stl", MeshData(*mesh))
    assert run("sphere", "apart.stl").code == 4
    result = run("repair", "apart.stl", "whole.npz", "--json")
    assert result.code == 0, result.err
    whole = read_mesh(folder / "whole.npz")
    assert (len(whole.vertices), len(whole.faces)) == (258, 512)
    apart, arrays = read_mesh(folder / "apart.stl"), np.load(folder / "whole.npz")
    assert np.array_equal(whole.vertices[arrays["vertex_to"]], apart.vertices)
    assert result.record["repairs"] and "258 vertices" in result.record["repair_report"][-1]
    assert run("repair", "apart.stl", "still.ply", "--merge", "none").code == 0
    assert len(read_mesh(folder / "still.ply").vertices) == 3 * 512
    assert run("repair", "apart.stl", "bad.ply", "--close-holes", "some").code == 2


def test_maps_repair_first(run, folder):
    write_mesh(folder / "apart.stl", MeshData(*meshes.bumpy_ball()))
    result = run("sphere", "apart.stl", "sphere.off", "--repair", "--areal", "areal.npy")
    assert result.code == 0 and "merged" in result.out
    points = read_mesh(folder / "sphere.off").vertices
    assert points.shape == (258, 3) and np.allclose(np.linalg.norm(points, axis=1), 1)
    assert read_values(folder / "areal.npy").shape == (258,)
    write_mesh(folder / "cap.stl", MeshData(*meshes.bumpy_cap()))
    assert run("disk", "cap.stl", "disk.obj", "--repair").code == 0
    assert read_mesh(folder / "disk.obj").uv.shape == (421, 2)


def test_a_sphere_with_a_hole_is_filled_virtually(run, folder):
    vertices, faces = meshes.bumpy_ball()
    write_mesh(folder / "hole.obj", MeshData(vertices, faces[1:]))
    assert run("sphere", "hole.obj", "sphere.obj").code == 4
    assert run("sphere", "hole.obj", "sphere.obj", "--fill-holes").code == 0
    assert np.array_equal(read_mesh(folder / "sphere.obj").faces, faces[1:])
