# SPDX-License-Identifier: GPL-3.0-or-later
"""Types of Blender's data with the properties that the extension adds; the type checker alone knows these."""

from typing import TYPE_CHECKING, Any, TypeGuard, TypeVar

import bpy

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    Entry = TypeVar("Entry")

    class EntryList(bpy.types.bpy_prop_collection[Entry]):
        """A list that the extension keeps on objects."""

        def add(self) -> Entry: ...
        def remove(self, index: int) -> None: ...
        def move(self, index: int, to: int) -> None: ...

    class Landmark(bpy.types.PropertyGroup):
        """A pair of landmark points as it is saved."""

        source_vertex: int
        target_vertex: int
        source_mark: int
        target_mark: int
        waiting: int
        is_soft: bool
        weight: float
        error: float

    class LandmarkCurve(bpy.types.PropertyGroup):
        """A pair of landmark curves as it is saved."""

        mark: int
        error: float

    class Registration(bpy.types.PropertyGroup):
        """The settings of the last registration as they are saved; `method` is "" if there was none."""

        method: str
        feature: str

    class Wrap(bpy.types.PropertyGroup):
        """The options of the next registration as they are saved."""

        method: str
        energy: str

    class MeshObject(bpy.types.Object):
        """An object of type "MESH"."""

        data: bpy.types.Mesh
        authalic_target: "MeshObject | None"
        authalic_landmarks: EntryList[Landmark]
        authalic_landmark_index: int
        authalic_landmark_curves: EntryList[LandmarkCurve]
        authalic_landmark_curve_index: int
        authalic_curve_key: str
        authalic_registration: Registration
        authalic_registered_by: str
        authalic_wrap: Wrap
        authalic_home: Any
        authalic_beside: Any
        authalic_mask: str

    Status = set[OperatorReturnItems]
    OperatorMixin = bpy.types.Operator
    PanelMixin = bpy.types.Panel
else:
    MeshObject, Landmark, LandmarkCurve = bpy.types.Object, bpy.types.PropertyGroup, bpy.types.PropertyGroup
    Status, OperatorMixin, PanelMixin = set, object, object


def owner_of(entry: "Landmark | LandmarkCurve") -> MeshObject:
    """The object that a list entry is kept on."""
    owner: MeshObject = entry.id_data  # type: ignore[assignment]
    return owner


def mesh_objects() -> list[MeshObject]:
    """All mesh objects of the file."""
    return [obj for obj in bpy.data.objects if is_mesh(obj)]


def is_mesh(obj: "bpy.types.Object | None") -> TypeGuard[MeshObject]:
    """Whether it is an object of type "MESH"."""
    return obj is not None and obj.type == "MESH"
