# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.measure: the area distortion of the active UV map."""

from typing import Any, NamedTuple

import bpy
from bpy.props import StringProperty

from ..blender import scene_changes, uv_maps
from ..blender.types import Status
from ..jobs import densities, measure, targets
from . import density, poll


class Figures(NamedTuple):
    """What the panel shows of a measurement: a sentence, a phrase for each number, and the texel density.

    That is as in `surfaces.texel_density`.
    """

    sentence: str
    numbers: list[str]
    texel_density: float


def figures_of(report: measure.Report) -> Figures:
    """The figures of a measurement for the panel."""
    return Figures(report.sentence, report.numbers, report.figures.texel_density)


# The last measurement, and what it was made of.
_last: tuple[Figures, object] | None = None


def current(context: bpy.types.Context) -> Figures | None:
    """The figures of the last measurement; None once meshes, UVs or the selection have changed."""
    return _last[0] if _last is not None and _last[1] == _looked_at(context) else None


def _looked_at(context: bpy.types.Context) -> object:
    """What a measurement depends on; equal as long as nothing of it has changed."""
    objects = [(obj.name_full, uv_maps.active(obj)) for obj in targets.meshes(context)]
    return context.mode, objects, scene_changes.looks()


class AUTHALIC_OT_measure(bpy.types.Operator):
    """Measure the area distortion of the active UV map, as figures and as a face attribute.

    The attribute is 0 for a fair share, 1 for double, -1 for half, -20 for a flipped face"""

    bl_idname = "authalic.measure"
    bl_label = "Measure Area Distortion"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)

    density_source: density.property_of_sources()

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.has_uv_maps(cls, context)

    def execute(self, context: bpy.types.Context) -> Status:
        global _last
        try:
            report = measure.job(context, self.density_source).execute()
        except (targets.NothingToDo, densities.NoDensity) as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        if context.view_layer:
            context.view_layer.update()  # counts the change that the attribute is
        _last = figures_of(report), _looked_at(context)
        self.report({"INFO"}, str(report))
        return {"FINISHED"}


def _lines(_manager: bpy.types.WindowManager) -> str:
    figures = current(bpy.context)
    return "\n".join(figures.numbers) if figures is not None else ""


_PROPERTIES: Any = bpy.types.WindowManager


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_measure)
    _PROPERTIES.authalic_figures = StringProperty(
        name="Figures",
        description="The last measurement, one figure per line; empty once it no longer applies",
        get=_lines,
        options={"SKIP_SAVE"},
    )


def unregister() -> None:
    global _last
    _last = None
    del _PROPERTIES.authalic_figures
    bpy.utils.unregister_class(AUTHALIC_OT_measure)
