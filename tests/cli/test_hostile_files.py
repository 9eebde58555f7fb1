# SPDX-License-Identifier: MIT OR Apache-2.0
"""Files from strangers: they end in an error that says what is wrong, soon, and lead to no other file."""

import base64
import gzip
import json
import os
import re
import struct
import sys
import tomllib
import zipfile
import zlib

import numpy as np
import pytest
from api import meshes
from api.archives import npy

from authalic.io import FileError, MeshData, read_mesh, read_values, write_mesh

ONLY_POSIX = pytest.mark.skipif(os.name != "posix", reason="needs pipes and links")
POINTS = "0 0 0\n1 0 0\n0 1 0\n"
MANY = 10**12

PLY = (
    "ply\nformat {coding} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n"
    "property float z\nelement face {faces}\nproperty list {kind} int vertex_indices\nend_header\n"
)


def ply(rows="3 0 1 2\n", coding="ascii", vertices=3, faces=1, kind="int", points=POINTS):
    return PLY.format(coding=coding, vertices=vertices, faces=faces, kind=kind) + points + rows


def binary_ply(rows, **options):
    head = ply("", "binary_little_endian", points="", **options).encode()
    return head + np.array([0, 0, 0, 1, 0, 0, 0, 1, 0], "<f4").tobytes() + rows


def vtk(rest, coding="ASCII", kind="POLYDATA", points=f"POINTS 3 float\n{POINTS}"):
    return f"# vtk DataFile Version 3.0\nx\n{coding}\nDATASET {kind}\n{points}{rest}"


