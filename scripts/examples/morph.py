# SPDX-License-Identifier: MIT OR Apache-2.0
"""Morphs one head into another without a window: landmarks, registration, key frames, rendered frames.

    .venv/bpy-5/bin/python scripts/examples/morph.py --extension dist/authalic-<version>-<platform>.zip
    .venv/bpy-5/bin/python scripts/examples/morph.py a.obj b.ply landmarks.json --output out/heads --frames 48

Without files it makes two heads. Files of meshes may be .obj, .ply, .stl, or .npz with the arrays V and F.
The file of landmarks is one that the extension exports (panel Wrap and Morph, authalic.landmark_export):

    {"format": "authalic-landmarks", "version": 1, "pairs": [{"name": "Nose", "source": 12, "target": 345}],
     "curves": [{"name": "Mouth", "source": [3, 4, 9], "target": [7, 8, 12]}]}

With --method curves the landmark curves, paths along edges, are matched instead of the points.

The script needs Blender as the Python package `bpy` (`scripts/build` makes .venv/bpy-5; in an application run
`blender --background --python morph.py -- OPTIONS`) and the extension, either in the profile that Blender
uses or as a zip, which --extension installs into a temporary profile. It installs nothing else.
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path

import numpy as np

EXTENSION = "bl_ext.user_default.authalic"
LANDMARKS = {  # directions from the middle of a made head: x to its left, -y to the front, z up
    "Nose": (0, -1, -0.08),
    "Brow": (0, -1, 0.3),
    "Chin": (0, -0.85, -0.75),
    "Left Eye": (0.38, -1, 0.2),
    "Right Eye": (-0.38, -1, 0.2),
    "Left Mouth": (0.3, -1, -0.42),
    "Right Mouth": (-0.3, -1, -0.42),
    "Left Ear": (1, 0.1, 0.05),
    "Right Ear": (-1, 0.1, 0.05),
    "Crown": (0, 0.1, 1),
    "Back": (0, 1, 0),
    "Below": (0, 0.15, -1),
}
CURVES = {  # from landmark to landmark, along the shortest way
    "Mouth": ("Left Mouth", "Right Mouth"),
    "Nose": ("Brow", "Nose"),
    "Back": ("Crown", "Back"),
    "Jaw": ("Chin", "Below"),
}


def main(options):
    """Makes or reads the meshes, registers them, and renders the morph."""
    start_blender(options)
    if options.meshes:
        source, target = (read_mesh(path) for path in options.meshes)
    else:
        source, target = make_heads()
    choose(source, target, options.landmarks)
    if options.method == "curves" and not options.landmarks:
        add_curves(source, target)
    key = morph(source, target, options)
    target.hide_render = True
    set_stage(source, key, options)
    render(options)
    print(f"{options.frames} frames are in {options.output}")


def start_blender(options):
    """Opens an empty file and enables the extension, or explains what is missing."""
    bpy.ops.wm.read_homefile(use_empty=True)
    if options.extension:
        bpy.ops.extensions.package_install_files(
            filepath=str(options.extension), repo="user_default", enable_on_install=True
        )
    elif EXTENSION not in bpy.context.preferences.addons:
        try:
            bpy.ops.preferences.addon_enable(module=EXTENSION)
        except RuntimeError as problem:
            print(problem)
    if not hasattr(bpy.types, "AUTHALIC_OT_register"):
        raise SystemExit(
            "Authalic is not installed in this Blender's profile. Build it with scripts/build and name the "
            "zip, --extension dist/authalic-<version>-<platform>.zip, or install that as in README.md."
        )


def read_mesh(path):
    """The object of a mesh file."""
    if path.suffix == ".npz":
        with np.load(path) as arrays:
            return add_mesh(path.stem, arrays["V"], arrays["F"])
    readers = {".obj": bpy.ops.wm.obj_import, ".ply": bpy.ops.wm.ply_import, ".stl": bpy.ops.wm.stl_import}
    if path.suffix not in readers:
        raise SystemExit(f"{path}: only {', '.join(readers)} and .npz files are read")
    readers[path.suffix](filepath=str(path))
    return bpy.context.object


def add_mesh(name, vertices, faces):
    """A new object with smooth faces."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(vertices, float).tolist(), [], np.asarray(faces).tolist())
    mesh.shade_smooth()
    shape = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(shape)
    return shape


