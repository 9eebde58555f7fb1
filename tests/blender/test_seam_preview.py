# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview of seams. There is no window here, so its timer is called by the tests."""

import time
from typing import Any

import bpy
import meshes
import pytest
import seaming
from installed import part
from seaming import marked


def tick() -> bool:
    return bool(part("operators.seam_preview").tick(bpy.context))


def settle() -> list[Any]:
    """Ticks until nothing changes; the lines that are drawn then."""
    preview = part("operators.seam_preview")
    deadline = time.monotonic() + 60
    for _ in range(3):
        assert tick()
    while preview._state.running is not None and time.monotonic() < deadline:
        tick()
        time.sleep(0.01)
    return list(part("overlay.seams").shown())


@pytest.fixture(autouse=True)
def manager() -> Any:
    manager: Any = bpy.context.window_manager
    manager.authalic_seam_preview = True
    yield manager
    manager = bpy.context.window_manager
    manager.authalic_seam_preview = False
    assert not tick()


def options() -> Any:
    return bpy.context.window_manager.operator_properties_last("authalic.mark_seams")


def test_quick_seams_are_drawn_and_nothing_is_marked(manager: Any) -> None:
    obj = meshes.torus()
    (lines,) = settle()
    assert lines.object_name == obj.name and not marked(obj)
    assert manager.authalic_seam_figures.startswith("1 island, length of new seams")
    bpy.ops.authalic.mark_seams(draft=True)
    assert {seaming.pair(edge) for edge in lines.edges.tolist()} == marked(obj)


def test_the_preview_follows_the_slider() -> None:
    meshes.icosphere(3)
    try:
        counts = []
        for shear in (1.6, 1.1):
            options().shear = shear
            (lines,) = settle()
            counts.append(len(lines.edges))
        assert counts[0] < counts[1]
    finally:
        options().shear_preset = "AUTO"


def test_the_preview_follows_the_mesh_and_the_selection() -> None:
    torus = meshes.torus()
    assert [lines.object_name for lines in settle()] == [torus.name]
    ball = meshes.icosphere(1)
    assert tick() and not part("overlay.seams").shown()  # those of the torus are gone at once
    assert [lines.object_name for lines in settle()] == [ball.name]
    bpy.ops.object.select_all(action="DESELECT")
    assert settle() == []


def test_no_preview_is_left_when_it_is_turned_off(manager: Any) -> None:
    meshes.torus()
    assert settle()
    manager.authalic_seam_preview = False
    assert not tick()
    assert not part("overlay.seams").shown() and not manager.authalic_seam_figures


def test_a_problem_is_said(manager: Any) -> None:
    meshes.torus()
    try:
        options().keep_off = "Nose"
        assert settle() == []
        assert "has the vertex group" in manager.authalic_seam_figures
    finally:
        options().keep_off = ""


def test_the_preview_is_no_step_of_undo() -> None:
    name = meshes.torus().name
    bpy.ops.ed.undo_push(message="Start")
    bpy.data.objects[name].location.x = 1
    bpy.ops.ed.undo_push(message="Move")
    assert settle()
    bpy.ops.ed.undo()
    assert bpy.data.objects[name].location.x == 0 and not marked(bpy.data.objects[name])
    assert settle()
