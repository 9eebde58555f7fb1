# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertex under the cursor by geometry alone, and the picking operator with made-up events."""

import types
from collections.abc import Iterator, Sequence
from typing import Any

import bpy
import meshes
import numpy as np
import pairing
import pytest
from installed import part
from meshes import MeshObject

WIDTH, HEIGHT = 800, 600


def perspective(eye: Sequence[float] = (0, 0, 10), lens: float = 1.5) -> Any:
    """A view from the eye straight down, with +Y up."""
    near, far, aspect = 0.1, 100.0, WIDTH / HEIGHT
    depth = [(far + near) / (near - far), 2 * far * near / (near - far)]
    projection = [[lens, 0, 0, 0], [0, lens * aspect, 0, 0], [0, 0, *depth], [0, 0, -1, 0]]
    away = np.eye(4)
    away[:3, 3] = -np.array(eye, float)
    return part("landmarks.picking").View(np.array(projection, float) @ away, WIDTH, HEIGHT)


def orthographic(size: float = 3.0) -> Any:
    aspect = WIDTH / HEIGHT
    matrix = np.diag([1 / size, aspect / size, -1e-2, 1.0])
    return part("landmarks.picking").View(matrix, WIDTH, HEIGHT)


def surface(obj: MeshObject) -> Any:
    seen = part("blender.vertex_positions").surface(obj, bpy.context.evaluated_depsgraph_get())
    return part("landmarks.picking").Pickable(*seen, obj.matrix_world)


def pick(surfaces: Sequence[Any], view: Any, pixel: Any, **options: Any) -> Any:
    return part("landmarks.picking").pick(surfaces, view, pixel, **options)


@pytest.mark.parametrize("view", [perspective, orthographic])
def test_rays_and_pixels_belong_together(view: Any) -> None:
    seen = view()
    origin, direction = seen.ray((123.0, 456.0))
    along = origin + np.outer([0.5, 5.0], direction)
    assert np.allclose(seen.project(along), [123, 456], atol=1e-6)
    assert direction[2] < 0 and np.isclose(np.linalg.norm(direction), 1)


def test_what_is_behind_the_eye_has_no_pixel() -> None:
    assert np.isnan(perspective().project(np.array([[0.0, 0, 11]]))).all()


@pytest.mark.parametrize("view", [perspective, orthographic])
@pytest.mark.parametrize("mode", ["object", "edit", "subdivided"])
def test_every_vertex_of_an_open_surface_is_found_at_its_pixel(view: Any, mode: str) -> None:
    obj = meshes.add_grid(n=5)
    obj.matrix_world = [(0.9, 0.3, 0, 0.5), (-0.3, 1.4, 0, 0.1), (0, 0, 2, -1), (0, 0, 0, 1)]
    if mode == "edit":
        meshes.edit(obj)
    elif mode == "subdivided":
        obj.modifiers.new("Subdivision", "SUBSURF")
    bpy.context.view_layer.update()
    pickable, seen = surface(obj), view()
    pixels = seen.project(pickable.world())
    assert [pick([pickable], seen, pixel + 0.4) for pixel in pixels] == [(0, k) for k in range(36)]


def test_the_far_side_is_not_picked() -> None:
    pickable, seen = surface(meshes.icosphere(3)), perspective()
    points = pickable.world()
    for pixel in seen.project(points):
        which, vertex = pick([pickable], seen, pixel)
        assert which == 0 and points[vertex][2] > -0.1


def test_the_nearer_object_is_picked() -> None:
    far, near = meshes.add_grid("Far"), meshes.add_grid("Near")
    near.location.z = 2
    bpy.context.view_layer.update()
    picked = pick([surface(far), surface(near)], perspective(), (400, 300))
    assert picked == (1, 24)
    assert pick([surface(far), surface(near)], perspective(), (400, 300), blocked=3.0) is None
    assert pick([surface(far), surface(near)], perspective(), (400, 300), blocked=9.0) == (1, 24)


def test_beside_the_surface_the_nearest_vertex_within_some_pixels() -> None:
    pickable, seen = surface(meshes.add_grid()), perspective()
    corner = seen.project(pickable.world([0]))[0]
    assert pick([pickable], seen, corner - 10) == (0, 0)
    assert pick([pickable], seen, corner - 30) is None
    assert pick([pickable], seen, (5, 5)) is None
    assert pick([], seen, (5, 5)) is None


