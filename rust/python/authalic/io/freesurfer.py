# SPDX-License-Identifier: MIT OR Apache-2.0
"""FreeSurfer's geometry and curv files by nibabel."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from .errors import FileError, require
from .mesh import MeshData, Reals

_LIMIT = float(np.finfo(np.float32).max)


def read_mesh(path: Path, name: str) -> MeshData:
    """Geometry, with the volume's where the file has it."""
    with warnings.catch_warnings():
        # not every file has the volume's geometry
        warnings.simplefilter("ignore")
        vertices, faces, volume = _io().read_geometry(str(path), read_metadata=True)
    return MeshData(vertices, faces, metadata={"freesurfer": dict(volume)})


def write_mesh(path: Path, mesh: MeshData, name: str) -> None:
    # nibabel would write user and time, and so never the same file twice
    volume = mesh.metadata.get("freesurfer") or None
    _io().write_geometry(
        str(path), mesh.vertices, mesh.faces, create_stamp="created by authalic", volume_info=volume
    )


def read_values(path: Path, name: str) -> Reals:
    return np.asarray(_io().read_morph_data(str(path)), np.float64)


def write_values(path: Path, values: Reals, name: str) -> None:
    if values.size and values.size != len(values):
        raise FileError(path, f"FreeSurfer's curv files hold one column, but there are {values.shape[1]}")
    if np.abs(values).max(initial=0) > _LIMIT:
        raise FileError(path, "FreeSurfer's curv files hold single precision, which a value exceeds")
    with open(path, "wb") as file:
        _io().write_morph_data(file, values.ravel())


def _io() -> Any:
    return require("nibabel.freesurfer.io", "FreeSurfer's files", "neuro")
