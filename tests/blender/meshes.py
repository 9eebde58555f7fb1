# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes for the tests, and measurements of them with numpy alone."""

from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Any

import bmesh
import bpy
import numpy as np
from numpy.typing import ArrayLike, NDArray

MeshObject = bpy.types.Object
Array = NDArray[Any]
Surface = tuple[Array, Array]
"""Vertices and faces."""


def add(
    vertices: ArrayLike,
    faces: Iterable[Iterable[int]] | Array,
    name: str = "Mesh",
    seams: Collection[Sequence[int]] = (),
) -> MeshObject:
    """A new selected, active object."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(map(float, v)) for v in vertices], [], [list(map(int, f)) for f in faces])
    mesh.update(calc_edges=True)
    wanted = {tuple(sorted(seam)) for seam in seams}
    edge: Any
    for edge in mesh.edges:
        edge.use_seam = tuple(sorted(edge.vertices)) in wanted
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(obj)
    select(obj)
    return obj


def select(*objects: MeshObject) -> None:
    """Selects exactly these objects; the first becomes active."""
    bpy.ops.object.select_all(action="DESELECT")
    for obj in objects:
        obj.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def grid(n: int = 6, bump: float = 0.6, offset: Sequence[float] = (0, 0, 0)) -> Surface:
    """Vertices and quads of a square with a bump in the middle."""
    side = np.linspace(-1, 1, n + 1)
    x, y = (a.ravel() for a in np.meshgrid(side, side))
    vertices = np.stack([x, y, bump * np.exp(-4 * (x * x + y * y))], axis=1) + offset
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    return vertices, np.stack([first, first + 1, first + n + 2, first + n + 1], axis=1)


def add_grid(name: str = "Grid", **options: Any) -> MeshObject:
    return add(*grid(**options), name)


def suzanne(levels: int = 2) -> MeshObject:
    bpy.ops.mesh.primitive_monkey_add()
    return subdivided(bpy.context.object, levels)


def seam_sphere() -> MeshObject:
    """A UV sphere, cut open along a meridian from pole to pole."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    obj = bpy.context.object
    position = np.array([vertex.co for vertex in obj.data.vertices])
    meridian = (np.abs(position[:, 1]) < 1e-5) & (position[:, 0] > -1e-5)
    for edge in obj.data.edges:
        edge.use_seam = all(meridian[vertex] for vertex in edge.vertices)
    return obj


def icosphere(subdivisions: int = 4, radius: float = 1.0) -> MeshObject:
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=subdivisions, radius=radius)
    return bpy.context.object


def uv_sphere(segments: int = 32, ring_count: int = 16) -> MeshObject:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=ring_count)
    return bpy.context.object


def cube_sphere(levels: int = 3) -> MeshObject:
    """A cube of quads, subdivided to nearly a sphere."""
    bpy.ops.mesh.primitive_cube_add()
    return subdivided(bpy.context.object, levels)


def subdivided(obj: MeshObject, levels: int) -> MeshObject:
    if levels:
        modifier = obj.modifiers.new("Subdivision", "SUBSURF")
        modifier.levels = levels
        bpy.ops.object.modifier_apply(modifier=modifier.name)
    return obj


def closed_suzanne(levels: int = 1) -> MeshObject:
    """Suzanne's head without her eyes, their sockets closed by n-gons."""
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    mesh = bmesh.new()
    mesh.from_mesh(obj.data)
    head = max(mesh.verts, key=lambda vertex: abs(vertex.co.x))  # the tip of an ear
    reached, border = {head}, [head]
    while border:
        border = [edge.other_vert(vertex) for vertex in border for edge in vertex.link_edges]
        border = list(set(border) - reached)
        reached.update(border)
    bmesh.ops.delete(mesh, geom=[vertex for vertex in mesh.verts if vertex not in reached], context="VERTS")
    bmesh.ops.holes_fill(mesh, edges=[edge for edge in mesh.edges if edge.is_boundary])
    mesh.to_mesh(obj.data)
    mesh.free()
    return subdivided(obj, levels)


def remove(obj: MeshObject, vertices: Sequence[int]) -> None:
    """Deletes some vertices of an object, with their faces."""
    mesh = bmesh.new()
    mesh.from_mesh(obj.data)
    mesh.verts.ensure_lookup_table()
    bmesh.ops.delete(mesh, geom=[mesh.verts[vertex] for vertex in vertices], context="VERTS")
    mesh.to_mesh(obj.data)
    mesh.free()


