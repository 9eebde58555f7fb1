# SPDX-License-Identifier: MIT OR Apache-2.0
"""Every format's way into a file and back, and what the files of other tools are like."""

import gzip
import os

import numpy as np
import pytest
from api import meshes

from authalic.io import (
    MESH_FORMATS,
    FileError,
    MeshData,
    mesh_format,
    read_mesh,
    read_values,
    write_mesh,
    write_values,
)

MESH_NAMES = {
    **{format.name: f"surface{format.suffixes[0]}" for format in MESH_FORMATS if format.suffixes},
    "freesurfer": "lh.white",
    "gifti, zipped": "surface.surf.gii.gz",
}
VALUE_NAMES = [
    "area.shape.gii",
    "area.func.gii",
    "lh.area",
    "area.npy",
    "area.npz",
    "area.csv",
    "area.shape.gii.gz",
]
SINGLE = {"stl", "glb", "gltf", "gifti", "gifti, zipped", "freesurfer"}


def scrambled(mesh, seed=5):
    """Vertices and faces in some order that no reader would come to by itself."""
    chance = np.random.default_rng(seed)
    order, rows = chance.permutation(len(mesh.vertices)), chance.permutation(len(mesh.faces))
    return mesh.vertices[order] * 17 + 3, np.argsort(order)[mesh.faces[rows]]


@pytest.mark.parametrize("name", [name for name in MESH_NAMES if name != "stl"])
def test_vertices_and_faces_come_back_in_their_order(name, tmp_path):
    vertices, faces = scrambled(meshes.bumpy_cap())
    write_mesh(tmp_path / MESH_NAMES[name], MeshData(vertices, faces))
    mesh = read_mesh(tmp_path / MESH_NAMES[name])
    expected = vertices.astype(np.float32) if name in SINGLE else vertices
    assert np.array_equal(mesh.vertices, expected)
    assert np.array_equal(mesh.faces, faces)
    assert mesh.vertices.dtype == np.float64 and mesh.faces.dtype == np.int64


@pytest.mark.parametrize("name", [name for name in MESH_NAMES if name != "stl"])
def test_points_that_coincide_or_have_no_face_stay(name, tmp_path):
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [7, 7, 7]])
    faces = np.array([[3, 5, 4], [0, 1, 2]])
    write_mesh(tmp_path / MESH_NAMES[name], MeshData(vertices, faces))
    mesh = read_mesh(tmp_path / MESH_NAMES[name])
    assert np.array_equal(mesh.vertices, vertices) and np.array_equal(mesh.faces, faces)


def test_the_triangles_of_stl_stay_apart(tmp_path):
    vertices, faces = scrambled(meshes.octahedron())
    write_mesh(tmp_path / "surface.stl", MeshData(vertices, faces))
    mesh = read_mesh(tmp_path / "surface.stl")
    assert np.array_equal(mesh.faces, np.arange(3 * len(faces)).reshape(-1, 3))
    assert np.array_equal(mesh.vertices, vertices[faces].reshape(-1, 3).astype(np.float32))


@pytest.mark.parametrize("name", [format.name for format in MESH_FORMATS if format.uv])
def test_uvs_come_back_at_every_corner(name, tmp_path):
    """One seam: two of the square's corners have two UV points each."""
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]])
    faces, uv_faces = np.array([[0, 1, 2], [0, 2, 3]]), np.array([[4, 0, 1], [2, 3, 5]])
    uv = np.array([[0.25, 0], [0.25, 0.5], [0.5, 0], [0.5, 0.75], [0, 0], [1, 1]])
    path = tmp_path / MESH_NAMES[name]
    write_mesh(path, MeshData(vertices, faces, uv, uv_faces))
    mesh = read_mesh(path)
    assert np.allclose(mesh.vertices[mesh.faces], vertices[faces], atol=1e-7)
    assert np.allclose(mesh.uv[mesh.uv_faces], uv[uv_faces], atol=1e-7)
    if mesh_format(path).uv == "corner":
        assert np.array_equal(mesh.faces, faces) and np.array_equal(mesh.uv_faces, uv_faces)
    else:
        assert len(mesh.vertices) == 6


