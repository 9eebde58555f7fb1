# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.register: the morph that it writes, its end, its report and its refusals."""

import re
import time
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bmesh
import bpy
import linking
import meshes
import numpy as np
import pairs
import pytest
import spheres
from installed import part
from mathutils import Matrix, Vector
from mathutils.bvhtree import BVHTree
from meshes import MeshObject
from pairs import SQUEEZED, TILTED

KEY = "Morph → Twin"
UV_MAP = "Authalic Registered"
CORNERS = [(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0), (0, 0, 1)]


def register(**options: Any) -> set[str]:
    return bpy.ops.authalic.register(**options)


def sheets(matrix: Matrix | None = None, n: int = 8) -> tuple[MeshObject, MeshObject]:
    """A bumpy grid and its copy, with landmarks on the bump."""
    source = meshes.add_grid("Sheet", n=n)
    target = pairs.twin(source, matrix)
    return pairs.pair(source, target, pairs.nearest(source, [(0.4, 0.4, 0), (-0.4, 0, 0), (0.1, -0.6, 0)]))


def balls(matrix: Matrix | None = None) -> tuple[MeshObject, MeshObject]:
    """A bumpy sphere and its copy, with landmarks all around."""
    source = meshes.bumpy(meshes.icosphere(3))
    target = pairs.twin(source, matrix)
    return pairs.pair(source, target, pairs.nearest(source, CORNERS))


def onto_another_sphere() -> tuple[MeshObject, MeshObject]:
    """A cube's sphere of quads and a bumpy one of triangles."""
    source, target = meshes.cube_sphere(3), meshes.bumpy(meshes.icosphere(4), 0.15)
    target.name = "Twin"
    target.matrix_world = TILTED
    ends = zip(pairs.nearest(source, CORNERS), pairs.nearest(target, CORNERS), strict=True)
    return pairs.pair(source, target, {f"Corner {number}": both for number, both in enumerate(ends)})


def assert_near(points: Any, expected: Any) -> None:
    """Points agree as well as maps of surfaces that differ by more than rounding do."""
    np.testing.assert_allclose(points, expected, atol=0.02 * pairs.size(expected))


@pytest.mark.parametrize("make", [sheets, balls])
def test_a_copy_is_found_again(make: Callable[..., tuple[MeshObject, MeshObject]]) -> None:
    source, target = make()
    before = pairs.positions(source)
    assert register() == {"FINISHED"}
    blocks = source.data.shape_keys.key_blocks
    assert [block.name for block in blocks] == ["Basis", KEY] and blocks[KEY].value == 0
    assert (pairs.positions(source) == before).all() and target.data.shape_keys is None
    np.testing.assert_allclose(pairs.positions(source, KEY), before, atol=1e-6 * pairs.size(before))


@pytest.mark.parametrize("make", [sheets, balls])
@pytest.mark.parametrize("matrix", [TILTED, Matrix.Scale(-1, 4, (1, 0, 0)) @ TILTED])
def test_a_copy_that_is_moved_turned_and_scaled_is_found_exactly(
    make: Callable[..., tuple[MeshObject, MeshObject]], matrix: Matrix | None
) -> None:
    source, target = make(matrix)
    source.matrix_world = (
        Matrix.Scale(matrix.determinant() / abs(matrix.determinant()), 4, (0, 1, 0)) @ TILTED
    )
    bpy.context.view_layer.update()
    assert register() == {"FINISHED"}
    expected = pairs.moved(pairs.positions(target), source.matrix_world.inverted() @ matrix)
    np.testing.assert_allclose(pairs.positions(source, KEY), expected, atol=3e-6 * pairs.size(expected))


@pytest.mark.parametrize("make", [sheets, balls])
@pytest.mark.parametrize("source_matrix", [Matrix.Identity(4), SQUEEZED])
def test_the_morph_ends_where_the_target_is(
    make: Callable[..., tuple[MeshObject, MeshObject]], source_matrix: Matrix
) -> None:
    source, target = make(TILTED)
    source.matrix_world = TILTED @ source_matrix
    target.data.transform(source_matrix)
    bpy.context.view_layer.update()
    assert register() == {"FINISHED"}
    expected = pairs.moved(pairs.positions(target), source.matrix_world.inverted() @ target.matrix_world)
    assert_near(pairs.positions(source, KEY), expected)


