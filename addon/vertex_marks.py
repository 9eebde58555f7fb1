# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices that can be found again after a mesh was edited: numbers in an integer attribute of its points.

Deleting a vertex renumbers those behind it, but their attributes go with them. A mark is a random number:
what Blender mixes of marks when it subdivides or merges is then not taken for another one, and no two meshes
agree by chance. Duplicating or extruding a vertex copies its mark; the vertex is then no longer certain.
"""

import random

import bmesh
import numpy as np

NAME = "authalic_landmark"
_random = random.SystemRandom()
# What was found last: session id of a mesh -> (counts of its elements, marks).
_seen = {}


def put(mesh, vertex):
    """The mark of a vertex, which gets one if it has none that is its own."""
    (old,) = _values(mesh, [vertex])
    if old > 0 and len(find(mesh).get(old, ())) == 1:
        return old
    mark = _random.randrange(1, 2**31)
    _write(mesh, [vertex], mark)
    return mark


def clear(mesh, mark):
    """Takes a mark off all vertices that have it."""
    _write(mesh, find(mesh).get(mark, ()), 0)


def find(mesh, *, wanted=None):
    """The vertices, a list of numbers, for each mark on a mesh.

    With `wanted`, some marks, what was found before is taken for true unless one of these is not where it
    was or the mesh has more or fewer elements: fast enough for drawing.
    """
    counts, found = _seen.get(mesh.session_uid, (None, {}))
    if wanted is None or counts != element_counts(mesh) or not _holds(mesh, found, wanted):
        found = _in_edit(bmesh.from_edit_mesh(mesh)) if mesh.is_editmode else _in_arrays(mesh)
        _seen[mesh.session_uid] = element_counts(mesh), found
    return found


def element_counts(mesh):
    """The numbers of vertices, edges and faces of a mesh, in edit mode too."""
    if not mesh.is_editmode:
        return len(mesh.vertices), len(mesh.edges), len(mesh.polygons)
    edit = bmesh.from_edit_mesh(mesh)
    return len(edit.verts), len(edit.edges), len(edit.faces)


def vertex_count(mesh):
    """The number of vertices, in edit mode too."""
    return element_counts(mesh)[0]


def _in_arrays(mesh):
    attribute = _attribute(mesh)
    if attribute is None:
        return {}
    values = np.empty(len(attribute.data), np.int32)
    attribute.data.foreach_get("value", values)
    vertices = np.flatnonzero(values)
    return _grouped(zip(values[vertices].tolist(), vertices.tolist(), strict=True))


def _in_edit(edit):
    layer = edit.verts.layers.int.get(NAME)
    if layer is None:
        return {}
    return _grouped((vertex[layer], number) for number, vertex in enumerate(edit.verts) if vertex[layer])


def _grouped(marked):
    found = {}
    for mark, vertex in marked:
        found.setdefault(mark, []).append(vertex)
    return found


def _holds(mesh, found, wanted):
    """Whether the wanted marks are there, and on the vertices where they were found."""
    if any(mark not in found for mark in wanted):
        return False
    placed = [(mark, vertex) for mark in wanted for vertex in found[mark]]
    return _values(mesh, [vertex for _, vertex in placed]) == [mark for mark, _ in placed]


def _values(mesh, vertices):
    """What some vertices have for a mark, 0 for none."""
    if not mesh.is_editmode:
        attribute = _attribute(mesh)
        return [attribute.data[vertex].value if attribute else 0 for vertex in vertices]
    edit = bmesh.from_edit_mesh(mesh)
    layer = edit.verts.layers.int.get(NAME)
    edit.verts.ensure_lookup_table()
    return [edit.verts[vertex][layer] if layer else 0 for vertex in vertices]


def _write(mesh, vertices, value):
    if not len(vertices):
        return
    _seen.pop(mesh.session_uid, None)
    if not mesh.is_editmode:
        # Not element by element: that could write into the array which the undo step shares.
        attribute = _attribute(mesh) or _new_attribute(mesh)
        values = np.empty(len(attribute.data), np.int32)
        attribute.data.foreach_get("value", values)
        values[vertices] = value
        attribute.data.foreach_set("value", values)
        mesh.update()
        return
    edit = bmesh.from_edit_mesh(mesh)
    layer = edit.verts.layers.int.get(NAME) or edit.verts.layers.int.new(NAME)
    edit.verts.ensure_lookup_table()
    for vertex in vertices:
        edit.verts[vertex][layer] = value
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def _attribute(mesh):
    attribute = mesh.attributes.get(NAME)
    kind = (attribute.domain, attribute.data_type) if attribute is not None else None
    return attribute if kind == ("POINT", "INT") else None


def _new_attribute(mesh):
    if NAME in mesh.attributes:  # of another kind, which marks nothing
        mesh.attributes.remove(mesh.attributes[NAME])
    return mesh.attributes.new(NAME, "INT", "POINT")
