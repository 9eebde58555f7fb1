# SPDX-License-Identifier: MIT OR Apache-2.0
"""The demo's morph of one surface into another by landmarks: five frames, each twice.

Runs inside Blender, after the comparison; leaves the scene "Registration". With the real meshes in the folder
AUTHALIC_DATA (or ../shared/data) one scanned head becomes another, else Suzanne a head that is made here.
"""

import time

import bpy
import morph as example
import numpy as np

from demo import measure, meshes, stage
from shell import DATA

FRAMES = (0.0, 0.25, 0.5, 0.75, 1.0)
ANGLE_WEIGHT = 0.632
PIXELS_PER_CELL, SAMPLES = 330, 24
LAYOUT = "Checker"
STEP = 0.95

# Names, files, and the directions up and to the front in them; vertices picked by hand on either head.
DAVID = ("David", "david_10671", (0, 0, 1), (-0.55, 0.83, 0))
MAX_PLANCK = ("Max Planck", "maxplanck_9002", (0, 1, 0), (0, 0, -1))
PICKED = {
    "Nose": (6384, 7502),
    "Bridge": (1387, 7547),
    "Right Eye Outer": (8294, 3116),
    "Right Eye Inner": (3306, 1798),
    "Left Eye Inner": (8847, 2740),
    "Left Eye Outer": (7953, 2975),
    "Right Mouth": (97, 1224),
    "Mouth": (5606, 1105),
    "Left Mouth": (4089, 7454),
    "Chin": (10046, 73),
    "Forehead": (9192, 803),
    "Right Ear": (5957, 427),
    "Left Ear": (10094, 7797),
    "Crown": (7655, 8085),
    "Back": (5243, 2084),
    "Nape": (4111, 1036),
    "Base": (8319, 8579),
}
# The places on Suzanne of a made head's landmarks: to her left and up, as parts of half her width and height,
# and the side from which they are seen.
SUZANNE = {
    "Nose": (0, -0.12, "front"),
    "Brow": (0, 0.45, "front"),
    "Chin": (0, -0.96, "front"),
    "Left Eye": (0.27, 0.22, "front"),
    "Right Eye": (-0.27, 0.22, "front"),
    "Left Mouth": (0.11, -0.78, "front"),
    "Right Mouth": (-0.11, -0.78, "front"),
    "Left Ear": (0.93, 0.25, "front"),
    "Right Ear": (-0.93, 0.25, "front"),
    "Crown": (0, 0.1, "above"),
    "Back": (0, 0.2, "behind"),
    "Below": (0, 0.1, "below"),
}
# Eyes and mouths sit otherwise on every head: exact pairs there would crumple the faces around them.
SOFT = ("Eye", "Mouth", "Chin")


def show():
    """Registers, and puts five frames on a wall, twice; returns the entry of the report."""
    stage.new_scene("Registration")
    source, target, landmarks = _real_heads() or _made_heads()
    shape, name = source, f"{source.name} into {target.name}"
    seconds, problem = _register(source, target, landmarks)
    entry = {
        "mesh": name,
        "method": "Authalic registration",
        "seconds": round(seconds, 3),
        "problem": problem,
    }
    if problem:
        stage.label("no morph: see report.json", 2, 0)
        print(f"  {name}: {problem}")
        return entry
    key = f"Morph → {target.name}"
    entry |= _figures(source, target, key)
    _wall(shape, key)
    stage.label(_caption(entry), (len(FRAMES) - 1) / 2, STEP + 0.56, 0.15)
    stage.light_and_camera((-0.62, len(FRAMES) - 0.38), (-0.75, STEP + 0.72), PIXELS_PER_CELL)
    print(f"  {name:<44} {seconds:7.2f} s   {_caption(entry)}", flush=True)
    for done in (source, target):
        bpy.data.objects.remove(done)
    return entry


def _real_heads():
    """David, Max Planck and the landmarks of both; None without the files."""
    folder = DATA / "sphere"
    if not all((folder / f"{file}.npz").is_file() for _, file, _, _ in (DAVID, MAX_PLANCK)):
        return None
    return *(_from_arrays(folder, *head) for head in (DAVID, MAX_PLANCK)), PICKED


def _from_arrays(folder, name, file, up, front):
    """A mesh that looks at the camera, as large as a cell allows."""
    with np.load(folder / f"{file}.npz") as arrays:
        vertices, faces = arrays["V"], arrays["F"]
    up, front = (np.array(axis, float) / np.linalg.norm(axis) for axis in (up, front))
    shape = example.add_mesh(name, vertices @ np.stack([np.cross(up, front), -front, up]).T, faces)
    return _fitted(shape)


