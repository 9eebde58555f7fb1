# SPDX-License-Identifier: MIT OR Apache-2.0
"""FreeSurfer's triangle files and curv files.

The two formats are headers and big-endian arrays, so that nibabel, whose import takes longer than reading, is
needed for files of old formats alone. What follows the arrays of a surface, such as the volume's geometry, is
kept as it is.
"""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from .errors import FileError, require
from .mesh import MeshData, Reals

_TRIANGLES, _CURV = b"\xff\xff\xfe", b"\xff\xff\xff"
_STAMP = b"created by authalic\n\n"
"""Without user and time, so that one result is one file."""
_LIMIT = float(np.finfo(np.float32).max)


def read_mesh(path: Path, name: str) -> MeshData:
    """Geometry. A line that says who made the file and an empty line come before the counts."""
    content = path.read_bytes()
    if not content.startswith(_TRIANGLES):
        return _read_old_mesh(path)
    place = content.find(b"\n", content.find(b"\n") + 1) + 1
    if place == 0 or place + 8 > len(content):
        raise ValueError("it ends before the numbers of its vertices and faces")
    n, m = np.frombuffer(content, ">i4", 2, place).tolist()
    faces_at, end = place + 8 + 12 * n, place + 8 + 12 * (n + m)
    if min(n, m) < 0 or end > len(content):
        raise ValueError(f"{n} vertices and {m} faces take {end} bytes, but there are {len(content)}")
    vertices = np.frombuffer(content, ">f4", 3 * n, place + 8).reshape(-1, 3)
    faces = np.frombuffer(content, ">i4", 3 * m, faces_at).reshape(-1, 3)
    return MeshData(vertices, faces, metadata={"freesurfer": content[end:]})


def write_mesh(path: Path, mesh: MeshData, name: str) -> None:
    counts = np.array([len(mesh.vertices), len(mesh.faces)], ">i4")
    arrays = counts, mesh.vertices.astype(">f4"), mesh.faces.astype(">i4")
    tags = mesh.metadata.get("freesurfer", b"")
    path.write_bytes(_TRIANGLES + _STAMP + b"".join(array.tobytes() for array in arrays) + tags)


def read_values(path: Path, name: str) -> Reals:
    """A curv file: the numbers of vertices, of faces and of values per vertex, and the values."""
    content = path.read_bytes()
    if not content.startswith(_CURV):
        return np.asarray(_nibabel().read_morph_data(str(path)), np.float64)
    if len(content) < 15:
        raise ValueError("it ends before the number of its values")
    n, _, columns = np.frombuffer(content, ">i4", 3, 3).tolist()
    if columns != 1 or n < 0 or 15 + 4 * n > len(content):
        raise ValueError(f"{n} vertices with {columns} values do not fit into {len(content)} bytes")
    return np.frombuffer(content, ">f4", n, 15).astype(np.float64)


def write_values(path: Path, values: Reals, name: str) -> None:
    if values.size and values.size != len(values):
        raise FileError(path, f"FreeSurfer's curv files hold one column, but there are {values.shape[1]}")
    if np.abs(values).max(initial=0) > _LIMIT:
        raise FileError(path, "FreeSurfer's curv files hold single precision, which a value exceeds")
    counts = np.array([len(values), 0, 1], ">i4")
    path.write_bytes(_CURV + counts.tobytes() + values.ravel().astype(">f4").tobytes())


def _read_old_mesh(path: Path) -> MeshData:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        vertices, faces = _nibabel().read_geometry(str(path))
    return MeshData(vertices, faces)


def _nibabel() -> Any:
    return require("nibabel.freesurfer.io", "FreeSurfer's files of old formats", "neuro")