def test_a_vertex_beside_an_edge_but_behind_another_object_is_not_picked() -> None:
    far, near = meshes.add_grid("Far"), meshes.add_grid("Near", n=1)
    near.location.z = 5
    near.scale = (0.2, 0.2, 0.2)
    bpy.context.view_layer.update()
    surfaces, seen = [surface(far), surface(near)], perspective()
    which, vertex = pick(surfaces, seen, (400, 300))
    assert which == 1
    # Right beside the near square, the far vertex in the middle is hidden by it.
    edge = seen.project(surfaces[1].world())[:, 0].max()
    which, vertex = pick(surfaces, seen, (edge + 2, 300))
    assert (which, vertex) != (0, 24)


def test_hidden_faces_are_not_picked() -> None:
    obj = meshes.add_grid()
    meshes.edit(obj)
    meshes.select_faces(obj, lambda index: False, {14, 15, 20, 21})
    assert pick([surface(obj)], perspective(), (400, 300)) is None


class Session:
    """The operator on two grids in one view, with made-up events."""

    def __init__(self) -> None:
        self.source, self.target = meshes.add_grid("Head A"), meshes.add_grid("Head B")
        self.source.location.x, self.target.location.x = -1.5, 1.5
        self.source.authalic_target = self.target
        meshes.select(self.source, self.target)
        bpy.context.view_layer.update()
        self.view = perspective()
        self.said: list[str] = []
        module = part("operators.landmark_pick")
        own = {
            name: value for name, value in vars(module.AUTHALIC_OT_landmark_pick).items() if callable(value)
        }
        self.operator = type("Plain", (), {**own, "bl_label": "Pick", "report": self._report})()
        self.operator._names = "Head A", "Head B"
        self.operator._chosen, self.operator._drag, self.operator._states = {}, None, None
        self.operator._steps, self.operator._pushed = [], []
        self.module, self.seen = module, module._view_under
        module._view_under = lambda context, event: self._under(event)
        self.context = types.SimpleNamespace(
            **{name: getattr(bpy.context, name) for name in ("mode", "view_layer", "scene", "object")},
            window=None,
            workspace=None,
            window_manager=types.SimpleNamespace(windows=()),
            evaluated_depsgraph_get=bpy.context.evaluated_depsgraph_get,
        )

    def close(self) -> None:
        self.module._view_under = self.seen
        part("overlay.points").hints.clear()
        part("overlay.points").dragged.clear()

    def _report(self, kinds: set[str], text: str) -> None:
        self.said.append(text)

    def _under(self, event: Any) -> Any:
        data = types.SimpleNamespace(perspective_matrix=self.view.matrix)
        region = types.SimpleNamespace(data=data, width=WIDTH, height=HEIGHT)
        area = types.SimpleNamespace(spaces=types.SimpleNamespace(active=None))
        return None if event.pixel is None else (area, region, event.pixel)

    def send(self, kind: str, pixel: Any = None, value: str = "PRESS", ctrl: bool = False) -> set[str]:
        event = types.SimpleNamespace(
            type=kind, value=value, ctrl=ctrl, oskey=False, alt=False, shift=False, pixel=pixel
        )
        return self.operator.modal(self.context, event)

    def at(self, obj: MeshObject, vertex: int) -> Any:
        return self.view.project(np.array([obj.matrix_world @ obj.data.vertices[vertex].co]))[0]

    def context_with_selection(self) -> Any:
        """The context in which the markers are drawn."""
        names = ("scene", "object", "selected_objects", "view_layer")
        return types.SimpleNamespace(**{name: getattr(bpy.context, name) for name in names})

    def click(self, obj: MeshObject, vertex: int) -> set[str]:
        return self.send("LEFTMOUSE", self.at(obj, vertex))

    def listed(self) -> list[Any]:
        return [pair[1:] for pair in part("landmarks.points").pairs(self.source)]


@pytest.fixture
def session() -> Iterator[Session]:
    new = Session()
    yield new
    new.close()


def test_clicks_make_pairs(session: Session) -> None:
    assert session.click(session.source, 10) == {"RUNNING_MODAL"}
    assert session.listed() == []
    session.click(session.target, 11)
    session.click(session.target, 20)
    session.click(session.target, 21)  # a second choice of the source
    session.click(session.source, 30)
    assert session.listed() == [(10, 11, None), (30, 21, None)]
    assert session.send("ESC") == {"FINISHED"}
    assert session.said == ["Picked 2 landmarks of Head A and Head B"]


