# SPDX-License-Identifier: GPL-3.0-or-later
"""The landmark curves of the source and of its target, drawn over the 3D view.

A curve has the same color on both, and its number at a dot where it starts; an open one ends in an arrow.
"""

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import bpy
import gpu
from bpy_extras.view3d_utils import location_3d_to_region_2d
from gpu_extras.batch import batch_for_shader
from mathutils import Vector

from ..blender import element_marks, scene_changes, vertex_positions
from ..blender.types import MeshObject
from ..landmarks import curves as landmark_curves
from ..landmarks import paths
from ..landmarks.objects import SIDES, active_source, side_object
from ..surfaces.arrays import Edge
from .drawing import ACTIVE, BEHIND, DARK, PROBLEM, disk, faces_eye, is_drawn, label, nearer_to_eye, sources

Color = tuple[float, float, float]
End = tuple[Vector, Vector, float]
"""The pixel of the end of a path, that of the vertex next to it, and how opaque it is drawn."""

# Blender's bone color sets that differ well from each other and from the red of a problem.
_COLOR_SETS = (9, 4, 3, 2, 6, 7, 5, 12, 14, 11)
_WIDTH, _ACTIVE_WIDTH, _RIM = 3.0, 4.0, 2.5
_DOT, _ARROW = 4.5, 11.0
_handles: list[Any] = []


class Line(NamedTuple):
    """A path on the object of a name, from start to end if it is whole, and how it is drawn."""

    object_name: str
    edges: tuple[Edge, ...]
    is_whole: bool
    is_closed: bool
    number: int
    is_active: bool
    has_problem: bool


class _Shape(NamedTuple):
    """A line in the coordinates of its object; (point, normal) of either end and of the vertex next to it."""

    batch: gpu.types.GPUBatch
    first: list[tuple[Vector, Vector]]
    last: list[tuple[Vector, Vector]]


# Lines ready to be drawn: (name of an object, edges) -> `_Shape`; and the `scene_changes` by then.
_shapes: dict[tuple[str, tuple[Edge, ...]], _Shape] = {}
_made: int | None = None


def icon(number: int) -> Any:
    """The icon in the color of a curve, by its number from 0."""
    return f"COLORSET_{_COLOR_SETS[number % len(_COLOR_SETS)]:02}_VEC"


def shown(context: bpy.types.Context) -> list[Line]:
    """The lines of the selected sources, and of those whose target is selected."""
    scene: Any = context.scene
    if not scene.authalic_show_landmarks:
        return []
    listed = [source for source in sources(context) if source.authalic_landmark_curves]
    return [line for source in listed for line in _of(source, context)]


def _of(source: MeshObject, context: bpy.types.Context) -> Iterator[Line]:
    active, is_meant = source.authalic_landmark_curve_index, source == active_source(context)
    for number, pair in enumerate(landmark_curves.pairs(source, drawing=True)):
        is_half = any(not getattr(pair, side).edges for side in SIDES)
        for side in SIDES:
            path = getattr(pair, side)
            if path.edges:
                yield Line(
                    object_name=side_object(source, side).name,
                    edges=tuple(paths.edges(path.vertices)) or path.edges,
                    is_whole=bool(path.vertices),
                    is_closed=path.is_closed,
                    number=number,
                    is_active=is_meant and number == active,
                    has_problem=bool(path.problem if is_half else pair.problem),
                )


def _draw_lines() -> None:
    context = bpy.context
    if not is_drawn(context):
        return
    drawn = _prepared(context)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_mask_set(False)  # rims must not hide the lines that they are around
    passes: tuple[tuple[Any, float], ...] = (("NONE", BEHIND), ("LESS_EQUAL", 1.0))
    for depth_test, alpha in passes:
        gpu.state.depth_test_set(depth_test)
        with gpu.matrix.push_pop():  # type: ignore[attr-defined]
            gpu.matrix.load_matrix(nearer_to_eye(context) @ gpu.matrix.get_model_view_matrix())
            for line, obj, shape in drawn:
                _draw_line(line, obj, shape, context, alpha)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def _prepared(context: bpy.types.Context) -> list[tuple[Line, MeshObject, _Shape]]:
    """(line, object, `_Shape`) of the lines on objects that are seen in the view, the active ones last."""
    global _made
    if _made != scene_changes.count():
        _shapes.clear()
        _made = scene_changes.count()
    lines = sorted(shown(context), key=lambda line: line.is_active)
    seen: list[tuple[Line, Any]]
    seen = [(line, context.view_layer.objects.get(line.object_name)) for line in lines]
    seen = [(line, obj) for line, obj in seen if obj and obj.visible_get(viewport=context.space_data)]
    new = [(line, obj) for line, obj in seen if _key(line) not in _shapes]
    held = [element_marks.hold(obj.data) for _, obj in new]
    for line, obj in new:
        _shapes[_key(line)] = _shape(line, obj, context.evaluated_depsgraph_get())
    del held
    return [(line, obj, _shapes[_key(line)]) for line, obj in seen]