FALSE_COUNTS = {
    "vertices.off": (f"OFF {MANY} 1 0 {POINTS} 3 0 1 2", "vertices: it states the number 10{12},"),
    "polygons.off": (f"OFF 3 {MANY} 0 {POINTS} 3 0 1 2", "polygons: it states the number 10{12},"),
    "negative.off": (f"OFF -3 1 0 {POINTS} 3 0 1 2", "vertices: it states the number -3, which is below 0"),
    "back.off": (f"OFF 3 4 0 {POINTS} -1 0 1 2", "corners of polygon 1: it states the number -1,"),
    "long.off": (f"OFF 3 2 0 {POINTS} 3 0 1 2 7 0 1 2", "corners of polygon 2: it states the number 7,"),
    "line.off": (f"OFF\n3 1 0\n{POINTS}-2 0 1 2\n", "corners of polygon 1: it states the number -2,"),
    "half.off": ("OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "vertex 1 has 2 coordinates"),
    "part.off": (f"OFF\n3 1 0\n{POINTS}3 0 1 2.5\n", "polygon 1 has the corners '0 1 2.5'"),
    "word.off": ("OFF three", "it ends before the numbers"),
    "huge.off": (f"OFF 3 1 0 {POINTS} 3 0 1 {10**30}", "beyond those of any vertex"),
    "vertices.ply": (ply(vertices=MANY), "rows of 'vertex': it states the number 10{12},"),
    "faces.ply": (ply("-1", faces=MANY), "rows of 'face': it states the number 10{12},"),
    "minus.ply": (ply(faces=-1), "rows of 'face': it states the number -1,"),
    "back.ply": (ply("-1 0 1 2"), "numbers in row 1 of 'face': it states the number -1,"),
    "long.ply": (ply("3 0 1 2 9 0 1 2", faces=2), "numbers in row 2 of 'face': it states the number 9,"),
    "digits.ply": (ply(vertices="9" * 5000), "the number of rows of 'vertex' is '9{40}…', which is no"),
    "kind.ply": (ply(kind="float"), "the line 'property list float int vertex_indices', which"),
    "short.ply": ("ply\nelement\nend_header\n", "the line 'element', which cannot be read"),
    "early.ply": ("ply\nformat ascii 1.0\nproperty float x\nend_header\n", "'property float x', which"),
    "nan.ply": (ply("3 nan 1 2"), "the corner nan, which is no whole number"),
    "huge.ply": (ply("3 1e300 1 2"), "beyond those of any vertex"),
    "binary.ply": (binary_ply(b"", faces=MANY), "rows of 'face': it states the number 10{12},"),
    "less.ply": (binary_ply(struct.pack("<i", -2) + bytes(50)), "numbers in row 1 of 'face': .* -2,"),
    "more.ply": (binary_ply(struct.pack("<i", 2**31 - 1)), "numbers in row 1 of 'face': .* 2147483647,"),
    "points.vtk": (vtk("", points=f"POINTS {MANY} float\n"), "coordinates: it states the number 30{12},"),
    "cells.vtk": (vtk(f"POLYGONS {MANY} 4\n-1 0 1 2\n"), "cells: it states the number 10{12},"),
    "back.vtk": (vtk("POLYGONS 2 4\n-1 0 1 2\n"), "corners of cell 1: it states the number -1,"),
    "end.vtk": (vtk("POLYGONS 2 4\n3 0 1 2\n"), "its numbers end before cell 2 of 2"),
    "minus.vtk": (vtk("POLYGONS 1 -4\n3 0 1 2\n"), "numbers of cells: it states the number -4,"),
    "again.vtk": (vtk("VERTICES 1 -2\n" * 2, "BINARY", points=""), "it states the number -2, which is"),
    "cut.vtk": (vtk("POLYGONS 1\n"), "the line 'POLYGONS 1', which is cut short"),
    "kind.vtk": (vtk("", "BINARY", points="POINTS 3 word\n"), "have the type 'word', which is not known"),
    "offsets.vtk": (
        vtk("POLYGONS 2 3\nOFFSETS vtktypeint64\n0 -3\nCONNECTIVITY vtktypeint64\n0 1 2\n"),
        "its offsets do not rise from 0 to the 3 corners",
    ),
    "grid.vtk": (
        vtk("DIMENSIONS 3000 3000 1000\nORIGIN 0 0 0\nSPACING 1 1 1\n", kind="STRUCTURED_POINTS", points=""),
        "points of a grid: it states the number 9000000000,",
    ),
}


@pytest.mark.parametrize("name", FALSE_COUNTS)
def test_numbers_of_elements_that_a_file_cannot_hold_are_named(name, tmp_path):
    content, said = FALSE_COUNTS[name]
    if name == "grid.vtk":
        pytest.importorskip("meshio")
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(FileError, match=said) as caught:
        read_mesh(path)
    assert str(path) in str(caught.value) and len(str(caught.value)) < 600


def test_elements_without_columns_are_passed_over(tmp_path):
    for coding in ("ascii", "binary_little_endian"):
        text = (
            ply()
            if coding == "ascii"
            else binary_ply(np.array([3, 0, 1, 2], "<i4").tobytes()).decode("latin-1")
        )
        path = tmp_path / "empty.ply"
        path.write_bytes(
            text.replace("element vertex", f"element none {MANY}\nelement vertex").encode("latin-1")
        )
        assert read_mesh(path).faces.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize("title", ["dimensions in cm units", "dimensions 9999 9999 9999", "no POLYDATA"])
def test_titles_of_vtk_are_only_titles(title, tmp_path):
    pytest.importorskip("meshio")
    text = vtk("CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n", kind="UNSTRUCTURED_GRID")
    (tmp_path / "a.vtk").write_text(text.replace("\nx\n", f"\n{title}\n"))
    assert read_mesh(tmp_path / "a.vtk").faces.tolist() == [[0, 1, 2]]


def test_sizes_of_a_grid_are_checked_wherever_they_are(tmp_path):
    pytest.importorskip("meshio")
    for between in ("FIELD FieldData 1\nTIME 1 1 double\n0\n", "ORIGIN 0 0 0\nSPACING 1 1 1\n"):
        rest = f"{between}DIMENSIONS 3000 3000 1000\n"
        (tmp_path / "a.vtk").write_text(vtk(rest, kind="STRUCTURED_POINTS", points=""))
        with pytest.raises(FileError, match="points of a grid: it states the number 9000000000,"):
            read_mesh(tmp_path / "a.vtk")


@pytest.mark.parametrize(("name", "text"), [("a.obj", "{0}f 1 2 3\n"), ("a.off", "OFF 3 1 0\n{1}3 0 1 2\n")])
def test_a_byte_order_mark_is_no_part_of_the_text(name, text, tmp_path):
    (tmp_path / name).write_text(text.format(OBJ, POINTS), encoding="utf-8-sig")
    mesh = read_mesh(tmp_path / name)
    assert np.array_equal(mesh.vertices, TRIANGLE) and mesh.faces.tolist() == [[0, 1, 2]]


OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (f"{OBJ}vt 0 0\nf 1/9 2/9 3/9\n", "line 5 names UV point 9, but there is 1 UV point"),
        (f"{OBJ}vt 0 0\nvt 1 0\nf 1/1 2/1 3/1\nf 1/1 2/3 3/1\n", "line 7 names UV point 3, but there are 2"),
        (f"{OBJ}f 1 2 4294967296\n", "line 4 names vertex 4294967296, but there are 3 vertices"),
        (f"{OBJ}f 1 2 {10**23}\n", "line 4 names vertex 10000000000000000000…, but there are 3"),
        (f"{OBJ}vt\nf 1 2 3\n", "line 4 cannot be read: 'vt'"),
        ("v 1_0 0 0\n", "line 1 cannot be read: 'v 1_0 0 0'"),
        (f"{OBJ}f 1 2 0_3\n", "line 4 cannot be read: 'f 1 2 0_3'"),
        ("v ١ 0 0\n", "line 1 cannot be read: 'v ١ 0 0'"),
    ],
)
def test_a_line_of_obj_that_names_what_there_is_not_is_named(text, said, tmp_path):
    path = tmp_path / "mesh.obj"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(FileError, match=re.escape(said)):
        read_mesh(path)


