# SPDX-License-Identifier: MIT OR Apache-2.0
"""The meshes of the demo: built in Blender or read from files by Blender's own importers."""

import heapq
import itertools
import math
from pathlib import Path

import bmesh
import bpy
import numpy as np
from mathutils import Matrix, Vector

from shell import ROOT

SPOT = ROOT / "tests" / "data" / "sphere" / "spot_2930.npz"
READERS = {
    ".obj": lambda path: bpy.ops.wm.obj_import(filepath=path),
    ".ply": lambda path: bpy.ops.wm.ply_import(filepath=path),
    ".stl": lambda path: bpy.ops.wm.stl_import(filepath=path),
}
BAR_RADIUS = 0.26
"""The radius of the bars of the frame, whose corners lie 1 from the axis."""
EXTENT, HEIGHT, DIAGONAL = 2.35, 2.1, 3.46
"""The limits of a mesh in the scene: along any axis, in height, and across its bounding box."""


def suzanne():
    """Blender's monkey, subdivided twice, with the seams of its own UV map."""
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
    return without_seams(_prepared(_remeshed(shape, 0.035, 4), "Suzanne, closed"))


def spot():
    """The cow Spot, a closed surface of triangles, turned upright and to the eye."""
    with np.load(SPOT) as file:
        vertices, faces = file["V"][:, [0, 2, 1]] * [-1, 1, 1], file["F"]
    mesh = bpy.data.meshes.new("Spot")
    mesh.from_pydata(vertices.tolist(), [], faces.tolist())
    return _prepared(_linked(mesh), "Spot")


def frame():
    """The edges of a tetrahedron as round bars: a closed surface of genus 3."""
    base = (Vector((math.cos(angle), math.sin(angle), 0)) for angle in (math.tau * k / 3 for k in range(3)))
    corners = [Vector((0, 0, math.sqrt(2))), *base]
    work = bmesh.new()
    for corner in corners:
        bmesh.ops.create_icosphere(work, subdivisions=4, radius=BAR_RADIUS, matrix=Matrix.Translation(corner))
    for a, b in itertools.combinations(corners, 2):
        turn = Vector((0, 0, 1)).rotation_difference(b - a).to_matrix().to_4x4()
        bmesh.ops.create_cone(
            work, cap_ends=True, segments=48, radius1=BAR_RADIUS, radius2=BAR_RADIUS,
            depth=(b - a).length, matrix=Matrix.Translation((a + b) / 2) @ turn,
        )  # fmt: skip
    mesh = bpy.data.meshes.new("Frame")
    work.to_mesh(mesh)
    work.free()
    shape = _remeshed(_linked(mesh), 0.055, 8)
    shape.modifiers.new("Triangulate", "TRIANGULATE").quad_method = "SHORTEST_DIAGONAL"
    bpy.ops.object.modifier_apply(modifier="Triangulate")
    return _prepared(shape, "Frame of genus 3")


def _remeshed(shape, size, iterations):
    """One closed surface of quads around all parts of an object, by voxels whose steps are smoothed away."""
    shape.data.remesh_voxel_size, shape.data.remesh_voxel_adaptivity = size, 0.0
    bpy.ops.object.voxel_remesh()
    smooth = shape.modifiers.new("Smooth", "SMOOTH")
    smooth.factor, smooth.iterations = 0.5, iterations
    bpy.ops.object.modifier_apply(modifier="Smooth")
    return shape


def _linked(mesh):
    """An object with a mesh, in the scene and active."""
    shape = bpy.data.objects.new(mesh.name, mesh)
    bpy.context.scene.collection.objects.link(shape)
    bpy.context.view_layer.objects.active = shape
    return shape


def without_seams(shape):
    """Removes the seams of an object that is to become a sphere, and fits that sphere into a cell."""
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
    manifold = all(element.is_manifold for element in (*work.edges, *work.verts))
    euler = len(work.verts) - len(work.edges) + len(work.faces)
    is_one = not loose and manifold and len(_pieces(work)) == 1 and euler == 2
    work.free()
    return is_one


def from_file(name):
    """The joined objects of a mesh file; closed pieces without seams are cut (see `open_up`)."""
    path = Path(name)
    if path.suffix.lower() not in READERS:
        raise SystemExit(f"{name}: the demo reads {', '.join(READERS)} files")
    if not path.is_file():
        raise SystemExit(f"{name}: there is no such file")
    bpy.ops.object.select_all(action="DESELECT")
    READERS[path.suffix.lower()](str(path))
    shapes = [shape for shape in bpy.context.selected_objects if shape.type == "MESH" and shape.data.polygons]
    if not shapes:
        raise SystemExit(f"{name}: Blender's importer found no faces in it")
    bpy.context.view_layer.objects.active = shapes[0]
    if len(shapes) > 1:
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
    """Marks a seam on each closed piece that has none: a shortest path between two far ends.

    Returns the number of pieces that were cut. Blender's methods need a cut.
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
    _center(mesh)
    return shape


def _opened(shape):
    cuts = open_up(shape.data)
    if cuts:
        print(
            f"  {shape.name}: {cuts} closed piece(s) without a seam, for the comparison cut along a shortest "
            "path between far ends"
        )
    return shape


def _center(mesh):
    corners = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", corners)
    low, high = corners.reshape(-1, 3).min(axis=0), corners.reshape(-1, 3).max(axis=0)
    size = high - low
    excess = size.max() / EXTENT, size[2] / HEIGHT, np.linalg.norm(size) / DIAGONAL
    scale = 1 / max(*map(float, excess), 1e-30)
    mesh.transform(Matrix.Scale(scale, 4) @ Matrix.Translation(tuple(-(low + high) / 2)))


def _pieces(work):
    seen, pieces = set(), []
    for first in work.verts:
        if first in seen or not first.link_faces:
            continue
        seen.add(first)
        piece = [first]
        for vertex in piece:  # grows while it is walked
            neighbors = [edge.other_vert(vertex) for edge in vertex.link_edges]
            fresh = [neighbor for neighbor in neighbors if neighbor not in seen]
            seen.update(fresh)
            piece += fresh
        pieces.append(piece)
    return pieces


def _paths_from(start):
    """Dijkstra: the length of the shortest path to each vertex, and the path's last edge."""
    lengths, arrived_by = {start: 0.0}, {}
    queue = [(0.0, start.index, start)]
    while queue:
        length, _, vertex = heapq.heappop(queue)
        if length > lengths[vertex]:
            continue
        for edge in vertex.link_edges:
            neighbor, further = edge.other_vert(vertex), length + edge.calc_length()
            if further < lengths.get(neighbor, math.inf):
                lengths[neighbor], arrived_by[neighbor] = further, edge
                heapq.heappush(queue, (further, neighbor.index, neighbor))
    return lengths, arrived_by
