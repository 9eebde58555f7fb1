# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.unwrap of meshes that artists have: faces without area, duplicates, fins, one-sided strips."""

import random
from collections.abc import Callable, Sequence
from typing import Any

import bmesh
import bpy
import meshes
import numpy as np
import pytest
from meshes import Array, MeshObject

Point = Sequence[float]


def unwrap(**options: Any) -> set[str]:
    return bpy.ops.authalic.unwrap(**options)


def sheet(points: Sequence[Point] = (), faces: Sequence[Sequence[int]] = (), **options: Any) -> MeshObject:
    """Three by three unit quads, and further points, from number 16 on, and faces, from number 9 on."""
    vertices = [(x, y, 0) for y in range(4) for x in range(4)]
    quads = [[4 * y + x, 4 * y + x + 1, 4 * y + x + 5, 4 * y + x + 4] for y in range(3) for x in range(3)]
    return meshes.add([*vertices, *points], [*quads, *faces], **options)


def places(obj: MeshObject) -> list[tuple[int, Array]]:
    """The vertex and the UV of each corner."""
    vertices = [loop.vertex_index for loop in obj.data.loops]
    return list(zip(vertices, meshes.uv(obj).astype(float), strict=True))


def solid(obj: MeshObject) -> Array:
    """Which triangles have an area."""
    areas = meshes.surface_areas(meshes.triangles(obj)[2])
    return areas > 1e-6 * areas.max()


def ratios(obj: MeshObject) -> Array:
    """UV area over area of the triangles that have one, on the scale of the whole."""
    corners, _, points = meshes.triangles(obj)
    has_area = solid(obj)
    image, area = meshes.uv_areas(meshes.uv(obj)[corners])[has_area], meshes.surface_areas(points)[has_area]
    return image / area * (area.sum() / np.abs(image).sum())


def assert_flat_sheet(obj: MeshObject, faces: int = 9) -> None:
    """The first quads are a similar image of what they are: one scale for all distances."""
    corners = places(obj)[: 4 * faces]
    points = np.array([tuple(obj.data.vertices[vertex].co) for vertex, _ in corners])
    uv = np.array([place for _, place in corners])

    def distances(of: Array) -> Array:
        return np.linalg.norm(of[:, None] - of[None], axis=-1)

    scale = distances(uv).max() / distances(points).max()
    assert scale > 0 and np.allclose(distances(uv), scale * distances(points), atol=2e-4)


def line_of(obj: MeshObject, polygon: int) -> list[tuple[int, Array]]:
    loops = obj.data.polygons[polygon].loop_indices
    return [places(obj)[loop] for loop in loops]


# Faces without area


@pytest.mark.parametrize(
    ("points", "face", "at"),
    [
        ([(0, 0, 0)], (0, 16, 1), {16: [(0, 1.0)]}),
        ([(0.25, 0, 0)], (0, 16, 1), {16: [(0, 0.75), (1, 0.25)]}),
        ([(1.25, 1, 0)], (5, 16, 6), {16: [(5, 1.0)]}),
        ([(1, 1, 0), (1, 1, 0)], (5, 16, 17), {16: [(5, 1.0)], 17: [(5, 1.0)]}),
        ([], (5, 6, 6), {}),
    ],
    ids=["needle", "at the boundary", "at an inner edge", "point", "same vertex twice"],
)
def test_a_face_without_area_lies_where_its_corners_are(
    points: list[Point],
    face: Sequence[int],
    at: dict[int, list[tuple[int, float]]],
    capfd: pytest.CaptureFixture[str],
) -> None:
    obj = sheet(points, [face])
    assert unwrap() == {"FINISHED"}
    assert_flat_sheet(obj)
    of_sheet = dict(places(obj)[:36])
    for vertex, place in line_of(obj, 9):
        hosts = at.get(vertex, [(vertex, 1.0)])
        assert place == pytest.approx(sum(weight * of_sheet[host] for host, weight in hosts), abs=1e-3)
    assert "Mesh: 1 face without area, put where the corners are" in capfd.readouterr().out