def test_uv_points_that_no_polygon_can_use_are_no_error(tmp_path):
    """Files name them without having any, or at some polygons only: then there are no UVs."""
    for lines in ("f 1/7 2/7 3/7", "vt 0 0\nf 1/7 2/7 3/7\nf 1 2 3"):
        (tmp_path / "mesh.obj").write_text(f"{OBJ}{lines}\n")
        assert read_mesh(tmp_path / "mesh.obj").uv is None


def test_numbers_are_read_as_other_tools_read_them(tmp_path):
    files = {
        "a.off": f"OFF 3 1 0 {POINTS.replace('1 0 0', '1_0 0 0')} 3 0 1 2",
        "a.ply": ply(points=POINTS.replace("1 0 0", "1_0 0 0")),
        "b.ply": ply("3 0 1 0_2\n"),
        "a.vtk": vtk("POLYGONS 1 4\n3 0 1 0_2\n"),
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
        with pytest.raises(FileError, match="_"):
            read_mesh(tmp_path / name)
    (tmp_path / "a.csv").write_text("1\n1_0\n")
    with pytest.raises(FileError, match="line 2 is no row of numbers"):
        read_values(tmp_path / "a.csv")


def test_indices_of_uvs_are_checked_in_arrays_too(tmp_path):
    vertices, faces = meshes.octahedron()
    bad = np.full((8, 3), 9)
    np.savez(tmp_path / "a.npz", vertices=vertices, faces=faces, uv=np.zeros((2, 2)), uv_faces=bad)
    np.savez(tmp_path / "b.npz", vertices=vertices, faces=faces, uv=np.zeros((2, 2)), uv_faces=bad[:3])
    np.savez(tmp_path / "c.npz", vertices=vertices, faces=faces + 0.5)
    for name, said in (("a", "face 0 has UV point 9"), ("b", "8 faces have UVs of"), ("c", "whole numbers")):
        with pytest.raises(FileError, match=said):
            read_mesh(tmp_path / f"{name}.npz")
    for name in ("x.obj", "x.ply", "x.npz"):
        with pytest.raises(FileError, match="UV point 9"):
            write_mesh(tmp_path / name, MeshData(vertices, faces, np.zeros((2, 2)), bad))
        assert not (tmp_path / name).exists()
    with pytest.raises(ValueError, match="none of the 6 vertices"):
        MeshData(vertices, faces + 7, np.zeros((6, 2)), faces).split_at_seams()


def test_the_command_names_the_file_and_the_line(run, folder):
    (folder / "uv.obj").write_text(f"{OBJ}vt 0 0\nf 1/9 2/9 3/9\n")
    result = run("measure", "uv.obj")
    assert result.code == 3 and "uv.obj: line 5 names UV point 9" in result.err


def gltf(uri, count=3):
    """A triangle whose coordinates are in the file of a name."""
    corners = base64.b64encode(np.array([0, 1, 2], "u4").tobytes()).decode()
    embedded = f"data:application/octet-stream;base64,{corners}"
    views = [{"buffer": k, "byteOffset": 0, "byteLength": size} for k, size in enumerate((36, 12))]
    return {
        **{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}]},
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"uri": uri, "byteLength": 36}, {"uri": embedded, "byteLength": 12}],
        "bufferViews": views,
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5125, "count": 3, "type": "SCALAR"},
        ],
    }


TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "f4")


