# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.unwrap along seams that it finds: the maps are those of the search, measured by numpy alone."""

import time
from collections.abc import Callable
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
import seaming
from installed import part
from meshes import Array, MeshObject
from seaming import marked
from test_unwrap import assert_no_overlap, assert_sound
from test_unwrap_seams import assert_cut_as_marked, unwrap

# The shear of the maps may exceed what is wanted by this factor, and areas deviate by so much.
MET, EVEN = 1.012, 0.005


def shears(obj: MeshObject) -> tuple[Array, Array]:
    """σ₁/σ₂ of the map of each triangle, and the areas, both (t,), by singular values."""
    corners, _, points = meshes.triangles(obj)
    first, second = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    length = np.linalg.norm(first, axis=1)
    along = (first * second).sum(axis=1) / length
    across = np.sqrt((second * second).sum(axis=1) - along**2)
    flat = np.zeros((len(points), 2, 2))
    flat[:, 0, 0], flat[:, 0, 1], flat[:, 1, 1] = length, along, across
    image = meshes.uv(obj)[corners].astype(float)
    sides = np.stack([image[:, 1] - image[:, 0], image[:, 2] - image[:, 0]], axis=2)
    values = np.linalg.svd(sides @ np.linalg.inv(flat), compute_uv=False)
    return values[:, 0] / values[:, 1], length * across / 2


def shear(*objects: MeshObject) -> float:
    """The mean of σ₁/σ₂ over the area."""
    ratios, areas = (np.concatenate(values) for values in zip(*map(shears, objects), strict=True))
    return float(np.average(ratios, weights=areas))


def deviation(obj: MeshObject) -> float:
    """The standard deviation of the area ratio over the area."""
    areas = shears(obj)[1]
    return float(np.sqrt(np.average((meshes.area_ratios(obj) - 1) ** 2, weights=areas)))


def twice_covered(obj: MeshObject, resolution: int = 700) -> float:
    """The share of the pixels under the UV map that lie in two triangles."""
    corners, _, _ = meshes.triangles(obj)
    count = meshes.coverage(meshes.uv(obj)[corners].astype(float), resolution)
    return float((count > 1).sum() / (count > 0).sum())


def assert_mapped(obj: MeshObject, wanted: float = 1.25) -> None:
    """Even, hardly sheared, without folds and overlaps, cut as it is marked."""
    assert_sound(obj)
    assert shear(obj) <= MET * wanted
    assert deviation(obj) <= EVEN
    assert_no_overlap(obj)
    assert twice_covered(obj) <= 0.002
    assert_cut_as_marked(obj)


def fine_torus() -> MeshObject:
    bpy.ops.mesh.primitive_torus_add(major_segments=24, minor_segments=12, minor_radius=0.4)
    return bpy.context.object


def fine_slab() -> MeshObject:
    return meshes.subdivided(seaming.two_handles(), 2)


def bumpy_ball() -> MeshObject:
    return meshes.bumpy(meshes.cube_sphere(3), size=0.15)


def triangulated(obj: MeshObject) -> MeshObject:
    obj.modifiers.new("Triangulate", "TRIANGULATE")
    bpy.ops.object.modifier_apply(modifier="Triangulate")
    return obj


CLOSED: dict[str, Callable[[], MeshObject]] = {
    "a bumpy ball of triangles": lambda: triangulated(bumpy_ball()),
    "a head of quads with n-gons": lambda: meshes.closed_suzanne(1),
    "a torus of quads": fine_torus,
    "two handles": fine_slab,
}


@pytest.mark.parametrize("make", CLOSED.values(), ids=CLOSED.keys())
def test_closed_meshes_are_even_and_hardly_sheared(
    make: Callable[[], MeshObject], capfd: pytest.CaptureFixture[str]
) -> None:
    obj = make()
    assert unwrap(seams="AUTOMATIC", shear=1.25) == {"FINISHED"}
    assert_mapped(obj)
    said = capfd.readouterr().out
    islands = int(meshes.islands(obj).max()) + 1
    assert f"Unwrapped {islands} island{'s' if islands > 1 else ''}, length of new seams " in said
    area = shears(obj)[1].sum()
    position = [vertex.co for vertex in obj.data.vertices]
    length = sum((position[first] - position[second]).length for first, second in marked(obj))
    assert f"length of new seams {length / np.sqrt(area):.2f}, " in said
    assert f", shear {shear(obj):.2f}, " in said