def test_a_fan_of_faces_without_area_is_carried_along(capfd: pytest.CaptureFixture[str]) -> None:
    fan = [(0, 16, 1), (0, 17, 16), (0, 18, 17), (18, 19, 17), (19, 20, 1)]
    obj = sheet([(0, 0, 0)] * 4 + [(0.5, 0, 0)], fan)
    assert unwrap() == {"FINISHED"}
    assert_flat_sheet(obj)
    start, end = (dict(places(obj)[:36])[vertex] for vertex in (0, 1))
    for vertex, place in places(obj)[36:]:
        wanted = {1: end, 20: (start + end) / 2}.get(vertex, start)
        assert place == pytest.approx(wanted, abs=1e-3)
    assert "5 faces without area" in capfd.readouterr().out


def test_a_sliver_in_a_t_junction_leaves_its_neighbors_flat() -> None:
    points = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0), (0, 2, 0), (1, 2, 0), (2, 2, 0), (1, 1, 0)]
    obj = meshes.add(points, [(0, 1, 2, 3), (3, 7, 5, 4), (7, 2, 6, 5), (3, 2, 7)])
    assert unwrap() == {"FINISHED"}
    assert_flat_sheet(obj, 3)
    assert meshes.islands(obj).max() == 0


def test_an_island_without_area_is_put_in_the_corner(capfd: pytest.CaptureFixture[str]) -> None:
    obj = sheet([(9, 9, 9), (10, 10, 10), (11, 11, 11)], [(16, 17, 18)])
    assert unwrap() == {"FINISHED"}
    assert_flat_sheet(obj)
    assert [tuple(place) for _, place in line_of(obj, 9)] == [(0.0, 0.0)] * 3
    assert "1 face without area apart, put in the lower left corner" in capfd.readouterr().out


def test_a_mesh_without_any_area_is_refused() -> None:
    obj = meshes.add([(0, 0, 0), (1, 1, 1), (2, 2, 2)], [(0, 1, 2)])
    with pytest.raises(RuntimeError, match="No island could be unwrapped: Mesh: no face has an area"):
        unwrap()
    assert not obj.data.uv_layers


def extruded_in_place() -> MeshObject:
    """A grid whose inner quads were extruded and not moved: eight quads without area around them."""
    obj = meshes.add_grid(n=6, bump=0.4)
    edited = bmesh.new()
    edited.from_mesh(obj.data)
    inner = [face for face in edited.faces if np.abs(face.calc_center_median()[:2]).max() < 0.4]
    result = bmesh.ops.extrude_face_region(edited, geom=inner)
    assert result["geom"]
    bmesh.ops.delete(edited, geom=inner, context="FACES_ONLY")
    edited.to_mesh(obj.data)
    edited.free()
    return obj


def whole_map(make: Callable[[], MeshObject], **options: Any) -> tuple[MeshObject, float]:
    obj = make()
    assert unwrap(**options) == {"FINISHED"}
    assert (ratios(obj) > 0).all()
    return obj, float(ratios(obj).std())


def test_an_extrusion_that_was_not_moved_changes_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    _, deviation = whole_map(lambda: meshes.add_grid(n=6, bump=0.4))
    obj, mended = whole_map(extruded_in_place)
    assert mended == pytest.approx(deviation, abs=1e-4)
    assert meshes.islands(obj)[solid(obj)].max() == 0
    assert "8 faces without area" in capfd.readouterr().out


def test_automatic_seams_run_along_edges_of_the_mesh_beside_collapsed_faces() -> None:
    obj, _ = whole_map(extruded_in_place, seams="AUTOMATIC", shear=1.01)
    marked = [edge for edge in obj.data.edges if edge.use_seam]
    uv = meshes.uv(obj)
    places = {
        (polygon.index, obj.data.loops[loop].vertex_index): tuple(uv[loop])
        for polygon in obj.data.polygons
        for loop in polygon.loop_indices
    }
    assert marked and all(np.isfinite(place).all() for place in places.values())


