# SPDX-License-Identifier: MIT OR Apache-2.0
"""Reading and writing by format."""

import importlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._reading import check_regular, words
from .atomic import Outputs
from .errors import FileError, MissingExtra
from .formats import Format, mesh_format, value_format
from .mesh import MeshData, Reals


def read_mesh(path: str | Path, format: str | None = None) -> MeshData:
    """Read a mesh. Polygons are cut into fans; nothing is merged, dropped or put into another order.

    Parameters
    ----------
    path : str or Path
        The file.
    format : str, optional
        The name of one of `MESH_FORMATS`. Default: by the file's name.

    Returns
    -------
    MeshData
        Vertices, faces and, where the file has them, UVs.

    Raises
    ------
    FileError
        If the file does not hold a mesh in this format.
    MissingExtra
        If the format needs an extra.
    OSError
        If the file cannot be opened.

    Examples
    --------
    >>> import authalic.io, pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "square.off"
    >>> _ = path.write_text("OFF 4 1 0  0 0 0  1 0 0  1 1 0  0 1 0  4 0 1 2 3")
    >>> authalic.io.read_mesh(path).faces.tolist()
    [[0, 1, 2], [0, 2, 3]]
    """
    chosen = mesh_format(path, format)
    mesh = _reading(path, chosen, "read_mesh")
    if not isinstance(mesh, MeshData) or mesh.vertices.ndim != 2 or mesh.faces.ndim != 2:
        raise FileError(path, "the file has no arrays of vertices and triangles")
    if len(mesh.faces) == 0:
        raise FileError(path, "the file has no triangles")
    if problem := mesh.uv_problem():
        raise FileError(path, problem)
    return mesh


def write_mesh(path: str | Path, mesh: MeshData, format: str | None = None) -> None:
    """Write a mesh. The file appears whole or not at all.

    Parameters
    ----------
    path : str or Path
        The file, in an existing folder.
    mesh : MeshData
        The mesh. Where the format holds one UV point for each vertex, vertices on seams occur several times.
        A format without UVs leaves them out.
    format : str, optional
        As in `read_mesh`.

    Raises
    ------
    FileError, MissingExtra, OSError
        As in `read_mesh`.

    Examples
    --------
    >>> import authalic.io, pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "triangle.npz"
    >>> authalic.io.write_mesh(path, authalic.io.MeshData([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    >>> path.exists()
    True
    """
    if problem := mesh.uv_problem():
        raise FileError(path, problem)
    with Outputs() as outputs:
        save_mesh(outputs.add(path), mesh, mesh_format(path, format))


def read_values(path: str | Path, format: str | None = None) -> Reals:
    """Read values, one for each vertex.

    Parameters
    ----------
    path : str or Path
        GIFTI, FreeSurfer's curv files, npy, npz, or text (one row a vertex).
    format : str, optional
        The name of one of `VALUE_FORMATS`. Default: by the file's name.

    Returns
    -------
    (n,) or (n, k) float64 array
        The values.

    Raises
    ------
    FileError, MissingExtra, OSError
        As in `read_mesh`.

    Examples
    --------
    >>> import authalic.io, pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "height.csv"
    >>> authalic.io.write_values(path, [1.5, 2.0])
    >>> authalic.io.read_values(path)
    array([1.5, 2. ])
    """
    values = _reading(path, value_format(path, format), "read_values")
    return np.ascontiguousarray(values, np.float64)


def write_values(path: str | Path, values: ArrayLike, format: str | None = None) -> None:
    """Write values, one for each vertex. The file appears whole or not at all.

    Parameters
    ----------
    path : str or Path
        The file, in an existing folder.
    values : (n,) or (n, k) real array
        FreeSurfer's curv files hold one column.
    format : str, optional
        As in `read_values`.

    Raises
    ------
    FileError, MissingExtra, OSError
        As in `read_mesh`.

    Examples
    --------
    >>> import authalic.io, pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "height.npy"
    >>> authalic.io.write_values(path, [1.5, 2.0])
    >>> path.exists()
    True
    """
    with Outputs() as outputs:
        save_values(outputs.add(path), np.asarray(values, np.float64), value_format(path, format))


def save_mesh(path: Path, mesh: MeshData, format: Format) -> None:
    """Writes a mesh to a path whose name need not say the format."""
    module = importlib.import_module(f".{format.module}", __package__)
    module.write_mesh(path, mesh.split_at_seams() if format.uv == "vertex" else mesh, format.name)


def save_values(path: Path, values: Reals, format: Format) -> None:
    """Writes values to a path whose name need not say the format."""
    module = importlib.import_module(f".{format.module}", __package__)
    module.write_values(path, values, format.name)


def _reading(path: str | Path, format: Format, function: str) -> Any:
    """What a format's function returns, with every fault of the file as FileError."""
    module = importlib.import_module(f".{format.module}", __package__)
    if Path(path).exists():
        try:
            check_regular(path)
        except ValueError as error:
            raise FileError(path, str(error)) from None
    with open(path, "rb") as file:
        if not file.read(1):
            raise FileError(path, "the file is empty")
    try:
        return getattr(module, function)(Path(path), format.name)
    except (MissingExtra, FileError):
        raise
    except Exception as error:  # libraries raise what they like for a damaged file
        raise FileError(path, f"the file cannot be read as {format.name}: {words(error)}") from error
