# SPDX-License-Identifier: MIT OR Apache-2.0
"""A closed surface onto the sphere and from there into the plane."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .._native import distortion, sphere_map
from ..io import MeshData, Outputs, mesh_format
from .disk import save_flat
from .record import Progress, Record, distortion_figures, folds_in_file, given, read_input
from .repair import repair_figures, repaired_mesh


def layout_run(
    source: Path,
    target: Path,
    *,
    input_format: str | None = None,
    output_format: str | None = None,
    options: Mapping[str, Any] | None = None,
    layout: Mapping[str, Any] | None = None,
    progress: Progress = None,
) -> Record:
    """Lays a closed surface out flat; `layout` are arguments of `SphereMap.layout`, else as `disk_run`."""
    # 1. What is to be written, before work starts
    options, layout = given(options or {}), given(layout or {})
    format = mesh_format(target, output_format)
    outputs = Outputs()
    place = outputs.add(target)
    # 2. The map, and its layout
    mesh, record = read_input(source, input_format, "layout", {**options, **layout})
    sphere = sphere_map(mesh.vertices, mesh.faces, **options, progress=progress)
    record |= repair_figures(sphere.repaired)
    mesh = repaired_mesh(mesh, sphere.repaired)
    flat = sphere.layout(**layout)
    points, corners = np.asarray(flat.points, np.float64), mesh.vertices[flat.vertex_of]
    record |= {"status": flat.status, "seconds": sphere.seconds + flat.seconds}
    record |= distortion_figures(distortion(corners, flat.faces, points))
    record |= folds_in_file(corners, flat.faces, points, format)
    # 3. The file
    with outputs:
        result = MeshData(mesh.vertices, mesh.faces, points, flat.faces, mesh.metadata)
        save_flat(place, result, format, record)
    return record | {"output": str(target)}
