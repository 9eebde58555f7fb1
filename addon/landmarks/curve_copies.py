# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of a source object: they list the same curves under the same key until one of them changes.

A copy that changes gets a new key, and its paths get marks under the new key. In edit mode a copy keeps the
old key: undo would take back the marks there but not the key, which is a part of the object.
"""

import uuid
from collections.abc import Iterator

import bpy

from ..blender import editability
from ..blender.types import LandmarkCurve, MeshObject, mesh_objects
from . import curve_marks
from .objects import SIDES, side_object


def ensure_key(source: MeshObject) -> None:
    """Gives a source a key if it has none."""
    source.authalic_curve_key = source.authalic_curve_key or _new_key()


def others(source: MeshObject, side: str) -> Iterator[tuple[MeshObject, LandmarkCurve]]:
    """(object, curve) of copies of the source with the same mesh on a side: these share paths with it."""
    obj, key = side_object(source, side), source.authalic_curve_key
    for copy in mesh_objects():
        if key and obj is not None and copy != source and copy.authalic_curve_key == key:
            copy_object = side_object(copy, side)
            if copy_object is not None and copy_object.data == obj.data:
                yield from ((copy, curve) for curve in copy.authalic_landmark_curves)


def sharing(source: MeshObject, curve: LandmarkCurve, side: str) -> MeshObject | None:
    """An object that has a path of the source's curve too, or None."""
    return next((copy for copy, copy_curve in others(source, side) if copy_curve.mark == curve.mark), None)


def can_part(source: MeshObject) -> bool:
    """Whether a source can get a new key now."""
    objects = [side_object(source, side) for side in SIDES]
    return all(_is_free(obj.data) for obj in objects if obj is not None and obj.type == "MESH")


def part(source: MeshObject) -> None:
    """Gives a source that shares paths with copies a new key, if possible."""
    if not can_part(source) or not any(True for side in SIDES for _ in others(source, side)):
        return
    before, source.authalic_curve_key = source.authalic_curve_key, _new_key()
    marks = {curve.mark for curve in source.authalic_landmark_curves}
    for side in SIDES:
        obj = side_object(source, side)
        if obj is not None and obj.type == "MESH":
            curve_marks.copy(obj.data, f"{side}_{before}", curve_marks.key(source, side), marks)
    tidy(before, but=source)


def tidy(key: str, but: MeshObject | None = None) -> None:
    """Removes marks of a key that no object lists from all meshes; not while a mesh of that key is edited."""
    users = [obj for obj in mesh_objects() if obj.authalic_curve_key == key and obj != but]
    if not key or not all(can_part(user) for user in users):
        return
    listed = {curve.mark for user in users for curve in user.authalic_landmark_curves}
    # A copy that has gone its own way needs nothing of this key on its mesh.
    parted = but.data if but is not None and all(user.data != but.data for user in users) else None
    for mesh in bpy.data.meshes:
        if _is_free(mesh):
            for side in SIDES:
                is_left = mesh == parted and side == "source"
                curve_marks.keep(mesh, f"{side}_{key}", set() if is_left else listed)


def _is_free(mesh: bpy.types.Mesh) -> bool:
    return editability.is_writable(mesh) and not mesh.is_editmode


def _new_key() -> str:
    return uuid.uuid4().hex[:8]
