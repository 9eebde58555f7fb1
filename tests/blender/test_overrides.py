# SPDX-License-Identifier: GPL-3.0-or-later
"""What is linked or overridden is refused by name before anything is written: Blender would lose it."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import linking
import meshes
import pytest
from installed import part
from meshes import MeshObject

AUTHALIC = bpy.ops.authalic
OF_MESHES = {
    "unwrap": lambda: AUTHALIC.unwrap(),
    "mark seams": lambda: AUTHALIC.mark_seams(),
    "fix flips": lambda: AUTHALIC.fix_flips(),
    "sphere": lambda: AUTHALIC.sphere_shape_key(),
}
OF_COUPLES = {
    "register": lambda: AUTHALIC.register(),
    "transfer": lambda: AUTHALIC.transfer(),
    "add": lambda: AUTHALIC.landmark_add(source_vertex=5, target_vertex=5),
    "pick": lambda: AUTHALIC.landmark_pick(source_vertex=5, target_vertex=5),
    "add curve": lambda: AUTHALIC.landmark_curve_add(source_vertices="0 1 2", target_vertices="0 1 2"),
}
OF_LISTS = {
    "remove": lambda: AUTHALIC.landmark_remove(),
    "clear": lambda: AUTHALIC.landmark_clear(),
    "remove curve": lambda: AUTHALIC.landmark_curve_remove(),
    "clear curves": lambda: AUTHALIC.landmark_curve_clear(),
    "reverse curve": lambda: AUTHALIC.landmark_curve_reverse(),
    "import": lambda: AUTHALIC.landmark_import(filepath="no such file.json"),
}
KINDS = ("linked", "override", "override with its mesh", "local with a linked mesh", "local with an override")


def couple(path: Path) -> list[MeshObject]:
    """Two linked grids with UV maps, a landmark and a curve, the first with the second as its target."""
    objects = [meshes.add_grid(name) for name in ("Head", "Mask")]
    for obj in objects:
        obj.data.uv_layers.new(name="Given")
    objects[0].authalic_target = objects[1]
    part("landmarks.points").add(objects[0], 24, 24)
    part("landmarks.curves").add(objects[0], (14, 15, 16), (14, 15, 16))
    return linking.relink(path, *objects)


def prepared(kind: str, path: Path) -> MeshObject:
    """The active object: an object or a mesh of it that cannot be written."""
    head, mask = couple(path)
    obj = head
    if kind.startswith("override"):
        obj = linking.overridden(head, is_mesh_too=kind.endswith("mesh"))
    elif kind.startswith("local"):
        lent = head if kind.endswith("linked mesh") else linking.overridden(head, is_mesh_too=True)
        obj = linking.local(lent)
        obj.authalic_target = mask
    meshes.select(obj)
    return obj


def state(obj: MeshObject) -> tuple[Any, ...]:
    mesh = obj.data
    uv = [tuple(corner.vector) for layer in mesh.uv_layers for corner in layer.uv]
    seams = [edge.use_seam for edge in mesh.edges]
    return (
        *(uv, seams, mesh.shape_keys, sorted(mesh.attributes.keys()), obj.vertex_groups.keys()),
        *(len(obj.authalic_landmarks), len(obj.authalic_landmark_curves)),
    )


def refused(obj: MeshObject, call: Callable[[], Any], words: str) -> None:
    before = state(obj)
    with pytest.raises(RuntimeError, match=f"{obj.name}: {words}; make it local first"):
        call()
    assert state(obj) == before


@pytest.mark.parametrize("kind", KINDS)
def test_measuring_writes_nothing_into_meshes_that_cannot_be_written(kind: str, tmp_path: Path) -> None:
    obj = prepared(kind, tmp_path)
    before = state(obj)
    report = part("jobs.measure").job(bpy.context).execute()
    assert report.figures.triangles == 72 and state(obj) == before
    assert f"{obj.name} gets no attribute: its mesh is" in str(report)
    assert AUTHALIC.measure() == {"FINISHED"} and state(obj) == before


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", [*OF_MESHES, *OF_COUPLES])
def test_operators_refuse_meshes_that_cannot_be_written(kind: str, name: str, tmp_path: Path) -> None:
    obj = prepared(kind, tmp_path)
    refused(obj, (OF_MESHES | OF_COUPLES)[name], "(its mesh|the object) is (linked|a library override).*")


@pytest.mark.parametrize("kind", KINDS[:3])
@pytest.mark.parametrize("name", OF_LISTS)
def test_landmarks_of_objects_that_cannot_be_written_stay(kind: str, name: str, tmp_path: Path) -> None:
    obj = prepared(kind, tmp_path)
    refused(obj, OF_LISTS[name], "the object is (linked|a library override).*")


@pytest.mark.parametrize("kind", KINDS[:3])
def test_functions_for_scripts_refuse_too(kind: str, tmp_path: Path) -> None:
    obj = prepared(kind, tmp_path)
    points, curves = part("landmarks.points"), part("landmarks.curves")
    before = state(obj)
    calls: list[Callable[[], Any]] = [
        lambda: points.add(obj, 3, 3),
        lambda: points.remove(obj, 0),
        lambda: points.clear(obj),
        lambda: points.replace(obj, [("Nose", 3, 3)]),
        lambda: curves.add(obj, (28, 29, 30), (28, 29, 30)),
        lambda: curves.remove(obj, 0),
        lambda: curves.reverse(obj, 0, "target"),
        lambda: curves.clear(obj),
    ]
    for call in calls:
        with pytest.raises(part("landmarks.objects").CannotPair, match="Head: the object is"):
            call()
    assert state(obj) == before


def test_vertices_of_the_target_mesh_cannot_be_marked(tmp_path: Path) -> None:
    _, mask = couple(tmp_path)
    source = meshes.add_grid("Mine")
    source.authalic_target = mask
    meshes.select(source)
    with pytest.raises(RuntimeError, match="Mask: its mesh is linked from another file"):
        OF_COUPLES["add"]()
    assert not source.authalic_landmarks


def test_a_writable_mesh_of_an_override_is_unwrapped(tmp_path: Path) -> None:
    head, _ = couple(tmp_path)
    obj = linking.overridden(head, is_mesh_too=False)
    obj.data = meshes.add_grid("Own").data
    meshes.select(obj)
    assert AUTHALIC.unwrap() == {"FINISHED"}
    assert len(obj.data.uv_layers) == 1


def test_others_are_worked_on_and_the_override_is_named(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    head, _ = couple(tmp_path)
    obj, free = linking.overridden(head, is_mesh_too=True), meshes.add_grid("Free")
    meshes.select(obj, free)
    before = state(obj)
    assert AUTHALIC.unwrap() == {"FINISHED"}
    assert state(obj) == before
    assert len(free.data.uv_layers) == 1
    assert "Head: its mesh is a library override" in capfd.readouterr().out


def test_made_local_it_works(tmp_path: Path) -> None:
    """The remedy that the refusal names."""
    obj = prepared("override with its mesh", tmp_path)
    assert bpy.ops.object.make_local(type="SELECT_OBDATA") == {"FINISHED"}
    assert AUTHALIC.unwrap() == {"FINISHED"}
    assert "UVMap" in bpy.context.object.data.uv_layers or "Given" in bpy.context.object.data.uv_layers
    assert bpy.context.object.data.override_library is None and obj is not None