def test_nothing_picked_is_nothing_done(session: Session) -> None:
    session.click(session.source, 10)
    session.send("LEFTMOUSE", (2.0, 2.0))
    assert session.send("RIGHTMOUSE", (2.0, 2.0)) == {"CANCELLED"} and session.listed() == []


@pytest.mark.parametrize("key", [{"kind": "BACK_SPACE"}, {"kind": "Z", "ctrl": True}])
def test_taking_back(session: Session, key: dict[str, Any]) -> None:
    for k in (10, 20):
        session.click(session.source, k)
        session.click(session.target, k)
    session.click(session.source, 30)
    session.send(**key)
    assert len(session.listed()) == 2 and not session.operator._chosen
    session.send(**key)
    assert session.listed() == [(10, 10, None)]
    session.send(**key)
    session.send(**key)
    # The second pair made the first a step of undo; so does the end.
    assert session.listed() == [] and session.send("ESC") == {"FINISHED"}


def test_a_vertex_is_not_picked_twice(session: Session) -> None:
    for k in (10, 11):
        session.click(session.source, 10)
        session.click(session.target, k)
    assert session.listed() == [(10, 10, None)]


def test_hovering_shows_the_vertex(session: Session) -> None:
    assert session.send("MOUSEMOVE", session.at(session.target, 12)) == {"PASS_THROUGH"}
    ((name, vertex, *_),) = part("overlay.points").shown(bpy.context)
    assert (name, vertex) == ("Head B", 12)
    session.send("MOUSEMOVE", (2.0, 2.0))
    assert part("overlay.points").hints == []


def test_navigation_and_panels_are_left_to_blender(session: Session) -> None:
    for kind in ("MIDDLEMOUSE", "WHEELUPMOUSE", "NUMPAD_1", "TRACKPADPAN", "NDOF_MOTION", "TIMER"):
        assert session.send(kind, (400, 300)) == {"PASS_THROUGH"}
    assert session.send("LEFTMOUSE", None) == {"PASS_THROUGH"}
    for kind in ("G", "X", "TAB", "Z"):
        assert session.send(kind, (400, 300)) == {"RUNNING_MODAL"}