def test_quarters_of_a_cut_sphere_are_added_to() -> None:
    obj = meshes.cube_sphere(3)
    ring = {pair for pair in seaming.edges(obj) if all(abs(obj.data.vertices[v].co.z) < 1e-4 for v in pair)}
    seaming.mark(obj, ring)
    assert unwrap(seams="ADD", shear=1.1) == {"FINISHED"}
    assert ring < marked(obj)
    assert_mapped(obj, 1.1)
    _, _, points = meshes.triangles(obj)
    island, upper = meshes.islands(obj), points[:, :, 2].mean(axis=1) > 0
    assert not set(island[upper]) & set(island[~upper])


def test_pieces_and_objects_have_one_density() -> None:
    pair = meshes.add(*meshes.together(meshes.ring(n=16), meshes.tube(6, 12)), "Pair")
    ball = meshes.bumpy(meshes.icosphere(2))
    ball.scale = (3, 3, 3)
    bpy.context.view_layer.update()
    meshes.select(pair, ball)
    assert unwrap(seams="AUTOMATIC", shear=1.3) == {"FINISHED"}
    density = meshes.densities(pair, ball)
    assert density.max() / density.min() == pytest.approx(1, abs=1e-3)
    assert shear(pair, ball) <= MET * 1.3
    for obj in (pair, ball):
        assert deviation(obj) <= EVEN
        assert_cut_as_marked(obj)
    assert_no_overlap(pair, ball)


def test_selected_faces_alone_get_seams_and_uvs() -> None:
    obj = meshes.add(*meshes.together(meshes.ring(n=12), meshes.ring((4, 0, 0), n=12)))
    obj.data.uv_layers.new(name="UVMap")
    before = meshes.uv(obj)
    meshes.edit(obj)
    meshes.select_faces(obj, lambda index: index >= 144)
    assert unwrap(seams="AUTOMATIC") == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert (meshes.uv(obj)[:576] == before[:576]).all()
    assert min(vertex for pair in marked(obj) for vertex in pair) >= 144
    ratios = meshes.area_ratios(obj)[288:]
    assert (ratios > 0).all() and ratios.std() < EVEN * ratios.mean()


def test_faces_that_are_turned_over_are_mirrored(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.torus()
    for polygon in list(obj.data.polygons)[:30]:
        polygon.flip()
    obj.data.update()
    assert unwrap(seams="AUTOMATIC") == {"FINISHED"}
    assert "30 faces with inconsistent normals mirrored" in capfd.readouterr().out
    areas = meshes.uv_areas(meshes.uv(obj)[meshes.triangles(obj)[0]])
    assert (np.sign(areas) == np.where(meshes.triangles(obj)[1] < 30, -1, 1)).all()


def test_an_island_of_faces_turned_over_is_not_mirrored() -> None:
    obj = meshes.cube_sphere(3)
    center = [polygon.center.z for polygon in obj.data.polygons]
    ring = {pair for pair in seaming.edges(obj) if all(abs(obj.data.vertices[v].co.z) < 1e-4 for v in pair)}
    for polygon, z in zip(obj.data.polygons, center, strict=True):
        if z < 0:
            polygon.flip()
    obj.data.update()
    seaming.mark(obj, ring)
    assert unwrap(seams="ADD") == {"FINISHED"}
    assert_sound(obj)


def test_nothing_is_mapped_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: Any, **__: Any) -> None:
        raise AssertionError("mapped twice")

    meshes.torus()
    monkeypatch.setattr(part("bridge.disks").authalic, "disk_maps", fail)
    assert unwrap(seams="AUTOMATIC") == {"FINISHED"}


