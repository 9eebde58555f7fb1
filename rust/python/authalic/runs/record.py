# SPDX-License-Identifier: MIT OR Apache-2.0
"""The record of a run: what was read, by which version and options, and the figures of the result."""

import hashlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .._native import Distortion, __version__, distortion
from ..io import Format, MeshData, read_mesh

Record = dict[str, Any]
Progress = Callable[[float, str], bool | None] | None


def read_input(
    path: Path, format: str | None, command: str, options: Mapping[str, Any]
) -> tuple[MeshData, Record]:
    """A mesh, and the beginning of the record of a run on it."""
    mesh = read_mesh(path, format)
    record = {
        "command": command,
        "input": str(path),
        "input_sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
        "authalic": __version__,
        "options": given(options),
        "vertices": len(mesh.vertices),
        "faces": len(mesh.faces),
    }
    return mesh, record


def map_metadata(mesh: MeshData, geometry: str) -> dict[str, Any]:
    """What a surface's file says beside its arrays, as it is true of a map.

    GIFTI names the kind of geometry ("Spherical", "Flat"). Its transform is for the place of the surface.
    """
    kept = {key: value for key, value in mesh.metadata.items() if key != "gifti_space"}
    if "gifti" in kept:
        of_surface = ("AnatomicalStructureSecondary", "GeometricType")
        facts = {key: value for key, value in kept["gifti"].items() if key not in of_surface}
        kept["gifti"] = facts | {"GeometricType": geometry}
    return kept


def map_figures(result: Any) -> Record:
    """Status, iterations, seconds and distortion of a map."""
    figures = {
        "status": result.status,
        "iterations": int(result.iterations),
        "seconds": float(result.seconds),
    }
    return figures | distortion_figures(result.distortion)


def distortion_figures(figures: Distortion) -> Record:
    return {
        "authalic_energy": float(figures.authalic_energy),
        "area_ratio_std": float(figures.area_ratio_std),
        "angle_distortion_mean": float(figures.angle_distortion_mean),
        "angle_distortion_p99": float(figures.angle_distortion_p99),
        "angle_distortion_max": float(figures.angle_distortion_max),
        "folded": len(figures.folded),
    }


def folds_in_file(vertices: np.ndarray, faces: np.ndarray, image: np.ndarray, format: Format) -> Record:
    """How many faces of a map fold when it is rounded to the precision of its file."""
    if format.precision == "float64":
        return {}
    rounded = image.astype(np.float32).astype(np.float64)
    return {"folded_in_file": len(distortion(vertices, faces, rounded).folded)}


def given(options: Mapping[str, Any]) -> dict[str, Any]:
    """The options that are not None, so that the library's own defaults stay."""
    return {key: value for key, value in options.items() if value is not None}


def problem(error: Exception) -> Record:
    """The data of an error of the library."""
    fields = ("kind", "side", "curve", "second_curve", "indices", "count")
    data = {key: getattr(error, key, None) for key in fields}
    return {"message": str(error)} | {key: value for key, value in data.items() if value is not None}
