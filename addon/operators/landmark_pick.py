# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.landmark_pick: pairs of landmarks by clicking on the two objects in a 3D view."""

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np
from bpy.props import IntProperty
from numpy.typing import ArrayLike

from ..blender import vertex_positions
from ..blender.types import MeshObject, Status
from ..landmarks import picking, point_marks
from ..landmarks import points as landmark_points
from ..landmarks.objects import NONE, CannotPair, active_source
from ..overlay.drawing import redraw
from ..overlay.points import Marker
from ..overlay.points import dragged as shown_dragged
from ..overlay.points import hints as shown_hints
from . import poll
from .landmark_steps import Added, Drag, Moved, Step, summary

Seen = tuple[bpy.types.Area, bpy.types.Region, tuple[int, int]]
"""A 3D view, its region, and a pixel there."""

# Events that move the view; other mouse buttons and keys are held back.
_NAVIGATION = {
    *("MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "WHEELINMOUSE", "WHEELOUTMOUSE", "TRACKPADPAN"),
    *("TRACKPADZOOM", "MOUSEROTATE", "MOUSESMARTZOOM", "INBETWEEN_MOUSEMOVE", "WINDOW_DEACTIVATE", "HOME"),
    *(f"NUMPAD_{key}" for key in (*range(10), "PERIOD", "SLASH", "PLUS", "MINUS")),
}
_DONE = {"ESC", "RET", "NUMPAD_ENTER"}
_SIDES = ("source", "target")
_GRABBED = 8.0  # pixels from the middle of a marker, at the scale 1 of the interface
_SKIPPED = 16  # wire objects in front of a surface that clicks go through, at most


class AUTHALIC_OT_landmark_pick(bpy.types.Operator):
    """Pick pairs of landmarks: click a point on the object and its partner on the target, in either order.

    Drag a marker to move it over the surface"""

    bl_idname = "authalic.landmark_pick"
    bl_label = "Pick Landmarks"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)
    running = False
    # While it runs: the names of both objects, the vertex chosen on either side, the marker that is dragged,
    # what was done, what of it has a step of undo, the states from which the surfaces were read, and those.
    _names: tuple[str, str]
    _chosen: dict[str, int]
    _drag: Drag | None
    _steps: list[Step]
    _pushed: list[Step]
    _states: list[tuple[object, ...]] | None
    _surfaces: list[picking.Pickable]

    source_vertex: IntProperty(
        name="Source Vertex",
        description="The vertex on this object",
        min=NONE,
        default=NONE,
        options={"SKIP_SAVE"},
    )
    target_vertex: IntProperty(
        name="Target Vertex",
        description="The vertex on the target",
        min=NONE,
        default=NONE,
        options={"SKIP_SAVE"},
    )
    index: IntProperty(
        name="Index",
        description="The pair in the list, from 0, that gets the two vertices. -1 for a new pair",
        min=NONE,
        default=NONE,
        options={"SKIP_SAVE", "HIDDEN"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if AUTHALIC_OT_landmark_pick.running:
            cls.poll_message_set("Landmarks are already being picked")
            return False
        return poll.can_pair(cls, context)

    def execute(self, context: bpy.types.Context) -> Status:
        """Adds or moves a pair by vertex numbers: for scripts, and for changes in the redo panel."""
        if NONE in (self.source_vertex, self.target_vertex):
            self.report({"ERROR"}, "Picking needs a window, or the numbers of two vertices")
            return {"CANCELLED"}
        source = active_source(context)
        try:
            if 0 <= self.index < len(source.authalic_landmarks):
                for change in (landmark_points.check_move, landmark_points.move):
                    change(source, self.index, "source", self.source_vertex)
                    change(source, self.index, "target", self.target_vertex)
            else:
                landmark_points.add(source, self.source_vertex, self.target_vertex)
        except CannotPair as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> Status:
        if bpy.app.background or context.window is None:
            return self.execute(context)
        source = active_source(context)
        self._names = source.name, source.authalic_target.name
        self._chosen, self._drag, self._steps, self._pushed, self._states = {}, None, [], [], None
        AUTHALIC_OT_landmark_pick.running = True
        self._say(context, "")
        context.window.cursor_modal_set("CROSSHAIR")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> Status:
        objects = self._objects(context)
        if objects is None or context.mode not in {"OBJECT", "EDIT_MESH"}:
            self.report({"WARNING"}, "Picking has ended: its objects or their mode have changed")
            return self._end(context)
        if event.type in _NAVIGATION or event.type.startswith(("TIMER", "NDOF")):
            return {"PASS_THROUGH"}
        view = _view_under(context, event)
        if self._drag is not None and self._dragged(context, objects, event, view):
            return {"RUNNING_MODAL"}
        if event.value == "PRESS" and (event.type in _DONE or (event.type == "RIGHTMOUSE" and view)):
            return self._end(context)
        if event.value == "PRESS" and _takes_back(event):
            self._take_back(context, objects)
            return {"RUNNING_MODAL"}
        if view is None or (event.type == "LEFTMOUSE" and event.alt):  # a panel, a menu; Alt orbits
            self._hover(context, None)
            return {"PASS_THROUGH"}
        if event.type == "MOUSEMOVE":
            is_over_marker = self._grabbed(context, objects, view) is not None
            self._hover(context, None if is_over_marker else self._under(context, objects, view))
        elif event.type == "LEFTMOUSE" and event.value in {"PRESS", "DOUBLE_CLICK"}:
            self._drag = self._grabbed(context, objects, view)
            if self._drag is None:
                self._click(context, objects, self._under(context, objects, view))
            else:
                self._begin_drag(context, objects[0], self._drag)
        return {"PASS_THROUGH" if event.type == "MOUSEMOVE" else "RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender closes the window or loads another file."""
        self._end(context)

    def _objects(self, context: bpy.types.Context) -> list[MeshObject] | None:
        """The source and its target, or None if either is gone or the target has changed."""
        objects: list[Any] = [context.view_layer.objects.get(name) for name in self._names]
        return objects if None not in objects and objects[0].authalic_target == objects[1] else None

    def _under(
        self, context: bpy.types.Context, objects: Sequence[MeshObject], view: Seen
    ) -> tuple[str, int] | None:
        """(side, vertex) under the cursor, or None."""
        shown, seen, pixel = self._seen(context, objects, view)
        picked = picking.pick(
            [self._surfaces[k] for k in shown], seen, pixel, blocked=_blocked(context, objects, seen, pixel)
        )
        return picked and (_SIDES[shown[picked[0]]], picked[1])

    def _seen(
        self, context: bpy.types.Context, objects: Sequence[MeshObject], view: Seen
    ) -> tuple[list[int], picking.View, tuple[int, int]]:
        """Which of the surfaces are shown in a view, the view, and the pixel in it."""
        area, region, pixel = view
        space: Any = area.spaces.active
        states = [_state(obj) for obj in objects]
        if self._states != states:
            self._states, self._surfaces = states, [_surface(obj, context) for obj in objects]
        shown = [k for k, obj in enumerate(objects) if obj.visible_get(viewport=space)]
        for k in shown:
            self._surfaces[k].place(objects[k].matrix_world)
        matrix = np.array(region.data.perspective_matrix)
        return shown, picking.View(matrix, region.width, region.height), pixel

    def _grabbed(self, context: bpy.types.Context, objects: Sequence[MeshObject], view: Seen) -> Drag | None:
        """The marker under the cursor, as it is before it is dragged."""
        scene: Any = context.scene
        if not scene.authalic_show_landmarks:
            return None
        shown, seen, pixel = self._seen(context, objects, view)
        there = [
            Drag(index, _SIDES[k], vertices[k], vertices[k])
            for index, pair in enumerate(landmark_points.pairs(objects[0], drawing=True))
            for k, vertices in ((k, (pair.source_vertex, pair.target_vertex)) for k in shown)
            if vertices[k] != NONE
        ]
        marked = [(shown.index(_SIDES.index(drag.side)), drag.vertex) for drag in there]
        radius = _GRABBED * max(1.0, bpy.context.preferences.system.ui_scale)
        number = picking.grabbed([self._surfaces[k] for k in shown], marked, seen, pixel, radius=radius)
        return None if number is None else there[number]

    def _begin_drag(self, context: bpy.types.Context, source: MeshObject, drag: Drag) -> None:
        source.authalic_landmark_index = drag.index
        self._say(context, source.authalic_landmarks[drag.index].name)
        self._hover(context, None)

    def _dragged(
        self,
        context: bpy.types.Context,
        objects: Sequence[MeshObject],
        event: bpy.types.Event,
        view: Seen | None,
    ) -> bool:
        """Takes an event while a marker is dragged; whether it needs nothing else."""
        drag = self._drag
        if drag is None or drag.index >= len(objects[0].authalic_landmarks):
            self._drop(context)
            return False
        if event.type == "MOUSEMOVE":
            picked = self._under(context, objects, view) if view is not None else None
            if picked is not None and picked[0] == drag.side:
                drag.vertex = picked[1]
                shown_dragged[self._names[0], drag.index, drag.side] = drag.vertex
                redraw(context)
            return True
        if event.value == "PRESS" and event.type in {"ESC", "RIGHTMOUSE"}:
            self._drop(context)
            self._say(context, "")
            return True
        if event.type == "LEFTMOUSE":
            self._drop(context)
            if event.value == "RELEASE":
                self._move(context, objects[0], drag)
                return True
            return False  # a press: the release went to another window
        return True

    def _drop(self, context: bpy.types.Context) -> None:
        """Ends the drag; the marker is drawn where its landmark is."""
        self._drag = None
        shown_dragged.clear()
        redraw(context)

    def _move(self, context: bpy.types.Context, source: MeshObject, drag: Drag) -> None:
        """Moves a landmark to where its marker was dragged."""
        if drag.vertex == drag.start:
            return
        name = source.authalic_landmarks[drag.index].name
        try:
            self._push_undo()
            landmark_points.move(source, drag.index, drag.side, drag.vertex)
        except CannotPair as problem:
            self._say(context, str(problem)[:1].upper() + str(problem)[1:])
            return
        self._steps.append(Moved(name, drag.index, drag.side, drag.start, drag.vertex))
        pair = landmark_points.pairs(source)[drag.index]
        self.source_vertex, self.target_vertex, self.index = *pair[1:3], drag.index
        self._say(context, f"Moved {name} to vertex {drag.vertex}")

    def _push_undo(self) -> None:
        """Makes what was done so far a step of undo; Blender makes the last itself."""
        if self._steps != self._pushed:
            bpy.ops.ed.undo_push(message=self.bl_label)
            self._pushed = list(self._steps)

    def _hover(self, context: bpy.types.Context, picked: tuple[str, int] | None) -> None:
        source: Any = context.view_layer.objects.get(self._names[0])
        number = str(len(source.authalic_landmarks) + 1) if source else ""
        hints = [self._hint(side, vertex, number) for side, vertex in self._chosen.items()]
        if picked is not None:
            hints.append(self._hint(*picked, number))
        if hints != shown_hints:
            shown_hints[:] = hints
            redraw(context)

    def _hint(self, side: str, vertex: int, text: str) -> Marker:
        return Marker(self._names[_SIDES.index(side)], vertex, text, side, is_active=True)

    def _click(
        self, context: bpy.types.Context, objects: Sequence[MeshObject], picked: tuple[str, int] | None
    ) -> None:
        if picked is None:
            self._say(context, "No vertex of the two objects is there")
            return
        side, vertex = picked
        self._chosen[side] = vertex
        if len(self._chosen) == 2:
            self._pair(context, objects[0])
        else:
            self._say(context, f"{side.capitalize()} vertex {vertex}")
        self._hover(context, None)

    def _pair(self, context: bpy.types.Context, source: MeshObject) -> None:
        vertices = self._chosen["source"], self._chosen["target"]
        self._chosen.clear()
        try:
            self._push_undo()
            added = landmark_points.add(source, *vertices)
        except CannotPair as problem:
            self._say(context, str(problem)[:1].upper() + str(problem)[1:])
        else:
            self._steps.append(Added(added.name, *vertices))
            self.source_vertex, self.target_vertex, self.index = *vertices, NONE
            self._say(context, f"Added {added.name}")

    def _take_back(self, context: bpy.types.Context, objects: Sequence[MeshObject]) -> None:
        """Undoes the last click if it has not made a pair yet, else the last step of this run."""
        if self._chosen:
            self._chosen.popitem()
            self._say(context, "")
        elif self._steps:
            self._say(context, self._steps.pop().take_back(objects[0]))
        self._hover(context, None)
        redraw(context)

    def _say(self, context: bpy.types.Context, text: str) -> None:
        missing = [side for side in _SIDES if side not in self._chosen]
        words = bpy.app.translations.pgettext_iface
        wanted = words("Pick on the source or the target")
        if missing == ["source"]:
            wanted = words("Pick on the source ({name})").format(name=self._names[0])
        elif missing == ["target"]:
            wanted = words("Pick on the target ({name})").format(name=self._names[1])

        def draw(header: bpy.types.Header, _context: bpy.types.Context) -> None:
            layout = header.layout
            layout.label(text=wanted, icon="MOUSE_LMB", translate=False)
            layout.label(text="Drag Marker", icon="MOUSE_LMB_DRAG")
            layout.label(text="Undo", icon=_backspace())
            layout.label(text="Done", icon="EVENT_ESC")
            layout.label(text=text, translate=False)

        if context.workspace is not None:
            context.workspace.status_text_set(draw)
        redraw(context)

    def _end(self, context: bpy.types.Context) -> Status:
        AUTHALIC_OT_landmark_pick.running = False
        shown_hints.clear()
        shown_dragged.clear()
        if context.window is not None:
            context.window.cursor_modal_restore()
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        redraw(context)
        if not self._steps and not self._pushed:
            return {"CANCELLED"}
        self.report({"INFO"}, f"{summary(self._steps)} of {self._names[0]} and {self._names[1]}")
        return {"FINISHED"}


def _takes_back(event: bpy.types.Event) -> bool:
    return event.type == "BACK_SPACE" or (event.type == "Z" and (event.ctrl or event.oskey))


def _backspace() -> Any:
    """The icon of the key, which Blender 4.2 lacks."""
    layout: Any = bpy.types.UILayout
    icons = layout.bl_rna.functions["label"].parameters["icon"].enum_items
    return "EVENT_BACKSPACE" if "EVENT_BACKSPACE" in icons else "LOOP_BACK"


def _view_under(context: bpy.types.Context, event: bpy.types.Event) -> Seen | None:
    """(area, region, pixel) of the 3D view that the mouse is in, or None if a panel is there."""
    x, y = event.mouse_x, event.mouse_y
    for area in context.window.screen.areas:
        if area.type == "VIEW_3D" and _contains(area, x, y):
            inside = [region for region in area.regions if _contains(region, x, y)]
            views = [region for region in inside if region.type == "WINDOW"]
            if views and len(views) == len(inside):
                return area, views[0], (x - views[0].x, y - views[0].y)
    return None


def _contains(place: bpy.types.Area | bpy.types.Region, x: int, y: int) -> bool:
    return place.x <= x < place.x + place.width and place.y <= y < place.y + place.height


def _surface(obj: MeshObject, context: bpy.types.Context) -> picking.Pickable:
    seen = vertex_positions.surface(obj, context.evaluated_depsgraph_get())
    return picking.Pickable(*seen, obj.matrix_world)


def _state(obj: MeshObject) -> tuple[object, ...]:
    """A state that changes when the surface of an object must be read again."""
    mesh = obj.data
    return obj.as_pointer(), mesh.session_uid, mesh.is_editmode, point_marks.vertex_count(mesh)


def _blocked(
    context: bpy.types.Context, objects: Sequence[MeshObject], view: picking.View, pixel: ArrayLike
) -> float:
    """The distance at which another object hides everything behind it, else infinity."""
    origin, direction = view.ray(pixel)
    start = origin
    for _ in range(_SKIPPED):
        hit, point, _, _, obj, _ = context.scene.ray_cast(
            context.evaluated_depsgraph_get(), origin=start.tolist(), direction=direction.tolist()
        )
        if not hit or obj.original in objects:
            return np.inf
        away = np.linalg.norm(np.array(point) - origin)
        if obj.display_type not in {"WIRE", "BOUNDS"}:
            return away
        start = origin + direction * away * (1 + 1e-5)
    return np.inf


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_landmark_pick)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_OT_landmark_pick)
