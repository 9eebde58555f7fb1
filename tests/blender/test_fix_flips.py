# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.fix_flips: flipped faces are turned over, and nothing else changes."""

from collections.abc import Sequence
from typing import Any

import bmesh
import bpy
import meshes
import numpy as np
import problems
import pytest
from installed import library, part
from meshes import Array, MeshObject

N = 8


def fix() -> set[str]:
    return bpy.ops.authalic.fix_flips()


def flat_grid(offset: Sequence[float] = (0, 0, 0), n: int = N) -> tuple[Array, Array]:
    return meshes.grid(n=n, bump=0, offset=offset)


def laid_flat(obj: MeshObject, scale: float = 0.1, mirrored: bool = False) -> MeshObject:
    """Gives an object its x and y as UVs."""
    obj.data.uv_layers.new(name="UVMap")
    position = np.array([obj.data.vertices[loop.vertex_index].co for loop in obj.data.loops])
    uv = position[:, :2] * [-scale if mirrored else scale, scale] + 0.5
    meshes.set_uv(obj, uv)
    return obj


def corner_vertices(obj: MeshObject) -> Array:
    return np.array([loop.vertex_index for loop in obj.data.loops])


def move(obj: MeshObject, vertex: int, to: Any) -> None:
    """Moves all UVs of a vertex."""
    uv = meshes.uv(obj)
    uv[corner_vertices(obj) == vertex] = to
    meshes.set_uv(obj, uv)


def tangled_grid(mirrored: bool = False, **options: Any) -> MeshObject:
    """A grid with the UVs of one vertex moved across several faces."""
    obj = laid_flat(meshes.add(*flat_grid(**options), "Grid"), mirrored=mirrored)
    inner = (N + 1) * 4 + 3
    uv = meshes.uv(obj)
    move(obj, inner, uv[corner_vertices(obj) == inner + 2][0])
    assert len(flipped(obj, mirrored))
    return obj


def flipped(obj: MeshObject, mirrored: bool = False) -> Array:
    """The polygons with a triangle of the wrong orientation."""
    corners, polygons, _ = meshes.triangles(obj)
    areas = meshes.uv_areas(meshes.uv(obj)[corners])
    return np.unique(polygons[(areas >= 0) if mirrored else (areas <= 0)])


def boundary(obj: MeshObject) -> Array:
    """The corners at boundary vertices of the mesh, as a mask."""
    edges = [edge.vertices for edge, count in zip(obj.data.edges, uses(obj), strict=True) if count == 1]
    return np.isin(corner_vertices(obj), np.unique(np.array([tuple(edge) for edge in edges])))


def uses(obj: MeshObject) -> Array:
    edge = np.array([loop.edge_index for loop in obj.data.loops])
    return np.bincount(edge, minlength=len(obj.data.edges))


def islands_of_uvs(obj: MeshObject, before: Array) -> int:
    """The number of UV vertices that have moved."""
    moved = (meshes.uv(obj) != before).any(axis=1)
    return len(np.unique(corner_vertices(obj)[moved]))


def test_flips_are_fixed_and_told(capfd: pytest.CaptureFixture[str]) -> None:
    obj = tangled_grid()
    before, faces = meshes.uv(obj), len(flipped(obj))
    assert fix() == {"FINISHED"}
    assert len(flipped(obj)) == 0
    moved = islands_of_uvs(obj, before)
    assert 0 < moved < 20
    said = capfd.readouterr().out
    named = "1 flipped face" if faces == 1 else f"{faces} flipped faces"
    uvs = "1 UV" if moved == 1 else f"{moved} UVs"
    assert f"Info: Fixed {named} in 1 island; {uvs} moved" in said


def test_outline_stays() -> None:
    obj = tangled_grid()
    before = meshes.uv(obj)
    fix()
    assert (meshes.uv(obj)[boundary(obj)] == before[boundary(obj)]).all()


