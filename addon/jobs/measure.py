# SPDX-License-Identifier: GPL-3.0-or-later
"""The measurement of a context's objects: figures of their active UV layers and a face attribute."""

import bpy

from .. import bridge
from ..blender import meshes, uv_maps
from . import targets
from .job import Job
from .targets import NothingToDo

ATTRIBUTE = "authalic_log2_area_ratio"


def job(context: bpy.types.Context) -> Job[bridge.Measurement | None, bridge.Measurement]:
    """A `Job` that measures the active UV layers; its `apply` writes the attribute, returns figures.

    Raises `NothingToDo` where no object has faces and UVs.
    """
    objects, _ = targets.editable(context)
    mapped = [obj for obj in objects if uv_maps.active(obj)]
    read = [(obj, meshes.read(obj, uv_layer=uv_maps.active(obj))) for obj in mapped]
    chosen = [(obj, surface) for obj, surface in read if len(surface.triangles)]
    if not chosen:
        raise NothingToDo("The selected objects have no faces with a UV map")
    surfaces = [surface for _, surface in chosen]

    def finish(figures: bridge.Measurement | None) -> bridge.Measurement:
        if figures is None:
            raise NothingToDo("No face has an area, or all UVs lie in one point")
        for (obj, _), values in zip(chosen, figures.log2, strict=True):
            meshes.write_face_attribute(obj.data, ATTRIBUTE, values)
        return figures

    return Job(lambda progress: bridge.measure(surfaces), finish)


def phrases(figures: bridge.Figures) -> list[str]:
    """A phrase for each figure."""
    said = [
        f"area ratio mean {figures.mean:.3f}",
        f"area ratio SD {figures.deviation:.3g}",
        f"log2 area ratio {figures.log2_min:.2f} to {figures.log2_max:.2f}",
        "1 flip" if figures.flips == 1 else f"{figures.flips} flips",
        f"angle distortion {figures.angle:.2f}",
    ]
    if figures.without_area:
        said.append(f"{figures.without_area} triangles without area left out")
    return said
