# SPDX-License-Identifier: MIT OR Apache-2.0
"""Meshes and per-vertex values from files and into files.

Vertices and faces keep the order that they have in the file, and nothing is merged. A file is written beside
its place and renamed, so that it is whole or not there. OBJ, PLY, OFF, npz, FreeSurfer and tables need numpy
alone; the other formats need an extra, which the error names: `authalic[io]` (STL, GLB, glTF, VTK, VTU)
or `authalic[neuro]` (GIFTI).

>>> import authalic.io, tempfile, pathlib
>>> path = pathlib.Path(tempfile.mkdtemp()) / "triangle.obj"
>>> mesh = authalic.io.MeshData([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
>>> authalic.io.write_mesh(path, mesh)
>>> authalic.io.read_mesh(path).faces
array([[0, 1, 2]])
"""

from .atomic import Outputs
from .errors import FileError, MissingExtra
from .files import read_mesh, read_values, write_mesh, write_values
from .formats import MESH_FORMATS, VALUE_FORMATS, Format, mesh_format, value_format
from .mesh import MeshData

__all__ = [
    "MESH_FORMATS",
    "VALUE_FORMATS",
    "FileError",
    "Format",
    "MeshData",
    "MissingExtra",
    "Outputs",
    "mesh_format",
    "read_mesh",
    "read_values",
    "value_format",
    "write_mesh",
    "write_values",
]
