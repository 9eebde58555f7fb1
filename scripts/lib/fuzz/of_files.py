# SPDX-License-Identifier: MIT OR Apache-2.0
"""atheris: files of meshes and values with changed bytes and words are read, or refused in few words."""

import contextlib
import re
import sys
import tempfile
from pathlib import Path

import atheris
import numpy as np

with atheris.instrument_imports(include=["authalic"]):
    from authalic import io

    for format in (*io.MESH_FORMATS, *io.VALUE_FORMATS):  # so that its module is imported here
        with contextlib.suppress(ValueError):
            io.read_mesh(__file__, format.name)

FOLDER = Path(tempfile.mkdtemp())
VERTICES = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]])
MESH = io.MeshData(VERTICES, [[0, 1, 2], [0, 2, 3]], VERTICES[:, :2], [[0, 1, 2], [0, 2, 3]])
HEAD = "# vtk DataFile Version 5.1\nx\n{}\nDATASET POLYDATA\nPOINTS 4 float\n"
POINTS = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 2\nproperty list int int vertex_indices\nproperty uchar red\nend_header\n"
)
NUMBERS = np.array([3, 0, 1, 2, 3, 0, 2, 3], ">i4").tobytes()
# Files as our writers do not write them.
OTHERS = {
    "a.ply": f"{PLY}{POINTS}3 0 1 2 9\n4 0 1 2 3 9\n".encode(),
    "b.ply": PLY.replace("ascii", "binary_big_endian").encode() + VERTICES.astype(">f4").tobytes() + NUMBERS,
    "a.off": f"OFF 4 2 0 {POINTS} 3 0 1 2 4 0 1 2 3".encode(),
    "a.vtk": f"{HEAD.format('ASCII')}{POINTS}LINES 1 3\n2 0 1\nPOLYGONS 2 8\n3 0 1 2 3 0 2 3\n".encode(),
    "b.vtk": HEAD.format("BINARY").encode()
    + VERTICES.astype(">f4").tobytes()
    + b"\nPOLYGONS 3 6\nOFFSETS vtktypeint32\n"
    + np.array([0, 3, 6], ">i4").tobytes()
    + b"\nCONNECTIVITY vtktypeint32\n"
    + np.array([0, 1, 2, 0, 2, 3], ">i4").tobytes(),
    "c.vtk": b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 1\n"
    b"ORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 4\n",
    "a.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nf 1/1/1 2/2/1 \\\n 3/1/1\nf -1/-1 -2/-2 -3/-1\n",
    "a.csv": b"x;y\n1;2\n3 4\n",
}
WORDS = tuple(
    word.encode()
    for word in (
        *("-1", "0", "1", "2", "4", "7", "-2147483648", "1000000000000", "9" * 30, "9" * 5000, "1e300"),
        *("nan", "inf", "0.5", "1_0", "x", "", "-1/-9", "1/7/7", "//", "\x00", "list", "uchar", "double"),
        *("element", "POLYGONS", "OFFSETS", "../a.off", "/dev/zero", "http://127.0.0.1:9/x"),
    )
)


def written():
    """Files of all formats, by their names."""
    files = dict(OTHERS)
    names = [format.suffixes[0] if format.suffixes else "white" for format in io.MESH_FORMATS]
    for number, name in enumerate([*names, ".surf.gii.gz"]):
        path = FOLDER / (f"lh.{name}" if name == "white" else f"mesh{number}{name}")
        io.write_mesh(path, MESH)
        files[path.name] = path.read_bytes()
    for name in ("v.npy", "v.npz", "v.shape.gii", "lh.area"):
        io.write_values(FOLDER / name, np.arange(4.0))
        files[name] = (FOLDER / name).read_bytes()
    return files


FILES = written()


@atheris.instrument_func
def changed(data, content):
    """The content with other words, with bytes of another value, twice, or less."""
    kind = data.ConsumeIntInRange(0, 5)
    if kind < 3:
        words = [match.span() for match in re.finditer(rb"[^\s/\"'<>,]+", content)]
        start, end = data.PickValueInList(words) if words else (0, 0)
        return content[:start] + data.PickValueInList(list(WORDS)) + content[end:]
    place = data.ConsumeIntInRange(0, len(content))
    if kind == 3:
        some = data.ConsumeBytes(data.ConsumeIntInRange(0, 8))
        return content[:place] + some + content[place + len(some) :]
    end = data.ConsumeIntInRange(place, len(content))
    return content[:place] + (content[end:] if kind == 4 else content[place:end] + content[place:])


def check(bytes_of_fuzzer):
    data = atheris.FuzzedDataProvider(bytes_of_fuzzer)
    name = data.PickValueInList(sorted(FILES))
    content = FILES[name]
    for _ in range(data.ConsumeIntInRange(0, 4)):
        content = changed(data, content)
    path = FOLDER / f"changed_{name}" if not name.startswith("lh.") else FOLDER / f"lh.changed_{name}"
    path.write_bytes(content)
    is_values = name.startswith(("v.", "lh.area")) or name.endswith(".csv")
    try:
        found = io.read_values(path) if is_values else io.read_mesh(path)
    except io.FileError as error:
        assert len(str(error)) < 1000, "the message is too long"
        assert "allow_pickle" not in str(error), error
        return
    if not is_values:
        assert found.uv_problem() is None and found.faces.ndim == 2
        with contextlib.suppress(ValueError):
            found.split_at_seams()


atheris.Setup(sys.argv, check)
atheris.Fuzz()
