# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.unwrap along seams that it finds itself."""

from collections.abc import Callable
from typing import Any

import bpy
import meshes
import problems
import pytest
import seaming
from installed import part
from meshes import MeshObject
from seaming import characteristics, marked
from test_unwrap import assert_no_overlap, assert_sound


def unwrap(**options: Any) -> set[str]:
    return bpy.ops.authalic.unwrap(**options)


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Quick seams, as of a search that ends at once, for tests of what is done with them."""

    def unmapped(*_given: Any, **_options: Any) -> None:
        raise problems.made("SolverError", "cancelled")

    monkeypatch.setattr(part("bridge.seams").authalic, "unwrap", unmapped)


def assert_cut_as_marked(obj: MeshObject) -> None:
    """The islands of the UV map are disks, and those between the seams."""
    sizes = characteristics(obj)
    assert set(sizes) == {1}
    assert meshes.islands(obj).max() + 1 == len(sizes)


def test_two_handles_in_one_call() -> None:
    obj = seaming.two_handles()
    assert unwrap(seams="AUTOMATIC") == {"FINISHED"}
    assert_sound(obj, deviation=0.2)
    assert_no_overlap(obj)
    assert_cut_as_marked(obj)


CLOSED: dict[str, Callable[[], MeshObject]] = {
    "a torus of quads": meshes.torus,
    "a ball": lambda: meshes.icosphere(2),
    "n-gons": lambda: meshes.closed_suzanne(0),
}


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("make", CLOSED.values(), ids=CLOSED.keys())
def test_closed_meshes_are_cut_open(make: Callable[[], MeshObject]) -> None:
    obj = make()
    assert unwrap(seams="AUTOMATIC") == {"FINISHED"}
    assert_sound(obj, deviation=0.2)
    assert_cut_as_marked(obj)
    before = meshes.uv(obj)
    unwrap()  # along the seams that are marked now
    assert meshes.uv(obj) == pytest.approx(before, abs=1e-3)


@pytest.mark.usefixtures("quick")
def test_domain_does_not_count() -> None:
    for domain in ("DISK", "SPHERE"):
        obj = meshes.icosphere(2)
        assert unwrap(seams="AUTOMATIC", domain=domain) == {"FINISHED"}
        assert_cut_as_marked(obj)


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("seams", ["ADD", "AUTOMATIC"])
def test_given_seams_are_added_to_or_ignored_and_always_stay(seams: Any) -> None:
    obj = meshes.cube_sphere(2)
    ring = {pair for pair in seaming.edges(obj) if all(abs(obj.data.vertices[v].co.z) < 1e-4 for v in pair)}
    assert len(ring) == 16
    seaming.mark(obj, ring)
    assert unwrap(seams=seams) == {"FINISHED"}
    assert ring <= marked(obj)
    _, _, points = meshes.triangles(obj)
    island, upper = meshes.islands(obj), points[:, :, 2].mean(axis=1) > 0
    shared = set(island[upper]) & set(island[~upper])
    assert (not shared) == (seams == "ADD")


@pytest.mark.usefixtures("quick")
def test_seams_are_marked_only_if_wanted() -> None:
    obj = meshes.torus()
    assert unwrap(seams="AUTOMATIC", mark_seams=False) == {"FINISHED"}
    assert not marked(obj)
    assert_sound(obj)


@pytest.mark.usefixtures("quick")
def test_less_shear_is_left(capfd: pytest.CaptureFixture[str]) -> None:
    obj = meshes.icosphere(3)
    count = {}
    for shear in (1.1, 1.6):
        seaming.mark(obj, set())
        unwrap(seams="AUTOMATIC", shear=shear)
        count[shear] = len(marked(obj))
    assert count[1.1] > count[1.6]


@pytest.mark.usefixtures("quick")
def test_selected_faces_only() -> None:
    obj = meshes.add(*meshes.together(meshes.ring(n=6), meshes.ring((4, 0, 0), n=6)))
    obj.data.uv_layers.new(name="UVMap")
    before = meshes.uv(obj)
    meshes.edit(obj)
    meshes.select_faces(obj, lambda index: index >= 36)
    assert unwrap(seams="AUTOMATIC") == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert (meshes.uv(obj)[:144] == before[:144]).all() and (meshes.uv(obj)[144:] != before[144:]).any()
    assert min(vertex for pair in marked(obj) for vertex in pair) >= 36


@pytest.mark.usefixtures("quick")
def test_two_objects() -> None:
    first, second = meshes.torus(), meshes.icosphere(2)
    second.location.x = 4
    bpy.context.view_layer.update()
    meshes.select(first, second)
    assert unwrap(seams="AUTOMATIC") == {"FINISHED"}
    density = meshes.densities(first, second)
    assert density.max() / density.min() == pytest.approx(1, abs=1e-3)
    for obj in (first, second):
        assert_cut_as_marked(obj)


def test_refusals_offer_automatic_seams() -> None:
    meshes.torus()
    with pytest.raises(RuntimeError, match="has a handle, which Seams set to Automatic cuts open"):
        unwrap(domain="DISK")
    with pytest.raises(RuntimeError, match=r"has a handle, .*, or set Seams to Automatic"):
        unwrap(domain="SPHERE")
    with pytest.raises(RuntimeError, match="like a torus; mark seams to cut it open, or set Seams to Auto"):
        unwrap()
    meshes.icosphere(1)
    with pytest.raises(RuntimeError, match=r"is closed; .*or Sphere, or set Seams to Automatic"):
        unwrap(domain="DISK")
    meshes.add(*meshes.tube(3, 8, closed=False))
    with pytest.raises(RuntimeError, match=r"2 boundaries; turn on Fill Holes, .*or set Seams to Automatic"):
        unwrap(fill_holes=False)


@pytest.mark.usefixtures("quick")
def test_undo() -> None:
    name = meshes.torus().name
    bpy.ops.ed.undo_push(message="Start")
    before = meshes.uv(bpy.data.objects[name])
    bpy.ops.authalic.unwrap("EXEC_DEFAULT", True, seams="AUTOMATIC")
    assert marked(bpy.data.objects[name])
    bpy.ops.ed.undo()
    assert not marked(bpy.data.objects[name])
    assert (meshes.uv(bpy.data.objects[name]) == before).all()


def job() -> Any:
    bridge, unwrapping = part("bridge"), part("jobs.unwrap")
    mapping = bridge.UnwrapSettings(seams=bridge.SeamSettings())
    return unwrapping.job(bpy.context, unwrapping.Settings(mapping=mapping))


def test_a_cancelled_search_changes_nothing() -> None:
    obj = meshes.icosphere(3)
    before = meshes.uv(obj)
    running = job().start()
    while running.poll()[1] < 0.01:
        pass
    running.cancel()
    with pytest.raises(part("jobs.job").Cancelled):
        running.apply()
    assert not marked(obj) and (meshes.uv(obj) == before).all()


def test_a_search_that_ends_early_unwraps_along_quick_seams() -> None:
    obj = meshes.icosphere(3)
    running = job().start()
    while running.poll()[1] < 0.01:
        pass
    running.end_early()
    said = str(running.apply())
    assert "a longer run finds shorter seams" in said
    assert_sound(obj)
    assert_cut_as_marked(obj)


def test_a_packer_that_fails_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    obj = meshes.icosphere(1)

    def fail(*_: Any) -> None:
        raise RuntimeError("no room")

    monkeypatch.setattr(part("bridge.placement"), "_pack", fail)
    with pytest.raises(RuntimeError, match="no room"):
        unwrap(seams="AUTOMATIC")
    assert not marked(obj)
