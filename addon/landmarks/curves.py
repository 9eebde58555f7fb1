# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of landmark curves: a path along edges of a source object and the corresponding path of its target.

They live on the source object, as `authalic_landmark_curves`, beside the landmark points and for the same
target. A curve keeps a mark, and so do the edges of both meshes (see `curve_marks`), so that its paths are
found again after the meshes were edited. `pairs` alone says which vertices these are now, in which order, and
where a path is missing or broken.
"""

from collections.abc import Callable, Collection, Sequence
from typing import Any, NamedTuple

import bpy
from bpy.props import CollectionProperty, FloatProperty, IntProperty, StringProperty

from .. import messages
from ..blender import editability
from ..blender.edges import NoEdge
from ..blender.types import LandmarkCurve, MeshObject, owner_of
from ..surfaces.arrays import Path
from . import curve_copies, curve_marks, paths, undo
from .objects import (
    NONE,
    SIDES,
    CannotPair,
    check_lists,
    check_target,
    check_vertex,
    side_object,
    target_problem,
)

_FEWEST = 2, 3  # edges of an open and of a closed curve


class Curve(NamedTuple):
    """A pair of curves as it is now: two `curve_marks.MarkedPath`, and the problem in words or None."""

    name: str
    source: curve_marks.MarkedPath
    target: curve_marks.MarkedPath
    problem: str | None


def _numbers(side: str) -> Callable[[LandmarkCurve], str]:
    return lambda curve: " ".join(str(vertex) for vertex in _path(owner_of(curve), curve, side).vertices)


class AUTHALIC_PG_landmark_curve(bpy.types.PropertyGroup):
    """One pair of curves. Its vertices have their current numbers, whatever was edited."""

    name: StringProperty(name="Name", description="The name of this pair of curves")
    source_vertices: StringProperty(
        name="Source Vertices",
        description="The vertices on this object from start to end; a loop repeats the first one at the end",
        get=_numbers("source"),
    )
    target_vertices: StringProperty(
        name="Target Vertices",
        description="The vertices on the target from start to end; a loop repeats the first one at the end",
        get=_numbers("target"),
    )
    mark: IntProperty(options={"HIDDEN"})
    error: FloatProperty(
        name="Error",
        description="Error of the last registration at this pair, in percent of the target's size. "
        "Negative if there was none",
        default=-1.0,
    )


def pairs(source: MeshObject, *, drawing: bool = False) -> list[Curve]:
    """All pairs of curves of a source object, with the problem of each in words.

    With `drawing`, large meshes are not searched anew unless they have changed visibly.
    """
    without_target = target_problem(source)
    objects = _objects(source)
    by_mark = [_found(source, side, drawing) for side in SIDES]
    listed: list[Curve] = []
    taken: dict[tuple[str, int], tuple[int, str]] = {}
    for index, curve in enumerate(source.authalic_landmark_curves):
        marked = [on_side.get(curve.mark, curve_marks.ABSENT) for on_side in by_mark]
        problem = without_target or _problem(taken, (index, curve.name), marked, objects)
        listed.append(Curve(curve.name, marked[0], marked[1], problem))
    return listed


def add(
    source: MeshObject,
    source_path: Path | None,
    target_path: Path | None,
    *,
    name: str = "",
    index: int = NONE,
) -> LandmarkCurve:
    """Adds a pair, or sets the paths of an existing one, makes it the active pair and returns it.

    Paths are vertices from start to end; a loop ends with its first vertex; None leaves a side as it is.
    Raises `CannotPair` and then changes nothing.
    """
    check_target(source)
    given = {side: tuple(path) for side, path in zip(SIDES, (source_path, target_path), strict=True) if path}
    if not given:
        raise CannotPair("A curve needs a path on the source or on the target")
    for side, path in given.items():
        _check(source, side, path, index)
    curve_copies.part(source)
    curve_copies.ensure_key(source)
    curve_copies.tidy(source.authalic_curve_key)
    curves = source.authalic_landmark_curves
    if index == NONE:
        name, index = name or _free_name(source), len(curves)
        curves.add().mark = curve_marks.new()
    curve = curves[index]
    for side, path in given.items():
        curve_marks.put(side_object(source, side).data, curve_marks.key(source, side), curve.mark, path)
    curve.name, curve.error = name or curve.name, -1.0
    source.authalic_landmark_curve_index = index
    return curve


def reverse(source: MeshObject, index: int, side: str) -> None:
    """Makes the end of a pair's path on one side its start. Raises `CannotPair` and then changes nothing."""
    curve, obj = source.authalic_landmark_curves[index], side_object(source, side)
    check_lists(source)
    if side == "target" and (problem := target_problem(source)):
        raise CannotPair(f"{source.name}: {problem}")
    if reason := editability.why_not_mesh(obj):
        raise CannotPair(f"{obj.name}: {reason}")
    path = getattr(pairs(source)[index], side)
    if path.problem:
        raise CannotPair(f"{curve.name}: {_worded(path, obj)}")
    if path.is_closed:
        raise CannotPair(f"{curve.name} is closed and has no direction")
    curve_copies.part(source)
    sharing = curve_copies.sharing(source, curve, side)
    if sharing is not None:
        raise CannotPair(f"{sharing.name} has this path on {obj.name} too; reverse it in Object Mode")
    curve_marks.reverse(obj.data, curve_marks.key(source, side), curve.mark)
    curve.error = -1.0