def test_a_cube_that_was_scaled_to_a_square() -> None:
    bpy.ops.mesh.primitive_cube_add()
    obj = bpy.context.object
    for vertex in obj.data.vertices:
        vertex.co.z = 0
    assert unwrap() == {"FINISHED"}
    corners = places(obj)
    for first, place in corners:  # what lies in one place of space lies in one place of the map
        for second, other in corners:
            if (obj.data.vertices[first].co - obj.data.vertices[second].co).length < 1e-6:
                assert place == pytest.approx(other)
    assert np.ptp(meshes.uv(obj), axis=0).min() > 0.9


def test_collapsed_faces_of_a_closed_mesh() -> None:
    obj = meshes.icosphere(2)
    for polygon in list(obj.data.polygons)[::20]:
        a, b, c = (obj.data.vertices[vertex] for vertex in polygon.vertices)
        a.co = b.co if polygon.index % 40 else (b.co + c.co) / 2
    assert unwrap(sphere_layout="OCTAHEDRAL") == {"FINISHED"}
    assert (ratios(obj) > 0).all()


def test_a_pinned_corner_of_a_face_without_area_stays() -> None:
    obj = sheet([(0, 0, 0)], [(0, 16, 1)])
    obj.data.uv_layers.new(name="UVMap")
    obj.data.attributes.new(".pn.UVMap", "BOOLEAN", "CORNER").data[37].value = True
    before = meshes.uv(obj)[37]
    assert unwrap() == {"FINISHED"}
    assert (meshes.uv(obj)[37] == before).all()


# Duplicate faces


@pytest.mark.parametrize("face", [(0, 1, 5, 4), (5, 4, 0, 1), (4, 5, 1, 0)])
def test_a_duplicate_face_lies_on_the_first(face: Sequence[int], capfd: pytest.CaptureFixture[str]) -> None:
    obj = sheet([], [face])
    assert unwrap() == {"FINISHED"}
    assert_flat_sheet(obj)
    of_sheet = dict(places(obj)[:36])
    assert all((place == of_sheet[vertex]).all() for vertex, place in line_of(obj, 9))
    said = capfd.readouterr().out
    assert "1 duplicate face, put over the first ones" in said and "0 flips" in said


def test_a_duplicate_face_is_no_flip_for_measure(capfd: pytest.CaptureFixture[str]) -> None:
    obj = sheet([], [(0, 1, 5, 4), (0, 1, 5, 4), (5, 6, 10, 9)])
    assert unwrap() == {"FINISHED"}
    assert bpy.ops.authalic.measure() == {"FINISHED"}
    said = capfd.readouterr().out.splitlines()[-1]
    assert "none flipped" in said and "100 %" in said
    assert len(obj.data.polygons) == 12


@pytest.mark.parametrize("face", [(0, 16, 1), (0, 1, 5, 4), (4, 5, 1, 0)])
def test_bad_faces_do_not_keep_flips_from_being_fixed(
    face: Sequence[int], capfd: pytest.CaptureFixture[str]
) -> None:
    obj = sheet([(0, 0, 0)], [face])
    unwrap()
    uv = meshes.uv(obj)
    at = [loop.vertex_index == 10 for loop in obj.data.loops]
    uv[at] += 0.6 * (uv[0] - uv[at][0])  # one inner vertex crosses over two others
    meshes.set_uv(obj, uv)
    corners = meshes.triangles(obj)[0][:18]
    assert (meshes.uv_areas(meshes.uv(obj)[corners]) < 0).any()
    assert bpy.ops.authalic.fix_flips() == {"FINISHED"}
    assert (meshes.uv_areas(meshes.uv(obj)[corners]) > 0).all()
    assert "Fixed" in capfd.readouterr().out


# Edges of more than two faces, and one-sided strips