def make_heads():
    """A round head of triangles and a long one of quads, the second beside the first, with landmarks."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6)
    first = shaped(bpy.context.object, "Round Head", (0.95, 1.0, 1.05), nose=0.2, ears=0.2, chin=0.05)
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.object.modifiers.new("Subdivision", "SUBSURF").levels = 6
    bpy.ops.object.modifier_apply(modifier="Subdivision")
    second = shaped(bpy.context.object, "Long Head", (0.72, 0.9, 1.3), nose=0.42, ears=0.4, chin=0.3)
    second.location.x = 3
    return first, second


def shaped(shape, name, radii, nose, ears, chin):
    """Gives a sphere the form of a head, with features of these sizes."""
    mesh = shape.data
    shape.name, mesh.name = name, name
    points = positions(mesh)
    sphere = points / np.linalg.norm(points, axis=1)[:, None]
    bump = {feature: _bump(sphere, direction, 0.16) for feature, direction in LANDMARKS.items()}
    height = 1 + nose * bump["Nose"] + 0.5 * nose * _bump(sphere, (0, -1, 0.08), 0.12)
    height += chin * _bump(sphere, LANDMARKS["Chin"], 0.35)
    height += ears * sum(_bump(sphere, LANDMARKS[f"{side} Ear"], 0.14) for side in ("Left", "Right"))
    height -= 0.1 * (bump["Left Eye"] + bump["Right Eye"])
    lips = [(x, -1, -0.42 + 0.3 * x * x) for x in np.linspace(-0.3, 0.3, 7)]
    height -= 0.035 * sum(_bump(sphere, spot, 0.09) for spot in lips)
    mesh.attributes["position"].data.foreach_set(
        "vector", np.ascontiguousarray(sphere * height[:, None] * radii, np.float32).ravel()
    )
    mesh.shade_smooth()
    mesh.update()
    shape["landmarks"] = [int(np.argmax(sphere @ _unit(d))) for d in LANDMARKS.values()]
    return shape


def choose(source, target, landmarks):
    """Makes the source active, and gives it its target and its landmarks, from a file or of made heads."""
    bpy.ops.object.select_all(action="DESELECT")
    source.select_set(True)
    bpy.context.view_layer.objects.active = source
    source.authalic_target = target
    if landmarks:
        bpy.ops.authalic.landmark_import(filepath=str(landmarks))
        return
    for name, first, second in zip(LANDMARKS, source["landmarks"], target["landmarks"], strict=True):
        bpy.ops.authalic.landmark_add(name=name, source_vertex=first, target_vertex=second)


def add_curves(source, target):
    """Adds landmark curves between the landmarks of made heads, selected as by hand in Edit Mode."""
    source.select_set(True)
    target.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    for name, ends in CURVES.items():
        bpy.ops.mesh.select_all(action="DESELECT")
        for shape in (source, target):
            select_vertices(shape, [shape["landmarks"][list(LANDMARKS).index(end)] for end in ends])
        bpy.ops.mesh.shortest_path_select()
        bpy.ops.authalic.landmark_curve_add(name=name)
    bpy.ops.object.mode_set(mode="OBJECT")


def select_vertices(shape, chosen):
    """Selects vertices in edit mode; the first becomes the active one, at which a curve starts."""
    edit = bmesh.from_edit_mesh(shape.data)
    edit.verts.ensure_lookup_table()
    edit.select_history.clear()
    for vertex in reversed(chosen):
        edit.verts[vertex].select_set(True)
        edit.select_history.add(edit.verts[vertex])
    bmesh.update_edit_mesh(shape.data)


def morph(source, target, options):
    """Registers and key-frames; returns the name of the shape key."""
    bpy.ops.authalic.register(
        method=options.method.upper(),
        align=options.align,
        energy=options.energy.upper(),
        animate=True,
        frame_start=1,
        frame_end=options.frames,
    )
    return f"Morph → {target.name}"


def set_stage(shape, key, options):
    """A camera that sees the morph from its beginning to its end, two lights, and a plain material."""
    scene = bpy.context.scene
    ends = np.concatenate([positions(shape.data), positions(shape.data, key)])
    ends = ends @ np.array(shape.matrix_world)[:3, :3].T + np.array(shape.matrix_world)[:3, 3]
    middle, size = (
        Vector((ends.min(axis=0) + ends.max(axis=0)) / 2),
        float(np.linalg.norm(np.ptp(ends, axis=0))),
    )
    to_camera = Vector(options.view).normalized()
    turn = (-to_camera).to_track_quat("-Z", "Y")
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 0.75 * size
    camera.data.clip_end = 10 * size
    camera.location, camera.rotation_euler = middle + 3 * size * to_camera, turn.to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera
    for sideways, strength in ((-40, 3.0), (50, 0.9)):
        light = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        light.data.energy = strength
        spin = Euler((np.radians(-35), np.radians(sideways), 0)).to_quaternion()
        light.rotation_euler = (turn @ spin).to_euler()
        scene.collection.objects.link(light)
    scene.world = bpy.data.worlds.new("World")
    material = bpy.data.materials.new("Clay")
    material.diffuse_color = (0.75, 0.55, 0.42, 1)
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.75, 0.55, 0.42, 1)
    shape.data.materials.clear()
    shape.data.materials.append(material)


def render(options):
    """Renders all frames into the folder."""
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, options.frames
    scene.render.engine = {"cycles": "CYCLES", "workbench": "BLENDER_WORKBENCH"}[options.engine]
    if options.engine == "cycles":
        scene.cycles.device, scene.cycles.samples, scene.cycles.max_bounces = "CPU", 16, 2
        scene.cycles.use_denoising = False
    scene.render.resolution_x = scene.render.resolution_y = options.size
    scene.render.image_settings.file_format = "PNG"
    options.output.mkdir(parents=True, exist_ok=True)
    scene.render.filepath = str(options.output / "morph_")
    bpy.ops.render.render(animation=True)


def positions(mesh, key=None):
    """The coordinates (n, 3) of a mesh or of one of its shape keys."""
    points = mesh.shape_keys.key_blocks[key].points if key else mesh.vertices
    values = np.empty(3 * len(points), np.float32)
    points.foreach_get("co", values)
    return values.reshape(-1, 3).astype(float)


def _unit(direction):
    return np.asarray(direction, float) / np.linalg.norm(direction)


def _bump(sphere, direction, width):
    """A smooth hill (n,) on the sphere in a direction, 1 at its top."""
    return np.exp(-((np.linalg.norm(sphere - _unit(direction), axis=1) / width) ** 2))


def chosen_options():
    """The options after the name of the script, or after "--" if Blender has options of its own."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    file = lambda name: Path(name).resolve()  # noqa: E731
    parser.add_argument("files", nargs="*", type=file, help="source, target and landmarks; or none")
    parser.add_argument("--extension", type=file, default=os.environ.get("AUTHALIC_EXTENSION_ZIP"))
    parser.add_argument("--output", type=file, default=file("out/morph"), help="folder (%(default)s)")
    parser.add_argument("--frames", type=int, default=24, help="%(default)s")
    parser.add_argument("--size", type=int, default=480, help="pixels along a side (%(default)s)")
    parser.add_argument("--engine", choices=("cycles", "workbench"), default="cycles", help="%(default)s")
    parser.add_argument(
        "--energy", choices=("surface", "area"), default="surface", help="keep shapes or areas (%(default)s)"
    )
    parser.add_argument("--method", choices=("points", "curves"), default="points", help="%(default)s")
    parser.add_argument("--no-align", dest="align", action="store_false", help="end where the target is")
    parser.add_argument(
        "--view",
        type=float,
        nargs=3,
        default=(-0.45, -1, 0.15),
        help="direction from the middle to the camera",
    )
    words = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    options = parser.parse_args(words)
    if len(options.files) not in (0, 3):
        parser.error("name a source, a target and a file of landmarks, or nothing")
    if options.frames < 2:
        parser.error("a morph has at least 2 frames")
    for path in [*options.files, *([options.extension] if options.extension else [])]:
        if not Path(path).is_file():
            parser.error(f"{path}: there is no such file")
    options.meshes, options.landmarks = options.files[:2], next(iter(options.files[2:]), None)
    return options


if __name__ == "__main__":
    chosen = chosen_options()
    if chosen.extension and "BLENDER_USER_RESOURCES" not in os.environ:
        os.environ["BLENDER_USER_RESOURCES"] = tempfile.mkdtemp(prefix="authalic-profile-")

import bpy  # noqa: E402, I001 (the profile is chosen first, and `bmesh` is there after `bpy`)
import bmesh  # noqa: E402
from mathutils import Euler, Vector  # noqa: E402

if __name__ == "__main__":
    status = 1
    try:
        main(chosen)
        status = 0
    except (SystemExit, RuntimeError) as problem:  # bpy passes on an operator's report so
        print(problem)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # some versions hang at a normal exit