def test_polygons_of_obj_become_fans_in_their_order(tmp_path):
    path = tmp_path / "polygons.obj"
    path.write_text(
        "# a comment\nmtllib none.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\nv 2 2 2\n"
        "vt 0 0\nvt 1 0 0\nvt 1 1\nvt 0 1\nvn 0 0 1\ns 1\n"
        "f 1/1/1 2/2/1 5/3/1\nf 1/1 2/2 \\\n3/3 4/4\nf -4/-3 -3/-2 -1/-1\n"
    )
    mesh = read_mesh(path)
    assert mesh.faces.tolist() == [[0, 1, 4], [0, 1, 2], [0, 2, 3], [1, 2, 4]]
    assert mesh.uv_faces.tolist() == [[0, 1, 2], [0, 1, 2], [0, 2, 3], [1, 2, 3]]


def test_lines_of_obj_may_be_set_in_and_have_tabs(tmp_path):
    path = tmp_path / "tabs.obj"
    path.write_bytes(
        b"o one\r\n  v 0 0 0\r\nv\t1 0 0\r\nv 0 1 0\r\nvt 1\r\no two\r\n\tf\t1/1 2/1 3/1\r\nf -3 -1 -2 \r\n"
    )
    mesh = read_mesh(path)
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 1]] and mesh.uv is None


@pytest.mark.parametrize("line", ["v 0 0", "v 0 0 x", "f 0 1 2", "f -4 1 2", "f 1 2 c", "f 1/9x 2/1 3/1"])
def test_a_bad_line_of_obj_is_named(line, tmp_path):
    path = tmp_path / "bad.obj"
    path.write_text(f"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n{line}\nf 1 2 3\n")
    with pytest.raises(FileError, match=f"line 5 cannot be read: '{line}'"):
        read_mesh(path)


def test_polygons_of_ply_become_fans_in_their_order(tmp_path):
    path = tmp_path / "polygons.ply"
    points = "0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1 0 255\n2 2 2 255\n"
    path.write_text(
        "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nelement face 3\nproperty list uchar int vertex_indices\n"
        f"end_header\n{points}3 0 1 4\n4 0 1 2 3\n3 1 2 4\n"
    )
    assert read_mesh(path).faces.tolist() == [[0, 1, 4], [0, 1, 2], [0, 2, 3], [1, 2, 4]]


def test_polygons_and_colors_of_off(tmp_path):
    path = tmp_path / "polygons.off"
    path.write_text(
        "OFF\n# by hand\n4 2 0\n0 0 0\n1 0 0 # here\n1 1 0\n0 1 0\n\n3 0 1 3 255 0 0\n4 0 1 2 3\n"
    )
    assert read_mesh(path).faces.tolist() == [[0, 1, 3], [0, 1, 2], [0, 2, 3]]


POLYDATA = """# vtk DataFile Version 4.2
vtk output
{coding}
DATASET POLYDATA
POINTS 4 float
"""


def test_vtk_polydata_in_ascii(tmp_path):
    path = tmp_path / "surface.vtk"
    path.write_text(
        POLYDATA.format(coding="ASCII")
        + "0 0 0 1 0 0 1 1 0\n0 1 0\nLINES 1 3\n2 0 1\nPOLYGONS 2 9\n3 0 1 3\n4 0 1 2 3\nPOINT_DATA 4\n"
    )
    mesh = read_mesh(path)
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert mesh.faces.tolist() == [[0, 1, 3], [0, 1, 2], [0, 2, 3]]


def test_vtk_polydata_in_binary_of_old_and_new_versions(tmp_path):
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], ">f4").tobytes()
    head = POLYDATA.format(coding="BINARY").encode() + points + b"\nMETADATA\nINFORMATION 0\n\n"
    old = b"POLYGONS 2 8\n" + np.array([3, 0, 1, 2, 3, 0, 2, 3], ">i4").tobytes() + b"\n"
    new = b"POLYGONS 3 6\nOFFSETS vtktypeint64\n" + np.array([0, 3, 6], ">i8").tobytes()
    new += b"\nCONNECTIVITY vtktypeint64\n" + np.array([0, 1, 2, 0, 2, 3], ">i8").tobytes() + b"\n"
    for polygons in (old, new):
        (tmp_path / "surface.vtk").write_bytes(head + polygons)
        mesh = read_mesh(tmp_path / "surface.vtk")
        assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]] and mesh.vertices[2].tolist() == [1, 1, 0]


@pytest.mark.parametrize("name", VALUE_NAMES)
def test_values_come_back(name, tmp_path):
    values = np.random.default_rng(2).normal(size=30)
    write_values(tmp_path / name, values)
    single = name.startswith("lh.") or ".gii" in name
    assert np.array_equal(read_values(tmp_path / name), values.astype(np.float32) if single else values)


