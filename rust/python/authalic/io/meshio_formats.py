# SPDX-License-Identifier: MIT OR Apache-2.0
"""VTU and VTK by meshio, which keeps double precision and the order of polygons."""

import importlib
from pathlib import Path
from typing import Any

import numpy as np

from .errors import require
from .mesh import Indices, MeshData, fans, uv_of_columns

_POLYGONS = ("triangle", "quad", "polygon")


def read_mesh(path: Path, name: str) -> MeshData:
    """Triangles, quads and polygons in the file's order; cells of other kinds are passed over."""
    found = _module(name).read(str(path))
    points = np.asarray(found.points, np.float64)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    faces = [_triangles(block) for block in found.cells if block.type.startswith(_POLYGONS)]
    return MeshData(
        points, np.vstack(faces) if faces else np.empty((0, 3), int), uv_of_columns(found.point_data)
    )


def write_mesh(path: Path, mesh: MeshData, name: str) -> None:
    meshio = require("meshio", name.upper(), "io")
    columns = {} if mesh.uv is None else {"s": mesh.uv[:, 0].copy(), "t": mesh.uv[:, 1].copy()}
    cells = [("triangle", mesh.faces)]
    _module(name).write(str(path), meshio.Mesh(mesh.vertices, cells, point_data=columns))


def _module(name: str) -> Any:
    require("meshio", name.upper(), "io")
    return importlib.import_module(f"meshio.{name}")


def _triangles(block: Any) -> Indices:
    if block.type == "triangle":
        return np.asarray(block.data, np.int64)
    return fans(np.asarray(block.data).tolist())