def test_a_gltf_file_reads_files_beside_it_only(tmp_path):
    pytest.importorskip("trimesh")
    inner = tmp_path / "inner"
    (inner / "deeper").mkdir(parents=True)
    for place in (tmp_path / "secret.bin", inner / "data 1.bin", inner / "deeper" / "data.bin"):
        place.write_bytes(TRIANGLE.tobytes())
    for name in ("data 1.bin", "data%201.bin"):
        (inner / "mesh.gltf").write_text(json.dumps(gltf(name)))
        assert np.array_equal(read_mesh(inner / "mesh.gltf").vertices, TRIANGLE)
    names = ["../secret.bin", str(tmp_path / "secret.bin"), "deeper/data.bin", "..%2Fsecret.bin", "..", ""]
    names += ["..\\secret.bin", "C:secret.bin", "http://127.0.0.1:9/x", "file:secret.bin", "~/x", "/dev/zero"]
    if os.name == "posix":
        (inner / "link.bin").symlink_to(tmp_path / "secret.bin")
        os.mkfifo(inner / "pipe.bin")
        names += ["link.bin", "pipe.bin"]
    for name in names:
        (inner / "mesh.gltf").write_text(json.dumps(gltf(name)))
        with pytest.raises(FileError, match="it names the file") as caught:
            read_mesh(inner / "mesh.gltf")
        assert "secret.bin: " not in str(caught.value)


def test_a_glb_file_reads_files_beside_it_only(tmp_path):
    pytest.importorskip("trimesh")
    (tmp_path / "secret.bin").write_bytes(TRIANGLE.tobytes())
    (tmp_path / "inner").mkdir()
    text = json.dumps(gltf("../secret.bin")).encode()
    text += b" " * (-len(text) % 4)
    head = b"glTF" + struct.pack("<III", 2, 20 + len(text), len(text)) + b"JSON"
    (tmp_path / "inner" / "mesh.glb").write_bytes(head + text)
    with pytest.raises(FileError, match="it names the file"):
        read_mesh(tmp_path / "inner" / "mesh.glb")


@pytest.mark.parametrize("extension", ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "NONE_such"])
def test_gltf_files_that_require_an_unknown_extension_are_refused_by_its_name(extension, tmp_path):
    pytest.importorskip("trimesh")
    (tmp_path / "data.bin").write_bytes(TRIANGLE.tobytes())
    allowed = ["KHR_materials_unlit", "KHR_texture_transform"]
    for name in ("a.gltf", "a.glb"):
        for required in ([], allowed, [*allowed, extension]):
            text = json.dumps({**gltf("data.bin"), "extensionsRequired": required}).encode()
            text += b" " * (-len(text) % 4)
            head = b"glTF" + struct.pack("<III", 2, 20 + len(text), len(text)) + b"JSON"
            (tmp_path / name).write_bytes(head + text if name == "a.glb" else text)
            if extension in required:
                with pytest.raises(FileError, match=f"requires the extension '{extension}', which is not"):
                    read_mesh(tmp_path / name)
            else:
                assert np.array_equal(read_mesh(tmp_path / name).vertices, TRIANGLE)


