# SPDX-License-Identifier: MIT OR Apache-2.0
"""Figures of a UV layout or of a map onto a sphere, from the coordinates in the mesh alone.

They are computed in plain numpy, independently of the native module that made the maps.
"""

from dataclasses import dataclass

import numpy as np


@dataclass
class Layout:
    """A mesh's triangles in space and their images: in the UV plane or on a sphere about the origin.

    corners (m, 3, 3); uv (m, 3, 2 or 3); polygon (m,), the polygon of each triangle.
    """

    corners: np.ndarray
    uv: np.ndarray
    polygon: np.ndarray


def layout_of(mesh):
    """Reads the triangles of a Blender mesh with its active UV layer."""
    loops, vertices, polygon = _triangles(mesh)
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers.active.uv.foreach_get("vector", uv)
    return Layout(positions(mesh)[vertices], uv.reshape(-1, 2).astype(float)[loops], polygon)


def surface(mesh):
    """The coordinates (n, 3) and triangles (m, 3) of a Blender mesh."""
    return positions(mesh), _triangles(mesh)[1]


def sphere_of(mesh, key):
    """Reads the triangles of a Blender mesh and their images by a shape key whose points lie on a sphere."""
    _, vertices, polygon = _triangles(mesh)
    image = points_of(mesh, key)
    image -= _center_of_sphere(image)
    return Layout(positions(mesh)[vertices], image[vertices], polygon)


def positions(mesh):
    """The coordinates (n, 3) of a Blender mesh, those of its first shape key if it has any."""
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", points)
    return points.reshape(-1, 3).astype(float)


def points_of(mesh, key):
    """The coordinates (n, 3) of a Blender mesh's shape key."""
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.shape_keys.key_blocks[key].points.foreach_get("co", points)
    return points.reshape(-1, 3).astype(float)


def areas(layout):
    """The area of each triangle in space and the signed area of its image.

    On the sphere the sign is positive if a face is seen counter-clockwise from outside.
    """
    surface = np.linalg.norm(np.cross(*_sides(layout.corners)), axis=1) / 2
    u, v = _sides(layout.uv)
    if layout.uv.shape[2] == 2:
        return surface, (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    normal = np.cross(u, v)
    outward = np.sign(np.einsum("ij,ij->i", normal, layout.uv[:, 0]))
    return surface, outward * np.linalg.norm(normal, axis=1) / 2


def area_ratio(layout):
    """Share of the UV area over share of the surface area, per triangle."""
    surface, signed = areas(layout)
    image = np.abs(signed)
    return (image / max(image.sum(), 1e-300)) / np.maximum(surface / surface.sum(), 1e-300)


def polygon_log2_ratio(layout, polygons):
    """log2 of the area ratio of each polygon (its triangles taken together)."""
    surface, signed = areas(layout)
    share = np.bincount(layout.polygon, np.abs(signed), polygons) / max(np.abs(signed).sum(), 1e-300)
    fair = np.bincount(layout.polygon, surface, polygons) / surface.sum()
    return np.log2(np.maximum(share, 1e-12 * fair.max()) / np.maximum(fair, 1e-300))


def stretch(layout):
    """sigma1 / sigma2 of each triangle's map from the surface to its image: 1 preserves angles."""
    a, b = _sides(layout.corners)
    length = np.maximum(np.linalg.norm(a, axis=1), 1e-300)
    along = np.einsum("ij,ij->i", a, b) / length
    across = np.maximum(2 * areas(layout)[0] / length, 1e-300)
    u, v = _sides(layout.uv)
    first = u / length[:, None]
    second = (v - along[:, None] * first) / across[:, None]
    singular = np.linalg.svd(np.stack([first, second], axis=2), compute_uv=False)
    return singular[:, 0] / np.maximum(singular[:, 1], 1e-12 * singular[:, 0].max() + 1e-300)


def summary(layout):
    """The figures of the report."""
    ratio, angle = area_ratio(layout), stretch(layout)
    return {
        "triangles": len(layout.uv),
        "area_ratio_mean": float(ratio.mean()),
        "area_ratio_std": float(ratio.std()),
        "flipped_triangles": int((areas(layout)[1] <= 0).sum()),
        "angle_distortion_mean": float(angle.mean()),
        "angle_distortion_median": float(np.median(angle)),
    }


def _sides(triangles):
    return triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]


def _triangles(mesh):
    """The corners (m, 3) of a mesh's triangles, their vertices (m, 3) and the triangles' polygons (m,)."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    loops, polygon = np.empty(3 * count, np.int32), np.empty(count, np.int32)
    mesh.loop_triangles.foreach_get("loops", loops)
    mesh.loop_triangles.foreach_get("polygon_index", polygon)
    vertex = np.empty(len(mesh.loops), np.int32)
    mesh.attributes[".corner_vert"].data.foreach_get("value", vertex)
    loops = loops.reshape(-1, 3)
    return loops, vertex[loops], polygon


def _center_of_sphere(points):
    """Least squares: |p|² = 2 c·p + r² − |c|² for all points p of a sphere about c."""
    matrix = np.column_stack([2 * points, np.ones(len(points))])
    return np.linalg.lstsq(matrix, (points**2).sum(axis=1), rcond=None)[0][:3]
