# SPDX-License-Identifier: MIT OR Apache-2.0
"""A surface with a boundary onto the disk or a rectangle, and flat maps into files."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from .._native import disk_map
from ..io import Format, MeshData, Outputs, mesh_format
from ..io.files import save_mesh
from .areal import ArealFile
from .record import Progress, Record, folds_in_file, given, map_figures, map_metadata, read_input
from .repair import repair_figures, repaired_mesh


def disk_run(
    source: Path,
    target: Path,
    *,
    areal: Path | None = None,
    input_format: str | None = None,
    output_format: str | None = None,
    options: Mapping[str, Any] | None = None,
    progress: Progress = None,
) -> Record:
    """Maps a surface with a boundary flat; else as `sphere_run`.

    The file holds the surface with the map as its UVs, or, in a format without UVs, the map itself at z = 0.
    """
    # 1. What is to be written, before work starts
    options = given(options or {})
    format = mesh_format(target, output_format)
    outputs = Outputs()
    place, areal_file = outputs.add(target), ArealFile(areal, outputs)
    # 2. The map
    mesh, record = read_input(source, input_format, "disk", options)
    result = disk_map(mesh.vertices, mesh.faces, **options, progress=progress)
    record |= map_figures(result) | repair_figures(result.repaired)
    mesh = repaired_mesh(mesh, result.repaired)
    record |= folds_in_file(mesh.vertices, mesh.faces, result.uv, format)
    # 3. The files
    with outputs:
        flat = MeshData(mesh.vertices, mesh.faces, result.uv, mesh.faces, mesh.metadata)
        save_flat(place, flat, format, record)
        record |= {"output": str(target)} | areal_file.save(mesh.vertices, mesh.faces, result.uv)
    return record


def save_flat(path: Path, mesh: MeshData, format: Format, record: Record) -> None:
    """The surface with its UVs, or the UVs at z = 0 as a mesh of their own where the format has no UVs."""
    if format.uv is None and mesh.uv is not None and mesh.uv_faces is not None:
        points = np.column_stack([mesh.uv, np.zeros(len(mesh.uv))])
        mesh = MeshData(points, mesh.uv_faces, metadata=map_metadata(mesh, "Flat"))
    save_mesh(path, replace(mesh, metadata={**mesh.metadata, "record": dict(record)}), format)
