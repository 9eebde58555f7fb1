# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of a registration, which its source keeps."""

from pathlib import Path
from typing import Any

import bpy
import drawing
import meshes
import pairs
import pytest
from installed import part
from meshes import MeshObject

USED = {"angle_weight": 0.25, "weight": 3.0, "align": True, "animate": True, "frame_end": 40}


def couple() -> tuple[MeshObject, MeshObject]:
    source = meshes.bumpy(meshes.icosphere(2))
    source.name = "Ball"
    target = pairs.twin(source)
    return pairs.pair(source, target, pairs.nearest(source, [(1, 1, 0), (-1, 1, 0), (0, -1, 0), (0, 0, 1)]))


def kept(obj: MeshObject) -> dict[str, Any]:
    return {name: getattr(obj.authalic_wrap, name) for name in USED}


class Caller:
    """An operator that a button starts with some options."""

    def __init__(self, **options: Any) -> None:
        self.properties, self._set = self, options
        for name, value in options.items():
            setattr(self, name, value)

    def is_property_set(self, name: str) -> bool:
        return name in self._set


def started(source: MeshObject, **options: Any) -> Caller:
    operator = Caller(**options)
    part("operators.wrap_options").start_with_kept(operator, source)
    return operator


def test_the_source_keeps_the_options_and_the_button_starts_with_them(tmp_path: Path) -> None:
    source, target = couple()
    assert bpy.ops.authalic.register(**USED) == {"FINISHED"}
    assert kept(source) == USED
    assert kept(target) == kept(pairs.twin(target, name="Third")) != USED
    path = str(tmp_path / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    source = bpy.data.objects["Ball"]
    assert kept(source) == USED
    operator = started(source, weight=7.0)
    assert (operator.angle_weight, operator.align, operator.frame_end) == (0.25, True, 40)
    assert operator.weight == 7.0, "what the caller sets counts"


def test_the_panel_shows_and_changes_what_the_source_keeps() -> None:
    source, _ = couple()
    source.authalic_wrap.method = "CURVES"
    assert "angle_weight" not in drawing.draw_panel("AUTHALIC_PT_wrap").properties
    source.authalic_wrap.method, source.authalic_wrap.energy = "POINTS", "AREA"
    source.authalic_wrap.angle_weight = 0.5
    assert "angle_weight" in drawing.draw_panel("AUTHALIC_PT_wrap").properties
    assert started(source).angle_weight == 0.5


def test_scripts_start_with_the_defaults() -> None:
    source, _ = couple()
    bpy.ops.authalic.register(**USED)
    assert bpy.ops.authalic.register() == {"FINISHED"}
    assert kept(source) == {
        **{"angle_weight": 0.0, "weight": 1.0, "align": False, "animate": False, "frame_end": 100}
    }


def test_a_refused_registration_keeps_nothing() -> None:
    source, _ = couple()
    with pytest.raises(RuntimeError, match="after frame 50"):
        bpy.ops.authalic.register(animate=True, frame_start=50, frame_end=40)
    assert not source.authalic_wrap.animate


def test_the_options_are_undone_with_the_registration() -> None:
    couple()
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.authalic.register("EXEC_DEFAULT", True, align=True)
    assert bpy.data.objects["Ball"].authalic_wrap.align
    bpy.ops.ed.undo()
    assert not bpy.data.objects["Ball"].authalic_wrap.align


def test_registering_again_keeps_the_value_of_the_morph() -> None:
    source, _ = couple()
    bpy.ops.authalic.register()
    source.data.shape_keys.key_blocks["Morph → Twin"].value = 0.75
    bpy.ops.authalic.register(angle_weight=0.5)
    assert source.data.shape_keys.key_blocks["Morph → Twin"].value == 0.75
    assert source.active_shape_key.name == "Basis"