def test_corners_of_a_vertex_stay_together() -> None:
    obj = tangled_grid()
    fix()
    vertices, uv = corner_vertices(obj), meshes.uv(obj)
    for vertex in range(len(obj.data.vertices)):
        assert len(np.unique(uv[vertices == vertex], axis=0)) == 1


def test_pinned_uvs_stay() -> None:
    obj = tangled_grid()
    pins = [(N + 1) * 4 + 5, (N + 1) * 3 + 3]
    pinned = np.isin(corner_vertices(obj), pins)
    attribute = obj.data.attributes.new(".pn.UVMap", "BOOLEAN", "CORNER")
    attribute.data.foreach_set("value", pinned)
    before = meshes.uv(obj)
    assert fix() == {"FINISHED"}
    assert len(flipped(obj)) == 0
    assert (meshes.uv(obj)[pinned] == before[pinned]).all()
    is_pinned = np.empty(len(pinned), bool)
    obj.data.attributes[".pn.UVMap"].data.foreach_get("value", is_pinned)
    assert (is_pinned == pinned).all()


def test_pins_that_leave_no_way_out_are_told() -> None:
    obj = tangled_grid()
    attribute = obj.data.attributes.new(".pn.UVMap", "BOOLEAN", "CORNER")
    attribute.data.foreach_set("value", np.ones(len(obj.data.loops), np.bool_))
    before = meshes.uv(obj)
    with pytest.raises(RuntimeError, match=r"Grid at face 0: .*pinned UVs; unpin UVs, smooth"):
        fix()
    assert (meshes.uv(obj) == before).all()


def test_outline_that_leaves_no_way_out_is_told() -> None:
    obj = laid_flat(meshes.add(*flat_grid(), "Grid"))
    # a corner over the opposite one: its face is flipped and has nothing to move
    move(obj, 0, (0.7, 0.7))
    before = meshes.uv(obj)
    with pytest.raises(RuntimeError, match=r"No flipped face could be fixed: Grid at face 0"):
        fix()
    assert (meshes.uv(obj) == before).all()


@pytest.mark.parametrize(
    ("exception", "kind", "said"),
    [
        ("SolverError", "still_folded", r"1 face \(0\) cannot be turned without moving its outline"),
        ("MeshError", "fixed_fold", r"cannot be turned without moving its outline"),
        ("MeshError", "outline_fold", r"cannot be turned without moving its outline"),
        ("SolverError", "factorization_failed", r"Grid at face 0: is too badly conditioned"),
        ("MeshError", "map_not_finite", r"Grid at face 0: NaN or infinite UVs"),
    ],
)
def test_only_faces_that_stay_flipped_are_said_to_need_another_outline(
    exception: str, kind: str, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_args: Any, **_options: Any) -> None:
        raise problems.made(exception, kind, indices=(0, 1), count=2)

    monkeypatch.setattr(library(), "untangle", refuse)
    obj = tangled_grid()
    before = meshes.uv(obj)
    with pytest.raises(RuntimeError, match=said) as refusal:
        fix()
    assert ("outline" in str(refusal.value)) == ("outline" in said)
    assert (meshes.uv(obj) == before).all()


def several(*parts: tuple[Array, Any], name: str = "Parts") -> MeshObject:
    return laid_flat(meshes.add(*meshes.together(*parts), name))


def tangle(obj: MeshObject, vertex: int, target: Any) -> None:
    move(obj, vertex, meshes.uv(obj)[corner_vertices(obj) == target][0])


def test_other_islands_are_bit_identical(capfd: pytest.CaptureFixture[str]) -> None:
    obj = several(flat_grid(), flat_grid((4, 0, 0)), flat_grid((0, 4, 0)))
    size = (N + 1) ** 2
    inner = (N + 1) * 4 + 3
    tangle(obj, inner, inner + 2)
    tangle(obj, 2 * size + inner, 2 * size + inner + 2)
    before = meshes.uv(obj)
    assert fix() == {"FINISHED"}
    assert len(flipped(obj)) == 0
    middle = (corner_vertices(obj) >= size) & (corner_vertices(obj) < 2 * size)
    assert meshes.uv(obj)[middle].tobytes() == before[middle].tobytes()
    assert " in 2 islands; " in capfd.readouterr().out