@pytest.mark.parametrize("make", [sheets, balls])
def test_mirrored_by_its_scale(make: Callable[..., tuple[MeshObject, MeshObject]]) -> None:
    source, target = make()
    mirror = Matrix.Scale(-1, 4, (1, 0, 0))
    target.data.transform(mirror)
    target.data.flip_normals()
    target.matrix_world = mirror
    bpy.context.view_layer.update()
    assert register() == {"FINISHED"}
    assert_near(pairs.positions(source, KEY), pairs.positions(source))


def test_align_does_not_travel() -> None:
    source, _ = balls(TILTED)
    before = pairs.positions(source)
    register(align=True)
    assert_near(pairs.positions(source, KEY), before)
    register()
    assert np.linalg.norm(pairs.positions(source, KEY) - before, axis=1).min() > 0.5


def test_another_surface(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = onto_another_sphere()
    assert register() == {"FINISHED"}
    said = capfd.readouterr().out
    goal = pairs.moved(pairs.positions(source, KEY), target.matrix_world.inverted())
    tree = BVHTree.FromObject(target, bpy.context.evaluated_depsgraph_get())
    extent = pairs.size(pairs.positions(target))
    assert max(tree.find_nearest(Vector(point))[3] for point in goal) < 1e-5 * extent
    for number, landmark in enumerate(part("landmarks.points").pairs(source)):
        missed = goal[landmark.source_vertex] - pairs.positions(target)[landmark.target_vertex]
        assert np.linalg.norm(missed) < 5e-3 * extent
        error = source.authalic_landmarks[number].error
        assert error == pytest.approx(100 * np.linalg.norm(missed) / extent, abs=1e-3)
    assert re.search(
        rf"Info: {KEY} on Cube: 5 landmark pairs, landmark error mean 0\.\d+ % and max 0\.\d+ %", said
    )
    assert re.search(r"of the size of Twin, 0 folds, strain 1\.\d\d \(.*\), .*[\w ]+, \d+\.\d+ s", said)
    assert not source.data.uv_layers.get(UV_MAP)


def test_disks_get_the_registered_map() -> None:
    source, target = sheets()
    source.data.uv_layers.new(name="Own")
    assert register(target_uv=True) == {"FINISHED"}
    for obj in (source, target):
        assert (meshes.uv_areas(meshes.uv(obj, UV_MAP)[meshes.triangles(obj)[0]]) > 0).all()
        assert meshes.uv(obj, UV_MAP).min() >= 0 and meshes.uv(obj, UV_MAP).max() <= 1
    np.testing.assert_allclose(meshes.uv(source, UV_MAP), meshes.uv(target, UV_MAP), atol=1e-5)
    assert source.data.uv_layers.active.name == "Own"
    register()
    assert [layer.name for layer in source.data.uv_layers] == ["Own", UV_MAP]


def test_the_target_gets_no_uv_map_by_default() -> None:
    _, target = sheets()
    register()
    assert not target.data.uv_layers


def test_no_room_for_the_uv_map(capfd: pytest.CaptureFixture[str]) -> None:
    source, _ = sheets()
    for number in range(8):
        source.data.uv_layers.new(name=f"Map {number}")
    assert register() == {"FINISHED"}
    assert "Sheet has no room for the UV map Authalic Registered" in capfd.readouterr().out
    assert KEY in source.data.shape_keys.key_blocks


def test_again_replaces_the_key() -> None:
    source, target = balls()
    register()
    source.data.shape_keys.key_blocks[KEY].value = 0.5
    target.matrix_world = Matrix.Translation((5, 0, 0))
    bpy.context.view_layer.update()
    assert register() == {"FINISHED"}
    blocks = source.data.shape_keys.key_blocks
    assert [block.name for block in blocks] == ["Basis", KEY] and blocks[KEY].value == 0.5
    assert pairs.positions(source, KEY)[:, 0].mean() > 4


def test_edit_mode_shows_the_key_that_was_active() -> None:
    """Not the morph, which would then be what is edited."""
    source, _ = balls()
    before = pairs.positions(source)
    register()
    assert source.active_shape_key.name == "Basis"
    meshes.edit(source)
    edited = np.array([vertex.co for vertex in bmesh.from_edit_mesh(source.data).verts])
    bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_allclose(edited, before, atol=1e-6)
    source.shape_key_add(name="Smile", from_mix=False)
    source.active_shape_key_index = 2
    register()
    assert source.active_shape_key.name == "Smile"


def test_long_names() -> None:
    source, target = balls()
    target.name = "A head with a name as long as a name may be in Blender, so long"
    register()
    register()
    assert len(source.data.shape_keys.key_blocks) == 2


def test_first_shape_keys_count() -> None:
    source, target = balls()
    expected = pairs.positions(target)
    for obj in (source, target):
        obj.shape_key_add(name="Basis", from_mix=False)
        key = obj.shape_key_add(name="Larger", from_mix=False)
        key.points.foreach_set("co", (2 * pairs.positions(obj)).astype(np.float32).ravel())
        key.value = 1.0
    assert register() == {"FINISHED"}
    np.testing.assert_allclose(pairs.positions(source, KEY), expected, atol=1e-5)


def test_loose_vertices_follow(capfd: pytest.CaptureFixture[str]) -> None:
    """So do wires, which would be torn off otherwise."""
    vertices, faces = meshes.grid()
    points = [(9, 9, 9), *vertices, (0.2, 0.1, 0.4), (0.3, 0.1, 0.6)]
    source = meshes.add(points, np.asarray(faces) + 1, "Dusty")
    pairs.pair(source, pairs.twin(source, TILTED), [17, 25, 33])
    assert register() == {"FINISHED"}
    assert "3 loose vertices of Dusty followed" in capfd.readouterr().out
    key = pairs.positions(source, KEY)
    assert_near(key, pairs.moved(np.array(points), TILTED))


def test_a_loose_vertex_that_is_nowhere_is_named() -> None:
    vertices, faces = meshes.grid()
    source = meshes.add([(np.nan, 9, 9), *vertices], np.asarray(faces) + 1, "Dusty")
    pairs.pair(source, pairs.twin(source, TILTED), [17, 25, 33])
    refusal("Dusty: NaN or infinite coordinates at vertex 0")


def test_n_gons() -> None:
    bpy.ops.mesh.primitive_cylinder_add(vertices=12)
    source = bpy.context.object
    pairs.pair(source, pairs.twin(source, TILTED), [0, 9, 16])
    assert register() == {"FINISHED"}
    assert_near(pairs.positions(source, KEY), pairs.moved(pairs.positions(source), TILTED))


def curve_points(obj: MeshObject) -> Any:
    """(frame, value) of the key frames of the morph."""
    curves = [curve for group in part("blender.animation")._curves(obj.data.shape_keys) for curve in group]
    assert [curve.data_path for curve in curves] == [f'key_blocks["{KEY}"].value']
    return [tuple(point.co) for point in curves[0].keyframe_points]


def test_animate() -> None:
    source, _ = balls()
    assert register(animate=True, frame_start=10, frame_end=50) == {"FINISHED"}
    assert curve_points(source) == [(10, 0), (50, 1)]
    key = source.data.shape_keys.key_blocks[KEY]
    assert key.value == 0
    for frame, value in ((10, 0), (50, 1), (70, 1)):
        bpy.context.scene.frame_set(frame)
        assert key.value == value
    bpy.context.scene.frame_set(30)
    assert 0.2 < key.value < 0.8
    register(animate=True, frame_start=1, frame_end=20)
    assert curve_points(source) == [(1, 0), (20, 1)] and key.value == 1


def test_animation_of_other_keys_stays() -> None:
    source, _ = balls()
    source.shape_key_add(name="Basis")
    other = source.shape_key_add(name="Other")
    other.keyframe_insert("value", frame=5)
    register(animate=True)
    curves = [curve for group in part("blender.animation")._curves(source.data.shape_keys) for curve in group]
    assert [curve.data_path for curve in curves] == [
        'key_blocks["Other"].value',
        f'key_blocks["{KEY}"].value',
    ]


def test_an_action_that_is_linked_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    source, _ = balls()
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Other").keyframe_insert("value", frame=5)
    action = linking.linked_action(tmp_path, source)
    with pytest.raises(RuntimeError, match=f'the action "{action.name}" of its shape keys is linked'):
        register(animate=True)
    assert source.data.shape_keys.key_blocks.keys() == ["Basis", "Other"]
    assert register() == {"FINISHED"}


def test_frames_in_the_wrong_order() -> None:
    balls()
    refusal("The morph has to end after frame 20", animate=True, frame_start=20, frame_end=20)


def test_the_registration_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    source, target = balls()
    register()
    registrations, made = part("bridge.registrations"), []
    monkeypatch.setattr(registrations, "_registered_by_points", lambda *_: made.append(1))
    register(align=True)
    register(animate=True)
    target.location = (3, 4, 5)
    bpy.context.view_layer.update()
    register()
    assert not made and pairs.positions(source, KEY)[:, 0].mean() > 2
    target.data.vertices[3].co.x += 0.1
    with pytest.raises(AttributeError):
        part("jobs.register").job(bpy.context, part("jobs.register").Settings()).execute()
    assert made


def refusal(pattern: str, obj: MeshObject | None = None, **options: Any) -> None:
    """The operator changes nothing, and its message matches."""
    obj = obj or bpy.context.object
    with pytest.raises(RuntimeError, match=pattern):
        register(**options)
    assert obj.data.shape_keys is None and not obj.data.uv_layers.get(UV_MAP)


def test_poll() -> None:
    source, target = balls()
    source.authalic_target = None
    refusal("there is no target object; choose one")
    source.authalic_target = target
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Only in Object Mode"):
        register()


def test_an_open_surface_onto_a_closed_one(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = meshes.icosphere(3), meshes.icosphere(3)
    target.name = "Twin"
    cut_off = [vertex for vertex in source.data.vertices if vertex.co.z > 0.9]
    gone = len(cut_off)
    meshes.remove(source, [vertex.index for vertex in cut_off])
    ends = zip(pairs.nearest(source, CORNERS[:4]), pairs.nearest(target, CORNERS[:4]), strict=True)
    pairs.pair(source, target, {str(number): both for number, both in enumerate(ends)})
    assert gone and register() == {"FINISHED"}
    assert "1 hole of Icosphere was filled for the map" in capfd.readouterr().out
    assert not source.data.uv_layers.get(UV_MAP)
    goal = pairs.positions(source, KEY)
    np.testing.assert_allclose(np.linalg.norm(goal, axis=1), 1, atol=0.03)


@pytest.mark.parametrize("domain", ["AUTO", "DISK", "SPHERE"])
def test_holes_of_one_are_filled(domain: str, capfd: pytest.CaptureFixture[str]) -> None:
    vertices, faces = meshes.grid(n=8)
    kept = [face for number, face in enumerate(faces) if number not in (18, 45)]
    holed, sheet = meshes.add(vertices, kept, "Holed"), meshes.add(vertices, faces, "Twin")
    pairs.pair(holed, sheet, [40, 41, 20, 60])
    assert register(domain=domain) == {"FINISHED"}
    said = capfd.readouterr().out
    if domain == "SPHERE":
        assert "3 holes of Holed were filled for the map; 1 hole of Twin was filled" in said
    else:
        assert "2 holes of Holed were filled for the map" in said and "of Twin was filled" not in said
    after = pairs.positions(holed, KEY)
    assert np.isfinite(after).all()
    assert domain == "SPHERE" or (np.linalg.norm(after - vertices, axis=1) < 0.5).all()


def test_a_landmark_on_the_rim_of_a_filled_hole() -> None:
    vertices, faces = meshes.grid(n=8)
    kept = [face for number, face in enumerate(faces) if number != 18]
    holed, sheet = meshes.add(vertices, kept, "Holed"), meshes.add(vertices, faces, "Twin")
    pairs.pair(holed, sheet, [int(faces[18][0]), 60])
    assert register() == {"FINISHED"}


def test_a_disk_of_a_closed_surface_is_refused() -> None:
    balls()
    refusal("Icosphere: is closed, a disk has a boundary; set Domain to Automatic", domain="DISK")


def test_handle() -> None:
    torus = meshes.torus()
    pairs.pair(torus, pairs.twin(torus), [0, 50])
    refusal("Torus: has a handle, like a torus; close it up or remesh it")


def test_surfaces_that_meet() -> None:
    vertices, faces = meshes.tetrahedron()
    fin = meshes.add([*vertices, (3, 3, -3)], [*faces, [0, 1, 4]], "Fin")
    pairs.pair(fin, meshes.icosphere(1), [0, 1])
    refusal("Fin: has edges or vertices where surfaces meet", fin)


def test_empty_target() -> None:
    source = meshes.icosphere(1)
    source.authalic_target = meshes.add([], [], "Empty")
    meshes.select(source)
    refusal("Empty has no faces")


def test_no_face_has_an_area() -> None:
    _, target = balls()
    target.data.vertices.foreach_set("co", np.zeros(3 * len(target.data.vertices), np.float32))
    refusal("Twin: .*area")


@pytest.mark.parametrize("ends", [(0, 0), (1 / 64, 1 / 32)], ids=["corners in one place", "on a line"])
def test_faces_without_area_are_named_with_what_removes_them(ends: tuple[float, float]) -> None:
    source, target = balls()
    first, *others = (target.data.vertices[vertex] for vertex in target.data.polygons[100].vertices)
    corner = [round(64 * x) / 64 for x in first.co]
    first.co = corner
    for vertex, along in zip(others, ends, strict=True):
        vertex.co = [corner[0] + along, *corner[1:]]
    refusal(
        r"Twin: no area in (face 100|triangles of faces \(([\d…]+, )*100(, [\d…]+)*\)): the corners lie on a "
        r"line; remove these faces \(Mesh > Clean Up > Degenerate Dissolve\)"
    )
    meshes.select(target)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.dissolve_degenerate()
    bpy.ops.object.mode_set(mode="OBJECT")
    meshes.select(source)
    assert register() == {"FINISHED"}


def test_bad_coordinate_of_the_target() -> None:
    _, target = balls()
    target.data.vertices[7].co.y = float("nan")
    refusal("Twin: .*vertex 7")


def test_flattened_object() -> None:
    source, _ = balls()
    source.scale = (1, 1, 0)
    bpy.context.view_layer.update()
    refusal("Icosphere has a scale of zero along an axis")


@pytest.mark.parametrize(
    ("make", "count", "pattern"),
    [(sheets, 0, "Sheet needs a landmark pair"), (balls, 1, "Icosphere needs at least two landmark pairs")],
)
def test_too_few_landmarks(
    make: Callable[..., tuple[MeshObject, MeshObject]], count: int, pattern: str
) -> None:
    source, _ = make()
    while len(source.authalic_landmarks) > count:
        part("landmarks.points").remove(source, 0)
    refusal(pattern)


def test_landmark_on_the_boundary() -> None:
    source, _ = sheets()
    part("landmarks.points").add(source, 3, 40, "Rim")
    refusal('Landmark "Rim" is on the boundary of Sheet, which becomes a circle; pick a vertex inside')


def test_landmark_on_a_loose_vertex() -> None:
    source = meshes.add([*spheres.icosphere(1)[0], (5, 0, 0)], spheres.icosphere(1)[1], "Dusty")
    pairs.pair(source, meshes.icosphere(2), {"Dust": (42, 1), "Nose": (3, 5)})
    refusal('Landmark "Dust" is on a loose vertex of Dusty')


def test_lost_landmark() -> None:
    source, target = balls()
    name = source.authalic_landmarks[1].name
    meshes.edit(target)
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    target.data.vertices[source.authalic_landmarks[1].target_vertex].select = True
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.dissolve_verts()
    bpy.ops.object.mode_set(mode="OBJECT")
    meshes.select(source)
    refusal(f'Landmark "{name}": its vertex on Twin is gone')


def test_pairs_that_cannot_meet_are_named(capfd: pytest.CaptureFixture[str]) -> None:
    source, _ = sheets()
    source.data.calc_loop_triangles()
    middle = min(source.data.loop_triangles, key=lambda triangle: triangle.center.length)
    a, b, c = list(middle.vertices)
    swapped = {"A": (a, b), "B": (b, a), "C": (c, c)}
    pairs.pair(source, source.authalic_target, swapped)
    assert register() == {"FINISHED"}
    said = capfd.readouterr().out
    assert "Warning: " in said and "0 folds" in said and "landmarks missed" in said
    assert re.search(r"pairs that do not meet without a fold: [ABC]", said)
    assert "the normals of the two may face opposite ways" in said


def test_absolute_keys() -> None:
    source, _ = balls()
    source.shape_key_add(name="Basis")
    source.data.shape_keys.use_relative = False
    with pytest.raises(RuntimeError, match="its shape keys are absolute"):
        register()


def test_shared_mesh(capfd: pytest.CaptureFixture[str]) -> None:
    source, _ = balls()
    bpy.context.collection.objects.link(bpy.data.objects.new("Second", source.data))
    assert register() == {"FINISHED"}
    assert "shares its mesh, all 2 users have the key" in capfd.readouterr().out


def test_worst_pairs_are_named() -> None:
    registration = part("registration.registered").Registered(
        *[None] * 6,
        names=list("ABCDE"),
        errors=np.array([0.01, 0.02, 0.004, 0.011, 0.0105]),
        missed=[],
        energy=0.0,
        folds=0,
        status="converged",
        seconds=0.0,
    )
    assert [name for name, _ in registration.worst] == ["B", "D", "E"]
    said = part("jobs.register_report")._worst(registration)
    assert said == ', worst at "B" 2.000 %; "D" 1.100 %; "E" 1.050 %'
    registration.errors = np.full(5, 1e-7)
    assert part("jobs.register_report")._worst(registration) == ""


def test_a_high_strain_is_warned_of(capfd: pytest.CaptureFixture[str]) -> None:
    source, _ = balls()
    register(angle_weight=0.7)
    said = capfd.readouterr().out
    assert re.search(r"strain 1\.\d\d \(\d+ % of the surface stretched over 2×", said)
    assert "the strain is high" not in said
    points = part("landmarks.points")
    swapped = [pair.target_vertex for pair in source.authalic_landmarks]
    names = [pair.name for pair in source.authalic_landmarks]
    ends = [pair.source_vertex for pair in source.authalic_landmarks]
    points.clear(source)
    swapped[0], swapped[1] = swapped[1], swapped[0]
    for name, first, second in zip(names, ends, swapped, strict=True):
        points.add(source, first, second, name)
    register(angle_weight=0.7)
    said = capfd.readouterr().out
    assert "Warning: " in said
    assert re.search(
        r"the strain is high: \d+ % of the surface is stretched or shrunk over 2×, most near", said
    )
    assert "check that pair, or add pairs" in said


def test_the_strain_of_faces_is_stored_where_wanted() -> None:

    source, target = onto_another_sphere()
    register()
    assert "authalic_strain" not in source.data.attributes
    register(strain_attribute=True)
    attribute: Any = source.data.attributes["authalic_strain"]
    assert (attribute.domain, attribute.data_type) == ("FACE", "FLOAT")
    strain = np.empty(len(source.data.polygons), np.float32)
    attribute.data.foreach_get("value", strain)
    assert strain.min() >= 1 - 1e-5
    # what the edges of a quad say, with both objects scaled to one area
    corners = np.array([list(face.vertices) for face in source.data.polygons])
    images = pairs.moved(pairs.positions(source, KEY), target.matrix_world.inverted())
    lengths = [edges(points[corners]) for points in (pairs.positions(source), images)]
    scale = np.sqrt(area_of(source) / area_of(target))
    ratios = scale * lengths[1] / lengths[0]
    least = np.maximum(ratios.max(axis=1), 1 / ratios.min(axis=1))
    assert (strain >= 0.25 * (least**2 + least**-2) - 1e-3).mean() > 0.95
    assert np.corrcoef(np.log(strain), np.log(least))[0, 1] > 0.7


def edges(quads: Any) -> Any:
    return np.linalg.norm(quads - np.roll(quads, 1, axis=1), axis=2)


def area_of(obj: MeshObject) -> float:
    areas = np.empty(len(obj.data.polygons), np.float32)
    obj.data.polygons.foreach_get("area", areas)
    return float(areas.sum())


def test_the_larger_energy_is_reported() -> None:
    class Figures:
        def __init__(self, energy: float, folded: Any) -> None:
            self.authalic_energy, self.folded = energy, folded

    class Native:
        positions, registered, target_registered = (np.zeros((1, 3)) for _ in range(3))
        distortion, status, seconds = Figures(0.25, []), "converged", 0.0
        strain = types.SimpleNamespace(median=1.0, stretched=0.0, worst_landmark=None)
        missed: tuple[int, ...] = ()

    sheets()
    sides = part("jobs.register").chosen(bpy.context).sides
    figures = part("registration.registered").registered_by_points
    assert figures(Native, sides, "SPHERE", np.zeros((2, 1), int), ["A"]).energy == 0.25
    Native.target_distortion = Figures(0.5, [3])
    registered = figures(Native, sides, "SPHERE", np.zeros((2, 1), int), ["A"])
    assert (registered.energy, registered.folds) == (0.5, 1)


def test_what_is_seen_but_not_registered_is_named(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = balls()
    register()
    assert "ignored" not in capfd.readouterr().out
    source.data.shape_keys.key_blocks[KEY].value = 1.0
    source.modifiers.new("Weights", "VERTEX_WEIGHT_EDIT")
    source.modifiers.new("Off", "SUBSURF").show_viewport = False
    register()
    assert "ignored" not in capfd.readouterr().out
    source.modifiers.new("Smooth", "SUBSURF")
    target.shape_key_add(name="Basis", from_mix=False)
    target.shape_key_add(name="Fat", from_mix=False).value = 0.5
    register()
    said = capfd.readouterr().out
    assert 'Icosphere: modifier "Smooth" was ignored' in said
    assert 'Twin: shape key "Fat" was ignored' in said


def test_undo_and_redo() -> None:
    source, _ = sheets()
    bpy.ops.ed.undo_push(message="Start")
    name = source.name
    bpy.ops.authalic.register("EXEC_DEFAULT", True)
    assert KEY in source.data.shape_keys.key_blocks
    bpy.ops.ed.undo()
    assert bpy.data.objects[name].data.shape_keys is None and not bpy.data.objects[name].data.uv_layers
    bpy.ops.ed.redo()
    assert KEY in bpy.data.objects[name].data.shape_keys.key_blocks


def test_cancelled_writes_nothing() -> None:
    source, _ = balls()
    registration = part("jobs.register")
    job = registration.job(bpy.context, registration.Settings()).start()
    job.cancel()
    with pytest.raises(part("jobs.job").Cancelled):
        job.apply()
    assert source.data.shape_keys is None


def test_what_there_is_can_be_kept() -> None:
    source, target = meshes.bumpy(meshes.icosphere(5)), meshes.bumpy(meshes.cube_sphere(6), 0.2)
    ends = zip(pairs.nearest(source, CORNERS), pairs.nearest(target, CORNERS), strict=True)
    pairs.pair(source, target, {f"Corner {number}": both for number, both in enumerate(ends)})
    registration = part("jobs.register")
    job = registration.job(bpy.context, registration.Settings()).start()
    while job.poll()[0] and job.poll()[1] < 0.42:
        time.sleep(0.01)
    job.end_early()
    report = job.apply()
    assert "stopped early" in str(report) and report.registered.folds == 0
    assert np.isfinite(pairs.positions(source, report.key)).all()


@pytest.mark.parametrize("change", ["remove", "subdivide", "landmarks"])
def test_changed_meanwhile(change: Any) -> None:
    source, target = balls()
    registration = part("jobs.register")
    job = registration.job(bpy.context, registration.Settings()).start()
    job._thread.join()
    if change == "remove":
        bpy.data.objects.remove(target)
        bpy.context.view_layer.update()
    elif change == "subdivide":
        meshes.select(target)
        meshes.subdivided(target, 1)
    else:
        part("landmarks.points").remove(source, 0)
    with pytest.raises(registration.CannotRegister, match="changed meanwhile; nothing was written"):
        job.apply()
    assert source.data.shape_keys is None


def test_progress_rises_and_says_what_it_does() -> None:
    balls()
    registration, seen = part("jobs.register"), []
    couple = registration.chosen(bpy.context)

    def listen(fraction: float, message: str) -> bool:
        seen.append((fraction, message))
        return True

    registration.registration(couple, part("registration.settings").Settings(weight=2.0), listen)
    fractions = [fraction for fraction, _ in seen]
    assert len(seen) > 3 and fractions == sorted(fractions) and 0 <= fractions[0] <= fractions[-1] <= 1


def test_options_reach_the_library(monkeypatch: pytest.MonkeyPatch) -> None:
    balls()
    registrations, given = part("bridge.registrations"), {}

    def stop(*_: Any, **options: Any) -> None:
        given.update(options)
        raise registrations.Unsuitable("seen")

    library = types.SimpleNamespace(**vars(registrations.authalic))
    library.register_spheres = stop
    monkeypatch.setattr(registrations, "authalic", library)
    refusal("seen", energy="AREA", weight=3.0, angle_weight=1.0)
    assert given["weight"] == 3.0 and given["angle_weight"] == pytest.approx(10**0.5)
