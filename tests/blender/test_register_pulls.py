# SPDX-License-Identifier: GPL-3.0-or-later
"""What pulls a registration that keeps shapes: soft landmarks, features and positions; and its preview."""

import inspect
import types
from typing import Any

import bpy
import drawing
import meshes
import numpy as np
import pairs
import pytest
from installed import part
from meshes import Array, MeshObject

PLACES = [(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0), (0, 0, 1)]
KEY = "Morph → Twin"


def balls() -> tuple[MeshObject, MeshObject]:
    source = meshes.bumpy(meshes.icosphere(3))
    source.name = "Ball"
    target = pairs.twin(source, pairs.TILTED)
    return pairs.pair(source, target, pairs.nearest(source, PLACES))


def paint(obj: MeshObject, name: str, values: Array) -> None:
    """Adds a float attribute of vertices."""
    attribute: Any = obj.data.attributes.new(name, "FLOAT", "POINT")
    attribute.data.foreach_set("value", np.ascontiguousarray(values, np.float32))


def register(**options: Any) -> set[str]:
    return bpy.ops.authalic.register(**options)


@pytest.fixture
def library(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The package, with functions that tests replace."""
    registrations = part("bridge.registrations")
    registrations._registrations._found.clear()
    copy = types.SimpleNamespace(**vars(registrations.authalic))
    monkeypatch.setattr(registrations, "authalic", copy)
    return copy


@pytest.fixture
def given(library: Any) -> dict[str, Any]:
    """What `authalic.register_spheres` is called with, which then refuses."""
    noted: dict[str, Any] = {}

    def stop(*_: Any, **options: Any) -> None:
        noted.update(options)
        raise part("bridge.registrations").Unsuitable("seen")

    library.register_spheres = stop
    return noted


def test_options_reach_the_library(given: dict[str, Any]) -> None:
    source, target = balls()
    for obj, sign in ((source, 1), (target, -1)):
        paint(obj, "Depth", sign * np.arange(len(obj.data.vertices)))
    source.authalic_landmarks[1].is_soft, source.authalic_landmarks[1].weight = True, 4.0
    with pytest.raises(RuntimeError, match="seen"):
        register(feature="Depth", feature_weight=0.5, position_weight=0.25)
    assert given["energy"] == "surface" and "angle_weight" not in given
    assert given["weights"] == [np.inf, 4.0, np.inf, np.inf, np.inf]
    on_source, on_target = given["features"]
    assert on_source.shape == (len(source.data.vertices), 1)
    np.testing.assert_array_equal(on_source[:, 0], np.arange(len(on_source)))
    np.testing.assert_array_equal(on_source, -on_target)
    assert (given["feature_weight"], given["position_weight"]) == (0.5, 0.25)


def test_areas_know_no_pulls(given: dict[str, Any]) -> None:
    source, _ = balls()
    source.authalic_landmarks[1].is_soft = True
    with pytest.raises(RuntimeError, match="seen"):
        register(energy="AREA", feature="Depth", position_weight=0.25)
    assert given["energy"] == "area" and not {"weights", "features", "position_weight"} & given.keys()


def test_exact_landmarks_have_no_weights(given: dict[str, Any]) -> None:
    balls()
    with pytest.raises(RuntimeError, match="seen"):
        register()
    assert not {"weights", "features", "feature_weight"} & given.keys()


def test_vertex_groups_and_colors_are_features() -> None:
    source, _ = balls()
    signals = part("blender.signals")
    group = source.vertex_groups.new(name="Brow")
    group.add([3, 5], 0.5, "REPLACE")
    color: Any = source.data.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    color.data[7].color = (1, 1, 1, 1)
    source.data.attributes.new("On", "BOOLEAN", "POINT").data[2].value = True
    assert {"Brow", "Paint", "On"} <= {*signals.names(source)}
    assert not [name for name in signals.names(source) if name.startswith((".", "authalic"))]
    assert np.flatnonzero(signals.read(source, "Brow")).tolist() == [3, 5]
    assert signals.read(source, "Paint")[7] == pytest.approx(1) and signals.read(source, "On")[2] == 1
    assert signals.read(source, "None") is None


def test_only_common_signals_are_offered() -> None:
    source, target = balls()
    for obj, names in ((source, ("A", "B")), (target, ("B", "C"))):
        for name in names:
            obj.vertex_groups.new(name=name)
    assert part("operators.wrap_options")._common_signals(None, bpy.context, "") == ["B"]


def test_a_feature_that_tells_nothing_is_refused() -> None:
    source, target = balls()
    with pytest.raises(
        RuntimeError, match='Ball and Twin do not both have the vertex group or attribute "Up"'
    ):
        register(feature="Up")
    for obj in (source, target):
        paint(obj, "Up", np.ones(len(obj.data.vertices)))
    with pytest.raises(RuntimeError, match='"Up" is the same all over Ball'):
        register(feature="Up")
    target.data.attributes["Up"].data[3].value = np.nan
    source.data.attributes["Up"].data[0].value = 2
    with pytest.raises(RuntimeError, match='"Up" is NaN or infinite at vertex 3 of Twin'):
        register(feature="Up")
    assert source.data.shape_keys is None


def test_a_feature_alone_lays_closed_meshes_over_each_other(capfd: pytest.CaptureFixture[str]) -> None:
    source, target = balls()
    part("landmarks.points").clear(source)
    with pytest.raises(RuntimeError, match=r"at least two landmark pairs.*or choose a feature"):
        register()
    x, y, z = pairs.positions(source).T
    for obj in (source, target):
        paint(obj, "Depth", x + 0.5 * x * y + 0.3 * z**3)
    register(feature="Depth")
    assert "by a feature alone, 0 folds" in capfd.readouterr().out
    goal = pairs.moved(pairs.positions(target), target.matrix_world)
    apart = np.linalg.norm(pairs.positions(source, KEY) - goal, axis=1)
    assert apart.max() < 1e-3 * pairs.size(goal)
    target.vertex_groups.new(name="Nose").add([7], 1.0, "REPLACE")
    for is_new in (False, True):
        if is_new:
            part("bridge.registrations")._registrations._found.clear()
        bpy.ops.authalic.transfer()
        assert "by a feature" + is_new * " (registered anew)" in capfd.readouterr().out
        assert [g.weight for g in source.data.vertices[7].groups] == pytest.approx([1.0], abs=1e-3)


def test_a_soft_landmark_only_pulls() -> None:
    """It is paired with a vertex far away: exact it meets that, soft it hardly moves."""
    source, target = balls()
    wrong = pairs.nearest(target, [(0.3, 0.3, 1)])[0]
    part("landmarks.points").move(source, 4, "target", wrong)
    goal = pairs.moved(pairs.positions(target), target.matrix_world)[wrong]
    vertex = part("landmarks.points").pairs(source)[4].source_vertex
    missed = []
    for weight in (None, 1e-3):
        if weight:
            source.authalic_landmarks[4].is_soft, source.authalic_landmarks[4].weight = True, weight
        register()
        missed.append(np.linalg.norm(pairs.positions(source, KEY)[vertex] - goal))
    size = pairs.size(pairs.positions(source, KEY))
    assert missed[0] < 1e-5 * size < 0.02 * size < missed[1]
    assert source.authalic_landmarks[0].error < 1e-3 < source.authalic_landmarks[4].error


def test_the_registration_is_kept_as_long_as_nothing_pulls_otherwise(library: Any) -> None:
    source, target = balls()
    made: list[Any] = []
    spheres = library.register_spheres
    library.register_spheres = lambda *args, **options: made.append(options) or spheres(*args, **options)
    for obj in (source, target):
        paint(obj, "Up", pairs.positions(obj)[:, 2])
    counts = []
    changes: list[Any] = [
        lambda: None,
        lambda: setattr(source.authalic_landmarks[0], "weight", 5.0),  # it is exact
        lambda: setattr(source.authalic_landmarks[0], "is_soft", True),
        lambda: setattr(source.authalic_landmarks[0], "weight", 7.0),
    ]
    for change in changes:
        change()
        register()
        counts.append(len(made))
    assert counts == [1, 1, 2, 3]
    for value, count in ((None, 4), (None, 4), (9.0, 5)):
        if value:
            source.data.attributes["Up"].data[0].value = value
        register(feature="Up")
        assert len(made) == count


def test_the_report_names_the_energy_of_areas_only_where_it_counts(capfd: pytest.CaptureFixture[str]) -> None:
    balls()
    for energy, is_named in (("SURFACE", False), ("AREA", True)):
        register(energy=energy)
        assert ("authalic energy" in capfd.readouterr().out) == is_named


def test_swap_and_mirror_keep_the_weights() -> None:
    source, target = balls()
    landmark = source.authalic_landmarks[0]
    landmark.name, landmark.is_soft, landmark.weight = "Ear.L", True, 3.0
    part("landmarks.points").remove(source, 1)
    bpy.ops.authalic.landmark_mirror(tolerance=0.2)
    weights = {each.name: (each.is_soft, each.weight) for each in source.authalic_landmarks}
    assert weights["Ear.R"] == weights["Ear.L"] == (True, 3.0) != weights["Landmark 3"]
    bpy.ops.authalic.swap_target()
    assert {each.name: (each.is_soft, each.weight) for each in target.authalic_landmarks} == weights


def test_the_weight_of_a_pair_is_in_the_panel_where_it_counts() -> None:
    source, _ = balls()
    assert {"is_soft", "weight"} <= {*drawing.draw_panel("AUTHALIC_PT_landmarks").properties}
    source.authalic_wrap.energy = "AREA"
    assert not {"is_soft", "weight"} & {*drawing.draw_panel("AUTHALIC_PT_landmarks").properties}


@pytest.mark.parametrize("align", [False, True])
def test_the_preview_shows_where_the_morph_would_end(library: Any, align: bool) -> None:
    source, _ = balls()
    spheres = library.register_spheres

    def with_preview(*given: Any, preview: Any = None, **options: Any) -> Any:
        registration = spheres(*given, **options)
        preview(np.zeros((len(source.data.vertices), 3)))
        preview(np.asarray(registration.positions))
        return registration

    library.register_spheres = with_preview
    module = part("jobs.register")
    job = module.job(bpy.context, module.Settings(align=align))
    assert job.preview() is None
    job.execute()
    shown = job.preview()
    assert shown.object_name == "Ball" and job.preview() is None, "each is shown once"
    ends = pairs.moved(pairs.positions(source, KEY), source.matrix_world)
    np.testing.assert_allclose(shown.points, ends, atol=1e-4)
    overlay = part("overlay.preview")
    overlay.show(bpy.context, shown)
    assert overlay.shown() is shown
    overlay.show(bpy.context, None)
    assert overlay.shown() is None


def test_a_library_without_previews_is_not_asked_for_them(library: Any) -> None:
    balls()
    spheres = library.register_spheres

    def without_preview(source: Any, target: Any, **options: Any) -> Any:
        assert "preview" not in options
        return spheres(source, target, **options)

    def plain(source: Any, target: Any, *, progress: Any = None, **_: Any) -> None: ...

    without_preview.__signature__ = inspect.signature(plain)
    library.register_spheres = without_preview
    assert register() == {"FINISHED"}


def test_the_wires_of_the_preview_are_the_edges_of_the_mesh() -> None:
    bpy.ops.mesh.primitive_cylinder_add(vertices=9)  # with n-gons
    obj = bpy.context.object
    surface = part("blender.shape_keys").read(obj)
    side = part("registration.sides").side(surface, np.identity(4))
    edges = {tuple(sorted(edge)) for edge in part("registration.wires").between_polygons(side).tolist()}
    vertices = side.vertices
    assert {tuple(sorted(vertices[list(edge)].tolist())) for edge in edges} == {
        tuple(sorted(edge.vertices)) for edge in obj.data.edges
    }