def test_one_island_that_cannot_be_fixed_beside_one_that_can(capfd: pytest.CaptureFixture[str]) -> None:
    obj = several(flat_grid(), flat_grid((4, 0, 0)))
    inner = (N + 1) * 4 + 3
    tangle(obj, inner, inner + 2)
    size = (N + 1) ** 2
    move(obj, size, (0.98, 0.7))
    before = meshes.uv(obj)
    assert fix() == {"FINISHED"}
    assert set(flipped(obj)) == {N * N}
    second = corner_vertices(obj) >= size
    assert (meshes.uv(obj)[second] == before[second]).all()
    said = capfd.readouterr().out
    assert "Warning: Fixed" in said and f"left as it was: Parts at face {N * N}: " in said


def test_mirrored_islands_are_no_flips(capfd: pytest.CaptureFixture[str]) -> None:
    obj = laid_flat(meshes.add(*flat_grid(), "Grid"), mirrored=True)
    before = meshes.uv(obj)
    assert fix() == {"FINISHED"}
    assert (meshes.uv(obj) == before).all()
    assert "Info: No flipped faces" in capfd.readouterr().out


def test_flips_of_mirrored_islands_are_fixed() -> None:
    obj = tangled_grid(mirrored=True)
    assert fix() == {"FINISHED"}
    assert len(flipped(obj, mirrored=True)) == 0


def test_inconsistent_normals_are_no_flips(capfd: pytest.CaptureFixture[str]) -> None:
    vertices, faces = flat_grid()
    faces[20] = faces[20][::-1]
    obj = laid_flat(meshes.add(vertices, faces, "Grid"))
    before = meshes.uv(obj)
    assert fix() == {"FINISHED"}
    assert (meshes.uv(obj) == before).all()
    assert "No flipped faces" in capfd.readouterr().out


def test_nothing_to_fix_changes_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.suzanne(1)
    bpy.ops.authalic.unwrap()
    before = meshes.uv(obj)
    assert fix() == {"FINISHED"}
    assert meshes.uv(obj).tobytes() == before.tobytes()
    assert "No flipped faces" in capfd.readouterr().out


def test_only_the_active_uv_map_changes() -> None:
    obj = tangled_grid()
    inactive = obj.data.uv_layers.new(name="Other")
    before = meshes.uv(obj, "Other")
    obj.data.uv_layers.active = obj.data.uv_layers["UVMap"]
    fix()
    assert len(flipped(obj)) == 0
    assert (meshes.uv(obj, inactive.name) == before).all() and obj.data.uv_layers.active.name == "UVMap"


def both_halves_tangled() -> tuple[MeshObject, set[int]]:
    """A grid with one tangle on the left and one on the right, and the faces of the left half."""
    obj = laid_flat(meshes.add(*flat_grid(n=12), "Grid"))
    left, right = 13 * 6 + 3, 13 * 6 + 9
    tangle(obj, left, left - 2)
    tangle(obj, right, right + 2)
    return obj, {face for face in range(144) if face % 12 < 6}


def test_edit_mode_fixes_selected_faces_only() -> None:
    obj, chosen = both_halves_tangled()
    before, bad = meshes.uv(obj), flipped(obj)
    meshes.edit(obj)
    meshes.select_faces(obj, chosen.__contains__)
    assert fix() == {"FINISHED"}
    assert bpy.context.mode == "EDIT_MESH"
    assert {face.index for face in bmesh.from_edit_mesh(obj.data).faces if face.select} == chosen
    bpy.ops.object.mode_set(mode="OBJECT")
    assert set(flipped(obj)) == {face for face in bad if face not in chosen}
    others = ~np.isin(np.repeat(np.arange(144), 4), list(chosen))
    assert (meshes.uv(obj)[others] == before[others]).all()
    # The selection does not come apart from the rest.
    vertices, uv = corner_vertices(obj), meshes.uv(obj)
    for vertex in range(len(obj.data.vertices)):
        assert len(np.unique(uv[vertices == vertex], axis=0)) == 1


