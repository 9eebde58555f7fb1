# SPDX-License-Identifier: MIT OR Apache-2.0
"""A surface with a boundary onto the disk or a rectangle, and flat maps into files."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .._native import disk_map
from ..io import Format, MeshData, Outputs, mesh_format, value_format
from ..io.files import save_mesh, save_values
from .record import Progress, Record, areal_distortion, given, map_figures, read_input
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
    # 1. The formats, before work starts
    options = given(options or {})
    format = mesh_format(target, output_format)
    areal_format = None if areal is None else value_format(areal)
    # 2. The map
    mesh, record = read_input(source, input_format, "disk", options)
    result = disk_map(mesh.vertices, mesh.faces, **options, progress=progress)
    record |= map_figures(result) | repair_figures(result.repaired)
    mesh = repaired_mesh(mesh, result.repaired)
    # 3. The files
    flat = MeshData(mesh.vertices, mesh.faces, result.uv, mesh.faces, mesh.metadata)
    with Outputs() as outputs:
        save_flat(outputs.add(target), flat, format, record)
        record["output"] = str(target)
        if areal is not None and areal_format is not None:
            values = areal_distortion(mesh.vertices, mesh.faces, result.uv)
            save_values(outputs.add(areal), values, areal_format)
            record["areal_distortion"] = str(areal)
    return record


def save_flat(path: Path, mesh: MeshData, format: Format, record: Record) -> None:
    """The surface with its UVs, or the UVs at z = 0 as a mesh of their own where the format has no UVs."""
    metadata = dict(mesh.metadata) | {"record": dict(record)}
    if format.uv is not None or mesh.uv is None or mesh.uv_faces is None:
        save_mesh(path, MeshData(mesh.vertices, mesh.faces, mesh.uv, mesh.uv_faces, metadata), format)
    else:
        points = np.column_stack([mesh.uv, np.zeros(len(mesh.uv))])
        save_mesh(path, MeshData(points, mesh.uv_faces, metadata=metadata), format)
