# SPDX-License-Identifier: MIT OR Apache-2.0
"""Figures of any map, from any tool, and what a mesh is like."""

from pathlib import Path
from typing import Any

import numpy as np

from .._native import MeshError, Surface, distortion
from ..io import FileError, MeshData, Outputs, mesh_format, read_mesh
from .areal import ArealFile
from .record import Record, distortion_figures, problem, read_input

_SINGLE_PRECISION = 1e-6
"""Of the size of a surface: how far its vertices may lie apart in files of single precision."""


def measure_run(
    source: Path,
    image: Path | None = None,
    *,
    areal: Path | None = None,
    input_format: str | None = None,
    image_format: str | None = None,
) -> Record:
    """Measures a map.

    Parameters
    ----------
    source : Path
        The surface.
    image : Path, optional
        A mesh with the same faces, whose vertices are the images: a sphere around the origin, or a plane at z
        = 0; or the surface with UVs that are the map. Default: the UVs of the surface's own file.
    areal : Path, optional
        The file for log₂ of each vertex's areal distortion.
    input_format, image_format : str, optional
        Names of formats where the files' names do not say them.

    Returns
    -------
    dict
        The record of the run.
    """
    outputs = Outputs()
    areal_file = ArealFile(areal, outputs)
    mesh, record = read_input(source, input_format, "measure", {})
    vertices, faces, points = _map(mesh, source, image, image_format)
    record |= distortion_figures(distortion(vertices, faces, points))
    if areal is not None and len(vertices) != len(mesh.vertices):
        raise FileError(source, "the UVs have seams, so that vertices have no single areal distortion")
    with outputs:
        return record | areal_file.save(vertices, faces, points)


def info_run(source: Path, *, input_format: str | None = None) -> Record:
    """What a mesh is like: counts, topology, which maps suit it, or the first thing that is wrong with it.

    Of a saved result, what it was computed from.
    """
    if (provenance := _provenance(source)) is not None:
        return {"command": "info", "input": str(source), "format": "result"} | provenance
    mesh, record = read_input(source, input_format, "info", {})
    record["format"] = mesh_format(source, input_format).name
    record["uv_points"] = 0 if mesh.uv is None else len(mesh.uv)
    bounded = mesh.vertices[np.isfinite(mesh.vertices).all(axis=1)]
    if len(bounded):
        record |= {"lowest": bounded.min(axis=0).tolist(), "highest": bounded.max(axis=0).tolist()}
    try:
        surface = Surface(mesh.vertices, mesh.faces)
    except MeshError as error:
        return record | {"suits": [], "problem": problem(error)}
    corners = surface.vertices[surface.faces]
    doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return record | {
        "area": float(np.linalg.norm(doubled, axis=1).sum() / 2),
        "components": surface.n_components,
        "euler_characteristic": surface.euler_characteristic,
        "genus": surface.genus,
        "boundary_loops": len(surface.boundary_loops),
        "suits": _suited(surface),
    }


def _provenance(source: Path) -> dict[str, Any] | None:
    """What a saved result was computed from; None for other files."""
    from .._files import provenance_in

    if source.suffix != ".npz":
        return None
    try:
        return provenance_in(source)
    except ValueError as error:
        raise FileError(source, f"it {str(error).removeprefix(f'{source} ')}") from error


def _map(
    mesh: MeshData, source: Path, image: Path | None, format: str | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The surface, cut where its UVs are, with the points of the map."""
    given = mesh if image is None else read_mesh(image, format)
    if given.uv is not None and given.uv_faces is not None and _is_map_of(given, mesh):
        cut = MeshData(mesh.vertices, mesh.faces, given.uv, given.uv_faces).split_at_seams()
        assert cut.uv is not None
        return cut.vertices, cut.faces, cut.uv
    if image is None:
        raise FileError(source, "the surface has no UVs; name the file of a map to be measured")
    if not np.array_equal(given.faces, mesh.faces):
        raise FileError(image, "the map's faces are not those of the surface, in the same order")
    flat = given.vertices[:, :2] if not given.vertices[:, 2].any() else given.vertices
    return mesh.vertices, mesh.faces, np.ascontiguousarray(flat)


def _is_map_of(given: MeshData, mesh: MeshData) -> bool:
    """Whether a file with UVs has the surface's faces. It may have vertices on seams several times."""
    if np.array_equal(given.faces, mesh.faces):
        return True
    has_corners = all(each.faces.max() < len(each.vertices) for each in (given, mesh))
    if given.faces.shape != mesh.faces.shape or not has_corners:
        return False
    corners, expected = given.vertices[given.faces], mesh.vertices[mesh.faces]
    return np.allclose(corners, expected, rtol=0, atol=_SINGLE_PRECISION * np.ptp(expected))


def _suited(surface: Surface) -> list[str]:
    suited = ["sphere", "layout"] if surface.is_closed and surface.genus == 0 else []
    if surface.n_components > 1:
        suited = []
    return (["disk"] if surface.is_disk else []) + suited + ["unwrap", "seams"]
