# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.sphere_shape_key: the key that it writes, the data that it leaves alone, and its refusals."""

import re
from pathlib import Path
from typing import Any

import bpy
import meshes
import numpy as np
import pytest
import spheres
from mathutils import Matrix
from meshes import Array, MeshObject

NAME = "Authalic Sphere"
CLOSED = {
    "icosphere": lambda: meshes.bumpy(meshes.icosphere(4)),
    "UV sphere": lambda: meshes.bumpy(meshes.uv_sphere(24, 12), 0.2),
    "cube": lambda: meshes.cube_sphere(0),
    "n-gons": lambda: cylinder(),
    "Suzanne": lambda: meshes.closed_suzanne(1),
    "tetrahedron": lambda: meshes.add(*meshes.tetrahedron()),
}


def cylinder() -> MeshObject:
    bpy.ops.mesh.primitive_cylinder_add(vertices=16)
    return bpy.context.object


def add_key(**options: Any) -> set[str]:
    return bpy.ops.authalic.sphere_shape_key(**options)


def key_positions(obj: MeshObject, name: str = NAME) -> Array:
    values = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.shape_keys.key_blocks[name].points.foreach_get("co", values)
    return values.reshape(-1, 3)


def mesh_positions(obj: MeshObject) -> Array:
    values = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


def vertex_triangles(obj: MeshObject) -> Array:
    obj.data.calc_loop_triangles()
    return np.array([tuple(triangle.vertices) for triangle in obj.data.loop_triangles])


def center_and_radius(points: Array, triangles: Array) -> tuple[Array, float]:
    """The center of a surface's area, and the radius of the sphere with this area."""
    area = meshes.surface_areas(points[triangles])
    return area @ points[triangles].mean(axis=1) / area.sum(), np.sqrt(area.sum() / (4 * np.pi))


@pytest.mark.parametrize("name", CLOSED)
def test_key_is_the_sphere_of_the_same_area(name: str, capfd: pytest.CaptureFixture[str]) -> None:
    obj = CLOSED[name]()
    before = mesh_positions(obj)
    assert add_key() == {"FINISHED"}
    said = capfd.readouterr().out
    blocks = obj.data.shape_keys.key_blocks
    assert [block.name for block in blocks] == ["Basis", NAME]
    assert blocks[NAME].value == 0 and blocks[NAME].relative_key == blocks["Basis"]
    assert (mesh_positions(obj) == before).all() and (key_positions(obj, "Basis") == before).all()
    triangles = vertex_triangles(obj)
    center, radius = center_and_radius(before.astype(float), triangles)
    around = key_positions(obj) - center
    np.testing.assert_allclose(
        np.linalg.norm(around, axis=1), radius, rtol=2e-2 if name == "n-gons" else 1e-4
    )
    if name != "n-gons":  # Blender triangulates these in its own way
        assert (np.linalg.det(around[triangles].astype(float)) > 0).all()
    assert f"{NAME} on {obj.name}: area ratio SD" in said and "0 flips, angle distortion" in said
    assert float(re.search(r"radius ([\d.]+)", said)[1]) == pytest.approx(radius, rel=2e-2)


def test_areas_are_kept() -> None:
    obj = meshes.bumpy(meshes.icosphere(5))
    assert add_key() == {"FINISHED"}
    triangles, before = vertex_triangles(obj), mesh_positions(obj).astype(float)
    ratio = meshes.surface_areas(key_positions(obj).astype(float)[triangles])
    ratio /= meshes.surface_areas(before[triangles])
    assert ratio.std() < 0.05 and ratio.mean() == pytest.approx(1, abs=0.02)


def test_key_lies_over_the_mesh() -> None:
    obj = meshes.bumpy(meshes.icosphere(4))
    obj.data.transform(Matrix.Translation((5, 6, 7)))
    add_key()
    points = mesh_positions(obj).astype(float)
    center, _ = center_and_radius(points, vertex_triangles(obj))
    cosine = (spheres.unit(points - center) * spheres.unit(key_positions(obj) - center)).sum(axis=1)
    assert cosine.mean() > 0.9


def test_inside_out_mesh_does_not_turn_inside_out() -> None:
    obj = meshes.bumpy(meshes.icosphere(4))
    obj.data.flip_normals()
    assert add_key() == {"FINISHED"}
    points, triangles = mesh_positions(obj).astype(float), vertex_triangles(obj)
    center, _ = center_and_radius(points, triangles)
    around = (key_positions(obj) - center)[triangles]
    assert (np.linalg.det(around) < 0).all()
    cosine = (spheres.unit(points - center) * spheres.unit(key_positions(obj) - center)).sum(axis=1)
    assert cosine.mean() > 0.9


