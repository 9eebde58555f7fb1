# SPDX-License-Identifier: MIT OR Apache-2.0
"""The models, loaded inside Blender (bpy): its primitives, Suzanne, and the files of a folder."""

from pathlib import Path

import bpy

READERS = {
    ".obj": lambda path: bpy.ops.wm.obj_import(filepath=str(path)),
    ".glb": lambda path: bpy.ops.import_scene.gltf(filepath=str(path)),
}
PRIMITIVES = {
    "plane": lambda: bpy.ops.mesh.primitive_plane_add(),
    "grid": lambda: bpy.ops.mesh.primitive_grid_add(x_subdivisions=100, y_subdivisions=10),
    "circle": lambda: bpy.ops.mesh.primitive_circle_add(fill_type="NGON"),
    "cube": lambda: bpy.ops.mesh.primitive_cube_add(),
    "cylinder": lambda: bpy.ops.mesh.primitive_cylinder_add(),
    "cone": lambda: bpy.ops.mesh.primitive_cone_add(),
    "cone frustum": lambda: bpy.ops.mesh.primitive_cone_add(radius2=0.4),
    "UV sphere": lambda: bpy.ops.mesh.primitive_uv_sphere_add(),
    "icosphere": lambda: bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3),
    "torus": lambda: bpy.ops.mesh.primitive_torus_add(),
    "Suzanne": lambda: bpy.ops.mesh.primitive_monkey_add(),
}
SUBDIVIDED = "Suzanne ×2"


def names(folder):
    """The names of all models: those that Blender makes, and the files of a folder, which may be None."""
    files = sorted(path.stem for path in Path(folder).iterdir() if path.suffix in READERS) if folder else []
    return [*PRIMITIVES, SUBDIVIDED, *files]


def load(name, folder):
    """The object of a model, alone in the scene, with the borders of its own UV islands as seams."""
    bpy.ops.wm.read_homefile(use_empty=True)
    if name in PRIMITIVES:
        PRIMITIVES[name]()
        shape = bpy.context.object
    elif name == SUBDIVIDED:
        bpy.ops.mesh.primitive_monkey_add()
        shape = bpy.context.object
        shape.modifiers.new("Subdivision", "SUBSURF").levels = 2
        bpy.ops.object.modifier_apply(modifier="Subdivision")
    else:
        shape = _imported(next(path for path in Path(folder).iterdir() if path.stem == name))
    _mark_seams(shape)
    return shape


def _imported(path):
    """The largest mesh of a file."""
    READERS[path.suffix](path)
    shapes = [shape for shape in bpy.context.scene.objects if shape.type == "MESH"]
    return max(shapes, key=lambda shape: len(shape.data.polygons))


def _mark_seams(shape):
    """Seams along the borders of the islands of an object's UV map, if it has one."""
    open_in_edit_mode(shape)
    bpy.ops.mesh.select_all(action="SELECT")
    if shape.data.uv_layers:
        bpy.ops.uv.select_all(action="SELECT")
        bpy.ops.uv.seams_from_islands()
    bpy.ops.object.mode_set(mode="OBJECT")


def open_in_edit_mode(shape):
    """Selects an object alone and opens it in Edit Mode."""
    bpy.ops.object.select_all(action="DESELECT")
    shape.select_set(True)
    bpy.context.view_layer.objects.active = shape
    bpy.ops.object.mode_set(mode="EDIT")