def test_edit_mode_asks_for_the_faces_around_where_it_needs_them() -> None:
    obj = tangled_grid()
    before, bad = meshes.uv(obj), set(flipped(obj))
    meshes.edit(obj)
    meshes.select_faces(obj, bad.__contains__)
    with pytest.raises(RuntimeError, match="select the faces around as well"):
        fix()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert (meshes.uv(obj) == before).all()


def test_edit_mode_without_selected_faces(capfd: pytest.CaptureFixture[str]) -> None:
    obj = tangled_grid()
    meshes.edit(obj)
    meshes.select_faces(obj, lambda index: False)
    assert fix() == {"CANCELLED"}
    assert "No faces are selected" in capfd.readouterr().out


def test_several_objects() -> None:
    first, second = tangled_grid(), tangled_grid()
    meshes.select(first, second)
    assert fix() == {"FINISHED"}
    assert len(flipped(first)) == len(flipped(second)) == 0


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_undo(mode: str) -> None:
    obj = tangled_grid()
    bpy.ops.object.mode_set(mode=mode)
    if mode == "EDIT":
        meshes.select_faces(obj, lambda index: True)
    bpy.ops.ed.undo_push(message="Start")
    before = meshes.uv(obj)
    bpy.ops.authalic.fix_flips("EXEC_DEFAULT", True)
    assert (meshes.uv(obj) != before).any()
    bpy.ops.ed.undo()
    assert bpy.context.object.mode == mode
    assert (meshes.uv(bpy.context.object) == before).all()


def test_cancelling_changes_nothing() -> None:
    obj = tangled_grid()
    before = meshes.uv(obj)
    job = part("jobs.fix_flips").job(bpy.context).start()
    job.cancel()
    with pytest.raises(part("jobs.job").Cancelled):
        job.apply()
    assert (meshes.uv(obj) == before).all()


def test_meshes_without_uv_maps_say_what_is_missing() -> None:
    meshes.add(*flat_grid())
    with pytest.raises(RuntimeError, match=r"poll.*have no UV map"):
        fix()
    bpy.ops.object.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match=r"poll.*Select at least one mesh object"):
        fix()


def test_uvs_that_were_never_laid_out_are_told() -> None:
    obj = laid_flat(meshes.add(*flat_grid(), "Grid"), scale=0)
    with pytest.raises(RuntimeError, match="Grid at face 0: "):
        fix()
    assert (meshes.uv(obj) == 0.5).all()


def test_closed_islands_are_told() -> None:
    vertices, faces = meshes.tetrahedron()
    laid_flat(meshes.add(vertices, faces, "Solid"))
    with pytest.raises(RuntimeError, match=r"Solid at face 0: is closed in its UV map"):
        fix()


def test_a_scrambled_island_of_n_gons(capfd: pytest.CaptureFixture[str]) -> None:
    bpy.ops.mesh.primitive_circle_add(vertices=12, fill_type="NGON")
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.inset(thickness=0.3)
    bpy.ops.mesh.inset(thickness=0.3)
    bpy.ops.object.mode_set(mode="OBJECT")
    obj = bpy.context.object
    while obj.data.uv_layers:
        obj.data.uv_layers.remove(obj.data.uv_layers[0])
    laid_flat(obj)
    inner = ~boundary(obj)
    uv = meshes.uv(obj)
    vertices = corner_vertices(obj)
    rng = np.random.default_rng(3)
    places = 0.5 + 0.08 * rng.standard_normal((len(obj.data.vertices), 2))
    uv[inner] = places[vertices[inner]]
    meshes.set_uv(obj, uv)
    assert len(flipped(obj))
    assert fix() == {"FINISHED"}
    assert len(flipped(obj)) == 0
    assert "Fixed" in capfd.readouterr().out
