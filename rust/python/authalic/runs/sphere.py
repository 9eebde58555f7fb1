# SPDX-License-Identifier: MIT OR Apache-2.0
"""A closed surface onto the sphere."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .._native import sphere_map
from ..io import MeshData, Outputs, mesh_format
from ..io.files import save_mesh
from .areal import ArealFile
from .record import Progress, Record, folds_in_file, given, map_figures, map_metadata, read_input
from .repair import repair_figures, repaired_mesh

FREESURFER_RADIUS = 100.0


def sphere_run(
    source: Path,
    target: Path,
    *,
    areal: Path | None = None,
    radius: float | None = None,
    input_format: str | None = None,
    output_format: str | None = None,
    options: Mapping[str, Any] | None = None,
    progress: Progress = None,
) -> Record:
    """Maps a surface onto the sphere.

    Parameters
    ----------
    source, target : Path
        The surface, and the file for the sphere: its vertices in the surface's order, its faces unchanged.
    areal : Path, optional
        The file for log₂ of each vertex's areal distortion.
    radius : float, optional
        Of the sphere. Default: 100 in FreeSurfer's and GIFTI's files, else 1.
    input_format, output_format : str, optional
        Names of formats where the files' names do not say them.
    options : mapping, optional
        Arguments of `authalic.sphere_map`.
    progress : callable, optional
        As for `authalic.sphere_map`.

    Returns
    -------
    dict
        The record of the run.
    """
    # 1. What is to be written, before work starts
    options = given(options or {})
    format = mesh_format(target, output_format)
    outputs = Outputs()
    place, areal_file = outputs.add(target), ArealFile(areal, outputs)
    # 2. The map
    mesh, record = read_input(source, input_format, "sphere", options)
    result = sphere_map(mesh.vertices, mesh.faces, **options, progress=progress)
    record |= map_figures(result) | repair_figures(result.repaired)
    mesh = repaired_mesh(mesh, result.repaired)
    # 3. The sphere as the file holds it
    radius = radius or (FREESURFER_RADIUS if format.name in ("freesurfer", "gifti") else 1.0)
    points = radius * result.positions
    record |= {"radius": radius} | folds_in_file(mesh.vertices, mesh.faces, points, format)
    # 4. The files
    with outputs:
        metadata = map_metadata(mesh, "Spherical") | {"record": dict(record)}
        save_mesh(place, MeshData(points, mesh.faces, metadata=metadata), format)
        record |= {"output": str(target)} | areal_file.save(mesh.vertices, mesh.faces, result.positions)
    return record
