# SPDX-License-Identifier: MIT OR Apache-2.0
"""The table of formats, and which of them a file has."""

from pathlib import Path
from typing import Literal, NamedTuple

from .errors import FileError


class Format(NamedTuple):
    """A format of files.

    Parameters
    ----------
    name : str
        Its name as an option.
    suffixes : tuple of str
        The ends of its files' names. FreeSurfer's files have none.
    module : str
        The module of this package that reads and writes it.
    uv : "corner", "vertex" or None
        How UVs are stored, if at all.
    precision : "float64" or "float32"
        Of the coordinates.
    bytes_per_vertex : int
        About how large a file is.
    """

    name: str
    suffixes: tuple[str, ...]
    module: str
    uv: Literal["corner", "vertex"] | None = None
    precision: Literal["float64", "float32"] = "float64"
    bytes_per_vertex: int = 80


MESH_FORMATS = (
    Format("obj", (".obj",), "obj", "corner", bytes_per_vertex=100),
    Format("ply", (".ply",), "ply", "vertex", bytes_per_vertex=50),
    Format("stl", (".stl",), "trimesh_formats", None, "float32", bytes_per_vertex=100),
    Format("off", (".off",), "off"),
    Format("glb", (".glb",), "trimesh_formats", "vertex", "float32", bytes_per_vertex=40),
    Format("gltf", (".gltf",), "trimesh_formats", "vertex", "float32", bytes_per_vertex=55),
    Format("vtk", (".vtk",), "vtk", "vertex"),
    Format("vtu", (".vtu",), "meshio_formats", "vertex", bytes_per_vertex=60),
    Format("npz", (".npz",), "arrays", "corner", bytes_per_vertex=60),
    Format("gifti", (".surf.gii", ".surf.gii.gz", ".gii", ".gii.gz"), "gifti", None, "float32", 20),
    Format("freesurfer", (), "freesurfer", None, "float32", bytes_per_vertex=36),
)
"""Formats of meshes."""

VALUE_FORMATS = (
    Format("gifti", (".shape.gii", ".func.gii", ".gii", ".gii.gz"), "gifti", None, "float32"),
    Format("npy", (".npy",), "arrays"),
    Format("npz", (".npz",), "arrays"),
    Format("csv", (".csv", ".txt", ".tsv"), "arrays"),
    Format("freesurfer", (), "freesurfer", None, "float32"),
)
"""Formats of values, one for each vertex."""

_HEMISPHERES = ("lh.", "rh.")


def mesh_format(path: str | Path, name: str | None = None) -> Format:
    """The format of a mesh file, by name or by the file's name.

    Parameters
    ----------
    path : str or Path
        The file. Names like `lh.white` are FreeSurfer's.
    name : str, optional
        The name of a format, which then decides.

    Returns
    -------
    Format
        One of `MESH_FORMATS`.

    Raises
    ------
    FileError
        If neither says which of `MESH_FORMATS` it is.

    Examples
    --------
    >>> from authalic.io import mesh_format
    >>> mesh_format("bunny.obj").name
    'obj'
    >>> mesh_format("lh.white").name
    'freesurfer'
    """
    return _format(path, name, MESH_FORMATS, "a mesh")


def value_format(path: str | Path, name: str | None = None) -> Format:
    """The format of a file with values, one for each vertex.

    Parameters
    ----------
    path : str or Path
        The file.
    name : str, optional
        The name of a format, which then decides.

    Returns
    -------
    Format
        One of `VALUE_FORMATS`.

    Raises
    ------
    FileError
        If neither says which of `VALUE_FORMATS` it is.

    Examples
    --------
    >>> from authalic.io import value_format
    >>> value_format("lh.sulc").name
    'freesurfer'
    >>> value_format("area.shape.gii").name
    'gifti'
    """
    return _format(path, name, VALUE_FORMATS, "per-vertex values")


def is_mesh_file(path: Path) -> bool:
    """Whether the name of a file says that it is a mesh in a known format. FreeSurfer's names do not."""
    name = path.name.lower()
    if name.endswith((".shape.gii", ".func.gii", ".label.gii")):
        return False
    return any(name.endswith(format.suffixes) for format in MESH_FORMATS if format.suffixes)


def _format(path: str | Path, name: str | None, formats: tuple[Format, ...], what: str) -> Format:
    if name is not None:
        for format in formats:
            if format.name == name:
                return format
        raise FileError(path, f"{name} is no format of {what}; there are {_listed(formats)}")
    file = Path(path).name.lower()
    for format in formats:
        if format.suffixes and file.endswith(format.suffixes):
            return format
    if file.startswith(_HEMISPHERES):
        return formats[-1]
    raise FileError(
        path,
        f"the name does not say which format of {what} the file has: rename it or name a format "
        f"({_listed(formats)})",
    )


def _listed(formats: tuple[Format, ...]) -> str:
    return ", ".join(format.name for format in formats)