@pytest.mark.parametrize("name", ["v.shape.gii", "v.npy", "v.csv"])
def test_several_columns_of_values_come_back(name, tmp_path):
    values = np.arange(12.0).reshape(4, 3)
    write_values(tmp_path / name, values)
    assert np.array_equal(read_values(tmp_path / name), values)
    with pytest.raises(FileError, match="one column"):
        write_values(tmp_path / "lh.area", values)


def test_a_table_may_have_a_head_and_any_separator(tmp_path):
    (tmp_path / "v.txt").write_text("\ufefffirst;second\n1;2\n3\t4\n\n5 6\n", encoding="utf-8")
    assert read_values(tmp_path / "v.txt").tolist() == [[1, 2], [3, 4], [5, 6]]


def test_freesurfer_keeps_the_volume_and_writes_the_same_file_twice(tmp_path):
    nibabel_io = pytest.importorskip("nibabel.freesurfer.io")
    mesh = meshes.octahedron()
    volume = {
        **{"head": np.array([2, 0, 20]), "valid": "1  # volume info valid", "filename": "orig.mgz"},
        **{"volume": np.array([256, 256, 256]), "voxelsize": np.ones(3), "xras": np.array([-1.0, 0, 0])},
        **{"yras": np.array([0.0, 0, -1]), "zras": np.array([0.0, 1, 0]), "cras": np.array([5.0, 6, 7])},
    }
    nibabel_io.write_geometry(str(tmp_path / "lh.white"), mesh.vertices, mesh.faces, volume_info=volume)
    for name in ("lh.copy", "lh.again"):
        write_mesh(tmp_path / name, read_mesh(tmp_path / "lh.white"))
    kept = nibabel_io.read_geometry(str(tmp_path / "lh.copy"), read_metadata=True)[2]
    assert np.array_equal(kept["cras"], [5, 6, 7]) and kept["filename"] == "orig.mgz"
    assert (tmp_path / "lh.copy").read_bytes() == (tmp_path / "lh.again").read_bytes()


