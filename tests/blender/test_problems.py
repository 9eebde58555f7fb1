# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's own sentences for errors of the library, made from their data, not their messages."""

import re
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import bmesh
import bpy
import curving
import meshes
import numpy as np
import pairs
import problems
import pytest
import spheres
from installed import library, part
from meshes import MeshObject

FACTS: tuple[dict[str, Any], ...] = (
    {},
    {"indices": (0, 2, 9), "count": 30},
    {"side": "target", "curve": 1, "second_curve": 0, "indices": (1,), "count": 1},
)
Make = Callable[[], MeshObject]
Spoil = Callable[[MeshObject], None]
Curves = list[tuple[Any, Any]]
OF_EDGES = {"non_manifold_edge", "not_orientable"}


# Every kind has a sentence


def test_every_kind_of_the_library_has_a_sentence() -> None:
    sentences = part("messages.problems")
    assert sentences.ERRORS.keys() == library().ERROR_KINDS.keys()
    assert sentences.WARNINGS.keys() == library().WARNING_KINDS.keys()


def all_problems() -> Iterator[Any]:
    """An error or a warning of each kind, with few and with many facts."""
    for facts in FACTS:
        for kind in library().ERROR_KINDS:
            indices = facts.get("indices", ())
            pairs_of = tuple((index, index + 1) for index in indices) if kind in OF_EDGES else indices
            yield problems.made("MeshError", kind, **facts | {"indices": pairs_of})
        for kind in library().WARNING_KINDS:
            value = 3.25 if kind in {"strained", "distorted"} else None
            yield problems.warned(kind, value=value, **facts)


def test_no_sentence_has_words_of_the_library() -> None:
    for problem in all_problems():
        for numbers in ((None, None), (np.array([5, 6, 7]), np.array([15, 16, -1]))):
            said = part("messages.problems").in_words(problem, *numbers, names=["Brow", "Jaw"])
            assert len(said) > 10 and "xyzzy" not in said and "None" not in said and "{" not in said, said


def test_an_unknown_kind_is_told_in_the_words_of_the_library() -> None:
    problem = problems.made("SolverError", "of_tomorrow", indices=(0,), count=1)
    assert part("messages.problems").in_words(problem, [8], [9]) == problems.GARBLED


# The library's messages do not matter


def refusal(call: Callable[..., Any], **options: Any) -> str:
    """The output of an operator, with its result or its error."""
    try:
        call(**options)
    except RuntimeError as error:
        return str(error)
    return ""


def islands() -> str:
    """Islands with a bad coordinate, and with a handle."""
    shapes = meshes.grid(), meshes.ring((0, 5, 0))
    obj = meshes.add(*meshes.together(*shapes), "Mixed")
    obj.data.vertices[7].co.x = float("nan")
    return refusal(bpy.ops.authalic.unwrap)


def handle() -> str:
    meshes.torus()
    return refusal(bpy.ops.authalic.unwrap)


def landmark_on_the_boundary() -> str:
    pairs.pair(*couple(sheet), [17, 0])
    return refusal(bpy.ops.authalic.register)


def holes() -> str:
    bpy.ops.mesh.primitive_cylinder_add(vertices=12, end_fill_type="NOTHING")
    return refusal(bpy.ops.authalic.unwrap, fill_holes=False)


def branching_edge() -> str:
    vertices, faces = spheres.icosphere(2)
    meshes.add([*vertices, (3, 0, 0)], [*faces, [*faces[0][:2], len(vertices)]])
    return refusal(bpy.ops.authalic.sphere_shape_key)


def sphere_with_a_bad_coordinate() -> str:
    meshes.icosphere(2).data.vertices[5].co.y = float("nan")
    return refusal(bpy.ops.authalic.sphere_shape_key)


def stretched_uvs() -> str:
    obj = meshes.add_grid("Grid", n=6)
    obj.data.uv_layers.new(name="UVMap")
    uv = np.array([obj.data.vertices[loop.vertex_index].co[:2] for loop in obj.data.loops])
    uv[[loop.vertex_index == 0 for loop in obj.data.loops]] = 3.0
    meshes.set_uv(obj, uv)
    return refusal(bpy.ops.authalic.fix_flips)


def couple(make: Make, spoil: Spoil | None = None) -> tuple[MeshObject, MeshObject]:
    source = make()
    target = pairs.twin(source)
    if spoil:
        spoil(target)
    source.authalic_target = target
    meshes.select(source)
    bpy.context.view_layer.update()
    return source, target


def bumpy() -> MeshObject:
    return meshes.bumpy(meshes.icosphere(3))


def sheet() -> MeshObject:
    return meshes.add_grid("Sheet", n=10)


def by_points(make: Make, spoil: Spoil) -> str:
    source, target = couple(make, spoil)
    pairs.pair(source, target, [17, 30, 60, 90])
    return refusal(bpy.ops.authalic.register)


def with_bad_coordinate(obj: MeshObject) -> None:
    obj.data.vertices[3].co.x = float("nan")