def remove(source: MeshObject, index: int) -> None:
    """Removes a pair; the next one becomes the active pair. Raises `CannotPair` and then changes nothing."""
    check_lists(source)
    curve_copies.part(source)
    undo.remember(source, index, undo.CURVES)
    curve = source.authalic_landmark_curves[index]
    for side in SIDES:
        obj = side_object(source, side)
        # In another mode the marks would stay away when the step is undone.
        is_writable = obj is not None and obj.type == "MESH" and editability.is_writable(obj.data)
        is_own = (
            is_writable and source.authalic_curve_key and curve_copies.sharing(source, curve, side) is None
        )
        if is_own and obj.data.is_editmode == source.data.is_editmode:
            curve_marks.clear(obj.data, curve_marks.key(source, side), curve.mark)
    source.authalic_landmark_curves.remove(index)
    curve_copies.tidy(source.authalic_curve_key)
    last = len(source.authalic_landmark_curves) - 1
    source.authalic_landmark_curve_index = max(min(source.authalic_landmark_curve_index, last), 0)


def clear(source: MeshObject) -> None:
    """Removes all pairs. Raises `CannotPair` and then changes nothing."""
    for index in reversed(range(len(source.authalic_landmark_curves))):
        remove(source, index)


def replace(source: MeshObject, wanted: Sequence[tuple[str, Path, Path]]) -> None:
    """Replaces all pairs by pairs (name, source path, target path), or none of them.

    Raises `CannotPair` and then changes nothing.
    """
    check_all(source, wanted)
    curve_copies.part(source)
    clear(source)
    for name, source_path, target_path in wanted:
        add(source, source_path, target_path, name=name)


def check_all(source: MeshObject, wanted: Sequence[tuple[str, Path, Path]]) -> None:
    """Raises `CannotPair` unless pairs (name, source path, target path) could be those of the source."""
    check_target(source)
    for number_of_side, side in enumerate(SIDES):
        obj = side_object(source, side)
        taken: dict[int, int] = {}
        for number, pair in enumerate(wanted):
            path = pair[1:][number_of_side]
            _check_path(obj, path)
            _check_copies(source, side, path)
            for vertex in path:
                earlier = taken.setdefault(vertex, number)
                if earlier != number:
                    names = f'"{wanted[earlier][0]}" and "{pair[0]}"'
                    raise CannotPair(f"the curves {names} meet at vertex {vertex} of {obj.name}")


def _objects(source: MeshObject) -> list[MeshObject | None]:
    return [side_object(source, side) for side in SIDES]


def _found(source: MeshObject, side: str, drawing: bool) -> dict[int, curve_marks.MarkedPath]:
    """{mark: path} of a side."""
    obj = side_object(source, side)
    if obj is None or obj.type != "MESH" or not source.authalic_curve_key:
        return {}
    return curve_marks.find(obj.data, curve_marks.key(source, side), drawing=drawing)


def _path(source: MeshObject, curve: LandmarkCurve, side: str) -> curve_marks.MarkedPath:
    return _found(source, side, False).get(curve.mark, curve_marks.ABSENT)


def _worded(path: curve_marks.MarkedPath, obj: MeshObject) -> str:
    return f"{path.problem} on {obj.name}"


def _problem(
    taken: dict[tuple[str, int], tuple[int, str]],
    numbered: tuple[int, str],
    marked: Sequence[curve_marks.MarkedPath],
    objects: Sequence[MeshObject],
) -> str | None:
    """The problem of a pair with paths on two objects, or None; `taken` are the vertices of earlier pairs."""
    broken = [_worded(path, obj) for path, obj in zip(marked, objects, strict=True) if path.problem]
    touching = _touching(taken, numbered, marked, objects)
    return broken[0] if broken else touching or _unlike(marked, objects)


def _touching(
    taken: dict[tuple[str, int], tuple[int, str]],
    numbered: tuple[int, str],
    marked: Sequence[curve_marks.MarkedPath],
    objects: Sequence[MeshObject],
) -> str | None:
    """The problem if an earlier curve has a vertex of a path; else remembers the vertices in `taken`."""
    for side, path, obj in zip(SIDES, marked, objects, strict=True):
        for vertex in path.vertices:
            earlier = taken.setdefault((side, vertex), numbered)
            if earlier != numbered:
                return f'meets "{earlier[1]}" at vertex {vertex} of {obj.name}; curves must not meet'
    return None


