# SPDX-License-Identifier: MIT OR Apache-2.0
"""Names of files for results, from the name of the surface."""

from pathlib import Path

from ..io import mesh_format

_AREAL = {"gifti": ".shape.gii"}


def map_output(surface: Path, command: str, format: str | None = None) -> Path:
    """The file of a map: `lh.authalic.sphere` for `lh.white`, `ball.sphere.obj` for `ball.obj`.

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
    ends = [end for end in chosen.suffixes if surface.name.lower().endswith(end)]
    suffix = surface.name[-len(ends[0]) :] if ends else chosen.suffixes[0]
    return surface.with_name(f"{_without(surface.name, suffix)}.{command}{suffix}")


def areal_output(output: Path, format: str) -> Path:
    """The file of the areal distortion of a map: `lh.authalic.areal`, `ball.sphere.areal.npy`."""
    if format == "freesurfer":
        return output.with_name(f"{output.name.rsplit('.', 1)[0]}.areal")
    ends = [end for end in mesh_format(output, format).suffixes if output.name.lower().endswith(end)]
    stem = output.name[: -len(ends[0])] if ends else output.name
    return output.with_name(f"{stem}.areal{_AREAL.get(format, '.npy')}")


def _without(name: str, suffix: str) -> str:
    return name[: -len(suffix)] if name.endswith(suffix) else name