def drag(session: Session, obj: MeshObject, vertex: int, to: int, end: str = "RELEASE") -> None:
    """Presses on the marker of a vertex, and moves the mouse to another vertex."""
    session.send("LEFTMOUSE", session.at(obj, vertex) + 3)
    session.send("MOUSEMOVE", session.at(obj, (vertex + to) // 2), "NOTHING")
    session.send("MOUSEMOVE", session.at(obj, to), "NOTHING")
    if end:
        kind = "LEFTMOUSE" if end == "RELEASE" else end
        session.send(kind, session.at(obj, to), "RELEASE" if end == "RELEASE" else "PRESS")


def two_pairs(session: Session) -> None:
    for source_vertex, target_vertex in ((10, 11), (30, 31)):
        session.click(session.source, source_vertex)
        session.click(session.target, target_vertex)
    session.source.authalic_landmarks[0].error = 1.0


@pytest.mark.parametrize("side", ["source", "target"])
def test_a_marker_is_dragged(session: Session, side: str) -> None:
    two_pairs(session)
    obj, start = getattr(session, side), {"source": 10, "target": 11}[side]
    drag(session, obj, start, 24, end="")
    shown = {
        (m.object_name, m.vertex) for m in part("overlay.points").shown(session.context_with_selection())
    }
    assert (obj.name, 24) in shown and (obj.name, start) not in shown
    assert session.listed() == [(10, 11, None), (30, 31, None)], "it moves when the button is let go"
    session.send("LEFTMOUSE", session.at(obj, 24), "RELEASE")
    first = (24, 11, None) if side == "source" else (10, 24, None)
    assert session.listed() == [first, (30, 31, None)]
    landmark = session.source.authalic_landmarks[0]
    assert landmark.error == -1 and session.source.authalic_landmark_index == 0
    assert session.operator.index == 0
    assert (session.operator.source_vertex, session.operator.target_vertex) == first[:2]
    session.send("BACK_SPACE")
    assert session.listed() == [(10, 11, None), (30, 31, None)]
    assert session.send("ESC") == {"FINISHED"}


@pytest.mark.parametrize("end", ["ESC", "RIGHTMOUSE"])
def test_esc_puts_a_marker_back_and_picking_goes_on(session: Session, end: str) -> None:
    two_pairs(session)
    drag(session, session.source, 10, 24, end=end)
    assert session.listed() == [(10, 11, None), (30, 31, None)] and not part("overlay.points").dragged
    assert session.send("LEFTMOUSE", session.at(session.source, 24), "RELEASE") == {"RUNNING_MODAL"}
    assert session.listed() == [(10, 11, None), (30, 31, None)]
    drag(session, session.source, 30, 17)
    assert session.send("ESC") == {"FINISHED"}
    assert session.said == ["Picked 2 landmarks and moved 1 of Head A and Head B"]


def test_a_marker_is_not_dragged_onto_another_nor_off_its_object(session: Session) -> None:
    two_pairs(session)
    drag(session, session.source, 10, 30)
    assert session.listed() == [(10, 11, None), (30, 31, None)]
    session.send("LEFTMOUSE", session.at(session.source, 10))
    session.send("MOUSEMOVE", session.at(session.target, 20), "NOTHING")
    session.send("LEFTMOUSE", session.at(session.target, 20), "RELEASE")
    assert session.listed() == [(10, 11, None), (30, 31, None)]
    assert not session.operator._chosen


def test_a_click_on_a_marker_makes_its_pair_the_active_one(session: Session) -> None:
    two_pairs(session)
    session.click(session.target, 11)
    session.send("LEFTMOUSE", session.at(session.target, 11), "RELEASE")
    assert session.source.authalic_landmark_index == 0 and not session.operator._chosen
    assert session.listed() == [(10, 11, None), (30, 31, None)]


def test_hidden_markers_are_not_dragged(session: Session) -> None:
    two_pairs(session)
    bpy.context.scene.authalic_show_landmarks = False
    drag(session, session.source, 10, 24)
    assert session.listed() == [(10, 11, None), (30, 31, None)]


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_moving_keeps_marks_tidy(session: Session, mode: str) -> None:
    two_pairs(session)
    points, marks = part("landmarks.points"), part("landmarks.point_marks")
    if mode == "EDIT":
        meshes.edit(session.source, session.target)
    mark = session.source.authalic_landmarks[0].source_mark
    points.move(session.source, 0, "source", 24)
    assert marks.find(session.source.data)[mark] == [24]
    assert len(marks.find(session.source.data)) == 2
    # another object has a landmark on this vertex of the same mesh
    bpy.ops.object.mode_set(mode="OBJECT")
    copy = session.source.copy()
    bpy.context.collection.objects.link(copy)
    points.move(session.source, 0, "source", 40)
    assert [pair[1] for pair in points.pairs(copy)] == [24, 30]
    assert [pair[1] for pair in points.pairs(session.source)] == [40, 30]


def test_a_lost_vertex_is_found_again_by_a_move(session: Session) -> None:
    two_pairs(session)
    meshes.edit(session.source)
    meshes.select_faces(session.source, lambda index: False)

    pairing.select_vertices(session.source, 10)
    bpy.ops.mesh.delete(type="VERT")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert session.listed()[0][0] == -1
    part("landmarks.points").move(session.source, 0, "source", 5)
    assert session.listed()[0] == (5, 11, None)


def test_scripts_and_the_redo_panel_move_a_pair(session: Session) -> None:
    two_pairs(session)
    bpy.ops.authalic.landmark_pick(index=1, source_vertex=40, target_vertex=31)
    assert session.listed() == [(10, 11, None), (40, 31, None)]
    with pytest.raises(RuntimeError, match='is in the pair "Landmark 1" already'):
        bpy.ops.authalic.landmark_pick(index=1, source_vertex=10, target_vertex=31)
    with pytest.raises(RuntimeError, match='is in the pair "Landmark 1" already'):
        bpy.ops.authalic.landmark_pick(index=1, source_vertex=33, target_vertex=11)
    assert session.listed() == [(10, 11, None), (40, 31, None)]


@pytest.mark.parametrize("lost", ["source", "target"])
def test_a_deleted_object_ends_it(session: Session, lost: str) -> None:
    session.click(session.source, 10)
    bpy.data.objects.remove(getattr(session, lost))
    bpy.context.view_layer.update()
    assert session.send("MOUSEMOVE", (400, 300)) == {"CANCELLED"}
    assert "have changed" in session.said[0] and part("overlay.points").hints == []