def test_inconsistent_normals() -> None:
    obj = meshes.bumpy(meshes.icosphere(4))
    obj.data.polygons[7].flip()
    assert add_key() == {"FINISHED"}
    center, _ = center_and_radius(mesh_positions(obj).astype(float), vertex_triangles(obj))
    volumes = np.linalg.det((key_positions(obj) - center)[vertex_triangles(obj)])
    assert np.flatnonzero(volumes < 0).tolist() == [7]


def test_slider_morphs() -> None:
    obj = meshes.bumpy(meshes.icosphere(3))
    add_key()
    obj.data.shape_keys.key_blocks[NAME].value = 1
    bpy.context.view_layer.update()
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    np.testing.assert_allclose(mesh_positions(evaluated), key_positions(obj), atol=1e-6)


def test_again_replaces_the_key() -> None:
    obj = meshes.bumpy(meshes.icosphere(3))
    add_key(iterations=1)
    first = key_positions(obj)
    obj.data.shape_keys.key_blocks[NAME].value = 0.7
    assert add_key() == {"FINISHED"}
    blocks = obj.data.shape_keys.key_blocks
    assert [block.name for block in blocks] == ["Basis", NAME] and blocks[NAME].value == pytest.approx(0.7)
    assert (key_positions(obj) != first).any()
    second = key_positions(obj)
    add_key()
    assert (key_positions(obj) == second).all()


def test_the_active_key_stays_active() -> None:
    obj = meshes.icosphere(2)
    add_key()
    assert obj.active_shape_key.name == "Basis"
    obj.shape_key_add(name="Smile", from_mix=False)
    obj.active_shape_key_index = 2
    add_key()
    assert obj.active_shape_key.name == "Smile"


def test_other_keys_stay_and_the_first_one_counts() -> None:
    obj = meshes.bumpy(meshes.icosphere(3))
    points = mesh_positions(obj)
    obj.shape_key_add(name="First", from_mix=False)
    key = obj.shape_key_add(name="Smile", from_mix=False)
    key.points.foreach_set("co", (points * [1, 1, 3]).astype(np.float32).ravel())
    key.value = 1.0
    other = obj.shape_key_add(name="Other", from_mix=False)
    other.relative_key, other.value = key, 0.25
    smile = key_positions(obj, "Smile")
    assert add_key() == {"FINISHED"}
    blocks = obj.data.shape_keys.key_blocks
    assert [block.name for block in blocks] == ["First", "Smile", "Other", NAME]
    assert (key_positions(obj, "Smile") == smile).all() and (key_positions(obj, "First") == points).all()
    assert blocks["Smile"].value == 1 and blocks["Other"].value == 0.25
    assert blocks["Other"].relative_key == blocks["Smile"]
    assert blocks[NAME].relative_key == blocks["First"] and blocks[NAME].value == 0
    _, radius = center_and_radius(points.astype(float), vertex_triangles(obj))
    center = key_positions(obj).mean(axis=0)
    assert np.linalg.norm(key_positions(obj) - center, axis=1).mean() == pytest.approx(radius, rel=0.05)


def test_object_scale_does_not_matter(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.bumpy(meshes.icosphere(3))
    obj.scale = (1, 5, 2)
    bpy.context.view_layer.update()
    add_key()
    assert f"{obj.name}: non-uniform scale" in capfd.readouterr().out
    _, radius = center_and_radius(mesh_positions(obj).astype(float), vertex_triangles(obj))
    size = np.ptp(key_positions(obj), axis=0)
    np.testing.assert_allclose(size, 2 * radius, rtol=0.05)


def refusal(pattern: str, *objects: MeshObject) -> None:
    """Nothing is changed by the operator, whose message matches."""
    if objects:
        meshes.select(*objects)
    obj = bpy.context.object
    with pytest.raises(RuntimeError, match=pattern):
        add_key()
    assert obj.data.shape_keys is None


def test_open_mesh() -> None:
    meshes.add_grid("Sail")
    refusal(r"Sail: has 1 open boundary, but a sphere has none; fill the holes")


def test_handle() -> None:
    meshes.torus()
    refusal(r"Torus: has a handle, like a torus")


def test_several_pieces() -> None:
    second = spheres.icosphere(1)
    meshes.add(*meshes.together(spheres.icosphere(1), (second[0] + [4, 0, 0], second[1])), "Pair")
    refusal(r"Pair: consists of 2 pieces")


def test_loose_vertices() -> None:
    vertices, faces = spheres.icosphere(1)
    meshes.add([*vertices, (5, 0, 0), (6, 0, 0)], faces, "Dusty")
    refusal(r"Dusty: has 2 loose vertices without a face \(42, 43\); delete loose geometry")


def test_surfaces_that_meet_at_an_edge() -> None:
    vertices, faces = meshes.tetrahedron()
    meshes.add([*vertices, (3, 3, -3)], [*faces, [0, 1, 4]], "Fin")
    refusal(r"Fin: has edges or vertices where surfaces meet")


def test_one_sided() -> None:
    meshes.add(*meshes.moebius(), "Band")
    refusal(r"Band: is one-sided")


def test_face_without_area() -> None:
    vertices, faces = spheres.icosphere(0)
    vertices[faces[3]] = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]
    meshes.add(vertices, faces, "Flat")
    refusal(r"Flat: .*no area in face 3")