def without_area(obj: MeshObject) -> None:
    first, *others = list(obj.data.polygons[20].vertices)
    for vertex in others:
        obj.data.vertices[vertex].co = obj.data.vertices[first].co


def registered(
    curves: Callable[[MeshObject], Curves],
    make: Make = bumpy,
    spoil: Spoil | None = None,
    progress: Callable[..., bool] = lambda *_: True,
) -> str:
    """The bridge's report of a registration of two objects by curves (source path, target path)."""
    source, _ = couple(make, spoil)
    bridge, sides = part("bridge"), part("jobs.register").chosen(bpy.context).sides
    named = [(f"Curve {number}", *both) for number, both in enumerate(curves(source), 1)]
    settings = part("registration.settings").Settings(method="CURVES")
    part("bridge.registrations")._registrations._found.clear()
    try:
        registration = bridge.register(*sides, named, settings, progress)
    except bridge.Unsuitable as error:
        return str(error)
    return "; ".join(registration.remarks)


ARCS = (
    [(1, 0.3, 0), (0.6, 0.9, 0.3), (0, 1, 0.5)],
    [(-1, 0.2, 0.4), (-0.6, -0.6, 0.5), (-0.1, -1, 0.2)],
    [(0.4, -0.5, -1), (-0.3, 0.4, -1)],
    [(0.3, -0.3, 1), (-0.3, 0.3, 1)],
)


def routes(obj: MeshObject, stops: Sequence[Any] = ARCS) -> list[Any]:
    return [curving.route(obj, *each) for each in stops]


def ring(obj: MeshObject) -> Any:
    """A closed path around the bottom."""
    around = [(1, 0, -0.3), (0, 1, -0.3), (-1, 0, -0.3), (0, -1, -0.3), (1, 0, -0.3)]
    return curving.route(obj, *around)


def same(obj: MeshObject) -> Curves:
    return [(path, path) for path in routes(obj)]


def crossing(obj: MeshObject) -> Curves:
    return [
        *same(obj)[:1],
        *[(path, path) for path in routes(obj, [[(0.3, 1, 0), (1, 1, 1)], ARCS[0][::-1]])],
    ]


def meeting_itself(obj: MeshObject) -> Curves:
    path = routes(obj)[0]
    return [([*path, path[-2]], path)]


def short(obj: MeshObject) -> Curves:
    return [(path[:2], path) for path in routes(obj)]


def closed_once(obj: MeshObject) -> Curves:
    return [(ring(obj), routes(obj)[0])]


def inside_once(obj: MeshObject) -> Curves:
    inside, outside = routes(obj, ARCS[2:])
    return [(ring(obj), ring(obj)), (inside, outside)]


def swapped(obj: MeshObject) -> Curves:
    first, second, *others = same(obj)
    return [(first[0], second[1]), (second[0], first[1]), *others]


def reversed_once(obj: MeshObject) -> Curves:
    (source_path, target_path), *others = same(obj)
    return [(source_path, target_path[::-1]), *others]


def rows(obj: MeshObject) -> Curves:
    paths = routes(obj, [[(x, -0.4, 0), (x, 0.4, 0)] for x in (-0.4, 0.4)])
    return [(path, path) for path in paths]


def reversed_rows(obj: MeshObject) -> Curves:
    return [(source_path, target_path[::-1]) for source_path, target_path in rows(obj)]


def mirrored(obj: MeshObject) -> None:
    for vertex in obj.data.vertices:
        vertex.co.x = -vertex.co.x
    obj.data.flip_normals()


def turned_over(obj: MeshObject) -> None:
    obj.data.flip_normals()


CASES: dict[str, tuple[Callable[[], str], list[str]]] = {
    "islands": (islands, ["vertex 7", "is closed and has a handle"]),
    "handle": (handle, ["is closed and has a handle"]),
    "landmark": (landmark_on_the_boundary, ['Landmark "Landmark 2" is on the boundary of Sheet']),
    "holes": (holes, ["2 boundaries"]),
    "branching_edge": (branching_edge, []),
    "sphere_nan": (sphere_with_a_bad_coordinate, ["vertex 5"]),
    "stretched_uvs": (stretched_uvs, ["Grid at face 0"]),
    "points_nan": (lambda: by_points(bumpy, with_bad_coordinate), ["Twin: NaN or infinite", "vertex 3"]),
    "points_area": (lambda: by_points(sheet, without_area), ["Twin: "]),
    "curves_nan": (
        lambda: registered(same, spoil=with_bad_coordinate),
        ["Twin: NaN or infinite", "vertex 3"],
    ),
    "crossing": (lambda: registered(crossing), ['Icosphere: curves "Curve 1" and "Curve 2" meet at vertex']),
    "meeting_itself": (lambda: registered(meeting_itself), ['Icosphere: curve "Curve 1" meets itself']),
    "short": (lambda: registered(short), ['Icosphere: curve "Curve 1" is too short']),
    "closed_once": (lambda: registered(closed_once), ['Twin: curve "Curve 1" is open']),
    "inside_once": (
        lambda: registered(inside_once),
        ['curve "Curve 2" lies inside the closed curve "Curve 1"'],
    ),
    "mirrored": (lambda: registered(same, spoil=mirrored), ["Object > Mirror"]),
    "swapped": (lambda: registered(swapped), ["strained"]),
    "reversed": (lambda: registered(reversed_once), ['curve "Curve 1" fits far better in reverse']),
    "reversed_all": (
        lambda: registered(reversed_rows, sheet),
        ["most curves run backwards", 'curve "Curve 2" fits far better in reverse'],
    ),
    "turned_over": (lambda: registered(rows, sheet, turned_over), ["Mesh > Normals > Flip"]),
    "cancelled": (lambda: registered(same, progress=lambda *_: False), ["cancelled before"]),
}


