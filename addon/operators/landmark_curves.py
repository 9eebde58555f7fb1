# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.landmark_curve_add, _remove, _clear, _select, _reverse: the pairs of curves of the source."""

import re
from typing import Any

import bpy
from bpy.props import EnumProperty, StringProperty

from .. import messages
from ..blender import selection
from ..blender.types import MeshObject, Status
from ..jobs import reversed_curves
from ..landmarks import curve_marks, curve_pairing, curve_selection
from ..landmarks import curves as landmark_curves
from ..landmarks.objects import NONE, SIDES, CannotPair, active_source, side_object
from ..surfaces.arrays import Path
from . import poll, views
from .landmark_base import GIVEN, LandmarkOperator, index_property

_SIDES = (
    ("SOURCE", "Source", "The path on this object"),
    ("TARGET", "Target", "The path on the target"),
)


class _CurveOperator(LandmarkOperator):
    pairs, active, noun = "authalic_landmark_curves", "authalic_landmark_curve_index", "curve"
    changes_lists = True

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        is_free = not cls.changes_lists or poll.can_change_lists(cls, context)
        return is_free and poll.has_curves(cls, context)

    def worded(self, problem: str) -> str:
        return problem[:1].upper() + problem[1:]


def _index(meaning: str = "-1 for the active one") -> Any:
    return index_property("the pair of curves", meaning)


def _side(meaning: str, default: str) -> Any:
    return EnumProperty(name="Side", description=meaning, items=_SIDES, default=default)


def _path(name: str, where: str) -> Any:
    return StringProperty(
        name=name,
        description=f"Vertex indices {where} from start to end; a loop repeats the first one at the end. "
        "Empty for the selected edges",
        default="",
        options=GIVEN,
    )


class AUTHALIC_OT_landmark_curve_add(_CurveOperator, bpy.types.Operator):
    """Make the selected edges a landmark curve: an open path or a closed loop, on this object or its target.

    Edges on one object alone complete the active curve if it lacks a path there. Open curves are matched
    start to start: a path starts at the end nearer to the active vertex or edge"""

    bl_idname = "authalic.landmark_curve_add"
    bl_label = "Add Landmark Curve"

    name: StringProperty(
        name="Name",
        description="Leave empty to keep the name, or to use a number",
        default="",
        options=GIVEN,
    )
    index: _index("-1 for a new pair, or for one that lacks the path")
    source_vertices: _path("Source Vertices", "on this object")
    target_vertices: _path("Target Vertices", "on the target")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.can_pair(cls, context)

    def run(self, _context: bpy.types.Context, source: MeshObject) -> Status:
        index = NONE if self.index == NONE else self.chosen(source)
        given = {"source": _numbers(self.source_vertices), "target": _numbers(self.target_vertices)}
        given = {side: path for side, path in given.items() if path}
        if not given:
            given, index = _selected(source, index)
        elif index == NONE:
            index, given = curve_pairing.place_for(source, given)
        landmark_curves.add(source, given.get("source"), given.get("target"), name=self.name, index=index)
        pair = landmark_curves.pairs(source)[source.authalic_landmark_curve_index]
        said = [_described(path, side_object(source, side)) for side, path in given.items()]
        self.report({"INFO"}, f"{pair.name}: {', '.join([*said, *filter(None, [pair.problem])])}")
        return {"FINISHED"}


class AUTHALIC_OT_landmark_curve_remove(_CurveOperator, bpy.types.Operator):
    """Remove a pair of landmark curves. The edges themselves stay"""

    bl_idname = "authalic.landmark_curve_remove"
    bl_label = "Remove Landmark Curve"
    index: _index()

    def run(self, _context: bpy.types.Context, source: MeshObject) -> Status:
        index = self.chosen(source)
        name = source.authalic_landmark_curves[index].name
        landmark_curves.remove(source, index)
        self.report({"INFO"}, f"Removed {name}, {len(source.authalic_landmark_curves)} left")
        return {"FINISHED"}


class AUTHALIC_OT_landmark_curve_clear(_CurveOperator, bpy.types.Operator):
    """Remove all pairs of landmark curves. The edges themselves stay"""

    bl_idname = "authalic.landmark_curve_clear"
    bl_label = "Clear Landmark Curves"

    def run(self, _context: bpy.types.Context, source: MeshObject) -> Status:
        count = len(source.authalic_landmark_curves)
        landmark_curves.clear(source)
        self.report({"INFO"}, f"Removed {messages.count(count, 'landmark curve')} of {source.name}")
        return {"FINISHED"}