def bumpy(obj: MeshObject, size: float = 0.3) -> MeshObject:
    """The object with smooth bumps all over."""
    position = np.array([vertex.co for vertex in obj.data.vertices])
    waves = np.sin(3 * position[:, 0]) * np.cos(4 * position[:, 1] + 1) + np.sin(5 * position[:, 2])
    position *= 1 + size * waves[:, None]
    obj.data.vertices.foreach_set("co", position.astype(np.float32).ravel())
    obj.data.update()
    return obj


def torus() -> MeshObject:
    bpy.ops.mesh.primitive_torus_add(major_segments=12, minor_segments=8)
    return bpy.context.object


def join(*objects: MeshObject) -> MeshObject:
    select(*objects)
    bpy.ops.object.join()
    return bpy.context.object


def edit(*objects: MeshObject) -> None:
    select(*objects)
    bpy.ops.object.mode_set(mode="EDIT")


def select_faces(obj: MeshObject, chosen: Callable[[int], bool], hidden: Collection[int] = ()) -> None:
    """Selects the faces in edit mode for which `chosen(index)` holds, hiding those in `hidden`."""
    mesh = bmesh.from_edit_mesh(obj.data)
    for vertex in mesh.verts:
        vertex.select = False
    for item in (*mesh.edges, *mesh.faces):
        item.select = False
    for face in mesh.faces:
        if face.index in hidden:
            face.hide_set(True)
        elif chosen(face.index):
            face.select_set(True)
    bmesh.update_edit_mesh(obj.data)


def uv(obj: MeshObject, layer: str | None = None) -> Array:
    """The UVs (c, 2) float32 of a layer, by default the active one, in object mode or edit mode."""
    if obj.data.is_editmode:
        obj.update_from_editmode()
        mesh = bmesh.from_edit_mesh(obj.data)
        loops = mesh.loops.layers.uv[layer or obj.data.uv_layers.active.name]
        return np.array([loop[loops].uv for face in mesh.faces for loop in face.loops], np.float32)
    data = (obj.data.uv_layers[layer] if layer else obj.data.uv_layers.active).data
    return np.array([item.uv for item in data], np.float32)


def set_uv(obj: MeshObject, values: Array, layer: str | None = None) -> None:
    data = (obj.data.uv_layers[layer] if layer else obj.data.uv_layers.active).data
    data.foreach_set("uv", np.ascontiguousarray(values, np.float32).ravel())


def triangles(obj: MeshObject) -> tuple[Array, Array, Array]:
    """Corners (t, 3), polygons (t,) and world positions (t, 3, 3) of the loop triangles; object mode."""
    obj.data.calc_loop_triangles()
    corners = np.array([tuple(triangle.loops) for triangle in obj.data.loop_triangles])
    polygons = np.array([triangle.polygon_index for triangle in obj.data.loop_triangles])
    vertices = np.array([tuple(triangle.vertices) for triangle in obj.data.loop_triangles])
    positions = np.array([tuple(obj.matrix_world @ vertex.co) for vertex in obj.data.vertices])
    return corners, polygons, positions[vertices]


def surface_areas(points: Array) -> Array:
    return np.linalg.norm(np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]), axis=1) / 2


def uv_areas(image: Array) -> Array:
    """Signed areas (t,) of triangles (t, 3, 2), by the shoelace formula."""
    x, y = image[..., 0].astype(float), image[..., 1].astype(float)
    return (x * (np.roll(y, -1, axis=1) - np.roll(y, 1, axis=1))).sum(axis=1) / 2


def area_ratios(obj: MeshObject, layer: str | None = None) -> Array:
    """UV area over surface area (t,), scaled so that both sums agree; negative for a flip."""
    corners, _, points = triangles(obj)
    image, area = uv_areas(uv(obj, layer)[corners]), surface_areas(points)
    return image / area * (area.sum() / np.abs(image).sum())


