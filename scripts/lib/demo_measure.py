# SPDX-License-Identifier: MIT OR Apache-2.0
"""Figures of a UV layout, from the coordinates that stand in the mesh and nothing else.

They are computed here in plain numpy, independently of the native module that made the maps.
"""

from dataclasses import dataclass

import numpy as np


@dataclass
class Layout:
    """A mesh's triangles in space and in the UV plane.

    corners (m, 3, 3); uv (m, 3, 2); polygon (m,), the polygon of each triangle.
    """

    corners: np.ndarray
    uv: np.ndarray
    polygon: np.ndarray


def layout_of(mesh):
    """Reads the triangles of a Blender mesh with its active UV layer."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    loops, polygon = np.empty(3 * count, np.int32), np.empty(count, np.int32)
    mesh.loop_triangles.foreach_get("loops", loops)
    mesh.loop_triangles.foreach_get("polygon_index", polygon)
    vertex = np.empty(len(mesh.loops), np.int32)
    mesh.attributes[".corner_vert"].data.foreach_get("value", vertex)
    position = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", position)
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers.active.uv.foreach_get("vector", uv)
    corners = position.reshape(-1, 3).astype(float)[vertex[loops]]
    return Layout(
        corners.reshape(-1, 3, 3), uv.reshape(-1, 2).astype(float)[loops].reshape(-1, 3, 2), polygon
    )


def areas(layout):
    """The area of each triangle in space and its signed area in the UV plane."""
    a, b = layout.corners[:, 1] - layout.corners[:, 0], layout.corners[:, 2] - layout.corners[:, 0]
    u, v = layout.uv[:, 1] - layout.uv[:, 0], layout.uv[:, 2] - layout.uv[:, 0]
    surface = np.linalg.norm(np.cross(a, b), axis=1) / 2
    return surface, (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2


def area_ratio(layout):
    """Share of the UV area over share of the surface, per triangle; one scale for the whole mesh."""
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
    """sigma1 / sigma2 of each triangle's map from the surface to the plane: 1 keeps angles."""
    a, b = layout.corners[:, 1] - layout.corners[:, 0], layout.corners[:, 2] - layout.corners[:, 0]
    length = np.maximum(np.linalg.norm(a, axis=1), 1e-300)
    along = np.einsum("ij,ij->i", a, b) / length
    across = np.maximum(2 * areas(layout)[0] / length, 1e-300)
    u, v = layout.uv[:, 1] - layout.uv[:, 0], layout.uv[:, 2] - layout.uv[:, 0]
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
