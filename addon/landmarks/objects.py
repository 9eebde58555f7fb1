# SPDX-License-Identifier: GPL-3.0-or-later
"""The two objects of landmarks: the source, which keeps them, and its target."""

import bpy

from ..blender import editability
from ..blender.element_marks import element_counts
from ..blender.types import MeshObject, is_mesh

NONE = -1
SIDES = ("source", "target")


class CannotPair(Exception):
    """Says why landmarks cannot be changed; they are as before."""


def active_source(context: bpy.types.Context) -> MeshObject | None:
    """The object whose landmarks are meant: the active object, or the selected object whose target it is."""
    active: MeshObject | None = context.object  # type: ignore[assignment]
    if not is_mesh(active) or active.authalic_target is not None:
        return active
    chosen = {*context.selected_objects, *(getattr(context, "objects_in_mode", None) or ())}
    aiming = [obj for obj in chosen if is_mesh(obj) and obj.authalic_target == active]
    return aiming[0] if len(aiming) == 1 else active


def sources(context: bpy.types.Context) -> list[MeshObject]:
    """The object whose landmarks are meant first, then all selected objects with the same target.

    Or, where the active object has no target, those whose target it is. Of objects that share a mesh, one.
    """
    source = active_source(context)
    if source is None or not is_mesh(source):
        return []
    target = source.authalic_target or source
    aiming = [obj for obj in context.selected_objects if is_mesh(obj) and obj.authalic_target == target]
    if source.authalic_target is None and not aiming:
        return [source]
    found = [*([source] if source.authalic_target else []), *aiming]
    return list({obj.data: obj for obj in reversed(found)}.values())[::-1]


def target_problem(source: MeshObject) -> str | None:
    """Why a source object has no target to work with, or None."""
    target = source.authalic_target
    if target is None:
        return "there is no target object; choose one"
    if target == source or target.type != "MESH":
        return f"{target.name} cannot be the target; choose another mesh object"
    if not target.users_scene:
        return f"the target object {target.name} was deleted; choose another one"
    return None


def side_object(source: MeshObject, side: str) -> MeshObject | None:
    """The object of the "source" or the "target" side, or None."""
    return source if side == "source" else source.authalic_target


def pairing_problem(source: MeshObject) -> str | None:
    """Why no pairs can be added to a source object, with the name of the object at fault, or None."""
    target, problem = source.authalic_target, target_problem(source)
    if problem or target is None:
        return f"{source.name}: {problem}"
    if reason := editability.why_not_object(source):
        return f"{source.name}: {reason}"
    unwritable = [(obj, editability.why_not_mesh(obj)) for obj in (source, target)]
    return next((f"{obj.name}: {reason}" for obj, reason in unwritable if reason), None)


def check_target(source: MeshObject) -> None:
    """Raises `CannotPair` unless pairs can be added to a source object."""
    if problem := pairing_problem(source):
        raise CannotPair(problem)


def check_lists(source: MeshObject) -> None:
    """Raises `CannotPair` unless the lists of a source object can be changed."""
    if reason := editability.why_not_object(source):
        raise CannotPair(f"{source.name}: {reason}")


def check_vertex(obj: MeshObject, vertex: int) -> None:
    """Raises `CannotPair` unless an object has a vertex."""
    count = element_counts(obj.data)[0]
    if not 0 <= vertex < count:
        raise CannotPair(f"{obj.name} has no vertex {vertex}; its {count} vertices are 0 to {count - 1}")
