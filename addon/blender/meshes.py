# SPDX-License-Identifier: GPL-3.0-or-later
"""Between Blender's meshes and numpy arrays, in object mode and, without leaving it, in edit mode."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bmesh
import bpy
import numpy as np
from numpy.typing import DTypeLike, NDArray

from ..surfaces import triangulation
from ..surfaces.arrays import Booleans, Floats, Integers, Singles
from ..surfaces.surface import Surface
from . import selection, subdivision, uv_maps
from .types import MeshObject

# The attribute that marks seams: of Blender 4.5 and newer, and of older versions.
_SEAM = ("uv_seam", ".uv_seam")


def read(
    obj: MeshObject,
    *,
    selected_only: bool = False,
    uv_layer: str | None = None,
    uv_selection: bool = False,
    world: bool = False,
    subdivided: bool = False,
) -> Surface:
    """The surface of an object; with `selected_only` that of its selected, visible faces.

    With `uv_selection` faces must be selected in the UV map too. The surface has the size of the object in
    the world, and with `world` its shape there, turned back and never mirrored: all lengths and areas are
    those in the world, all directions those of the mesh. With `subdivided` vertices and areas are those of
    the Subdivision Surface modifier, if there is one.
    """
    with readable(obj.data) as mesh:
        surface = _of_mesh(mesh, obj.name, selected_only, uv_layer, uv_selection)
        shape = _shape(surface, obj, world)
        smooth = subdivision.smoothed(obj, mesh, shape) if subdivided else None
    if smooth is None:
        _scale(surface, shape)
    else:
        surface.positions, areas = smooth
        surface.density = _densities(surface, areas)
    return surface


def read_from(obj: MeshObject, mesh: bpy.types.Mesh, uv_layer: str) -> Surface:
    """The surface in the world of an object by a mesh not in edit mode, as modifiers may have made it."""
    surface = _of_mesh(mesh, obj.name, False, uv_layer)
    _scale(surface, _shape(surface, obj, True))
    return surface


def points(mesh: bpy.types.Mesh) -> Singles:
    """The positions (n, 3) of the vertices of a mesh that is not in edit mode."""
    return _attribute(mesh, "position", np.float32, 3)


def hidden(mesh: bpy.types.Mesh) -> Booleans:
    """Which polygons (p,) of a mesh are hidden."""
    values = np.empty(len(mesh.polygons), bool)
    mesh.polygons.foreach_get("hide", values)
    return values


def has_faces(obj: MeshObject) -> bool:
    """Whether an object's mesh had faces when edit mode was last left."""
    return len(obj.data.polygons) > 0


def has_corners(obj: MeshObject, count: int) -> bool:
    """Whether an object still exists and its mesh has this number of corners."""
    try:
        mesh = obj.data
    except ReferenceError:
        return False
    if mesh.is_editmode:
        return sum(len(face.loops) for face in bmesh.from_edit_mesh(mesh).faces) == count
    return len(mesh.loops) == count


def write_face_attribute(mesh: bpy.types.Mesh, name: str, values: Floats, polygons: Integers) -> None:
    """Writes values (p,) at polygons (k,) into the face attribute `name`, replacing one of another kind."""
    attribute: Any = mesh.attributes.get(name)
    if attribute is not None and (attribute.domain, attribute.data_type) != ("FACE", "FLOAT"):
        mesh.attributes.remove(attribute)
        attribute = None
    attribute = attribute or mesh.attributes.new(name, "FLOAT", "FACE")
    if not mesh.is_editmode:
        written = np.empty(len(mesh.polygons), np.float32)
        attribute.data.foreach_get("value", written)
        written[polygons] = values[polygons]
        attribute.data.foreach_set("value", written)
        mesh.update()
        return
    edit = bmesh.from_edit_mesh(mesh)
    edit.faces.ensure_lookup_table()
    layer = edit.faces.layers.float[name]
    chosen = np.unique(polygons)
    for polygon, value in zip(chosen.tolist(), values[chosen].tolist(), strict=True):
        edit.faces[polygon][layer] = value
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def has_uniform_scale(obj: MeshObject) -> bool:
    """Whether the object's scale in the world is the same, up to mirroring, in all directions."""
    return _is_uniform(_scales(obj)[0])


def _of_mesh(
    mesh: bpy.types.Mesh, name: str, selected_only: bool, uv_layer: str | None, uv_selection: bool = False
) -> Surface:
    """The surface of a mesh in its own coordinates."""
    polygons = _polygons(mesh)
    corner_vertex = _attribute(mesh, ".corner_vert", np.int32)
    corners, owner = _loop_triangles(mesh, polygons)
    chosen = _selected(mesh) if selected_only else np.ones(len(mesh.polygons), bool)
    if uv_selection and uv_layer is not None:
        chosen &= selection.uv_faces(mesh, uv_layer, polygons[0])
    if not chosen.all():
        corners, owner = corners[chosen[owner]], owner[chosen[owner]]
    surface = Surface(
        name=name,
        positions=points(mesh).astype(float),
        triangles=corner_vertex[corners],
        corners=corners,
        polygons=owner,
        seams=_seams(mesh, np.repeat(chosen, polygons[1])),
        corner_vertex=corner_vertex,
        polygon_start=polygons[0],
        polygon_size=polygons[1],
    )
    if uv_layer is not None and uv_layer in mesh.uv_layers:
        surface.uv = uv_maps.read(mesh, uv_layer)
        pins = _attribute(mesh, f".pn.{uv_layer}", bool)
        surface.pinned = pins if len(pins) else None
    return surface


