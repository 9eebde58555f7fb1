# SPDX-License-Identifier: GPL-3.0-or-later
"""A .blend file from a stranger: what the extension keeps in files may be of any type and value there."""

from pathlib import Path
from typing import Any

import bpy
import meshes
import numpy as np
import pairing
import pytest
from installed import MODULE, part
from meshes import MeshObject

NAMES = (
    *("authalic_landmarks", "authalic_landmark_index", "authalic_target", "authalic_registered_by"),
    *("authalic_landmark_curves", "authalic_landmark_curve_index", "authalic_curve_key"),
    *("authalic_registration", "authalic_wrap", "authalic_home", "authalic_beside", "authalic_mask"),
)
VALUES: tuple[Any, ...] = (
    *("a text", "x" * 10_000, 7, -(2**31), float("nan"), [1.0, float("inf")], [1, 2, 3, 4], ["a", "b"]),
    {"method": 5, "name": {"a": 1}},
    [{"source_mark": "text", "mark": [1, 2], "name": 3, "weight": "heavy"}],
)


def _stored(owner: Any) -> Any:
    """Where Blender keeps the values of properties that add-ons define."""
    if hasattr(owner, "bl_system_properties_get"):
        return owner.bl_system_properties_get(do_create=True)
    return owner


@pytest.fixture
def heads() -> tuple[MeshObject, MeshObject]:
    return _paired()


def _paired() -> tuple[MeshObject, MeshObject]:
    source, target = pairing.heads()
    for on_source, on_target in ((8, 10), (24, 40), (38, 60)):
        pairing.add(on_source, on_target)
    return source, target


def _reopen(path: Path) -> MeshObject:
    """Saves the file and opens it, as it comes from a stranger; Head A is active there."""
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    source: Any = bpy.data.objects["Head A"]
    meshes.select(source, bpy.data.objects["Head B"])
    return source


def _use(source: MeshObject, folder: Path) -> None:
    """Whatever a person may do; operators may refuse, in words."""
    points, curves, overlay = part("landmarks.points"), part("landmarks.curves"), part("overlay.points")
    points.pairs(source), points.pairs(source, drawing=True)
    curves.pairs(source), curves.pairs(source, drawing=True)
    overlay.shown(bpy.context)
    bpy.ops.ed.undo_push(message="before")
    steps: list[tuple[str, dict[str, Any]]] = [
        *(("register", {}), ("transfer", {}), ("measure", {}), ("unwrap", {})),
        *(("landmark_export", {"filepath": str(folder / "out.json")}), ("landmark_remove", {})),
        *(("landmark_curve_remove", {}), ("landmark_mirror", {}), ("swap_target", {}), ("side_by_side", {})),
        *(
            ("landmark_clear", {}),
            ("landmark_curve_clear", {}),
            ("landmark_add", {"source_vertex": 3, "target_vertex": 4}),
        ),
    ]
    for name, options in steps:
        try:
            getattr(bpy.ops.authalic, name)(**options)
        except RuntimeError as problem:
            assert "Traceback" not in str(problem), f"{name}: {problem}"


@pytest.mark.parametrize("name", NAMES)
def test_values_of_any_type_are_survived(
    heads: tuple[MeshObject, MeshObject], tmp_path: Path, name: str
) -> None:
    source, _ = heads
    for number, value in enumerate(VALUES):
        try:
            _stored(source)[name] = value
        except (TypeError, KeyError, ValueError, OverflowError):
            continue  # no file of Blender holds such a value there
        source = _reopen(tmp_path / f"{number}.blend")
        _use(source, tmp_path)
        assert MODULE in bpy.context.preferences.addons
        bpy.ops.wm.read_homefile(use_empty=True)
        source, _ = _paired()


@pytest.mark.parametrize(
    ("domain", "kind"),
    [("POINT", "FLOAT"), ("FACE", "INT"), ("POINT", "FLOAT_VECTOR"), ("CORNER", "BOOLEAN")],
)
def test_marks_of_any_type_mark_nothing(
    heads: tuple[MeshObject, MeshObject], tmp_path: Path, domain: str, kind: str
) -> None:
    source, _ = heads
    attributes: Any = source.data.attributes
    attributes.remove(attributes["authalic_landmark"])
    attributes.new("authalic_landmark", kind, domain)
    source = _reopen(tmp_path / "marks.blend")
    assert [pair.source_vertex for pair in part("landmarks.points").pairs(source)] == [-1, -1, -1]
    _use(source, tmp_path)


def test_marks_of_any_value_are_survived(heads: tuple[MeshObject, MeshObject], tmp_path: Path) -> None:
    source, _ = heads
    data: Any = source.data.attributes["authalic_landmark"].data
    for values in (np.full(len(data), -1), np.full(len(data), 2**31 - 1), np.arange(len(data)) - 5):
        source.data.attributes["authalic_landmark"].data.foreach_set("value", values.astype(np.int32))
        source = _reopen(tmp_path / "marks.blend")
        _use(source, tmp_path)


@pytest.mark.parametrize(
    "change",
    [
        {"method": "ELSEWISE"},
        {"domain": "TORUS"},
        {"energy": "FREE"},
        {"weight": float("nan")},
        {"angle_weight": float("inf")},
        {"position_weight": -1.0},
    ],
)
def test_settings_that_no_registration_had_are_none(
    heads: tuple[MeshObject, MeshObject], change: dict[str, Any]
) -> None:
    source, _ = heads
    assert bpy.ops.authalic.register() == {"FINISHED"}
    last = part("jobs.last_registration")
    assert last.settings(source).method == "POINTS"
    for name, value in change.items():
        setattr(source.authalic_registration, name, value)
    assert last.settings(source) is None
    target = bpy.data.objects["Head B"]
    target.vertex_groups.new(name="Group").add([0], 1.0, "REPLACE")
    assert bpy.ops.authalic.transfer() == {"FINISHED"}
