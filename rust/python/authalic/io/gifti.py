# SPDX-License-Identifier: MIT OR Apache-2.0
"""GIFTI by nibabel: surfaces (.surf.gii) and per-vertex values (.shape.gii)."""

import gzip
from pathlib import Path
from typing import Any

import numpy as np

from .errors import require
from .mesh import MeshData, Reals

_POINTS, _TRIANGLES, _SHAPE = "NIFTI_INTENT_POINTSET", "NIFTI_INTENT_TRIANGLE", "NIFTI_INTENT_SHAPE"


def read_mesh(path: Path, name: str) -> MeshData:
    """The first array of points and the first of triangles, with the metadata of the points."""
    image = _load(path)
    points, triangles = (image.get_arrays_from_intent(intent) for intent in (_POINTS, _TRIANGLES))
    if not points or not triangles:
        raise ValueError("it has no surface; is it a file of values?")
    metadata = {"gifti": dict(points[0].meta), "gifti_space": points[0].coordsys}
    return MeshData(points[0].data, triangles[0].data, metadata=metadata)


def write_mesh(path: Path, mesh: MeshData, name: str) -> None:
    gifti = _gifti()
    meta = gifti.GiftiMetaData(mesh.metadata.get("gifti", {}))
    points = gifti.GiftiDataArray(
        mesh.vertices.astype(np.float32),
        _POINTS,
        "NIFTI_TYPE_FLOAT32",
        coordsys=mesh.metadata.get("gifti_space"),
        meta=meta,
    )
    faces = gifti.GiftiDataArray(mesh.faces.astype(np.int32), _TRIANGLES, "NIFTI_TYPE_INT32")
    _save(path, gifti.GiftiImage(darrays=[points, faces]))


def read_values(path: Path, name: str) -> Reals:
    """One column for each array of the file that is not of a surface."""
    arrays = [array for array in _load(path).darrays if array.intent not in _surface_codes()]
    if not arrays:
        raise ValueError("it has no values; is it a surface?")
    columns = [np.asarray(array.data, np.float64) for array in arrays]
    return columns[0] if len(columns) == 1 else np.stack(columns, axis=1)


def write_values(path: Path, values: Reals, name: str) -> None:
    gifti = _gifti()
    columns = values.astype(np.float32).reshape(len(values), -1).T
    arrays = [gifti.GiftiDataArray(column, _SHAPE, "NIFTI_TYPE_FLOAT32") for column in columns]
    _save(path, gifti.GiftiImage(darrays=arrays))


def _gifti() -> Any:
    return require("nibabel.gifti", "GIFTI", "neuro")


def _surface_codes() -> set[int]:
    codes = require("nibabel.nifti1", "GIFTI", "neuro").intent_codes
    return {codes.code[intent] for intent in (_POINTS, _TRIANGLES)}


def _load(path: Path) -> Any:
    content = path.read_bytes()
    if content[:2] == b"\x1f\x8b":
        content = gzip.decompress(content)
    return _gifti().GiftiImage.from_bytes(content)


def _save(path: Path, image: Any) -> None:
    content = image.to_bytes()
    path.write_bytes(gzip.compress(content) if path.name.endswith(".gz") else content)
