# SPDX-License-Identifier: MIT OR Apache-2.0
"""Names of files for results, from the name of the surface."""

from pathlib import Path

from ..io import MESH_FORMATS, mesh_format

_AREAL = {"gifti": ".shape.gii"}


def map_output(surface: Path, command: str, format: str | None = None) -> Path:
    """The file of a map: `lh.authalic.sphere` for `lh.white`, `ball.sphere.obj` for `ball.obj`.

    In another format it has the suffix of that: `ball.disk.obj` for `ball.ply`.

    Parameters
    ----------
    surface : Path
        The file of the surface.
    command : str
        The run that makes the map.
    format : str, optional
        The name of the map's format. Default: that of the surface.

    Returns
    -------
    Path
        A file beside the surface.
    """
    chosen = mesh_format(surface, format)
    if chosen.name == "freesurfer":
        return surface.with_name(f"{surface.name.split('.')[0]}.authalic.{command}")
    stem, suffix = _parted(surface.name)
    if suffix.lower() not in chosen.suffixes:
        suffix = chosen.suffixes[0]
    return surface.with_name(f"{stem}.{command}{suffix}")


def areal_output(output: Path, format: str) -> Path:
    """The file of the areal distortion of a map: `lh.authalic.areal`, `ball.sphere.areal.npy`."""
    if format == "freesurfer":
        return output.with_name(f"{output.name.rsplit('.', 1)[0]}.areal")
    stem, _ = _parted(output.name)
    return output.with_name(f"{stem}.areal{_AREAL.get(format, '.npy')}")


def _parted(name: str) -> tuple[str, str]:
    """A name without the suffix of a format of meshes, and that suffix."""
    for format in MESH_FORMATS:
        for suffix in format.suffixes:
            if name.lower().endswith(suffix):
                return name[: -len(suffix)], name[-len(suffix) :]
    return name, ""
