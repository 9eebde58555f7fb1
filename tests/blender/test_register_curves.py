# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.register by landmark curves: the morph, its report, its refusals, and transfers after it."""

import contextlib
import re
from pathlib import Path
from typing import Any

import bmesh
import bpy
import curving
import drawing
import meshes
import numpy as np
import pairs
import problems
import pytest
import spheres
from installed import part
from mathutils import Matrix
from meshes import Array, MeshObject
from pairs import TILTED

KEY = "Morph → Twin"
ROUTES = (
    [(1, 0.3, 0), (0.6, 0.9, 0.3), (0, 1, 0.5)],
    [(-1, 0.2, 0.4), (-0.6, -0.6, 0.5), (-0.1, -1, 0.2)],
    [(0.4, -0.5, -1), (-0.3, 0.4, -1)],
    [(0.3, -0.3, 1), (-0.3, 0.3, 1)],
)


def register(**options: Any) -> set[str]:
    return bpy.ops.authalic.register(method="CURVES", **options)


def couple(source: MeshObject, target: MeshObject, curves: Any) -> tuple[MeshObject, MeshObject]:
    """Gives the source a target and curves (source path, target path)."""
    source.authalic_target = target
    meshes.select(source)
    for paths in curves:
        curving.add(*paths)
    bpy.context.view_layer.update()
    return source, target


def balls(matrix: Matrix | None = None, count: int = 4) -> tuple[MeshObject, MeshObject]:
    """A bumpy sphere and its copy, with curves all around."""
    source = meshes.bumpy(meshes.icosphere(3))
    target = pairs.twin(source, matrix)
    paths = [curving.route(source, *stops) for stops in ROUTES[:count]]
    return couple(source, target, [(path, path) for path in paths])


def sheets() -> tuple[MeshObject, MeshObject]:
    """A bumpy grid and its copy, with two curves inside."""
    source = meshes.add_grid("Sheet", n=10)
    target = pairs.twin(source)
    paths = [curving.route(source, (x, -0.4, 0), (x, 0.4, 0)) for x in (-0.4, 0.4)]
    return couple(source, target, [(path, path) for path in paths])


def onto_another_sphere() -> tuple[MeshObject, MeshObject]:
    """A cube's sphere of quads and a bumpy one of triangles."""
    source, target = meshes.cube_sphere(4), meshes.bumpy(meshes.icosphere(4), 0.1)
    target.name = "Twin"
    target.matrix_world = TILTED
    curves = [[curving.route(obj, *stops) for obj in (source, target)] for stops in ROUTES]
    return couple(source, target, curves)


def ring_around(obj: MeshObject, vertex: int) -> list[int]:
    """The closed path around a vertex of a mesh of triangles."""
    faces: list[list[int]] = [list(face.vertices) for face in obj.data.polygons]
    around = [face for face in faces if vertex in face]
    turned = [face[face.index(vertex) :] + face[: face.index(vertex)] for face in around]
    following = {first: second for _, first, second in turned}
    ring = [turned[0][1]]
    while len(ring) <= len(following):
        ring.append(following[ring[-1]])
    return ring


def from_polyline(points: Array, corners: Any) -> Array:
    """The distances of points (k, 3) from a polyline (n, 3)."""
    a, along = corners[:-1], np.diff(corners, axis=0)
    place = np.einsum("knd,nd->kn", points[:, None] - a, along) / (along**2).sum(axis=1)
    nearest = a + np.clip(place, 0, 1)[..., None] * along
    return np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1)


def test_a_copy_is_found_again() -> None:
    source, target = balls()
    before = pairs.positions(source)
    assert register() == {"FINISHED"}
    blocks = source.data.shape_keys.key_blocks
    assert [block.name for block in blocks] == ["Basis", KEY] and blocks[KEY].value == 0
    assert (pairs.positions(source) == before).all() and target.data.shape_keys is None
    np.testing.assert_allclose(pairs.positions(source, KEY), before, atol=0.01 * pairs.size(before))


