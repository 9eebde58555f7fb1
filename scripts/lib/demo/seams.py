# SPDX-License-Identifier: MIT OR Apache-2.0
"""The demo's automatic seams: a closed statue and a frame of genus 3, each unwrapped by one call.

Runs inside Blender, after the comparison; leaves the scene "Seams". Each mesh is seen from the front and
from the back, with its seams, beside its UV layout in the unit square. The colors of the checker change over
the square, so that each place of the layout is found again on the mesh.
"""

import math

import bpy
import numpy as np

from demo import measure, meshes, stage

TARGET = 1.25
"""The wanted mean of σ₁/σ₂."""
VIEWS = {"front": -0.6, "back": -0.6 + math.pi}
"""Turns about the vertical axis."""
COARSER = 1.3
"""The squares are larger by this than in the comparison."""
SQUARE = 2.2
"""The side of the unit square on the wall."""
SEAM, BORDER = (0.70, 0.02, 0.01), (0.25, 0.25, 0.25)
SEAM_RADIUS, OUTLINE_RADIUS, BORDER_RADIUS = 0.012, 0.008, 0.005
FIGURES = ("islands", "length", "shear", "shear_p99", "packed", "status")
PIXELS_PER_CELL, SAMPLES = 400, 12


def show():
    """Unwraps both meshes and puts them on a wall; returns the entries of the report."""
    stage.new_scene("Seams")
    checker = stage.checker_material("UVMap")
    stage.color_by_place(checker)
    rows = (meshes.spot(), _off_the_face), (meshes.frame(), lambda mesh: None)
    entries = [_row(row, shape, weights, checker) for row, (shape, weights) in enumerate(rows)]
    for column, heading in enumerate((*VIEWS, "UV layout")):
        stage.label(heading, column, -0.555, 0.17)
    stage.light_and_camera((-0.55, len(VIEWS) + 0.5), (-0.68, 1.62), PIXELS_PER_CELL)
    return entries


def _row(row, shape, weights, checker):
    """Unwraps a mesh, shows it with its layout, and returns its entry in the report."""
    unwrapped = _unwrapped(shape.data, weights)
    print(f"  {shape.name:<18} {unwrapped}", flush=True)
    corners = unwrapped.uv[unwrapped.faces]
    shape.data.uv_layers.active.uv.foreach_set("vector", corners.astype(np.float32).ravel())
    layout = measure.layout_of(shape.data)
    shape["checker_scale"] = stage.checker_scale(*measure.areas(layout)) / COARSER
    _views(row, shape, unwrapped, checker)
    _layout(row, shape, unwrapped, checker)
    stage.label(_caption(shape.name, unwrapped), 1, row + 0.505, 0.135)
    entry = {"mesh": shape.name, "method": "authalic.unwrap", "seconds": round(unwrapped.seconds, 3)}
    entry |= {name: getattr(unwrapped, name) for name in FIGURES} | measure.summary(layout)
    bpy.data.objects.remove(shape)
    return entry


def _unwrapped(mesh, weights):
    """The one call."""
    import authalic  # installed with the extension, after this file is read

    return authalic.unwrap(measure.surface(mesh), target=TARGET, weights=weights(mesh))


def _off_the_face(mesh):
    """Factors of the cost of a seam at each vertex, infinite on the face of the statue."""
    normals = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertex_normals.foreach_get("vector", normals)
    depth, facing = measure.positions(mesh)[:, 1], -normals[1::3]
    return np.where((depth < np.quantile(depth, 0.25)) & (facing > 0.3), np.inf, 1.0)


def _caption(name, unwrapped):
    parts = (
        f"{name}: {len(unwrapped.faces):,} triangles",
        f"{unwrapped.islands} island{'s' if unwrapped.islands > 1 else ''}",
        f"seam length {unwrapped.length:.2f}",
        f"shear {unwrapped.shear:.2f}",
        f"area ratio SD {unwrapped.area_ratio_std:.4f}",
        f"{unwrapped.packed:.0%} of the square",
        f"{unwrapped.seconds:.1f} s",
    )
    return "     ".join(parts)


def _views(row, shape, unwrapped, checker):
    """The mesh with its seams, from all sides."""
    seams = measure.positions(shape.data)[unwrapped.edges]
    for column, (view, turn) in enumerate(VIEWS.items()):
        seen = meshes.copy_of(shape, f"{shape.name} - {view}")
        stage.place(seen, checker, column, row)
        seen.rotation_euler = (0, 0, turn)
        stage.lines(f"{seen.name} - seams", seams, SEAM_RADIUS, SEAM).parent = seen


def _layout(row, shape, unwrapped, checker):
    """The UV layout as a flat mesh, with the outlines of its islands, in the unit square."""
    points = _on_wall(unwrapped.uv)
    mesh = bpy.data.meshes.new(f"{shape.name} - layout")
    mesh.from_pydata(points.tolist(), [], unwrapped.faces.tolist())
    corners = unwrapped.uv[unwrapped.faces]
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", corners.astype(np.float32).ravel())
    flat = bpy.data.objects.new(mesh.name, mesh)
    bpy.context.scene.collection.objects.link(flat)
    flat["checker_scale"] = shape["checker_scale"]
    stage.place(flat, checker, len(VIEWS), row)
    flat.rotation_euler = (0, 0, 0)
    sides = np.sort(unwrapped.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, count = np.unique(sides, axis=0, return_counts=True)
    stage.lines(f"{flat.name} - outlines", points[edges[count == 1]], OUTLINE_RADIUS, SEAM).parent = flat
    square = _on_wall(np.array([[0, 0], [1, 0], [1, 1], [0, 1]]))
    border = np.stack([square, np.roll(square, -1, axis=0)], axis=1)
    stage.lines(f"{flat.name} - border", border, BORDER_RADIUS, BORDER).parent = flat


def _on_wall(uv):
    """Points of the unit square on the wall, about its center."""
    u, v = (SQUARE * (uv - 0.5)).T
    return np.stack([u, np.zeros(len(u)), v], axis=1)