def coverage(triangles: Array, resolution: int) -> Array:
    """In how many triangles each pixel center of the unit square strictly lies, (resolution, resolution)."""
    count = np.zeros((resolution, resolution), int)
    for triangle in triangles * resolution - 0.5:
        low, high = np.ceil(triangle.min(axis=0)).astype(int), np.floor(triangle.max(axis=0)).astype(int)
        x, y = np.meshgrid(np.arange(low[0], high[0] + 1), np.arange(low[1], high[1] + 1))
        inside = np.ones(x.shape, bool)
        for (ax, ay), (bx, by) in zip(triangle, np.roll(triangle, -1, axis=0), strict=True):
            inside &= (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0
        count[y[inside], x[inside]] += 1
    return count


def islands(obj: MeshObject, layer: str | None = None) -> Array:
    """The UV island number of each triangle; triangles that share a UV at a vertex have one number."""
    corners, _, _ = triangles(obj)
    vertices = np.array([loop.vertex_index for loop in obj.data.loops])
    key = np.column_stack([vertices, uv(obj, layer).view(np.int32)])
    points = np.unique(key, axis=0, return_inverse=True)[1].reshape(-1)[corners]
    label = np.arange(points.max() + 1)
    while True:
        lowest = label[points].min(axis=1)
        new = label.copy()
        np.minimum.at(new, points.ravel(), np.repeat(lowest, 3))
        if (new == label).all():
            return np.unique(lowest, return_inverse=True)[1].reshape(-1)
        label = new


def densities(*objects: MeshObject) -> Array:
    """UV area over world area of every island of all objects."""
    ratios = []
    for obj in objects:
        corners, _, points = triangles(obj)
        image, area, label = uv_areas(uv(obj)[corners]), surface_areas(points), islands(obj)
        ratios += list(np.bincount(label, image) / np.bincount(label, area))
    return np.array(ratios)


def tetrahedron(center: Sequence[float] = (0, 0, 0)) -> Surface:
    vertices = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) + center
    return vertices, np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])


def moebius(n: int = 12, offset: Sequence[float] = (0, 0, 0)) -> Surface:
    """A one-sided strip of quads."""
    angle = np.repeat(np.arange(n) * 2 * np.pi / n, 2)
    width = np.tile([-0.3, 0.3], n)
    radius = 1 + width * np.cos(angle / 2)
    vertices = np.stack([radius * np.cos(angle), radius * np.sin(angle), width * np.sin(angle / 2)], axis=1)
    faces = [[2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1] for i in range(n - 1)]
    return vertices + offset, np.array([*faces, [2 * n - 2, 1, 0, 2 * n - 1]])


def ring(offset: Sequence[float] = (0, 0, 0), n: int = 4) -> Surface:
    """A closed ring of n x n quads, a torus."""
    angle = np.arange(n) * 2 * np.pi / n
    around, across = (a.ravel() for a in np.meshgrid(angle, angle, indexing="ij"))
    radius = 1 + 0.4 * np.cos(across)
    vertices = np.stack([radius * np.cos(around), radius * np.sin(around), 0.4 * np.sin(across)], axis=1)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    further, inner = (i + 1) % n, (j + 1) % n
    return vertices + offset, np.stack(
        [n * i + j, n * further + j, n * further + inner, n * i + inner], axis=1
    )


def together(*parts: tuple[Array, Any]) -> tuple[Array, list[list[int]]]:
    """Several (vertices, faces) as one surface; faces stay lists, so that they may differ in size."""
    vertices, faces, start = [], [], 0
    for points, polygons in parts:
        vertices += [tuple(point) for point in points]
        faces += [[int(v) + start for v in polygon] for polygon in polygons]
        start += len(points)
    return np.array(vertices), faces


def tube(rings: int, around: int, closed: bool = True, step: float = 0.8) -> tuple[Array, list[list[int]]]:
    """A long tube of quads, open at its first ring; at its last one closed by a fan, or open too."""
    angle = 2 * np.pi * np.arange(around) / around
    height = np.repeat(step * np.arange(rings), around)
    vertices = np.column_stack([np.tile(np.cos(angle), rings), np.tile(np.sin(angle), rings), height])
    side = [(j, (j + 1) % around) for j in range(around)]
    faces = [
        [around * i + a, around * i + b, around * (i + 1) + b, around * (i + 1) + a]
        for i in range(rings - 1)
        for a, b in side
    ]
    if closed:
        last = around * (rings - 1)
        faces += [[last + a, last + b, len(vertices)] for a, b in side]
        vertices = np.concatenate([vertices, [(0, 0, step * rings)]])
    return vertices, faces
