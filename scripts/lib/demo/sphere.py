# SPDX-License-Identifier: MIT OR Apache-2.0
"""The demo's closed meshes: their UVs by way of the sphere, and the morph into the sphere.

Runs inside Blender, after the comparison; leaves two scenes: "Sphere", which is the picture, and "Morph".
"""

import bpy
from mathutils import Matrix, Vector

from demo import measure, meshes, report, stage, unwrap

FRAMES = (0.0, 0.25, 0.5, 0.75, 1.0)
LAYOUTS = (unwrap.LAMBERT, unwrap.OCTAHEDRAL)
KEY = unwrap.SHAPE_KEY.name
STEP, HEAT_ROW, ROWS = 0.88, 1.94, 3.06
"""Distances down the wall in rows: to the next row of frames, to the heat maps, to the next mesh."""
COARSER = 1.4
"""The squares are larger by this than in the comparison, so that the morph's form shows."""
LAST_FRAME = 96
PIXELS_PER_CELL, SAMPLES = 270, 16


def show(out, closed, heat):
    """Maps closed meshes, {name: mesh}, and puts them on a wall; returns the entries of the report."""
    stage.new_scene("Sphere")
    checkers = {name: stage.checker_material(name, f"checker_scale {name}") for name in LAYOUTS}
    entries, morphs = [], []
    for index, (name, mesh) in enumerate(closed.items()):
        shape = bpy.data.objects.new(name, mesh)
        bpy.context.scene.collection.objects.link(shape)
        results = {method.name: _mapped(out, shape, method) for method in _methods()}
        entries += [entry for entry, _ in results.values()]
        frames = _wall(shape, results, index * ROWS, checkers)
        _heat_maps(shape, frames, results, index * ROWS + HEAT_ROW, heat)
        morphs += [frames[0]] if frames[0].data.shape_keys else []
        bpy.data.objects.remove(shape)
    _headings(len(closed), heat)
    _morph_scene(morphs, checkers[unwrap.LAMBERT])
    return entries


def _methods():
    return [*unwrap.of_closed_meshes(), unwrap.SHAPE_KEY]


def _mapped(out, shape, method):
    """Runs one method; returns its entry in the report and the map, None if it failed."""
    of_uv = method is not unwrap.SHAPE_KEY
    if of_uv:
        shape.data.uv_layers.active = shape.data.uv_layers.new(name=method.name)
    seconds, problem = unwrap.timed(shape, method, mode="EDIT" if of_uv else "OBJECT")
    entry = {"mesh": shape.name, "method": method.name, "seconds": round(seconds, 3), "problem": problem}
    layout = None
    if not problem:
        layout = measure.layout_of(shape.data) if of_uv else measure.sphere_of(shape.data, KEY)
        entry |= measure.summary(layout)
        report.keep(out / "data" / ("sphere" if of_uv else "shape_key"), entry, layout)
    print("  " + report.sentence(entry), flush=True)
    return entry, layout


def _wall(shape, results, top, checkers):
    """Two rows of frames of the morph, with the checker of either layout; returns the frames."""
    stage.label(shape.name, -0.56, top - 0.08, 0.2, "RIGHT")
    frames = _frames(shape)
    if len(frames) < len(FRAMES):
        stage.label("no shape key: see report.json", 2, top, 0.15)
    for row, name in enumerate(LAYOUTS):
        place = top + row * STEP
        layout = results[name][1]
        text = f"{name} UVs" if layout is not None else f"no {name} UVs"
        stage.label(text, -0.56, place + 0.08, 0.15, "RIGHT", 0.1)
        for column, frame in enumerate(frames):
            if layout is not None:
                frame[f"checker_scale {name}"] = stage.checker_scale(*measure.areas(layout)) / COARSER
            twin = frame if row == 0 else _twin(frame, f"{frame.name}, {name}")
            stage.place(twin, checkers[name], column, place)
            _center(twin, FRAMES[column])
    return frames


def _frames(shape):
    """Copies of an object at the values of the shape key; without a key, one copy."""
    frames = []
    for value in FRAMES if shape.data.shape_keys else FRAMES[:1]:
        frame = meshes.copy_of(shape, f"{shape.name} - {value:g}")
        frame.data.uv_layers.remove(frame.data.uv_layers[unwrap.PROJECTION])
        if frame.data.shape_keys:
            frame.data.shape_keys.key_blocks[KEY].value = value
        frames.append(frame)
    return frames


def _twin(shape, name):
    twin = shape.copy()
    twin.name = name
    bpy.context.scene.collection.objects.link(twin)
    return twin


def _center(shape, value):
    """Moves an object so that the middle of its bounding box at this value is the middle of its cell."""
    points = measure.positions(shape.data)
    if value:
        points = (1 - value) * points + value * measure.points_of(shape.data, KEY)
    middle = Vector((points.min(axis=0) + points.max(axis=0)) / 2)
    shape.location -= Matrix.Rotation(stage.TURN, 3, "Z") @ middle


def _heat_maps(shape, frames, results, row, heat):
    """The area ratios of every method, on the mesh or for the shape key on the sphere, with figures."""
    stage.label("area ratio", -0.56, row, 0.15, "RIGHT", 0.1)
    for index, (name, (entry, layout)) in enumerate(results.items()):
        column = index * (len(FRAMES) - 1) / (len(results) - 1)
        on_sphere = name == KEY
        heading = f"{name}, the shape key" if on_sphere else f"{name} UVs"
        stage.label(heading, column, row - 0.5, 0.15)
        if layout is None:
            stage.label("no map: see report.json", column, row, 0.15)
            continue
        title = f"{shape.name} - {name} - area ratio"
        copy = _twin(frames[-1], title) if on_sphere else _bare(shape, title)
        stage.write_ratio(copy.data, measure.polygon_log2_ratio(layout, len(copy.data.polygons)))
        stage.place(copy, heat, column, row)
        _center(copy, float(on_sphere))
        stage.label(report.caption(entry), column, row + 0.5, 0.125)


def _bare(shape, name):
    """A copy without UV maps and shape keys."""
    copy = meshes.copy_of(shape, name)
    copy.shape_key_clear()
    while copy.data.uv_layers:
        copy.data.uv_layers.remove(copy.data.uv_layers[0])
    return copy


def _headings(mesh_count, heat):
    for column, value in enumerate(FRAMES):
        stage.label(f"shape key at {value:g}", column, -0.62, 0.2)
    last = (mesh_count - 1) * ROWS + HEAT_ROW + 0.75
    stage.heat_legend(heat, (len(FRAMES) - 1) / 2, last + 0.1)
    stage.light_and_camera((-1.2, len(FRAMES) - 0.42), (-0.8, last + 0.32), PIXELS_PER_CELL)


def _morph_scene(shapes, checker):
    """A scene in which the shape key's slider is animated: to the sphere and back."""
    stage.new_scene("Morph")
    for column, shape in enumerate(shapes):
        moving = meshes.copy_of(shape, shape.name.replace(" - 0", " - morph"))
        stage.place(moving, checker, column, 0)
        key = moving.data.shape_keys.key_blocks[KEY]
        for frame, value in ((1, 0.0), (LAST_FRAME // 2, 1.0), (LAST_FRAME, 0.0)):
            key.value = value
            key.keyframe_insert("value", frame=frame)
    bpy.context.scene.frame_end = LAST_FRAME
    bpy.context.scene.frame_set(1)
    stage.light_and_camera((-0.7, max(len(shapes), 1) - 0.3), (-0.7, 0.7), 2 * PIXELS_PER_CELL)