def told(case: Callable[[], str], capfd: pytest.CaptureFixture[str]) -> str:
    """All output of a case, without its seconds."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    capfd.readouterr()
    said = case()
    return re.sub(r"\d+\.\d+ s\b", "", said + capfd.readouterr().out)


@pytest.mark.parametrize(("case", "words"), CASES.values(), ids=CASES)
def test_the_sentences_stay_when_every_message_of_the_library_changes(
    case: Callable[[], str],
    words: list[str],
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    before = told(case, capfd)
    for word in words:
        assert word in before, before
    assert len(before) > 20
    problems.garble(monkeypatch)
    after = told(case, capfd)
    assert "xyzzy" not in after
    assert after == before


# The right remedy


def split(obj: MeshObject, kind: str) -> MeshObject:
    """Separates the faces of a mesh: all, or along the edges of one face."""
    meshes.edit(obj)
    bpy.ops.mesh.select_all(action="SELECT" if kind == "all faces" else "DESELECT")
    if kind == "one face":
        edit = bmesh.from_edit_mesh(obj.data)
        edit.faces.ensure_lookup_table()
        edit.faces[0].select_set(True)
        bmesh.update_edit_mesh(obj.data)
        bpy.ops.mesh.split()
    else:
        bpy.ops.mesh.edge_split(type="EDGE")
    bpy.ops.object.mode_set(mode="OBJECT")
    return obj


@pytest.mark.parametrize("kind", ["all faces", "one face"])
def test_split_vertices_are_to_be_merged(kind: str) -> None:
    """And that helps."""
    obj = split(meshes.icosphere(2), kind)
    with pytest.raises(RuntimeError, match=r"lie on each other, but are not joined.*Merge > By Distance"):
        bpy.ops.authalic.sphere_shape_key()
    meshes.edit(obj)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.remove_doubles()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.authalic.sphere_shape_key() == {"FINISHED"}


def test_split_vertices_of_a_registration_are_to_be_merged() -> None:
    source, target = meshes.icosphere(2), split(meshes.icosphere(2), "all faces")
    source.authalic_target = target
    part("landmarks.points").add(source, 0, 0)
    meshes.select(source)
    with pytest.raises(RuntimeError, match=r"lie on each other, but are not joined.*Merge > By Distance"):
        bpy.ops.authalic.register()


def test_pieces_that_do_not_touch_are_not_to_be_merged() -> None:
    vertices, faces = meshes.grid(n=3)
    above = vertices + np.array([0, 0, 5])
    meshes.add([*vertices, *above], [*faces, *(faces + len(vertices))], "Two")
    with pytest.raises(RuntimeError, match="consists of 2 pieces") as problem:
        bpy.ops.authalic.sphere_shape_key()
    assert "Merge" not in str(problem.value)


@pytest.mark.parametrize(
    ("options", "uneven", "sheared"),
    [
        ({}, "set Seams to Add", "set Seams to Add"),
        ({"outline": "CIRCLE"}, "set Outline to Free", "set Outline to Free"),
        ({"angle_weight": 0.9}, "choose the preset Even", "set Seams to Add"),
        ({"method": "FIXED_POINT"}, "set Method to Gauss-Newton", "set Seams to Add"),
    ],
)
def test_the_remedy_of_an_island_is_one_that_applies(
    options: dict[str, Any], uneven: str, sheared: str
) -> None:
    solver = part("bridge.solver").Solver(**options)
    settings = part("bridge.settings").UnwrapSettings(solver=solver)
    assert part("bridge.remedies").of_disk(settings) == (uneven, sheared)
    make = part("bridge.shortfall").shortfall
    assert str(make("converged", (9.0, 1.0), solver, 0.1, (uneven, sheared))).endswith(f"; {uneven}")
    assert str(make("converged", (0.0, 99.0), solver, 0.1, (uneven, sheared))).endswith(f"; {sheared}")


@pytest.mark.parametrize(("size", "is_named"), [(3, False), (4, False), (9, True)])
def test_only_n_gons_are_to_be_poked(size: int, is_named: bool) -> None:
    polygons = np.repeat(np.arange(5), size - 2)
    remedies = part("bridge.remedies")
    said = [
        *remedies.of_sphere(polygons),
        *remedies.of_layout(part("bridge.settings").UnwrapSettings(), polygons),
    ]
    assert any("poke" in remedy for remedy in said) == is_named
    assert not any("Layout" in remedy for remedy in said)