def _shape(surface: Surface, obj: MeshObject, world: bool) -> float | Floats:
    """What gives a surface the size of its object in the world, and if `world` its shape there.

    A factor of its points, or a matrix (3, 3).
    """
    scale, axes = _scales(obj)
    if _is_uniform(scale):
        return float(scale.mean()) or 1.0
    return (axes.T * scale) @ axes if world else _world_size(obj, surface)


def _scale(surface: Surface, shape: float | Floats) -> None:
    if isinstance(shape, float):
        surface.positions *= shape
    else:
        with np.errstate(invalid="ignore"):
            surface.positions = surface.positions @ shape


def _densities(surface: Surface, areas: Floats) -> Floats:
    """The density (p,) by which polygons have the areas (p,) of a finer surface."""
    triangles = triangulation.areas(surface.positions[surface.triangles])
    own = np.bincount(surface.polygons, triangles, surface.polygon_count)
    density: Floats = np.divide(areas, own, out=np.ones(len(own)), where=(own > 0) & (areas > 0))
    return density


@contextmanager
def readable(mesh: bpy.types.Mesh) -> Iterator[bpy.types.Mesh]:
    """The mesh; in edit mode, where its arrays are empty, a temporary copy of what is being edited."""
    if not mesh.is_editmode:
        yield mesh
        return
    copy = bpy.data.meshes.new(".authalic")
    try:
        bmesh.from_edit_mesh(mesh).to_mesh(copy)
        yield copy
    finally:
        bpy.data.meshes.remove(copy)


def _attribute(mesh: bpy.types.Mesh, name: str, dtype: DTypeLike, width: int = 1) -> NDArray[Any]:
    """The values of an attribute, (n,) or (n, width); none where the mesh has no such attribute."""
    attribute: Any = mesh.attributes.get(name)
    if attribute is None:  # an empty mesh lacks even its positions
        return np.empty((0, width) if width > 1 else 0, dtype)
    values = np.empty(len(attribute.data) * width, dtype)
    attribute.data.foreach_get("vector" if attribute.data_type == "FLOAT_VECTOR" else "value", values)
    return values if width == 1 else values.reshape(-1, width)


def _polygons(mesh: bpy.types.Mesh) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """The first corner and the number of corners of each polygon; one polygon's corners follow another's."""
    start = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_start", start)
    return start, np.diff(start, append=np.int32(len(mesh.loops)))


def _selected(mesh: bpy.types.Mesh) -> Booleans:
    selected, hidden = np.empty((2, len(mesh.polygons)), bool)
    mesh.polygons.foreach_get("select", selected)
    mesh.polygons.foreach_get("hide", hidden)
    return selected & ~hidden


def _loop_triangles(
    mesh: bpy.types.Mesh, polygons: tuple[NDArray[np.int32], NDArray[np.int32]]
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """The corners (t, 3) and the polygon (t,) of each triangle, as Blender itself divides its polygons."""
    start, size = polygons
    if (size == 3).all():
        corners = np.add(start[:, None], np.arange(3), dtype=np.int32)
        return corners, np.arange(len(start), dtype=np.int32)
    mesh.calc_loop_triangles()
    values = np.empty(3 * len(mesh.loop_triangles), np.int32)
    owner = np.empty(len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("loops", values)
    mesh.loop_triangle_polygons.foreach_get("value", owner)
    return values.reshape(-1, 3), owner


def _seams(mesh: bpy.types.Mesh, corner_chosen: Booleans) -> Integers:
    """The seams, as pairs of vertices, among the edges of the chosen corners' faces."""
    name = next((name for name in _SEAM if name in mesh.attributes), None)
    seam = np.empty(0, np.int32) if name is None else np.flatnonzero(_attribute(mesh, name, bool))
    if len(seam):
        used = np.zeros(len(mesh.edges), bool)
        used[_attribute(mesh, ".corner_edge", np.int32)[corner_chosen]] = True
        seam = seam[used[seam]]
    ends: Integers = _attribute(mesh, ".edge_verts", np.int32, 2)[seam]
    return ends


def _scales(obj: MeshObject) -> tuple[Floats, Floats]:
    """How much an object's matrix scales (3,), and the axes (3, 3) of the mesh along which it does so."""
    matrix = np.array(obj.matrix_world, float)[:3, :3]
    if not np.isfinite(matrix).all():
        return np.ones(3), np.eye(3)
    _, scale, axes = np.linalg.svd(matrix)
    return scale, axes


def _is_uniform(scale: Floats) -> bool:
    return bool(scale.max() - scale.min() <= 1e-4 * scale.max())


def _world_size(obj: MeshObject, surface: Surface) -> float:
    """The size of an object in the world over that of its mesh: the root of the ratio of their areas."""
    points = surface.positions[surface.triangles]
    matrix = np.array(obj.matrix_world)[:3, :3]
    local, world = _total_area(points), _total_area(points @ matrix.T)
    ratio = np.sqrt(world / local) if local > 0 else 1.0
    return float(ratio) if np.isfinite(ratio) and ratio > 0 else 1.0


def _total_area(triangles: Floats) -> float:
    a, b = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    return np.nansum(np.linalg.norm(np.cross(a, b), axis=1))