def test_bad_coordinate() -> None:
    obj = meshes.icosphere(1)
    obj.data.vertices[3].co.x = float("nan")
    refusal(r"Icosphere: .*vertex 3")


def test_empty_mesh() -> None:
    meshes.add([], [], "Empty")
    refusal(r"Empty: has no faces")


def test_absolute_keys() -> None:
    obj = meshes.icosphere(1)
    obj.shape_key_add(name="Basis")
    obj.data.shape_keys.use_relative = False
    with pytest.raises(RuntimeError, match=r"Icosphere: its shape keys are absolute; turn on Relative"):
        add_key()
    assert len(obj.data.shape_keys.key_blocks) == 1


def test_first_key_with_the_name() -> None:
    obj = meshes.icosphere(1)
    obj.shape_key_add(name=NAME)
    before = key_positions(obj)
    with pytest.raises(RuntimeError, match=r'first shape key.*"Authalic Sphere"; rename'):
        add_key()
    assert (key_positions(obj) == before).all()


def test_linked_mesh(tmp_path: Path) -> None:
    obj = meshes.icosphere(1)
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {obj.data}, fake_user=True)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(path, link=True) as (source, target):
        target.meshes = source.meshes
    linked = bpy.data.objects.new("Linked", target.meshes[0])
    bpy.context.collection.objects.link(linked)
    refusal(r"Linked: its mesh is linked from another file; make it local first", linked)


def test_shared_mesh_gets_one_key(capfd: pytest.CaptureFixture[str]) -> None:
    first = meshes.bumpy(meshes.icosphere(2))
    second = bpy.data.objects.new("Second", first.data)
    bpy.context.collection.objects.link(second)
    meshes.select(first, second)
    assert add_key() == {"FINISHED"}
    assert [block.name for block in first.data.shape_keys.key_blocks] == ["Basis", NAME]
    assert "shares its mesh" in capfd.readouterr().out


def test_several_objects_with_one_that_is_refused(capfd: pytest.CaptureFixture[str]) -> None:
    good, bad = meshes.bumpy(meshes.icosphere(3)), meshes.add_grid("Sail")
    other = meshes.cube_sphere(2)
    meshes.select(good, bad, other)
    assert add_key() == {"FINISHED"}
    said = capfd.readouterr().out
    assert said.count(f"{NAME} on ") == 2 and "left as it was: Sail: has 1 open boundary" in said
    assert bad.data.shape_keys is None
    for obj in (good, other):
        assert NAME in obj.data.shape_keys.key_blocks


def test_modes_and_selection() -> None:
    meshes.icosphere(2)
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Only in Object Mode"):
        add_key()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="Select at least one mesh object"):
        add_key()


@pytest.mark.parametrize("had_keys", [False, True])
def test_undo(had_keys: bool) -> None:
    obj = meshes.bumpy(meshes.icosphere(3))
    if had_keys:
        obj.shape_key_add(name="Basis")
        obj.shape_key_add(name=NAME).points[3].co.z = 5
    bpy.ops.ed.undo_push(message="Start")
    name, before = obj.name, mesh_positions(obj)
    old = key_positions(obj) if had_keys else None
    bpy.ops.authalic.sphere_shape_key("EXEC_DEFAULT", True)
    assert len(obj.data.shape_keys.key_blocks) == 2
    bpy.ops.ed.undo()
    obj = bpy.data.objects[name]
    assert (mesh_positions(obj) == before).all()
    if had_keys:
        assert (key_positions(obj) == old).all()
    else:
        assert obj.data.shape_keys is None
    bpy.ops.ed.redo()
    assert NAME in bpy.data.objects[name].data.shape_keys.key_blocks
