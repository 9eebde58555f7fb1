# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole numbers that mark vertices or edges of a mesh, in an integer attribute that edits carry along.

A mark is a random number. Where Blender subdivides or merges, it mixes marks; the result is then no mark of
another element. And no two meshes have the same mark by chance.
"""

import random
from collections.abc import Sequence
from typing import Any, Literal

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

_random = random.SystemRandom()


def new(bits: int = 31) -> int:
    """A new mark. Marks of 24 bits are exact in single precision, in which some edits mix them."""
    return _random.randrange(1, 2**bits)


def element_counts(mesh: bpy.types.Mesh) -> tuple[int, int, int]:
    """The numbers of vertices, edges and faces of a mesh, in edit mode too."""
    if not mesh.is_editmode:
        return len(mesh.vertices), len(mesh.edges), len(mesh.polygons)
    edit = bmesh.from_edit_mesh(mesh)
    return len(edit.verts), len(edit.edges), len(edit.faces)


def hold(mesh: bpy.types.Mesh) -> bmesh.types.BMesh | None:
    """A reference to keep while a mesh in edit mode is read piece by piece.

    When Python drops its last reference, Blender frees the tables of all elements and builds them anew for
    the next access.
    """
    return bmesh.from_edit_mesh(mesh) if mesh.is_editmode else None


class Marks:
    """The marks in the attribute of a name, on the vertices ("POINT") or the edges ("EDGE") of meshes."""

    def __init__(self, name: str, domain: Literal["POINT", "EDGE"]) -> None:
        self.name, self.domain = name, domain

    def is_on(self, mesh: bpy.types.Mesh) -> bool:
        """Whether a mesh has an attribute of the name."""
        return self.name in mesh.attributes

    def all(self, mesh: bpy.types.Mesh) -> dict[int, int]:
        """{element: mark} of all marked elements, in the order of the elements."""
        if mesh.is_editmode:
            elements, layer = self._edited(mesh)
            if layer is None:
                return {}
            return {number: element[layer] for number, element in enumerate(elements) if element[layer]}
        attribute = self._attribute(mesh)
        if attribute is None:
            return {}
        values = _values(attribute)
        marked = np.flatnonzero(values)
        return dict(zip(marked.tolist(), values[marked].tolist(), strict=True))

    def of(self, mesh: bpy.types.Mesh, elements: Sequence[int]) -> list[int]:
        """The marks of some elements, 0 where there is none."""
        if not mesh.is_editmode:
            attribute = self._attribute(mesh)
            return [attribute.data[element].value if attribute else 0 for element in elements]
        edited, layer = self._edited(mesh)
        edited.ensure_lookup_table()
        return [edited[element][layer] if layer else 0 for element in elements]

    def write(self, mesh: bpy.types.Mesh, elements: Sequence[int], mark: int) -> None:
        """Gives some elements a mark; 0 removes theirs."""
        if not len(elements):
            return
        if not mesh.is_editmode:
            # Not element by element: that could write into the array which the undo step shares.
            attribute = self._attribute(mesh) or self._new_attribute(mesh)
            values = _values(attribute)
            values[elements] = mark
            attribute.data.foreach_set("value", values)
            mesh.update()
            return
        edited, layer = self._edited(mesh)
        if layer is None:
            edited.layers.int.new(self.name)
            edited, layer = self._edited(mesh)
        edited.ensure_lookup_table()
        for element in elements:
            edited[element][layer] = mark
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)

    def drop(self, mesh: bpy.types.Mesh) -> None:
        """Removes the attribute from a mesh."""
        if mesh.is_editmode:
            elements, layer = self._edited(mesh)
            if layer is not None:
                elements.layers.int.remove(layer)
        elif self._attribute(mesh) is not None:
            mesh.attributes.remove(self._attribute(mesh))

    def _edited(self, mesh: bpy.types.Mesh) -> tuple[Any, Any]:
        """The elements of a mesh in edit mode, and their layer or None."""
        edit = bmesh.from_edit_mesh(mesh)
        elements = edit.verts if self.domain == "POINT" else edit.edges
        return elements, elements.layers.int.get(self.name)

    def _attribute(self, mesh: bpy.types.Mesh) -> Any:
        attribute: Any = mesh.attributes.get(self.name)
        kind = (attribute.domain, attribute.data_type) if attribute is not None else None
        return attribute if kind == (self.domain, "INT") else None

    def _new_attribute(self, mesh: bpy.types.Mesh) -> Any:
        if self.name in mesh.attributes:  # of another kind, which marks nothing
            mesh.attributes.remove(mesh.attributes[self.name])
        return mesh.attributes.new(self.name, "INT", self.domain)


def _values(attribute: Any) -> NDArray[np.int32]:
    values = np.empty(len(attribute.data), np.int32)
    attribute.data.foreach_get("value", values)
    return values
