# SPDX-License-Identifier: GPL-3.0-or-later
"""The heat map of a context's objects: their UV maps measured, whoever made them."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from .. import bridge
from ..blender import shown_meshes, uv_maps
from ..blender.shown_meshes import ShownMesh
from ..blender.types import MeshObject, is_mesh
from ..surfaces import heat_map
from . import densities
from .job import Job
from .measure import Report


@dataclass
class Layer:
    """The figures of an object as it is seen in the 3D view, and of its UV map."""

    object_name: str
    in_space: heat_map.Values
    in_plane: heat_map.Values


@dataclass
class HeatMap:
    """The layers of some objects, all on one scale, and the report of the measurement; None without area."""

    layers: list[Layer]
    report: Report | None


def objects(context: bpy.types.Context) -> list[MeshObject]:
    """The visible mesh objects with a UV map that are selected or in edit mode."""
    chosen = context.objects_in_mode if context.mode == "EDIT_MESH" else context.selected_objects
    return [obj for obj in chosen if is_mesh(obj) and uv_maps.active(obj) and obj.visible_get()]


def job(context: bpy.types.Context, density_source: str = "") -> Job[HeatMap, HeatMap]:
    """A `Job` that measures the active UV maps of the visible objects; nothing is written."""
    graph = context.evaluated_depsgraph_get()
    names, shown = [], []
    for obj in objects(context):
        mesh = shown_meshes.read(obj, uv_maps.active(obj) or "", graph)
        densities.apply(obj, mesh.own, density_source)
        if mesh.evaluated is not None:
            densities.apply(obj, mesh.seen, density_source, mesh.evaluated)
            mesh.evaluated = None  # the thread touches no data of Blender's
        names.append(obj.name)
        shown.append(mesh)
    return Job(lambda progress: _measured(names, shown))


def _measured(names: Sequence[str], shown: Sequence[ShownMesh]) -> HeatMap:
    figures = seen = bridge.measure([mesh.own for mesh in shown]) if shown else None
    if any(mesh.seen is not mesh.own for mesh in shown):
        seen = bridge.measure([mesh.seen for mesh in shown])
    if figures is None or seen is None:
        return HeatMap([], None)
    layers = [
        Layer(
            name,
            heat_map.in_space(mesh.seen, mesh.points, of_seen, mesh.hidden),
            heat_map.in_plane(mesh.own, of_own, mesh.hidden),
        )
        for name, mesh, of_seen, of_own in zip(names, shown, seen.polygons, figures.polygons, strict=True)
    ]
    return HeatMap(layers, Report(list(names), figures, []))
