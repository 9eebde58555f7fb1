# SPDX-License-Identifier: MIT OR Apache-2.0
"""numpy's files, and text with one row a vertex."""

from pathlib import Path
from typing import Any

import numpy as np

from .._reading import open_numpy
from . import strict_json
from .errors import FileError
from .mesh import MeshData, Reals
from .words import check_plain

_TO_SPACES = str.maketrans(",;\t", "   ")


def read_mesh(path: Path, name: str) -> MeshData:
    """npz with the arrays `vertices` and `faces`, and where there are UVs `uv` and `uv_faces`."""
    with open_numpy(path) as arrays:
        _check_archive(arrays)
        absent = {"vertices", "faces"} - set(arrays)
        if absent:
            raise ValueError(f"it lacks the arrays {sorted(absent)}; it has {sorted(arrays)}")
        return MeshData(arrays["vertices"], arrays["faces"], arrays.get("uv"), arrays.get("uv_faces"))


def write_mesh(path: Path, mesh: MeshData, name: str) -> None:
    """Also the further arrays in the metadata under "arrays", and what is there under "record", as JSON."""
    arrays = {"vertices": mesh.vertices, "faces": mesh.faces, **mesh.metadata.get("arrays", {})}
    if mesh.uv is not None and mesh.uv_faces is not None:
        arrays |= {"uv": mesh.uv, "uv_faces": mesh.uv_faces}
    if "record" in mesh.metadata:
        arrays["record"] = np.array(strict_json.dumps(mesh.metadata["record"]))
    with open(path, "wb") as file:
        np.savez_compressed(file, **arrays)


def read_values(path: Path, name: str) -> Reals:
    if name == "npy":
        with open_numpy(path) as array:
            return np.asarray(array, np.float64)
    if name == "npz":
        return _only_array(path)
    return read_table(path)


def write_values(path: Path, values: Reals, name: str) -> None:
    with open(path, "wb") as file:
        if name == "npy":
            np.save(file, values)
        elif name == "npz":
            np.savez_compressed(file, values=values)
        else:
            rows = values.reshape(len(values), -1).tolist()
            file.write("".join(",".join(map(repr, row)) + "\n" for row in rows).encode())


def read_table(path: Path) -> Reals:
    """Rows of numbers between commas, semicolons, tabs or spaces, below at most one line of words."""
    rows: list[list[float]] = []
    is_first = True
    for number, line in enumerate(path.read_text(encoding="utf-8-sig").splitlines(), start=1):
        words = line.translate(_TO_SPACES).split()
        try:
            check_plain(words)
            row = [float(word) for word in words]
        except ValueError as error:
            if not is_first:
                raise FileError(path, f"line {number} is no row of numbers: {line.strip()[:60]!r}") from error
            row = []  # the line of words
        is_first = is_first and not words
        if row and rows and len(row) != len(rows[0]):
            raise FileError(path, f"line {number} has {len(row)} numbers, those before have {len(rows[0])}")
        if row:
            rows.append(row)
    table = np.array(rows, np.float64)
    return table[:, 0] if table.ndim == 2 and table.shape[1] == 1 else table


def _check_archive(found: Any) -> None:
    if not isinstance(found, np.lib.npyio.NpzFile):
        raise ValueError("it holds one array, as npy files do, and is no npz")


def _only_array(path: Path) -> Reals:
    with open_numpy(path) as arrays:
        _check_archive(arrays)
        if len(arrays) == 0:
            raise ValueError("it has no arrays")
        name = "values" if "values" in arrays else next(iter(arrays))
        if name != "values" and len(arrays) > 1:
            raise ValueError(f"it has several arrays and none named values: {sorted(arrays)}")
        return np.asarray(arrays[name], np.float64)
