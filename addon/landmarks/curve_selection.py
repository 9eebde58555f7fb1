# SPDX-License-Identifier: GPL-3.0-or-later
"""The path of selected edges in edit mode, and which end it starts at; and the selection of a path."""

import bmesh
import numpy as np
from mathutils import Vector

from .. import messages
from . import paths
from .points import CannotPair

_WHAT = "select the edges of one open path or of one closed loop"


def path(obj):
    """The path along the selected edges of an object, from the end that is nearer to the active element.

    Returns also whether that says where it starts. None where no edge is selected in edit mode. Raises
    `CannotPair` where the edges are no single path.
    """
    if not obj.data.is_editmode:
        return None
    edit = bmesh.from_edit_mesh(obj.data)
    edit.verts.index_update()
    edges = [
        tuple(vertex.index for vertex in edge.verts) for edge in edit.edges if edge.select and not edge.hide
    ]
    if not edges:
        return None
    try:
        found = paths.ordered(edges)
    except paths.NoPath as problem:
        count = messages.count(len(edges), "selected edge")
        raise CannotPair(f"The {count} of {obj.name} {problem}; {_WHAT}") from None
    return _from_active(found, edit.select_history.active)


def like(obj, found, other_obj, other):
    """An open path of an object in the direction that a path of another one has in the world."""
    if paths.is_closed(found) or paths.is_closed(other):
        return found
    chords = [_chord(*part) for part in ((obj, found), (other_obj, other))]
    return found[::-1] if chords[0] @ chords[1] < 0 else found


def select(obj, edges):
    """Selects edges (pairs of vertices) and nothing else of a mesh."""
    mesh, wanted = obj.data, {frozenset(edge) for edge in edges}
    if mesh.is_editmode:
        _select_edited(mesh, edges)
        return
    for elements in (mesh.polygons, mesh.edges, mesh.vertices):
        elements.foreach_set("select", [False] * len(elements))
    for edge in mesh.edges:
        edge.select = frozenset(edge.vertices) in wanted
    for vertex in {vertex for edge in edges for vertex in edge}:
        mesh.vertices[vertex].select = True


def _from_active(found, active):
    """The path from the end that is nearer to the active vertex or edge, and whether there is such an end."""
    chosen = active.verts if isinstance(active, bmesh.types.BMEdge) else [active]
    near = [one.index for one in chosen if isinstance(one, bmesh.types.BMVert) and one.index in found]
    if not near:
        return found, False
    if paths.is_closed(found):
        return paths.started(found, near[0]), True
    middle = sum(found.index(vertex) for vertex in near) / len(near)
    if 2 * middle == len(found) - 1:
        return found, False
    return (found[::-1] if 2 * middle > len(found) - 1 else found), True


def _chord(obj, found):
    """From the start to the end in the world."""
    mesh = obj.data
    if mesh.is_editmode:
        vertices = bmesh.from_edit_mesh(mesh).verts
        vertices.ensure_lookup_table()
    else:
        vertices = mesh.vertices
    ends = [np.array(obj.matrix_world @ Vector(vertices[vertex].co)) for vertex in (found[0], found[-1])]
    return ends[1] - ends[0]


def _select_edited(mesh, edges):
    edit = bmesh.from_edit_mesh(mesh)
    for elements in (edit.verts, edit.edges, edit.faces):
        for one in elements:
            one.select = False
    edit.verts.ensure_lookup_table()
    for first, second in edges:
        edge = edit.edges.get((edit.verts[first], edit.verts[second]))
        edge.hide_set(False)
        edge.select_set(True)
    edit.select_history.clear()
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
