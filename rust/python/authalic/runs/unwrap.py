# SPDX-License-Identifier: MIT OR Apache-2.0
"""Any surface to UVs in the unit square, and its seams alone."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .._native import distortion, seams, unwrap
from ..io import FileError, MeshData, Outputs, mesh_format
from ..io.files import save_mesh
from ..io.obj import append_lines
from .disk import save_flat
from .record import Progress, Record, distortion_figures, folds_in_file, given, read_input

SEAM_FORMATS = ("csv", "npz", "obj")


def unwrap_run(
    source: Path,
    target: Path,
    *,
    input_format: str | None = None,
    output_format: str | None = None,
    options: Mapping[str, Any] | None = None,
    progress: Progress = None,
) -> Record:
    """Unwraps a surface; `options` are arguments of `authalic.unwrap`, else as `disk_run`.

    The figures are those of all other maps, over faces, and `shear` and `shear_p99` are weighted by area.
    """
    options = given(options or {})
    format = mesh_format(target, output_format)
    outputs = Outputs()
    place = outputs.add(target)
    mesh, record = read_input(source, input_format, "unwrap", options)
    found = unwrap((mesh.vertices, mesh.faces), **options, progress=progress)
    record |= {
        **{"status": found.status, "islands": found.islands, "seam_length": found.length},
        **{"shear": found.shear, "shear_p99": found.shear_p99},
        **{"packed": found.packed, "seconds": found.seconds},
    }
    corners = mesh.vertices[found.vertex_of]
    record |= distortion_figures(distortion(corners, found.faces, found.uv))
    record |= folds_in_file(corners, found.faces, found.uv, format)
    with outputs:
        result = MeshData(mesh.vertices, mesh.faces, found.uv, found.faces, mesh.metadata)
        save_flat(place, result, format, record)
    return record | {"output": str(target)}


def seams_run(
    source: Path,
    target: Path,
    *,
    input_format: str | None = None,
    output_format: str | None = None,
    options: Mapping[str, Any] | None = None,
    progress: Progress = None,
) -> Record:
    """Finds seams; `options` are arguments of `authalic.seams`.

    The file has the two vertices of each seam, counted from 0 (csv), the arrays `edges` and `island_of`
    (npz), or the surface with the seams as line elements (obj).
    """
    options = given(options or {})
    format = output_format or target.name.rsplit(".", 1)[-1].lower()
    if format not in SEAM_FORMATS:
        raise FileError(target, f"seams are written as {', '.join(SEAM_FORMATS)}")
    outputs = Outputs()
    path = outputs.add(target)
    mesh, record = read_input(source, input_format, "seams", options)
    found = seams((mesh.vertices, mesh.faces), **options, progress=progress)
    record |= {
        **{"status": found.status, "islands": found.islands, "seams": len(found.edges)},
        **{"seam_length": found.length, "shear_predicted": found.predicted, "seconds": found.seconds},
    }
    with outputs:
        if format == "csv":
            rows = "".join(f"{a},{b}\n" for a, b in found.edges.tolist())
            path.write_text("first,second\n" + rows, encoding="ascii")
        elif format == "npz":
            with open(path, "wb") as file:
                np.savez_compressed(file, edges=found.edges, island_of=found.island_of)
        else:
            save_mesh(path, MeshData(mesh.vertices, mesh.faces), mesh_format(target, format))
            append_lines(path, found.edges)
    return record | {"output": str(target)}
