# SPDX-License-Identifier: MIT OR Apache-2.0
"""GIFTI by nibabel: surfaces (.surf.gii) and per-vertex values (.shape.gii)."""

import base64
import gzip
import math
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from .errors import require
from .mesh import MeshData, Reals

_POINTS, _TRIANGLES, _SHAPE = "NIFTI_INTENT_POINTSET", "NIFTI_INTENT_TRIANGLE", "NIFTI_INTENT_SHAPE"

_MOST_BYTES, _MOST_TIMES = 2**28, 20
"""What is packed may unpack to so many bytes, or to so many times its own; surfaces unpack to a few times."""


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
        content = _unpacked(content, zlib.MAX_WBITS | 16, _limit(content), "the file")
    parser = _bounded_parser()()
    parser.parse(string=content)
    return parser.img


def _bounded_parser() -> type:
    """nibabel's parser, which looks at each array before it is unpacked."""
    parent: Any = _gifti().GiftiImage.parser

    class Parser(parent):  # type: ignore[misc]
        def flush_chardata(self) -> None:
            if self.write_to == "Data":
                _check_array(self.da, self._char_blocks or [])
            super().flush_chardata()

    return Parser


def _check_array(array: Any, pieces: list[str]) -> None:
    """Refuses numbers in another file, and packed ones that are not as many as the array states."""
    util = require("nibabel.gifti.util", "GIFTI", "neuro")
    types = require("nibabel.nifti1", "GIFTI", "neuro").data_type_codes
    encoding = util.gifti_encoding_codes.label[array.encoding]
    if encoding == "External":
        raise ValueError("its numbers are in a file of their own, which is not read")
    if min(array.dims, default=0) < 0:
        raise ValueError(f"it states an array of the shape {tuple(array.dims)}")
    if encoding == "B64GZ":
        packed = base64.b64decode("".join(pieces).encode("ascii"))
        expected = math.prod(array.dims) * types.dtype[array.datatype].itemsize
        if expected > _limit(packed):
            raise ValueError(f"it states an array of {expected} bytes, packed in {len(packed)}")
        _unpacked(packed, zlib.MAX_WBITS, expected, f"an array of the shape {tuple(array.dims)}")


def _limit(packed: bytes) -> int:
    return max(_MOST_BYTES, _MOST_TIMES * len(packed))


def _unpacked(packed: bytes, kind: int, limit: int, what: str) -> bytes:
    """What was packed, in one part or more, if it is no longer than a limit."""
    parts, size = [], 0
    while packed:
        unpacker = zlib.decompressobj(kind)
        part = unpacker.decompress(packed, limit - size + 1)
        parts.append(part)
        size += len(part)
        if size > limit:
            raise ValueError(f"{what} unpacks to more than {limit} bytes")
        if not unpacker.eof:
            raise ValueError(f"{what} is packed and ends early")
        packed = unpacker.unused_data.lstrip(b"\0")
    return b"".join(parts)


def _save(path: Path, image: Any) -> None:
    content = image.to_bytes()
    path.write_bytes(gzip.compress(content) if path.name.endswith(".gz") else content)