def test_a_fin_is_cut_off_and_named(capfd: pytest.CaptureFixture[str]) -> None:
    obj = sheet([(1, 1, 1), (2, 1, 1)], [(5, 6, 17, 16)])
    assert unwrap() == {"FINISHED"}
    assert_flat_sheet(obj)
    assert meshes.islands(obj).max() == 1
    assert ratios(obj) == pytest.approx(1, abs=1e-4)
    assert "Mesh: cut along 1 edge of more than two faces" in capfd.readouterr().out


def test_parts_that_touch_in_a_point() -> None:
    obj = meshes.add([(0, 0, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)], [(0, 1, 2), (0, 3, 4)])
    assert unwrap() == {"FINISHED"}
    assert meshes.islands(obj).max() == 1 and ratios(obj) == pytest.approx(1, abs=1e-4)


@pytest.mark.parametrize("options", [{}, {"seams": "AUTOMATIC"}])
def test_a_one_sided_strip_is_cut_across(options: dict[str, Any], capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.add(*meshes.moebius())
    assert unwrap(**options) == {"FINISHED"}
    assert meshes.islands(obj).max() == 0
    assert ratios(obj) == pytest.approx(1, abs=0.02)
    # the strip is cut once: two vertices have two UVs
    split = [v for v in range(24) if len({tuple(place) for vertex, place in places(obj) if vertex == v}) > 1]
    assert split == [0, 1]
    said = capfd.readouterr().out
    assert "Mesh at face 0: one-sided, like a Moebius strip; cut across" in said and "mirrored" not in said


def test_a_one_sided_strip_with_random_windings() -> None:
    vertices, faces = meshes.moebius(20)
    turned = random.Random(3)
    obj = meshes.add(vertices, [face[::-1] if turned.random() < 0.5 else face for face in faces])
    assert unwrap() == {"FINISHED"}
    assert np.abs(ratios(obj)) == pytest.approx(1, abs=0.02)
    assert meshes.islands(obj).max() == 0


# All together


def spoiled(seed: int) -> MeshObject:
    """A mesh with collapsed, duplicate, folded and added faces here and there."""
    chance = random.Random(seed)
    make = (meshes.add_grid, lambda: meshes.icosphere(2), lambda: meshes.uv_sphere(12, 6))
    obj = chance.choice(make)()
    points = [list(vertex.co) for vertex in obj.data.vertices]
    faces = [list(polygon.vertices) for polygon in obj.data.polygons]
    for _ in range(chance.choice([1, 4, 15])):
        _spoil(points, faces, chance)
    bpy.data.objects.remove(obj)
    return meshes.add(points, faces)


def _spoil(points: list[list[float]], faces: list[list[int]], chance: random.Random) -> None:
    number = chance.randrange(len(faces))
    face, how = faces[number], chance.randrange(7)
    first, second = face[:2]
    if how == 0:
        points[first] = list(points[second])
    elif how == 1:
        points[first] = [(a + b) / 2 for a, b in zip(points[second], points[face[2]], strict=True)]
    elif how == 2:
        faces.append(face[::-1] if chance.random() < 0.5 else list(face))
    elif how == 3:
        faces.append([first, second, second])
    elif how == 4:
        points.append([(a + b) / 2 for a, b in zip(points[first], points[second], strict=True)])
        faces.append([first, len(points) - 1, second])
    elif how == 5:
        points.append([x + chance.gauss(0, 1) for x in points[first]])
        faces.append([first, second, len(points) - 1])
    else:
        top = list(range(len(points), len(points) + len(face)))
        points += [list(points[vertex]) for vertex in face]
        faces[number] = top
        sides = zip(face, face[1:] + face[:1], top, top[1:] + top[:1], strict=True)
        faces += [[a, b, d, c] for a, b, c, d in sides]


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("seams", ["GIVEN", "AUTOMATIC"])
def test_no_mesh_is_refused_for_its_bad_faces(
    seed: int, seams: Any, capfd: pytest.CaptureFixture[str]
) -> None:
    obj = spoiled(seed)
    assert unwrap(seams=seams) == {"FINISHED"}
    assert np.isfinite(meshes.uv(obj)).all()
    said = capfd.readouterr().out
    assert "0 flips" in said and "left as it was" not in said
