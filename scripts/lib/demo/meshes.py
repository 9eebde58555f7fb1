# SPDX-License-Identifier: MIT OR Apache-2.0
"""The meshes of the demo: built in Blender or read from files by Blender's own importers."""

import heapq
import math
from pathlib import Path

import bmesh
import bpy
import numpy as np
from mathutils import Matrix

READERS = {
    ".obj": lambda path: bpy.ops.wm.obj_import(filepath=path),
    ".ply": lambda path: bpy.ops.wm.ply_import(filepath=path),
    ".stl": lambda path: bpy.ops.wm.stl_import(filepath=path),
}
EXTENT, HEIGHT, DIAGONAL = 2.35, 2.1, 3.46
"""The most that a mesh may measure in the scene: along an axis, upwards, and across its bounding box."""


def suzanne():
    """Blender's monkey, subdivided twice, with seams where the UV map that it comes with has them."""
    bpy.ops.mesh.primitive_monkey_add()
    shape = bpy.context.object
    shape.modifiers.new("Subdivision", "SUBSURF").levels = 2
    bpy.ops.object.modifier_apply(modifier="Subdivision")
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.select_all(action="SELECT")
    bpy.ops.uv.seams_from_islands()
    bpy.ops.object.mode_set(mode="OBJECT")
    return _prepared(shape, "Suzanne")


def cut_sphere():
    """A UV sphere with a seam along one meridian, from pole to pole."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32)
    shape = bpy.context.object
    mesh = shape.data
    for edge in mesh.edges:
        ends = [mesh.vertices[index].co for index in edge.vertices]
        edge.use_seam = all(abs(end.x) < 1e-6 and end.y > -1e-6 for end in ends)
    return _prepared(shape, "Sphere, one seam")


def closed_suzanne():
    """Blender's monkey as one closed surface, all of quads: eyes and head are joined by a remesh."""
    bpy.ops.mesh.primitive_monkey_add()
    shape = bpy.context.object
    shape.modifiers.new("Subdivision", "SUBSURF").levels = 2
    bpy.ops.object.modifier_apply(modifier="Subdivision")
    shape.data.remesh_voxel_size, shape.data.remesh_voxel_adaptivity = 0.035, 0.0
    bpy.ops.object.voxel_remesh()
    smooth = shape.modifiers.new("Smooth", "SMOOTH")  # takes away the steps of the voxels
    smooth.factor, smooth.iterations = 0.5, 4
    bpy.ops.object.modifier_apply(modifier="Smooth")
    return without_seams(_prepared(shape, "Suzanne, closed"))


def without_seams(shape):
    """Takes the seams off an object that is to become a sphere, and makes that fit into a cell."""
    mesh = shape.data
    for edge in mesh.edges:
        edge.use_seam = False
    area = sum(polygon.area for polygon in mesh.polygons)
    diameter = math.sqrt(area / math.pi)
    mesh.transform(Matrix.Scale(min(1.0, HEIGHT / diameter), 4))
    return shape


def is_sphere(mesh):
    """Whether a mesh is one closed surface without handles: manifold, with Euler characteristic 2."""
    work = bmesh.new()
    work.from_mesh(mesh)
    loose = any(not vertex.link_faces for vertex in work.verts)
    manifold = all(part.is_manifold for part in (*work.edges, *work.verts))
    euler = len(work.verts) - len(work.edges) + len(work.faces)
    found = not loose and manifold and len(_pieces(work)) == 1 and euler == 2
    work.free()
    return found


def from_file(name):
    """The objects of a mesh file, joined; closed pieces without seams are cut (see `open_up`)."""
    path = Path(name)
    if path.suffix.lower() not in READERS:
        raise SystemExit(f"{name}: the demo reads {', '.join(READERS)} files")
    if not path.is_file():
        raise SystemExit(f"{name}: there is no such file")
    bpy.ops.object.select_all(action="DESELECT")
    READERS[path.suffix.lower()](str(path))
    found = [shape for shape in bpy.context.selected_objects if shape.type == "MESH" and shape.data.polygons]
    if not found:
        raise SystemExit(f"{name}: Blender's importer found no faces in it")
    bpy.context.view_layer.objects.active = found[0]
    if len(found) > 1:
        bpy.ops.object.join()
    return _opened(_prepared(bpy.context.object, path.stem))


def copy_of(source, name):
    """A copy of an object with a mesh of its own, in the scene."""
    shape = source.copy()
    shape.data = source.data.copy()
    shape.name = name
    bpy.context.scene.collection.objects.link(shape)
    return shape


def open_up(mesh):
    """Marks a seam on each closed piece that has none: a shortest path between two far ends of it.

    Returns how many pieces were cut. No method makes sense of a closed surface without a cut.
    """
    work = bmesh.new()
    work.from_mesh(mesh)
    closed = [
        piece
        for piece in _pieces(work)
        if not any(e.is_boundary or e.seam for v in piece for e in v.link_edges)
    ]
    for piece in closed:
        start = max(_paths_from(piece[0])[0].items(), key=lambda item: item[1])[0]
        lengths, arrived_by = _paths_from(start)
        vertex = max(lengths.items(), key=lambda item: item[1])[0]
        while vertex is not start:
            arrived_by[vertex].seam = True
            vertex = arrived_by[vertex].other_vert(vertex)
    work.to_mesh(mesh)
    work.free()
    return len(closed)


def _prepared(shape, name):
    shape.name = shape.data.name = name
    mesh = shape.data
    mesh.transform(shape.matrix_world)
    shape.matrix_world = Matrix.Identity(4)
    while mesh.uv_layers:
        mesh.uv_layers.remove(mesh.uv_layers[0])
    mesh.uv_layers.new(name="UVMap")
    mesh.materials.clear()
    mesh.shade_smooth()
    _centre(mesh)
    return shape


def _opened(shape):
    cuts = open_up(shape.data)
    if cuts:
        print(
            f"  {shape.name}: {cuts} closed piece(s) without a seam, for the comparison cut along a shortest "
            "path between far ends"
        )
    return shape


def _centre(mesh):
    corners = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", corners)
    low, high = corners.reshape(-1, 3).min(axis=0), corners.reshape(-1, 3).max(axis=0)
    size = high - low
    excess = size.max() / EXTENT, size[2] / HEIGHT, np.linalg.norm(size) / DIAGONAL
    scale = 1 / max(*map(float, excess), 1e-30)
    mesh.transform(Matrix.Scale(scale, 4) @ Matrix.Translation(tuple(-(low + high) / 2)))


def _has_open_edge(vertex):
    return any(edge.is_boundary or edge.seam for edge in vertex.link_edges)


def _pieces(work):
    seen, pieces = set(), []
    for first in work.verts:
        if first in seen or not first.link_faces:
            continue
        seen.add(first)
        piece = [first]
        for vertex in piece:  # grows while it is walked
            fresh = [other for edge in vertex.link_edges if (other := edge.other_vert(vertex)) not in seen]
            seen.update(fresh)
            piece += fresh
        pieces.append(piece)
    return pieces


def _paths_from(start):
    """Dijkstra: the length of the shortest path to each vertex, and the edge by which it arrives."""
    lengths, arrived_by = {start: 0.0}, {}
    queue = [(0.0, start.index, start)]
    while queue:
        length, _, vertex = heapq.heappop(queue)
        if length > lengths[vertex]:
            continue
        for edge in vertex.link_edges:
            other, further = edge.other_vert(vertex), length + edge.calc_length()
            if further < lengths.get(other, math.inf):
                lengths[other], arrived_by[other] = further, edge
                heapq.heappush(queue, (further, other.index, other))
    return lengths, arrived_by
