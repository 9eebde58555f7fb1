# SPDX-License-Identifier: MIT OR Apache-2.0
"""What a mesh file holds."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._reading import there_is

Reals = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(eq=False)
class MeshData:
    """A triangle mesh as in a file, unchecked: `authalic.Surface(mesh.vertices, mesh.faces)` checks it.

    Parameters
    ----------
    vertices : (n, 3) real array
        Positions.
    faces : (m, 3) int array
        Triangles.
    uv : (k, 2) real array, optional
        Points of a UV map.
    uv_faces : (m, 3) int array, optional
        The UV point of each corner. Default: `faces`, which is right with one point for each vertex.
    metadata : mapping, optional
        What the format's family of files keeps beside the arrays, e.g. FreeSurfer's volume geometry. It is
        written again into files of the same family.

    Examples
    --------
    >>> from authalic.io import MeshData
    >>> MeshData([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).vertices.dtype
    dtype('float64')
    """

    vertices: Reals
    faces: Indices
    uv: Reals | None = None
    uv_faces: Indices | None = None
    metadata: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.vertices = _rows(self.vertices, 3, np.float64)
        self.faces = _rows(self.faces, 3, np.int64)
        if self.uv is not None:
            self.uv = _rows(self.uv, 2, np.float64)
            self.uv_faces = self.faces if self.uv_faces is None else _rows(self.uv_faces, 3, np.int64)

    def split_at_seams(self) -> "MeshData":
        """The mesh with one UV point for each vertex, for formats that know no other UVs.

        Returns
        -------
        MeshData
            Vertices on seams occur once for each UV point. The mesh itself if no vertex has two points.

        Examples
        --------
        >>> from authalic.io import MeshData
        >>> vertices, uv = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 0], [1, 0], [0, 1], [2, 2]]
        >>> faces, uv_faces = [[0, 1, 2], [1, 3, 2]], [[0, 1, 2], [3, 1, 0]]
        >>> mesh = MeshData(vertices, faces, uv, uv_faces)
        >>> mesh.split_at_seams().vertices.shape
        (6, 3)
        """
        if self.uv is None or self.uv_faces is None or np.array_equal(self.faces, self.uv_faces):
            return self
        if problem := self.uv_problem():
            raise ValueError(problem)
        if not _are_within(self.faces, len(self.vertices)):
            raise ValueError(f"faces have corners that are none of the {len(self.vertices)} vertices")
        corners = np.stack([self.faces.ravel(), self.uv_faces.ravel()], axis=1)
        pairs, of_corner = np.unique(corners, axis=0, return_inverse=True)
        faces = of_corner.reshape(-1, 3)
        return MeshData(self.vertices[pairs[:, 0]], faces, self.uv[pairs[:, 1]], faces, self.metadata)

    def uv_problem(self) -> str | None:
        """What is wrong with the UVs, if anything.

        Returns
        -------
        str or None
            Words on their shapes, or on the first corner whose UV point there is not.

        Examples
        --------
        >>> from authalic.io import MeshData
        >>> vertices, uv = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0]]
        >>> MeshData(vertices, [[0, 1, 2]], uv, [[0, 0, 8]]).uv_problem()
        'face 0 has UV point 8 at a corner, but there is 1 UV point, counted from 0'
        """
        if self.uv is None or self.uv_faces is None:
            return None
        if self.uv.shape[1:] != (2,):
            return f"its UVs have the shape {self.uv.shape}, but they are pairs of numbers"
        if self.uv_faces.shape != self.faces.shape:
            return f"its {len(self.faces)} faces have UVs of the shape {self.uv_faces.shape}"
        bad = (self.uv_faces < 0) | (self.uv_faces >= len(self.uv))
        if not bad.any():
            return None
        face, corner = np.argwhere(bad)[0]
        point, there = self.uv_faces[face, corner], there_is(len(self.uv), "UV point", "UV points")
        return f"face {face} has UV point {point} at a corner, but {there}, counted from 0"


_UV_COLUMNS = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"), ("texture_s", "texture_t"))


def uv_of_columns(columns: Mapping[str, Any]) -> Reals | None:
    """UVs among the columns of vertices, by the names that they mostly have."""
    for first, second in _UV_COLUMNS:
        if first in columns and second in columns:
            return np.column_stack([columns[first], columns[second]]).astype(np.float64)
    return None


def fans(polygons: list[list[int]]) -> Indices:
    """The triangles of polygons, in their order, each a fan around its first corner."""
    triangles = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    try:
        return np.array(triangles, np.int64).reshape(-1, 3)
    except OverflowError as error:
        raise ValueError("a corner of a polygon has a number beyond those of any vertex, 2⁶³") from error


def _rows(values: ArrayLike, width: int, dtype: type) -> NDArray[Any]:
    given = np.asarray(values)
    if dtype is np.int64 and given.dtype.kind == "f" and not np.all(given % 1 == 0):
        raise ValueError("the corners of faces are whole numbers, but there are others among them")
    array: NDArray[Any] = np.ascontiguousarray(given, dtype)
    return array.reshape(-1, width) if array.size == 0 else array


def _are_within(indices: Indices, count: int) -> bool:
    return indices.size == 0 or (int(indices.min()) >= 0 and int(indices.max()) < count)