def test_what_reads_files_of_strangers_is_tested_in_the_least_version_that_is_allowed():
    project = tomllib.loads((meshes.ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = [line for name in ("io", "neuro") for line in project["optional-dependencies"][name]]
    tested = (meshes.ROOT / "scripts" / "requirements" / "dev.txt").read_text(encoding="utf-8").splitlines()
    for name in ("trimesh", "meshio", "nibabel"):
        [least] = [line.removeprefix(f"{name}>=") for line in extras if line.startswith(name)]
        [version] = [line.removeprefix(f"{name}==") for line in tested if line.startswith(f"{name}==")]
        assert f"{version}.".startswith(f"{least}.")


def test_damaged_stl_is_called_damaged(tmp_path, monkeypatch):
    pytest.importorskip("trimesh")
    for name in ("charset_normalizer", "chardet"):  # which trimesh asks for damaged text
        monkeypatch.setitem(sys.modules, name, None)
    for content in (b"\xff\xfe\x9d\x81" * 50, b"solid x\xff\xfe\x9d" + bytes(range(256))):
        (tmp_path / "a.stl").write_bytes(content)
        with pytest.raises(FileError, match=r"damaged|no triangles") as caught:
            read_mesh(tmp_path / "a.stl")
        assert "module" not in str(caught.value)


def test_a_library_that_is_missing_is_named(tmp_path, monkeypatch):
    trimesh = pytest.importorskip("trimesh")

    def load_mesh(*_, **__):
        import nothing_such  # noqa: F401

    monkeypatch.setattr(trimesh, "load_mesh", load_mesh)
    (tmp_path / "a.stl").write_bytes(b"solid x")
    with pytest.raises(FileError, match=r"it needs a further library .*nothing_such"):
        read_mesh(tmp_path / "a.stl")


ARRAY = (
    "<DataArray Intent='NIFTI_INTENT_{intent}' DataType='NIFTI_TYPE_{kind}' Dimensionality='2' Dim0='{rows}' "
    "ArrayIndexingOrder='RowMajorOrder' Dim1='3' Encoding='{coding}' Endian='LittleEndian' "
    "ExternalFileName='{file}' ExternalFileOffset='0'><Data>{data}</Data></DataArray>"
)


def gifti(coding="GZipBase64Binary", data=b"", rows=3, file=""):
    """A triangle whose coordinates are packed."""
    text = base64.b64encode(zlib.compress(data, 9)).decode() if data else ""
    points = ARRAY.format(intent="POINTSET", kind="FLOAT32", rows=rows, coding=coding, file=file, data=text)
    faces = ARRAY.format(intent="TRIANGLE", kind="INT32", rows=1, coding="ASCII", file="", data="0 1 2")
    return f"<?xml version='1.0'?><GIFTI Version='1.0' NumberOfDataArrays='2'>{points}{faces}</GIFTI>"


def test_gifti_unpacks_to_what_it_states(tmp_path):
    pytest.importorskip("nibabel")
    path = tmp_path / "a.surf.gii"
    path.write_text(gifti(data=TRIANGLE.tobytes()))
    assert np.array_equal(read_mesh(path).vertices, TRIANGLE)
    zeros = bytes(50_000_000)
    for rows, said in ((3, "more than 36 bytes"), (10**9, "12000000000 bytes, packed in"), (-3, "shape")):
        path.write_text(gifti(data=zeros, rows=rows))
        with pytest.raises(FileError, match=said):
            read_mesh(path)


def test_gifti_that_is_packed_as_a_whole_unpacks_to_a_limit(tmp_path, monkeypatch):
    pytest.importorskip("nibabel")
    from authalic.io import gifti as reader

    monkeypatch.setattr(reader, "_MOST_BYTES", 2**20)
    path = tmp_path / "a.surf.gii.gz"
    text = gifti(data=TRIANGLE.tobytes()).encode()
    path.write_bytes(gzip.compress(text[:100]) + gzip.compress(text[100:]) + bytes(8))
    assert np.array_equal(read_mesh(path).vertices, TRIANGLE)
    path.write_bytes(gzip.compress(text + b" " * 2**21))
    with pytest.raises(FileError, match="unpacks to more than 1048576 bytes"):
        read_mesh(path)
    path.write_bytes(gzip.compress(text)[:-30])
    with pytest.raises(FileError, match="ends early"):
        read_mesh(path)


def test_gifti_leads_to_no_other_file(tmp_path):
    pytest.importorskip("nibabel")
    (tmp_path / "secret.bin").write_bytes(TRIANGLE.tobytes())
    for file in ("secret.bin", str(tmp_path / "secret.bin")):
        (tmp_path / "a.surf.gii").write_text(gifti("ExternalFileBinary", file=file))
        with pytest.raises(FileError, match="in a file of their own, which is not read"):
            read_mesh(tmp_path / "a.surf.gii")


@pytest.mark.parametrize(
    ("shape", "kind", "said"),
    [
        ((MANY * 1000, 3), "<f8", "not enough memory for what it states"),
        ((10**30, 3), "<f8", "a number that is too large"),
        ((-1, 3), "<f8", r"negative|\(-1, 3\)"),
        ((1, 3), "|O", "which can run code and are never read"),
    ],
)
def test_arrays_that_cannot_be_are_errors_of_the_file(shape, kind, said, tmp_path):
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as archive:
        archive.writestr("vertices.npy", npy(shape, kind) + bytes(24))
        archive.writestr("faces.npy", npy((1, 3), "<i8") + bytes(24))
    (tmp_path / "a.npy").write_bytes(npy(shape, kind) + bytes(24))
    for read, name in ((read_mesh, "a.npz"), (read_values, "a.npy")):
        with pytest.raises(FileError, match=said) as caught:
            read(tmp_path / name)
        assert "allow_pickle" not in str(caught.value)


def test_archives_without_arrays_say_so(tmp_path):
    np.savez(tmp_path / "a.npz")
    with pytest.raises(FileError, match="it has no arrays"):
        read_values(tmp_path / "a.npz")


@ONLY_POSIX
def test_pipes_are_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.obj")
    with pytest.raises(FileError, match="a device or a pipe"):
        read_mesh(tmp_path / "a.obj")