def _made_heads():
    """A closed Suzanne, a head made of a sphere, and the landmarks of both."""
    source = meshes.closed_suzanne()
    source.name = "Suzanne"
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6)
    target = example.shaped(bpy.context.object, "a made head", (0.8, 0.9, 1.1), nose=0.3, ears=0.3, chin=0.2)
    points = measure.positions(source.data)
    vertices = {name: _seen(points, *place) for name, place in SUZANNE.items()}
    goals = dict(zip(example.LANDMARKS, target["landmarks"], strict=True))
    return source, _fitted(target), {name: (vertex, goals[name]) for name, vertex in vertices.items()}


def _seen(points, right, up, side):
    """The vertex that is seen first at a place from a side; see SUZANNE."""
    points = points / (np.ptp(points, axis=0) / 2)
    across = points[:, [0, 1 if side in ("above", "below") else 2]]
    depth = {"front": -points[:, 1], "behind": points[:, 1], "above": points[:, 2], "below": -points[:, 2]}
    apart, near = np.linalg.norm(across - (right, up), axis=1), depth[side]
    seen = near > near[apart < 0.08].max() - 0.2
    return int(np.flatnonzero(seen)[apart[seen].argmin()])


def _fitted(shape):
    """Moves a mesh to the middle of its object and scales it to a cell's height."""
    points = measure.positions(shape.data)
    low, high = points.min(axis=0), points.max(axis=0)
    points = (points - (low + high) / 2) * (meshes.HEIGHT / (high - low)[2])
    shape.data.attributes["position"].data.foreach_set(
        "vector", np.ascontiguousarray(points, np.float32).ravel()
    )
    shape.data.update()
    return shape


def _register(source, target, landmarks):
    """Gives the source UVs, a target and landmarks, and registers; returns the seconds and the problem."""
    bpy.ops.object.select_all(action="DESELECT")
    source.select_set(True)
    bpy.context.view_layer.objects.active = source
    source.data.uv_layers.active = source.data.uv_layers.new(name=LAYOUT)
    began = time.perf_counter()
    try:
        bpy.ops.authalic.unwrap(uv_layer=LAYOUT, sphere_layout="OCTAHEDRAL", angle_weight=ANGLE_WEIGHT)
        source.authalic_target = target
        for name, (first, second) in landmarks.items():
            bpy.ops.authalic.landmark_add(name=name, source_vertex=first, target_vertex=second)
            source.authalic_landmarks[-1].is_soft = any(part in name for part in SOFT)
        began = time.perf_counter()
        bpy.ops.authalic.register()
    except RuntimeError as error:  # bpy passes on an error report so
        return time.perf_counter() - began, str(error).strip()
    return time.perf_counter() - began, None


def _figures(source, target, key):
    """The final distances of the landmarks, from the coordinates alone, in percent of the target's size."""
    ends, goals = measure.points_of(source.data, key), measure.positions(target.data)
    size = np.linalg.norm(np.ptp(goals, axis=0))
    apart = [
        np.linalg.norm(ends[pair.source_vertex] - goals[pair.target_vertex])
        for pair in source.authalic_landmarks
    ]
    return {
        "landmarks": len(apart),
        "soft_landmarks": sum(pair.is_soft for pair in source.authalic_landmarks),
        "landmark_error_mean_percent": float(100 * np.mean(apart) / size),
        "landmark_error_max_percent": float(100 * np.max(apart) / size),
    }


def _caption(entry):
    mean, most = entry["landmark_error_mean_percent"], entry["landmark_error_max_percent"]
    met = f"met to {mean:.2f} % of the size on average, {most:.2f} % at most"
    return f"{entry['mesh']} by {entry['landmarks']} landmarks, {entry['soft_landmarks']} of them soft, {met}"


def _wall(shape, key):
    """Five frames in clay, and below them with the checker."""
    clay, checker = _clay(), stage.checker_material(LAYOUT, "checker_scale morph")
    layout = measure.layout_of(shape.data)
    for column, value in enumerate(FRAMES):
        frame = meshes.copy_of(shape, f"{shape.name} - {value:g}")
        frame.data.shape_keys.key_blocks[key].value = value
        frame["checker_scale morph"] = stage.checker_scale(*measure.areas(layout))
        stage.label(f"{value:g}", column, -0.62, 0.2)
        stage.place(frame, clay, column, 0)
        twin = frame.copy()
        bpy.context.scene.collection.objects.link(twin)
        stage.place(twin, checker, column, STEP)


def _clay():
    material = bpy.data.materials.new("Clay")
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.72, 0.52, 0.4, 1)
    material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.7
    return material