def test_a_copy_that_is_moved_turned_and_scaled() -> None:
    mirror = Matrix.Scale(-1, 4, (1, 0, 0)) @ TILTED
    source, target = balls(mirror)
    source.matrix_world = Matrix.Scale(-1, 4, (0, 1, 0)) @ TILTED
    bpy.context.view_layer.update()
    assert register() == {"FINISHED"}
    expected = pairs.moved(pairs.positions(target), source.matrix_world.inverted() @ mirror)
    np.testing.assert_allclose(pairs.positions(source, KEY), expected, atol=0.01 * pairs.size(expected))


def test_another_surface(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = onto_another_sphere()
    assert register() == {"FINISHED"}
    said = capfd.readouterr().out
    goal = pairs.moved(pairs.positions(source, KEY), target.matrix_world.inverted())
    extent = pairs.size(pairs.positions(target))
    for curve in part("landmarks.curves").pairs(source):
        ends = goal[list(curve.source.vertices)]
        line = pairs.positions(target)[list(curve.target.vertices)]
        assert from_polyline(ends, line).max() < 1e-5 * extent
        np.testing.assert_allclose(ends[[0, -1]], line[[0, -1]], atol=1e-5 * extent)
    assert all(0 <= curve.error < 1e-5 for curve in source.authalic_landmark_curves)
    assert re.search(rf"{KEY} on Cube: 4 landmark curves, curve error max 0\.000 % of the size of Twin", said)
    assert re.search(r"0 folds, strain 1\.\d\d \(\d+ % of the surface .*\), [\w ]+, \d+\.\d+ s", said)
    assert not source.data.uv_layers.get("Authalic Registered")


def test_open_surfaces() -> None:
    source, _ = sheets()
    before = pairs.positions(source)
    assert register() == {"FINISHED"}
    np.testing.assert_allclose(pairs.positions(source, KEY), before, atol=0.02 * pairs.size(before))


def test_loops() -> None:
    """Around the waists of two spheres, and a curve on either side of it."""
    source = meshes.uv_sphere(24, 12)
    target = pairs.twin(source)
    points = pairs.positions(source)
    waist = np.flatnonzero(np.abs(points[:, 2]) < 1e-5)
    waist = waist[np.argsort(np.arctan2(points[waist, 1], points[waist, 0]))].tolist()
    ends = [curving.route(source, (0.9, 0, z), (0, 0.9, z)) for z in (0.5, -0.5)]
    loop = (*waist, waist[0])
    couple(source, target, [(loop, (*loop[5:], *loop[1:6])), *((path, path) for path in ends)])
    assert register() == {"FINISHED"}
    key = pairs.positions(source, KEY)
    assert np.abs(key[waist, 2]).max() < 1e-5
    np.testing.assert_allclose(key, points, atol=0.05 * pairs.size(points))


def test_align_and_animate() -> None:
    source, _ = balls(TILTED, count=3)
    before = pairs.positions(source)
    register(align=True, animate=True, frame_end=20)
    np.testing.assert_allclose(pairs.positions(source, KEY), before, atol=0.01 * pairs.size(before))
    assert source.data.shape_keys.animation_data is not None


def test_points_are_not_needed_and_do_not_count() -> None:
    source, _ = balls()
    part("landmarks.points").add(source, 5, 7)
    assert register() == {"FINISHED"}
    assert source.authalic_landmarks[0].error == -1
    with pytest.raises(RuntimeError, match="needs at least two landmark pairs"):
        bpy.ops.authalic.register()


def test_the_registration_is_kept_and_transfers_use_it(monkeypatch: pytest.MonkeyPatch) -> None:
    source, target = balls()
    register()
    group = target.vertex_groups.new(name="Top")
    group.add([v.index for v in target.data.vertices if v.co.z > 0], 1.0, "REPLACE")
    registrations, made = part("bridge.registrations"), []
    monkeypatch.setattr(registrations, "_registered_by_curves", lambda *_: made.append(1))
    monkeypatch.setattr(registrations, "_registered_by_points", lambda *_: made.append(1))
    register(align=True)
    meshes.select(source)
    assert bpy.ops.authalic.transfer() == {"FINISHED"}
    assert not made
    weights = [vertex.groups[0].weight if vertex.groups else 0.0 for vertex in source.data.vertices]
    heights = pairs.positions(source)[:, 2]
    assert np.mean((np.array(weights) > 0.5) == (heights > 0)) > 0.97


def test_transfer_by_curves_alone() -> None:
    source, target = balls()
    target.vertex_groups.new(name="All").add(range(len(target.data.vertices)), 1.0, "REPLACE")
    assert bpy.ops.authalic.transfer() == {"FINISHED"}
    assert "All" in source.vertex_groups
    for name in list(source.vertex_groups.keys()):
        source.vertex_groups.remove(source.vertex_groups[name])
    assert bpy.ops.authalic.transfer(method="CURVES") == {"FINISHED"}
    assert "All" in source.vertex_groups


def layer(target: MeshObject) -> None:
    """Gives a target a layer to transfer."""
    target.vertex_groups.new(name="All").add(range(len(target.data.vertices)), 1.0, "REPLACE")


def test_transfers_go_by_the_method_of_the_last_registration(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    source, target = balls()
    for vertex in (5, 50):
        part("landmarks.points").add(source, vertex, vertex)
    register()
    layer(target)
    path = str(tmp_path / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    part("bridge.registrations")._registrations._found.clear()
    bpy.ops.wm.open_mainfile(filepath=path)
    for said in ("by landmark curves (registered anew)", "by landmark curves, "):
        assert bpy.ops.authalic.transfer() == {"FINISHED"}
        assert said in capfd.readouterr().out
    bpy.ops.authalic.register()
    bpy.ops.authalic.transfer()
    assert "by landmark points, " in capfd.readouterr().out


def test_transfer_by_boundaries_alone(capfd: pytest.CaptureFixture[str]) -> None:
    source = meshes.add_grid("Sheet", n=10)
    _, target = couple(source, pairs.twin(source), [])
    layer(target)
    assert bpy.ops.authalic.transfer() == {"FINISHED"}
    assert "from Twin to Sheet by boundaries (registered anew)" in capfd.readouterr().out


def refusal(pattern: str, obj: MeshObject | None = None, **options: Any) -> None:
    obj = obj or bpy.context.object
    with pytest.raises(RuntimeError, match=pattern):
        register(**options)
    assert obj.data.shape_keys is None


def test_there_must_be_a_curve_or_a_boundary() -> None:
    balls(count=0)
    refusal("Icosphere needs a landmark curve; select edges that belong together on both and add them")


def test_broken_curves_are_named() -> None:
    source, _ = balls(count=2)
    path = part("landmarks.curves").pairs(source)[1].target.vertices
    twin = source.authalic_target
    meshes.edit(twin)
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    twin.data.vertices[path[2]].select = True
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.delete(type="VERT")
    bpy.ops.object.mode_set(mode="OBJECT")
    meshes.select(source)
    refusal('Curve "Curve 2": has .* on Twin')


def test_a_side_that_is_missing() -> None:
    source, _ = balls(count=1)
    curving.add(curving.route(source, *ROUTES[1]))
    refusal('Curve "Curve 2": has no edges on Twin')


def test_curve_that_meets_the_boundary() -> None:
    source, _ = sheets()
    curving.add((0, 1, 2), (26, 27, 28), name="Rim")
    refusal(r'Curve "Rim" meets the boundary of Sheet at vertices 0, 1, 2; end it inside', source)


@pytest.mark.parametrize("swapped", [False, True])
def test_other_boundaries_are_filled_and_outlines_matched(
    swapped: bool, capfd: pytest.CaptureFixture[str]
) -> None:
    vertices, faces = meshes.grid(n=8)
    gone = 27
    holed = meshes.add(vertices, [face for number, face in enumerate(faces) if number != gone], "Holed")
    sheet = meshes.add_grid("Sheet", n=8)
    source, target = (sheet, holed) if swapped else (holed, sheet)
    couple(source, target, [((10, 11, 12), (10, 11, 12))])
    assert register() == {"FINISHED"}
    said = capfd.readouterr().out
    assert "1 hole of Holed was filled for the map" in said and "0 folds" in said
    key = pairs.positions(source, f"Morph → {target.name}")
    assert np.abs(key - vertices).max() < 0.04  # all but the filling, which is flatter, is alike
    border = np.flatnonzero(np.abs(np.abs(vertices[:, :2]).max(axis=1) - 1) < 1e-6)
    np.testing.assert_allclose(key[border], vertices[border], atol=1e-5)
    target.vertex_groups.new(name="Edge").add([0], 1.0, "REPLACE")
    assert bpy.ops.authalic.transfer() == {"FINISHED"}
    assert "by landmark curves" in capfd.readouterr().out


def test_a_curve_that_meets_an_outline_is_named_beside_filled_holes() -> None:
    vertices, faces = meshes.grid(n=8)
    holed = meshes.add(vertices, [face for number, face in enumerate(faces) if number != 27], "Holed")
    couple(holed, meshes.add_grid("Sheet", n=8), [((0, 1, 2), (10, 11, 12))])
    refusal('Holed: curves "Curve 1" and "the outline" meet', holed)


def test_an_open_mesh_onto_a_closed_one_by_curves(capfd: pytest.CaptureFixture[str]) -> None:
    """The rim of the hole is a curve of the source alone; there the target has a ring of edges."""
    source, _ = balls(TILTED, count=3)
    points = pairs.positions(source)
    top = int(points[:, 2].argmax())
    ring = ring_around(source, top)
    edit = bmesh.new()
    edit.from_mesh(source.data)
    edit.verts.ensure_lookup_table()
    bmesh.ops.delete(edit, geom=[edit.verts[top]], context="VERTS")
    edit.to_mesh(source.data)
    edit.free()
    after = [vertex - (vertex > top) for vertex in ring]
    curving.add(after, ring, name="Rim")
    assert register() == {"FINISHED"}
    assert "1 hole of Icosphere was filled for the map" in capfd.readouterr().out
    key = pairs.positions(source, KEY)
    goal = pairs.moved(np.delete(points, top, axis=0), TILTED)
    assert np.abs(key - goal).max() < 0.02 * pairs.size(goal)
    np.testing.assert_allclose(key[after[:-1]], goal[after[:-1]], atol=1e-4)


def test_open_and_closed_without_curves_need_one() -> None:
    source = meshes.add_grid("Sheet", n=8)
    couple(source, meshes.icosphere(2), [])
    refusal("Sheet needs a landmark curve", source)


def test_edges_without_faces() -> None:
    vertices, faces = spheres.icosphere(2)
    source = meshes.add([*vertices, (3, 0, 0)], faces, "Dusty")
    far = int(np.argmax(-vertices[:, 0]))
    mesh = source.data
    mesh.edges.add(1)
    mesh.edges[-1].vertices = (0, far)
    mesh.update()
    target = pairs.twin(source)
    near = curving.route(source, vertices[far], vertices[far] + [0.2, 0.2, 0])
    couple(source, target, [((0, *near), (0, *near))])
    refusal(rf'Curve "Curve 1" has the edge \(0, {far}\) of Dusty, which has no face', source)


def test_handle_and_pieces() -> None:
    torus = meshes.torus()
    couple(torus, pairs.twin(torus), [((0, 1, 2), (0, 1, 2))])
    refusal("Torus: has a handle, like a torus; close it up or remesh it")


def test_sentences_name_curves_and_vertices() -> None:
    balls(count=2)
    sides = part("jobs.register").chosen(bpy.context).sides
    curves: list[Any] = [("Brow", (), ()), ("Jaw", (), ()), ("Ear", (), ())]

    def said(kind: str, **facts: Any) -> str:
        problem = problems.made("MeshError", kind, **facts)
        return part("registration.problems").in_words(problem, sides, curves)

    meeting = said("curves_meet", side="source", curve=0, second_curve=2, indices=(7,), count=1)
    assert meeting.startswith('Icosphere: curves "Brow" and "Ear" meet at vertex 7: shorten')
    (warned,) = part("registration.problems").remarks(
        [problems.warned("backward_curve", curve=1)], sides, curves
    )
    assert warned.startswith('curve "Jaw" fits far better in reverse')
    unpaired = said("curve_counts", indices=(0, 1), count=2)
    assert unpaired.startswith('give a partner to curves "Brow" and "Jaw"')
    assert said("no_arc", curve=9).startswith("no path joins curve 9 to the next")
    assert said("no_arc", curve=2).startswith('no path joins curve "Ear" to the next')
    assert said("no_arc").startswith("no path joins a boundary to the next")
    assert said("no_arc", side="target", curve=2).startswith('Twin: no path joins curve "Ear"')
    mirrored = said("mirrored")
    assert "Object > Mirror" in mirrored and "negate" not in mirrored and "Flip" not in mirrored


def test_opposite_normals_of_open_surfaces_are_told(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = sheets()
    target.data.flip_normals()
    with contextlib.suppress(RuntimeError):
        register()
    said = capfd.readouterr().out
    assert "(Mesh > Normals > Flip)" in said.split("the other way round")[0]
    assert part("registration.sides").is_open(part("jobs.register").chosen(bpy.context).sides[0])
    assert source.authalic_target == target


def test_a_curve_that_runs_the_other_way_is_told(capfd: pytest.CaptureFixture[str]) -> None:
    balls()
    bpy.ops.authalic.landmark_curve_reverse(index=1)
    assert register() == {"FINISHED"}
    assert 'curve "Curve 2" fits far better in reverse' in capfd.readouterr().out


def directions(source: MeshObject) -> list[tuple[int, ...]]:
    return [curve.target.vertices for curve in part("landmarks.curves").pairs(source)]


def shown_buttons(panel: str) -> tuple[list[str], list[str]]:
    """The labels of a panel, and its operators."""
    layout = drawing.draw_panel(panel)
    return layout.labels, [name for name, _ in layout.operators]


def test_the_curves_that_look_reversed_are_reversed_by_a_button(capfd: pytest.CaptureFixture[str]) -> None:
    part("jobs.reversed_curves")._reversed.clear()
    source, _ = balls()
    right = directions(source)
    for index in (1, 3):
        bpy.ops.authalic.landmark_curve_reverse(index=index)
    with pytest.raises(RuntimeError, match="No curve looked reversed"):
        bpy.ops.authalic.landmark_curve_reverse_these()
    assert register() == {"FINISHED"}
    for panel in ("AUTHALIC_PT_landmark_curves", "AUTHALIC_PT_wrap"):
        labels, buttons = shown_buttons(panel)
        assert "C2, C4 fit far better in reverse" in " ".join(labels).replace("  ", " ")
        assert "authalic.landmark_curve_reverse_these" in buttons
    assert bpy.ops.authalic.landmark_curve_reverse_these() == {"FINISHED"}
    assert directions(source) == right
    assert "Reversed C2, C4; wrap again" in capfd.readouterr().out
    for panel in ("AUTHALIC_PT_landmark_curves", "AUTHALIC_PT_wrap"):
        assert "authalic.landmark_curve_reverse_these" not in shown_buttons(panel)[1]
    register()
    assert "far better in reverse" not in capfd.readouterr().out


def test_a_curve_that_was_changed_since_is_not_reversed() -> None:
    source, _ = balls()
    for index in (1, 3):
        bpy.ops.authalic.landmark_curve_reverse(index=index)
    register()
    bpy.ops.authalic.landmark_curve_reverse(index=1)
    assert part("jobs.reversed_curves").of(source) == [3]
    bpy.ops.authalic.landmark_curve_remove(index=0)
    assert part("jobs.reversed_curves").of(source) == [2]


def test_reversing_these_is_one_step_of_undo() -> None:
    source, _ = balls()
    bpy.ops.authalic.landmark_curve_reverse(index=2)
    register()
    before, name = directions(source), source.name
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.authalic.landmark_curve_reverse_these("EXEC_DEFAULT", True)
    assert directions(bpy.data.objects[name]) != before
    bpy.ops.ed.undo()
    source = bpy.data.objects[name]
    assert directions(source) == before and part("jobs.reversed_curves").of(source) == [2]


def test_where_curves_fit_mirrored_all_open_ones_can_be_reversed() -> None:
    source, _ = balls()
    register_module = part("jobs.register")
    bridge = part("bridge")
    couple_ = part("jobs.couple").chosen(bpy.context)

    def refuse(*_: Any, **__: Any) -> None:
        raise bridge.MirroredCurves("mirrored")

    before, bridge.register = bridge.register, refuse
    try:
        with pytest.raises(register_module.CannotRegister, match="mirrored"):
            register_module.registration(
                couple_, part("registration.settings").Settings(method="CURVES"), None
            )
    finally:
        bridge.register = before
    assert part("jobs.reversed_curves").of(source) == [0, 1, 2, 3]


def test_undo_and_redo() -> None:
    source, _ = balls(count=3)
    bpy.ops.ed.undo_push(message="Start")
    name = source.name
    bpy.ops.authalic.register("EXEC_DEFAULT", True, method="CURVES")
    assert KEY in source.data.shape_keys.key_blocks
    bpy.ops.ed.undo()
    assert bpy.data.objects[name].data.shape_keys is None
    bpy.ops.ed.redo()
    assert KEY in bpy.data.objects[name].data.shape_keys.key_blocks


@pytest.mark.parametrize("end", ["cancel", "end_early"])
def test_stopped(end: str) -> None:
    """Enter keeps the current result; without one it is an error. Neither writes half a morph."""
    source, _ = balls()
    registration = part("jobs.register")
    settings = registration.Settings(part("registration.settings").Settings(method="CURVES"))
    job = registration.job(bpy.context, settings).start()
    getattr(job, end)()
    try:
        report = job.apply()
    except (part("jobs.job").Cancelled, registration.CannotRegister):
        assert source.data.shape_keys is None
    else:
        assert end == "end_early" and report.registered.folds == 0


def test_curves_that_changed_meanwhile() -> None:
    source, _ = balls()
    registration = part("jobs.register")
    settings = registration.Settings(part("registration.settings").Settings(method="CURVES"))
    job = registration.job(bpy.context, settings).start()
    job._thread.join()
    part("landmarks.curves").remove(source, 0)
    with pytest.raises(registration.CannotRegister, match="changed meanwhile; nothing was written"):
        job.apply()
    assert source.data.shape_keys is None


def test_progress_rises() -> None:
    source, _ = balls()
    source.data.vertices[0].co.z += 0.01  # not one that is kept
    registration, seen = part("jobs.register"), []

    def listen(fraction: float, message: str) -> bool:
        seen.append(fraction)
        return True

    settings = part("registration.settings").Settings(method="CURVES")
    registration.registration(registration.chosen(bpy.context), settings, listen)
    assert len(seen) > 3 and seen == sorted(seen) and 0 <= seen[0] <= seen[-1] <= 1
