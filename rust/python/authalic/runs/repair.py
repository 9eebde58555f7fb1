# SPDX-License-Identifier: MIT OR Apache-2.0
"""Any triangles to a surface that can be mapped."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .._native import Repaired, repair
from ..io import MeshData, Outputs, mesh_format
from ..io.files import save_mesh
from .record import Progress, Record, given, read_input


def repair_run(
    source: Path,
    target: Path,
    *,
    input_format: str | None = None,
    output_format: str | None = None,
    options: Mapping[str, Any] | None = None,
    progress: Progress = None,
) -> Record:
    """Repairs a mesh; `options` are arguments of `authalic.repair`, else as `sphere_run`.

    As npz the file also has `vertex_of`, `face_of`, `vertex_to` and `face_to`, which lead from and to the
    elements of the source. A repair takes too little time for progress.
    """
    options = dict(options or {})
    format = mesh_format(target, output_format)
    outputs = Outputs()
    place = outputs.add(target)
    mesh, record = read_input(source, input_format, "repair", given(options))
    found = repair(mesh.vertices, mesh.faces, **options)
    record |= repair_figures(found)
    with outputs:
        names = ("vertex_of", "face_of", "vertex_to", "face_to")
        arrays = {name: getattr(found, name) for name in names}
        metadata = dict(mesh.metadata) | {"record": dict(record), "arrays": arrays}
        save_mesh(place, MeshData(found.vertices, found.faces, metadata=metadata), format)
    return record | {"output": str(target)}


def repaired_mesh(mesh: MeshData, found: Repaired | None) -> MeshData:
    """The mesh that was mapped: repaired, if that was asked for."""
    return mesh if found is None else MeshData(found.vertices, found.faces, metadata=mesh.metadata)


def repair_figures(found: Repaired | None) -> Record:
    """What a repair did; nothing without one."""
    if found is None:
        return {}
    return {
        "repairs": {name: count for name, count in found.counts.items() if count},
        "repair_report": found.report.splitlines(),
        "repaired_vertices": len(found.vertices),
        "repaired_faces": len(found.faces),
    }
