# SPDX-License-Identifier: MIT OR Apache-2.0
"""The areal distortion of vertices, and the file for it."""

from pathlib import Path

import numpy as np

from ..io import Outputs, value_format
from ..io.files import save_values
from .record import Record


class ArealFile:
    """The file that a run may be asked to write areal distortions into.

    Parameters
    ----------
    path : Path or None
        The file, if it is asked for.
    outputs : Outputs
        The files of the run.
    """

    def __init__(self, path: Path | None, outputs: Outputs) -> None:
        self._path = path
        if path is not None:
            self._format = value_format(path)
            self._place = outputs.add(path)

    def save(self, vertices: np.ndarray, faces: np.ndarray, image: np.ndarray) -> Record:
        """Writes log₂ of each vertex's areal distortion, if asked for; returns what the record says of it."""
        if self._path is None:
            return {}
        save_values(self._place, areal_distortion(vertices, faces, image), self._format)
        return {"areal_distortion": str(self._path)}


def areal_distortion(vertices: np.ndarray, faces: np.ndarray, image: np.ndarray) -> np.ndarray:
    """log₂ of each vertex's share of the image's area over its share of the surface's, (n,).

    The area of a vertex is a third of that of its faces. 0 is preserved, 1 is twice as large, −∞ is nothing.
    """
    shares = []
    for points in (vertices, image):
        areas = _vertex_areas(np.asarray(points, np.float64), faces)
        shares.append(areas / areas.sum())
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.log2(shares[1] / shares[0]))


def _vertex_areas(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    a, b, c = (points[faces[:, k]] for k in range(3))
    if points.shape[1] == 2:
        doubled = np.abs(np.linalg.det(np.stack([b - a, c - a], axis=2)))
    else:
        doubled = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return np.bincount(faces.ravel(), np.repeat(doubled / 6, 3), minlength=len(points))
