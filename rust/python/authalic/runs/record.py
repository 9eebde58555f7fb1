# SPDX-License-Identifier: MIT OR Apache-2.0
"""The record of a run: what was read, by which version and options, and the figures of the result."""

import hashlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .._native import Distortion, __version__
from ..io import MeshData, read_mesh

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
        "options": {key: value for key, value in options.items() if value is not None},
        "vertices": len(mesh.vertices),
        "faces": len(mesh.faces),
    }
    return mesh, record


def map_figures(result: Any) -> Record:
    """Status, iterations, seconds and distortion of a map."""
    figures = {
        "status": result.status,
        "iterations": int(result.iterations),
        "seconds": float(result.seconds),
    }
    return figures | distortion_figures(result.distortion)


def distortion_figures(distortion: Distortion) -> Record:
    return {
        "authalic_energy": float(distortion.authalic_energy),
        "area_ratio_std": float(distortion.area_ratio_std),
        "angle_distortion_mean": float(distortion.angle_distortion_mean),
        "angle_distortion_p99": float(distortion.angle_distortion_p99),
        "angle_distortion_max": float(distortion.angle_distortion_max),
        "folded": len(distortion.folded),
    }


def given(options: Mapping[str, Any]) -> dict[str, Any]:
    """The options that are not None, so that the library's own defaults stay."""
    return {key: value for key, value in options.items() if value is not None}


def problem(error: Exception) -> Record:
    """The data of an error of the library."""
    fields = ("kind", "side", "curve", "second_curve", "indices", "count")
    data = {key: getattr(error, key, None) for key in fields}
    return {"message": str(error)} | {key: value for key, value in data.items() if value is not None}


def areal_distortion(vertices: np.ndarray, faces: np.ndarray, image: np.ndarray) -> np.ndarray:
    """log₂ of each vertex's share of the image's area over its share of the surface's, (n,).

    The area of a vertex is a third of that of its faces. 0 is preserved, 1 is twice as large.
    """
    shares = []
    for points in (vertices, image):
        areas = _vertex_areas(np.asarray(points, np.float64), faces)
        shares.append(areas / areas.sum())
    return np.asarray(np.log2(shares[1] / shares[0]))


def _vertex_areas(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    a, b, c = (points[faces[:, k]] for k in range(3))
    if points.shape[1] == 2:
        doubled = np.abs(np.linalg.det(np.stack([b - a, c - a], axis=2)))
    else:
        doubled = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return np.bincount(faces.ravel(), np.repeat(doubled / 6, 3), minlength=len(points))
