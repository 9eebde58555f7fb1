# SPDX-License-Identifier: MIT OR Apache-2.0
"""One surface onto another, by landmarks, curves or values."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .._native import Registration, Surface, register_disks, register_hyperbolic, register_spheres, repair
from ..io import FileError, MeshData, Outputs, mesh_format, read_mesh, read_values, value_format
from ..io.arrays import read_table
from ..io.files import save_mesh, save_values
from .record import Progress, Record, given, read_input
from .repair import repair_figures, repaired_mesh


def register_run(
    source: Path,
    output: Path,
    *,
    target: Path,
    landmarks: Path | None = None,
    curves: Path | None = None,
    features: tuple[Path, Path] | None = None,
    pull: tuple[Path, Path] | None = None,
    input_format: str | None = None,
    output_format: str | None = None,
    options: Mapping[str, Any] | None = None,
    progress: Progress = None,
) -> Record:
    """Registers a surface to another.

    Parameters
    ----------
    source, target : Path
        The surfaces: both closed, or both with a boundary.
    output : Path
        The file for the source's faces with its vertices at their places on the target. As npz it also has
        `triangles` and `barycentric`, the place of each vertex on the target.
    landmarks : Path, optional
        Text with a vertex of the source and one of the target in each row, counted from 0; with the weight of
        a soft pair in a third column, inf for exact pairs.
    curves : Path, optional
        JSON {"source": [[vertices], …], "target": [[vertices], …]}: a registration by curves.
    features : two Paths, optional
        Values at the vertices of the source and of the target that are laid over each other.
    pull : two Paths, optional
        Values at the vertices of the target, and the file for them at the vertices of the source.
    input_format, output_format : str, optional
        Names of formats where the files' names do not say them.
    options : mapping, optional
        Arguments of the function of the library.
    progress : callable, optional
        As for the library.

    Returns
    -------
    dict
        The record of the run.
    """
    # 1. Everything is read before work starts
    options = given(options or {})
    format = mesh_format(output, output_format)
    outputs = Outputs()
    place = outputs.add(output)
    mesh, record = read_input(source, input_format, "register", options)
    other = read_mesh(target, input_format)
    pulled = None if pull is None else (read_values(pull[0]), outputs.add(pull[1]), value_format(pull[1]))
    if features is not None:
        options["features"] = tuple(map(read_values, features))
    if pull is not None and pulled is not None:
        _check_rows(pull[0], pulled[0], other)
    # 2. The registration
    found = _register(mesh, other, landmarks, curves, options, progress)
    record |= repair_figures(found.source_repaired)
    record |= _figures(found) | {"target": str(target), "target_vertices": len(other.vertices)}
    # 3. The files
    with outputs:
        arrays = {"triangles": found.triangles, "barycentric": found.barycentric}
        metadata = dict(other.metadata) | {"record": dict(record), "arrays": arrays}
        faces = repaired_mesh(mesh, found.source_repaired).faces
        save_mesh(place, MeshData(found.positions, faces, metadata=metadata), format)
        if pull is not None and pulled is not None:
            values, pulled_place, pulled_format = pulled
            if found.target_repaired is not None:
                values = found.target_repaired.carry(values, per="vertex")
            save_values(pulled_place, found.pull(values), pulled_format)
            record["pulled"] = str(pull[1])
    return record | {"output": str(output)}


def _register(
    source: MeshData,
    target: MeshData,
    landmarks: Path | None,
    curves: Path | None,
    options: dict[str, Any],
    progress: Progress,
) -> Registration:
    arrays = [(mesh.vertices, mesh.faces) for mesh in (source, target)]
    surfaces: list[Any] = arrays if options.get("repair") else [Surface(*each) for each in arrays]
    if curves is not None:
        pair = _curves(curves)
        options |= {f"{side}_curves": pair[side] for side in ("source", "target")}
        return register_hyperbolic(*surfaces, **options, progress=progress)
    is_closed = _is_closed(surfaces[0]) or (bool(options.get("fill_holes")) and _is_closed(surfaces[1]))
    if landmarks is not None or not is_closed:
        pairs, weights = (np.empty((0, 2), int), None) if landmarks is None else _pairs(landmarks)
        options |= {"source_landmarks": pairs[:, 0], "target_landmarks": pairs[:, 1]}
        options |= given({"weights": weights})
    register = register_spheres if is_closed else register_disks
    return register(*surfaces, **options, progress=progress)


def _check_rows(path: Path, values: np.ndarray, mesh: MeshData) -> None:
    """Values are those of vertices or, in the order of the faces, of corners."""
    if len(values) not in (len(mesh.vertices), len(mesh.faces)):
        raise FileError(path, f"it has {len(values)} rows, but the target has {len(mesh.vertices)} vertices")


def _curves(path: Path) -> dict[str, Any]:
    try:
        pair = json.loads(path.read_text(encoding="utf-8-sig"))
    except ValueError as error:
        raise FileError(path, f"it is no JSON: {error}") from error
    if not isinstance(pair, dict) or not {"source", "target"} <= pair.keys():
        raise FileError(path, 'it must hold {"source": [[vertices], …], "target": [[vertices], …]}')
    return pair


def _is_closed(surface: Surface | tuple[np.ndarray, np.ndarray]) -> bool:
    """Whether a surface is closed, after its repair where it is yet to be repaired."""
    checked = surface if isinstance(surface, Surface) else repair(*surface, keep="largest").surface
    return checked.is_closed


def _pairs(path: Path) -> tuple[np.ndarray, np.ndarray | None]:
    """The pairs, and their weights where there is a third column."""
    rows = read_table(path)
    if rows.ndim != 2 or rows.shape[1] not in (2, 3) or (rows[:, :2] != rows[:, :2].round()).any():
        raise FileError(
            path,
            "each row must have a vertex of the source and one of the target, counted from 0, and may have a "
            "weight",
        )
    return rows[:, :2].astype(np.int64), rows[:, 2] if rows.shape[1] == 3 else None


def _figures(found: Registration) -> Record:
    strain = found.strain
    figures = {
        **{"status": found.status, "iterations": int(found.iterations), "seconds": float(found.seconds)},
        **{"strain_mean": strain.mean, "strain_median": strain.median, "strain_p95": strain.p95},
        "folded": len(found.distortion.folded),
        "missed": found.missed.tolist(),
        "warnings": [str(warning) for warning in found.warnings],
    }
    if len(found.landmark_error):
        figures["landmark_error_max"] = float(np.max(found.landmark_error))
    return figures