@pytest.mark.parametrize(
    "options",
    [{"outline": "CIRCLE"}, {"angle_preset": "SOFT"}, {"area_tolerance": 0.05}, {"iterations": 9}],
    ids=str,
)
def test_other_maps_are_made_where_they_are_asked_for(
    options: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    library, asked = part("bridge.disks").authalic, []
    disk_maps = library.disk_maps

    def listen(surfaces: Any, **options: Any) -> Any:
        asked.extend(surfaces)
        return disk_maps(surfaces, **options)

    monkeypatch.setattr(library, "disk_maps", listen)
    obj = meshes.torus()
    assert unwrap(seams="AUTOMATIC", **options) == {"FINISHED"}
    assert len(asked) == meshes.islands(obj).max() + 1
    assert_cut_as_marked(obj)


def test_overlap_is_allowed_if_wanted(monkeypatch: pytest.MonkeyPatch) -> None:
    library, asked = part("bridge.seams").authalic, []
    native = library.unwrap

    def listen(*given: Any, **options: Any) -> Any:
        asked.append(options["overlap"])
        return native(*given, **options)

    monkeypatch.setattr(library, "unwrap", listen)
    for overlap in (True, False):
        obj = meshes.torus()
        assert unwrap(seams="AUTOMATIC", allow_overlap=overlap) == {"FINISHED"}
        assert deviation(obj) <= EVEN
    assert asked == [True, False]


# What seams cost


def faced_ball() -> MeshObject:
    obj = bumpy_ball()
    for name, weight, sign in (("Face", 1.0, 1), ("Nape", 0.5, -1)):
        members = [v.index for v in obj.data.vertices if sign * v.co.y < _FACE]
        obj.vertex_groups.new(name=name).add(members, weight, "REPLACE")
    return obj


_FACE = -0.5
WISHES: dict[str, Any] = {
    "shear": 1.4,
    "keep_off": "Face",
    "prefer": "Nape",
    "front": "NEGATIVE_X",
    "symmetry": "OFF",
}


def test_wishes_mean_what_they_mean_for_marks() -> None:
    obj = faced_ball()
    bpy.ops.authalic.mark_seams(**WISHES)
    expected = marked(obj)
    seaming.mark(obj, set())
    assert unwrap(seams="AUTOMATIC", **WISHES) == {"FINISHED"}
    assert marked(obj) == expected
    face = {vertex.index for vertex in obj.data.vertices if vertex.co.y < _FACE}
    assert not {vertex for pair in expected for vertex in pair} & face
    assert_mapped(obj, 1.4)


@pytest.mark.parametrize("name", ["keep_off", "prefer"])
def test_a_group_that_nobody_has_counts_for_new_seams_only(name: str) -> None:
    meshes.add_grid()
    wish: dict[str, Any] = {name: "Nose"}
    assert unwrap(**wish) == {"FINISHED"}
    with pytest.raises(RuntimeError, match='No selected object has the vertex group "Nose"; choose another'):
        unwrap(seams="ADD", **wish)


class Recorder:
    """A layout that notes the properties that are drawn."""

    def __init__(self) -> None:
        self.drawn: list[str] = []

    def prop(self, _properties: Any, name: str, **_options: Any) -> None:
        self.drawn.append(name)

    def prop_enum(self, _properties: Any, name: str, _item: str, **_options: Any) -> None:
        self.drawn.append(name)

    def label(self, **_options: Any) -> None:
        pass

    def _nested(self, **_options: Any) -> "Recorder":
        return self

    column = row = box = grid_flow = _nested


@pytest.mark.parametrize("seams", ["GIVEN", "ADD", "AUTOMATIC"])
def test_the_redo_panel_shows_options_of_new_seams_for_these_only(seams: Any) -> None:
    meshes.torus()
    properties = bpy.context.window_manager.operator_properties_last("authalic.unwrap")
    properties.seams = seams
    try:
        recorder = Recorder()
        part("operators.unwrap").draw_options(recorder, properties)
    finally:
        properties.property_unset("seams")
    of_new = {"shear_preset", "shear", "keep_off", "prefer", "front", "symmetry", "mark_seams"}
    of_given = {"domain", "fill_holes", "sphere_layout", "pole_axis", "seam_direction"}
    assert set(recorder.drawn) >= (of_given if seams == "GIVEN" else of_new)
    assert not set(recorder.drawn) & (of_new if seams == "GIVEN" else of_given)


# The shear that suits a mesh


def scan(name: str, offset: float = 0.0) -> MeshObject:
    obj = meshes.add_grid(name, n=100, bump=0.5)
    obj.location.x = offset
    return obj


def test_the_report_names_the_preset_that_was_chosen(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.add_grid("Model", bump=0.2)
    unwrap(seams="AUTOMATIC")
    assert f", shear {shear(obj):.2f} (Low Shear), " in capfd.readouterr().out
    unwrap(seams="AUTOMATIC", shear=1.25)
    assert f", shear {shear(obj):.2f}, " in capfd.readouterr().out
    scans = scan("Scan")
    unwrap(seams="AUTOMATIC")
    assert " (Few Seams), " in capfd.readouterr().out
    meshes.select(obj, scans)
    bpy.ops.authalic.mark_seams()
    assert " (Low Shear, Few Seams for Scan), " in capfd.readouterr().out


def test_meshes_of_many_slits_count_as_scans(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    obj = bumpy_ball()
    monkeypatch.setattr(part("bridge.seams"), "_MOST_SLITS", 1)
    unwrap(seams="AUTOMATIC")
    assert " (Few Seams), " in capfd.readouterr().out
    few = marked(obj)
    assert shear(obj) <= 1.4 * MET
    seaming.mark(obj, set())
    unwrap(seams="AUTOMATIC", shear_preset="FEW_SEAMS")
    assert marked(obj) == few


def test_slits_are_ends_of_seams_inside() -> None:
    count = part("surfaces.seam_costs").slit_count
    seams = np.array([[0, 1], [1, 2], [1, 3], [5, 6]])
    assert count(seams, []) == 5
    assert count(seams, [np.array([0, 9]), np.array([6])]) == 3
    assert count(np.empty((0, 2), int), [np.array([4])]) == 0


# Cancel and undo


@pytest.mark.parametrize("operator", ["unwrap", "mark_seams"])
def test_a_search_is_cancelled_at_once(operator: str) -> None:
    bridge, jobs = part("bridge"), part(f"jobs.{operator}")
    obj = bumpy_ball()
    before = meshes.uv(obj)
    search = bridge.SeamSettings(shear=1.05)
    options = {"mapping": bridge.UnwrapSettings(seams=search)} if operator == "unwrap" else {"search": search}
    running = jobs.job(bpy.context, jobs.Settings(**options)).start()
    time.sleep(0.3)
    assert running.poll()[0]
    running.cancel()
    assert not running.poll()[0]
    with pytest.raises(part("jobs.job").Cancelled, match="nothing was changed"):
        running.apply()
    assert not marked(obj) and (meshes.uv(obj) == before).all()
    running._thread.join(20)
    assert not running._thread.is_alive()


def test_undo_and_redo() -> None:
    name = fine_torus().name
    bpy.ops.ed.undo_push(message="Start")
    before = meshes.uv(bpy.data.objects[name])
    bpy.ops.authalic.unwrap("EXEC_DEFAULT", True, seams="AUTOMATIC")
    after, seams = meshes.uv(bpy.data.objects[name]), marked(bpy.data.objects[name])
    bpy.ops.ed.undo()
    assert not marked(bpy.data.objects[name])
    assert (meshes.uv(bpy.data.objects[name]) == before).all()
    bpy.ops.ed.redo()
    assert marked(bpy.data.objects[name]) == seams
    assert (meshes.uv(bpy.data.objects[name]) == after).all()


def test_a_result_does_not_change_when_it_is_repeated() -> None:
    obj = fine_torus()
    unwrap(seams="AUTOMATIC")
    first, seams = meshes.uv(obj), marked(obj)
    unwrap(seams="AUTOMATIC")
    assert marked(obj) == seams and (meshes.uv(obj) == first).all()