class AUTHALIC_OT_landmark_curve_select(_CurveOperator, bpy.types.Operator):
    """Select the edges of a landmark curve and bring them into view"""

    bl_idname = "authalic.landmark_curve_select"
    bl_label = "Select Landmark Curve"
    changes_lists = False
    index: _index()
    side: _side("The object whose edges to select", "SOURCE")

    @classmethod
    def description(cls, context: bpy.types.Context, properties: Any) -> str:
        """The tooltip, with the edges of the pair and its last error."""
        words = bpy.app.translations.pgettext_tip
        said, source = [words(str(cls.__doc__))], active_source(context)
        if source is not None and 0 <= properties.index < len(source.authalic_landmark_curves):
            pair = landmark_curves.pairs(source)[properties.index]
            error = source.authalic_landmark_curves[properties.index].error
            said.append(pair.problem or _both(pair, source))
            if pair.problem is None and error >= 0:
                said.append(words("Missed by {error:.3f} % of the target's size").format(error=error))
        return ".\n".join(said)

    def run(self, context: bpy.types.Context, source: MeshObject) -> Status:
        index = self.chosen(source)
        pair, side = landmark_curves.pairs(source)[index], self.side.lower()
        obj = side_object(source, side)
        path = getattr(pair, side)
        if not path.edges:
            raise CannotPair(f"{pair.name}: {pair.problem}")
        source.authalic_landmark_curve_index = index
        # In vertex mode, any edge between two vertices of the path would be selected too.
        context.tool_settings.mesh_select_mode = False, True, False  # type: ignore[assignment]
        selection.select_edges(obj, path.edges)
        views.show(context, obj, _middle(path))
        self.report({"INFO"}, f"{pair.name}: {_described(path.vertices, obj, len(path.edges))}")
        return {"FINISHED"}


class AUTHALIC_OT_landmark_curve_reverse(_CurveOperator, bpy.types.Operator):
    """Let an open landmark curve start at its other end: open curves are matched start to start"""

    bl_idname = "authalic.landmark_curve_reverse"
    bl_label = "Reverse Landmark Curve"
    index: _index()
    side: _side("The object whose path to reverse", "TARGET")

    def run(self, _context: bpy.types.Context, source: MeshObject) -> Status:
        index, side = self.chosen(source), self.side.lower()
        landmark_curves.reverse(source, index, side)
        source.authalic_landmark_curve_index = index
        obj = side_object(source, side)
        pair = landmark_curves.pairs(source)[index]
        start = getattr(pair, side).vertices[0]
        self.report({"INFO"}, f"{pair.name} starts at vertex {start} of {obj.name} now")
        return {"FINISHED"}


class AUTHALIC_OT_landmark_curve_reverse_these(_CurveOperator, bpy.types.Operator):
    """Reverse the target's paths of the curves that fitted far better in reverse in the last registration"""

    bl_idname = "authalic.landmark_curve_reverse_these"
    bl_label = "Reverse These"

    def run(self, _context: bpy.types.Context, source: MeshObject) -> Status:
        numbers = reversed_curves.reverse(source)
        if not numbers:
            raise CannotPair("no curve looked reversed in the last registration")
        self.report({"INFO"}, f"Reversed {', '.join(f'C{number + 1}' for number in numbers)}; wrap again")
        return {"FINISHED"}


def _numbers(text: str) -> Path:
    """The vertex indices in a text."""
    words = [word for word in re.split(r"[\s,]+", text) if word]
    bad = next((word for word in words if not word.isdecimal()), None)
    if bad is not None:
        raise CannotPair(f'"{bad}" is not the number of a vertex')
    return tuple(map(int, words))


def _selected(source: MeshObject, index: int) -> tuple[dict[str, Path], int]:
    """The paths {side: path} of selected edges, and the index of their pair, -1 for a new one."""
    selected = {side: path for side in SIDES if (path := curve_selection.path(side_object(source, side)))}
    if not selected:
        raise CannotPair(
            f"Select edges of {source.name} or of {source.authalic_target.name} in Edit Mode: one open path "
            "or one closed loop"
        )
    chosen = {side: path for side, (path, _) in selected.items()}
    if index == NONE:
        index, chosen = curve_pairing.place_for(source, chosen)
    loose = [side for side in chosen if not selected[side][1]]
    return curve_pairing.directed(source, index, chosen, loose), index


def _both(pair: landmark_curves.Curve, source: MeshObject) -> str:
    """The paths of a pair in words."""
    paths = [_described(getattr(pair, side).vertices, side_object(source, side)) for side in SIDES]
    said = ", ".join(paths)
    return said[:1].upper() + said[1:]


def _middle(path: curve_marks.MarkedPath) -> int:
    """A vertex halfway along."""
    return path.vertices[len(path.vertices) // 2] if path.vertices else path.edges[0][0]


def _described(path: Path, obj: MeshObject, count: int | None = None) -> str:
    edges = messages.count(len(path) - 1 if count is None else count, "edge")
    if not path:
        return f"{edges} of {obj.name}"
    if path[0] == path[-1]:
        return f"a loop of {edges} of {obj.name}"
    return f"{edges} of {obj.name} from vertex {path[0]} to {path[-1]}"


_CLASSES = (
    AUTHALIC_OT_landmark_curve_add,
    AUTHALIC_OT_landmark_curve_remove,
    AUTHALIC_OT_landmark_curve_clear,
    AUTHALIC_OT_landmark_curve_select,
    AUTHALIC_OT_landmark_curve_reverse,
    AUTHALIC_OT_landmark_curve_reverse_these,
)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