def test_gifti_keeps_what_the_points_are(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    gifti = nibabel.gifti
    mesh = meshes.octahedron()
    meta = gifti.GiftiMetaData({"AnatomicalStructurePrimary": "CortexLeft"})
    points = gifti.GiftiDataArray(mesh.vertices.astype("f4"), "NIFTI_INTENT_POINTSET", meta=meta)
    faces = gifti.GiftiDataArray(mesh.faces.astype("i4"), "NIFTI_INTENT_TRIANGLE")
    nibabel.save(gifti.GiftiImage(darrays=[points, faces]), tmp_path / "a.surf.gii")
    write_mesh(tmp_path / "b.surf.gii", read_mesh(tmp_path / "a.surf.gii"))
    image = nibabel.load(tmp_path / "b.surf.gii")
    assert dict(image.darrays[0].meta) == {"AnatomicalStructurePrimary": "CortexLeft"}
    assert np.array_equal(image.agg_data("triangle"), mesh.faces)


@pytest.mark.parametrize("encoding", ["ASCII", "B64BIN", "B64GZ"])
def test_gifti_in_every_encoding_and_order(encoding, tmp_path):
    """Arrays in columns, triangles before points, and a transform, which is kept and not applied."""
    nibabel = pytest.importorskip("nibabel")
    gifti = nibabel.gifti
    mesh = meshes.octahedron()
    space = gifti.GiftiCoordSystem(xform=np.diag([2.0, 3, 4, 1]))
    options = {"encoding": f"GIFTI_ENCODING_{encoding}", "ordering": "ColumnMajorOrder"}
    points = gifti.GiftiDataArray(
        mesh.vertices.astype("f4"), "NIFTI_INTENT_POINTSET", coordsys=space, **options
    )
    faces = gifti.GiftiDataArray(mesh.faces.astype("i4"), "NIFTI_INTENT_TRIANGLE", **options)
    nibabel.save(gifti.GiftiImage(darrays=[faces, points]), tmp_path / "a.surf.gii")
    found = read_mesh(tmp_path / "a.surf.gii")
    assert np.array_equal(found.vertices, mesh.vertices) and np.array_equal(found.faces, mesh.faces)
    write_mesh(tmp_path / "b.surf.gii", found)
    [kept] = nibabel.load(tmp_path / "b.surf.gii").get_arrays_from_intent("NIFTI_INTENT_POINTSET")
    assert np.array_equal(kept.coordsys.xform, np.diag([2.0, 3, 4, 1]))


@pytest.mark.parametrize("name", MESH_NAMES)
def test_a_damaged_file_is_named_as_such(name, tmp_path):
    path = tmp_path / MESH_NAMES[name]
    vertices, faces = meshes.octahedron()
    write_mesh(path, MeshData(vertices, faces))
    content = path.read_bytes()
    for damaged in (b"", b"what is this\n", content[: len(content) // 3]):
        path.write_bytes(damaged)
        with pytest.raises((FileError, OSError)) as caught:
            mesh = read_mesh(path)
            # a text file cut off between two lines is a smaller mesh that lacks vertices
            assert mesh.faces.max(initial=0) < len(mesh.vertices)
            raise FileError(path, f"{path}: it ends early")
        assert str(path) in str(caught.value)


@pytest.mark.parametrize("name", [*MESH_NAMES.values(), *VALUE_NAMES])
def test_an_empty_file_is_called_empty(name, tmp_path):
    (tmp_path / name).touch()
    for read in (read_mesh, read_values):
        with pytest.raises(FileError, match=r"the file is empty|which format of"):
            read(tmp_path / name)


def test_names_say_formats(tmp_path):
    assert mesh_format("a/lh.white").name == "freesurfer"
    assert mesh_format("lh.white.surf.gii").name == "gifti"
    assert mesh_format("SHOUT.OBJ").name == "obj"
    assert mesh_format("whatever", "vtu").name == "vtu"
    with pytest.raises(FileError, match=r"rename it or name a format \(obj, ply"):
        mesh_format("surface.xyz")
    with pytest.raises(FileError, match="jpg is no format"):
        mesh_format("surface.obj", "jpg")


def test_a_file_of_values_is_no_surface_and_the_other_way_round(tmp_path):
    write_values(tmp_path / "a.shape.gii", np.ones(6))
    write_mesh(tmp_path / "a.surf.gii", MeshData(*meshes.octahedron()))
    with pytest.raises(FileError, match="is it a file of values"):
        read_mesh(tmp_path / "a.shape.gii")
    with pytest.raises(FileError, match="is it a surface"):
        read_values(tmp_path / "a.surf.gii")
    (tmp_path / "z.obj").write_bytes(gzip.compress(b"v 0 0 0"))
    with pytest.raises(FileError, match="no triangles"):
        read_mesh(tmp_path / "z.obj")


def test_files_appear_together_or_not_at_all(tmp_path):
    from authalic.io import Outputs

    (tmp_path / "old.txt").write_text("old")
    with pytest.raises(KeyboardInterrupt), Outputs() as outputs:
        outputs.add(tmp_path / "old.txt").write_text("new")
        outputs.add(tmp_path / "other.txt").write_text("new")
        raise KeyboardInterrupt
    assert [path.name for path in tmp_path.iterdir()] == ["old.txt"]
    assert (tmp_path / "old.txt").read_text(encoding="utf-8") == "old"
    with Outputs() as outputs:
        outputs.add(tmp_path / "old.txt").write_text("new")
        assert (tmp_path / "old.txt").read_text(encoding="utf-8") == "old"
    assert (tmp_path / "old.txt").read_text(encoding="utf-8") == "new" and len(list(tmp_path.iterdir())) == 1


def test_files_that_cannot_be_written_are_refused_before_there_is_anything_to_write(tmp_path):
    from authalic.io import Outputs

    outputs = Outputs()
    outputs.add(tmp_path / "a.npz")
    with pytest.raises(FileError, match="two results"):
        outputs.add(tmp_path / "nowhere" / ".." / "a.npz")
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        outputs.add(tmp_path / "nowhere" / "a.npz")
    with pytest.raises(IsADirectoryError, match="is a folder"):
        outputs.add(tmp_path)


def test_names_may_be_as_long_as_the_system_allows(tmp_path):
    longest = 258 - len(str(tmp_path)) if os.name == "nt" else 255  # Windows counts the whole path
    path = tmp_path / "x.obj".rjust(longest, "n")
    write_mesh(path, MeshData(*meshes.octahedron()))
    assert len(read_mesh(path).faces) == 8 and len(list(tmp_path.iterdir())) == 1


def test_freesurfers_old_formats_are_read_by_nibabel(tmp_path):
    """A quad file: 3-byte integers, coordinates in hundredths; and an old curv file."""
    pytest.importorskip("nibabel")

    def three(*numbers):
        return b"".join(int(number).to_bytes(3, "big") for number in numbers)

    points = np.array([[0, 0, 0], [100, 0, 0], [100, 100, 0], [0, 100, 0]], ">i2")
    (tmp_path / "lh.old").write_bytes(b"\xff\xff\xff" + three(4, 1) + points.tobytes() + three(0, 1, 2, 3))
    mesh = read_mesh(tmp_path / "lh.old")
    assert mesh.vertices.tolist() == (points / 100).tolist() and len(mesh.faces) == 2
    values = np.array([150, -25], ">i2")
    (tmp_path / "lh.oldcurv").write_bytes(three(2, 0) + values.tobytes())
    assert read_values(tmp_path / "lh.oldcurv").tolist() == [1.5, -0.25]


def test_values_that_a_curv_file_cannot_hold_are_refused(tmp_path):
    with pytest.raises(FileError, match="single precision"):
        write_values(tmp_path / "lh.area", [1e39, 0])


def ply(element, rows, coding="binary_little_endian"):
    """An octahedron's corners and faces; `element` has further properties of the faces."""
    order = ">" if "big" in coding else "<"
    vertices = np.zeros(6, [("xyz", order + "f4", 3), ("color", "u1", 4)])
    vertices["xyz"] = meshes.octahedron().vertices
    head = (
        f"ply\nformat {coding} 1.0\ncomment by hand\nelement vertex 6\n"
        "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
        f"property uchar blue\nproperty uchar alpha\nelement face 8\n{element}end_header\n"
    )
    return head.encode() + vertices.tobytes() + rows


def test_ply_with_further_properties_of_faces(tmp_path):
    """As MeshLab writes it: UVs at the corners and colors, after the corners and before them."""
    faces = meshes.octahedron().faces
    uv = np.random.default_rng(3).random((8, 6)).astype("f4")
    for order, coding in (("<", "binary_little_endian"), (">", "binary_big_endian")):
        kinds = [
            ("n", "u1"),
            ("corners", order + "i4", 3),
            ("k", "u1"),
            ("uv", order + "f4", 6),
            ("red", "u1"),
        ]
        rows = np.zeros(8, kinds)
        rows["n"], rows["k"], rows["corners"], rows["uv"], rows["red"] = 3, 6, faces, uv, 200
        element = (
            "property list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty uchar red\n"
        )
        (tmp_path / "a.ply").write_bytes(ply(element, rows.tobytes(), coding))
        mesh = read_mesh(tmp_path / "a.ply")
        assert np.array_equal(mesh.vertices, meshes.octahedron().vertices)
        assert np.array_equal(mesh.faces, faces)
        assert np.array_equal(mesh.uv[mesh.uv_faces].reshape(8, 6), uv)


def test_binary_ply_with_polygons_of_several_sizes(tmp_path):
    rows = b"".join(
        bytes([len(polygon)]) + np.array(polygon, "<u2").tobytes() + bytes([7])
        for polygon in ([0, 1, 2], [1, 3, 4, 2], [0, 1, 5], *[[3, 4, 5]] * 5)
    )
    element = "property list uchar ushort vertex_index\nproperty uchar flags\n"
    (tmp_path / "a.ply").write_bytes(ply(element, rows))
    faces = read_mesh(tmp_path / "a.ply").faces.tolist()
    assert faces == [[0, 1, 2], [1, 3, 4], [1, 4, 2], [0, 1, 5], *[[3, 4, 5]] * 5]


def test_our_ply_is_read_by_other_libraries(tmp_path):
    trimesh, mesh = pytest.importorskip("trimesh"), meshes.bumpy_cap()
    write_mesh(tmp_path / "a.ply", MeshData(*mesh))
    theirs = trimesh.load_mesh(tmp_path / "a.ply", process=False)
    assert np.array_equal(theirs.vertices, mesh.vertices) and np.array_equal(theirs.faces, mesh.faces)
    theirs = pytest.importorskip("meshio").read(tmp_path / "a.ply")
    assert np.array_equal(theirs.points, mesh.vertices) and np.array_equal(theirs.cells[0].data, mesh.faces)


def test_off_with_colors_of_vertices(tmp_path):
    (tmp_path / "a.off").write_text("COFF\n3 1 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2\n")
    mesh = read_mesh(tmp_path / "a.off")
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]] and mesh.faces.tolist() == [[0, 1, 2]]