def _unlike(marked: Sequence[curve_marks.MarkedPath], objects: Sequence[MeshObject]) -> str | None:
    """The problem of two paths that are sound by themselves, or None."""
    for path, obj in zip(marked, objects, strict=True):
        few = _too_few(path.vertices)
        if few:
            return f"{few} on {obj.name}"
    if marked[0].is_closed != marked[1].is_closed:
        closed, opened = objects if marked[0].is_closed else objects[::-1]
        return f"is closed on {closed.name} and open on {opened.name}; both must be open or both closed"
    return None


def _too_few(path: Path) -> str | None:
    count, fewest = len(path) - 1, _FEWEST[paths.is_closed(path)]
    return None if count >= fewest else f"needs at least {fewest} edges, not {count},"


def _check(source: MeshObject, side: str, path: Path, index: int) -> None:
    """Raises `CannotPair` unless a path can be that of an existing pair, or of a new one."""
    obj, curves = side_object(source, side), source.authalic_landmark_curves
    _check_path(obj, path)
    replaced = curves[index] if index != NONE else None
    for curve, pair in zip(curves, pairs(source), strict=True):
        shared = {vertex for edge in getattr(pair, side).edges for vertex in edge}.intersection(path)
        if shared and curve != replaced:
            raise CannotPair(
                f'the curve "{pair.name}" has {_vertices(shared)} of {obj.name} already; curves must not meet'
            )
    _check_copies(source, side, path, replaced)


def _check_copies(source: MeshObject, side: str, path: Path, replaced: LandmarkCurve | None = None) -> None:
    """Raises `CannotPair` if a path of a pair, or of a new one, would take edges that a copy shares."""
    if curve_copies.can_part(source):
        return
    obj, owners = side_object(source, side), _owners(source, side, path)
    for copy, curve in curve_copies.others(source, side):
        if curve.mark in owners or (replaced is not None and curve.mark == replaced.mark):
            raise CannotPair(
                f'edges or ends on {obj.name} are those of the curve "{curve.name}" of {copy.name} '
                f"too; remove or reverse one of the copy {source.name} in Object Mode first"
            )


def _vertices(numbers: Collection[int]) -> str:
    numbers = sorted(numbers)
    if len(numbers) == 1:
        return f"vertex {numbers[0]}"
    return f"{len(numbers)} vertices ({messages.numbers(numbers)})"


def _check_path(obj: MeshObject, path: Path) -> None:
    """Raises `CannotPair` unless vertices are a path along edges of an object."""
    if not path:
        raise CannotPair(f"a curve has no vertices on {obj.name}")
    for vertex in path:
        check_vertex(obj, vertex)
    problem = _too_few(path)
    if problem is None and (twice := paths.repeated(path)) is not None:
        problem = f"comes to vertex {twice} twice"
    if problem is not None:
        raise CannotPair(f"the curve {problem} on {obj.name}")
    try:
        curve_marks.check(obj.data, path)
    except NoEdge as missing:
        raise CannotPair(f"{obj.name}: {missing}; a curve runs along edges") from None


def _owners(source: MeshObject, side: str, path: Path) -> set[int]:
    """The marks that edges or ends of a path have already."""
    if not source.authalic_curve_key:
        return set()
    return curve_marks.owners(side_object(source, side).data, curve_marks.key(source, side), path)


def _free_name(source: MeshObject) -> str:
    taken = {curve.name for curve in source.authalic_landmark_curves}
    number = len(source.authalic_landmark_curves) + 1
    while f"Curve {number}" in taken:
        number += 1
    return f"Curve {number}"


_PROPERTIES: Any = bpy.types.Object


def register() -> None:
    bpy.utils.register_class(AUTHALIC_PG_landmark_curve)
    _PROPERTIES.authalic_landmark_curves = CollectionProperty(
        type=AUTHALIC_PG_landmark_curve,
        name="Landmark Curves",
        description="Pairs of paths along edges, here and on the target",
    )
    _PROPERTIES.authalic_landmark_curve_index = IntProperty(
        name="Active Curve", description="The pair of curves that is selected in the list", min=0
    )
    # Names the attributes with the marks of this object's curves on both meshes.
    _PROPERTIES.authalic_curve_key = StringProperty(options={"HIDDEN"})


def unregister() -> None:
    del _PROPERTIES.authalic_curve_key
    del _PROPERTIES.authalic_landmark_curve_index
    del _PROPERTIES.authalic_landmark_curves
    bpy.utils.unregister_class(AUTHALIC_PG_landmark_curve)