def _key(line: Line) -> tuple[str, tuple[Edge, ...]]:
    return line.object_name, line.edges


def _shape(line: Line, obj: MeshObject, graph: bpy.types.Depsgraph) -> _Shape:
    vertices = [vertex for edge in line.edges for vertex in edge]
    points = vertex_positions.many(obj, vertices, graph).tolist()
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    ends = [[vertex_positions.local(obj, vertex, graph) for vertex in edge] for edge in _end_edges(line)]
    return _Shape(batch_for_shader(shader, "LINES", {"pos": points}), *ends)


def _end_edges(line: Line) -> tuple[Edge, Edge]:
    return line.edges[0], line.edges[-1][::-1]


def _draw_line(line: Line, obj: MeshObject, shape: _Shape, context: bpy.types.Context, alpha: float) -> None:
    scale = context.preferences.system.ui_scale
    width = (_ACTIVE_WIDTH if line.is_active else _WIDTH) * scale
    rim = ACTIVE if line.is_active else DARK
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.uniform_float("viewportSize", (context.region.width, context.region.height))
    with gpu.matrix.push_pop():  # type: ignore[attr-defined]
        gpu.matrix.multiply_matrix(obj.matrix_world)
        for color, wide in ((rim, width + _RIM * scale), (_color(line, context), width)):
            shader.uniform_float("lineWidth", wide)
            shader.uniform_float("color", (*color, alpha))
            shape.batch.draw(shader)


def _color(line: Line, context: bpy.types.Context) -> Color:
    if line.has_problem:
        return PROBLEM
    sets = context.preferences.themes[0].bone_color_sets
    color = sets[_COLOR_SETS[line.number % len(_COLOR_SETS)] - 1].active
    return color[0], color[1], color[2]


def _draw_ends() -> None:
    context = bpy.context
    if not is_drawn(context):
        return
    scale = context.preferences.system.ui_scale
    for line, obj, shape in _prepared(context):
        first, last = (_end(obj, end, context) for end in (shape.first, shape.last))
        color = _color(line, context)
        gpu.state.blend_set("ALPHA")
        if line.is_whole and not line.is_closed:
            _draw_arrow(last, color, scale)
        if first is not None:
            _draw_start(line, first, color, scale)
        gpu.state.blend_set("NONE")


def _end(obj: MeshObject, end: Sequence[tuple[Vector, Vector]], context: bpy.types.Context) -> End | None:
    """(pixel of the end, pixel of the vertex next to it, how opaque), or None if not in view."""
    ends = [vertex_positions.to_world(obj, *place) for place in end]
    pixels = [location_3d_to_region_2d(context.region, context.region_data, point) for point, _ in ends]
    if None in pixels:
        return None
    is_front = faces_eye(context, *ends[0])
    return pixels[0], pixels[1], 1.0 if is_front else BEHIND


def _draw_start(line: Line, end: End, color: Color, scale: float) -> None:
    pixel, _, alpha = end
    rim = ACTIVE if line.is_active else DARK
    if line.is_whole:
        disk(pixel, (_DOT + 1.5) * scale, (*rim, alpha))
        disk(pixel, _DOT * scale, (*color, alpha))
    text = PROBLEM if line.has_problem else ACTIVE
    label(f"C{line.number + 1}", pixel, scale * (14 if line.is_active else 12), (*text, alpha))


def _draw_arrow(end: End | None, color: Color, scale: float) -> None:
    """An arrow head at the end."""
    if end is None:
        return
    tip, before, alpha = end
    along = (tip - before).normalized() if (tip - before).length > 0 else Vector((1, 0))
    for length, shade in ((_ARROW + 4, DARK), (_ARROW, color)):
        wing = Vector((-along.y, along.x)) * length * math.tan(math.radians(28)) * scale
        middle = tip - along * 0.3 * _ARROW * scale  # of the circle within, so that the rim is even
        point, back = middle + along * 0.68 * length * scale, middle - along * 0.32 * length * scale
        corners = [(place.x, place.y, 0.0) for place in (point, back + wing, back - wing)]
        shader = gpu.shader.from_builtin("UNIFORM_COLOR")
        shader.uniform_float("color", (*shade, alpha))
        batch_for_shader(shader, "TRIS", {"pos": corners}).draw(shader)


def register() -> None:
    add = bpy.types.SpaceView3D.draw_handler_add
    _handles.append(add(_draw_lines, (), "WINDOW", "POST_VIEW"))
    _handles.append(add(_draw_ends, (), "WINDOW", "POST_PIXEL"))


def unregister() -> None:
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")
    _shapes.clear()
