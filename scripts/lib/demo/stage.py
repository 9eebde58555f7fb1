# SPDX-License-Identifier: MIT OR Apache-2.0
"""The demo's picture: a wall of meshes with materials, labels, soft light and an orthographic camera.

The wall stands in the x-z plane and is seen along +y. A mesh takes two rows: checker above, heat map below.
"""

import math

import bpy
import numpy as np

COLUMN, ROW = 2.75, 2.5
TURN = math.radians(-24)
"""Every mesh is turned a little, so that its form shows."""
CHECKER_SIZE = 0.085
HEAT_RANGE = 2.0
"""The heat map goes from 2^-2 to 2^2: a quarter to four times the fair share."""
LEGEND_WIDTH = 2.6
CORNER_COLORS = (("X", "Red", (0.12, 0.95)), ("Y", "Blue", (0.06, 0.85)))
"""Axes of the unit square, the channels that change along them, and their values at 0 and 1."""
HEAT_STOPS = (
    (0.00, (0.020, 0.090, 0.330)),
    (0.25, (0.140, 0.430, 0.760)),
    (0.50, (0.830, 0.830, 0.830)),
    (0.75, (0.890, 0.330, 0.190)),
    (1.00, (0.360, 0.010, 0.040)),
)


def new_scene(name):
    """Adds an empty scene and makes it the current one."""
    bpy.context.window.scene = bpy.data.scenes.new(name)


def checker_material(uv_map="", scale_name="checker_scale"):
    """A checker whose squares have one size on the surface if the map is even.

    uv_map: the UV map's name, or the active one; scale_name: the object's property that sets the size.
    """
    material, nodes, link = _material(f"Checker {uv_map}".strip())
    uv = nodes.new("ShaderNodeUVMap")
    uv.uv_map = uv_map
    scale = nodes.new("ShaderNodeAttribute")
    scale.attribute_type, scale.attribute_name = "OBJECT", scale_name
    scaled = nodes.new("ShaderNodeVectorMath")
    scaled.operation = "SCALE"
    checker = nodes.new("ShaderNodeTexChecker")
    checker.inputs["Scale"].default_value = 1.0
    checker.inputs["Color1"].default_value = (0.86, 0.84, 0.80, 1)
    checker.inputs["Color2"].default_value = (0.055, 0.125, 0.190, 1)
    link(uv.outputs["UV"], scaled.inputs[0])
    link(scale.outputs["Fac"], scaled.inputs["Scale"])
    link(scaled.outputs["Vector"], checker.inputs["Vector"])
    link(checker.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    return material


def heat_material():
    """A material that is blue where faces have too little of the texture, red where they have too much."""
    material, nodes, link = _material("Area ratio (log2)")
    ratio = nodes.new("ShaderNodeAttribute")
    ratio.attribute_name = "log2_area_ratio"
    place = nodes.new("ShaderNodeMapRange")
    place.inputs["From Min"].default_value = -HEAT_RANGE
    place.inputs["From Max"].default_value = HEAT_RANGE
    ramp = nodes.new("ShaderNodeValToRGB")
    _set_stops(ramp.color_ramp)
    link(ratio.outputs["Fac"], place.inputs["Value"])
    link(place.outputs["Result"], ramp.inputs["Fac"])
    link(ramp.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    return material


def color_by_place(material):
    """Colors the bright squares of a checker by their place in the unit square."""
    nodes, link = material.node_tree.nodes, material.node_tree.links.new
    uv = next(node for node in nodes if node.bl_idname == "ShaderNodeUVMap")
    place, color = nodes.new("ShaderNodeSeparateXYZ"), nodes.new("ShaderNodeCombineColor")
    link(uv.outputs["UV"], place.inputs[0])
    for axis, channel, (at_zero, at_one) in CORNER_COLORS:
        ramp = nodes.new("ShaderNodeMapRange")
        ramp.inputs["To Min"].default_value, ramp.inputs["To Max"].default_value = at_zero, at_one
        link(place.outputs[axis], ramp.inputs["Value"])
        link(ramp.outputs["Result"], color.inputs[channel])
    color.inputs["Green"].default_value = 0.50
    checker = next(node for node in nodes if node.bl_idname == "ShaderNodeTexChecker")
    link(color.outputs["Color"], checker.inputs["Color1"])


def lines(name, segments, radius, color):
    """Straight segments (k, 2, 3) as round lines of one color, unlit."""
    curve = bpy.data.curves.new(name, "CURVE")
    curve.dimensions, curve.bevel_depth, curve.use_fill_caps = "3D", radius, True
    for segment in segments:
        spline = curve.splines.new("POLY")
        spline.points.add(1)
        for point, end in zip(spline.points, segment, strict=True):
            point.co = (*end, 1)
    curve.materials.append(_ink(color))
    shape = bpy.data.objects.new(name, curve)
    bpy.context.scene.collection.objects.link(shape)
    return shape


def checker_scale(surface, image):
    """The scale of UVs in the checker, from the areas of the triangles in space and in the UV plane."""
    density = float(np.sqrt(surface.sum() / max(np.abs(image).sum(), 1e-300)))
    return density / CHECKER_SIZE


def write_ratio(mesh, values):
    """Writes the attribute that the heat map shows: log2 of the area ratio of each polygon."""
    if "log2_area_ratio" in mesh.attributes:
        mesh.attributes.remove(mesh.attributes["log2_area_ratio"])
    attribute = mesh.attributes.new("log2_area_ratio", "FLOAT", "FACE")
    attribute.data.foreach_set("value", np.ascontiguousarray(values, np.float32))


def place(shape, material, column, row):
    """Puts an object on the wall with a material of its own (the mesh may be shared)."""
    if not shape.data.materials:
        shape.data.materials.append(None)
    shape.material_slots[0].link = "OBJECT"
    shape.material_slots[0].material = material
    shape.location = spot(column, row)
    shape.rotation_euler = (0, 0, TURN)


def spot(column, row):
    """The center of a cell; rows count downward and may be fractions."""
    return (column * COLUMN, 0.0, -row * ROW)


def label(text, column, row, size=0.2, align="CENTER", shade=0.02):
    """A line of text that faces the camera, in one color and unlit."""
    curve = bpy.data.curves.new(text[:60], "FONT")
    curve.body, curve.size = text, size
    curve.align_x, curve.align_y = align, "CENTER"
    shape = bpy.data.objects.new(f"Label {text[:50]}", curve)
    shape.location, shape.rotation_euler = spot(column, row), (math.pi / 2, 0, 0)
    curve.materials.append(_ink((shade, shade, shade)))
    bpy.context.scene.collection.objects.link(shape)
    return shape


def heat_legend(material, column, row):
    """A bar of the heat map's colors with its meaning above and its scale below."""
    bar = bpy.data.objects.new("Legend", _legend_mesh(LEGEND_WIDTH, 0.16, 60))
    bar.data.materials.append(material)
    bar.location = spot(column, row)
    bpy.context.scene.collection.objects.link(bar)
    label("texture area / fair share", column, row - 0.09, 0.14)
    for offset, text in ((-0.5, "1/4"), (-0.25, "1/2"), (0, "1"), (0.25, "2"), (0.5, "4")):
        label(text, column + offset * LEGEND_WIDTH / COLUMN, row + 0.085, 0.13)


def light_and_camera(columns, rows, pixels_per_cell):
    """Soft light from the upper left, a neutral gray ground, and a camera that frames the whole wall.

    columns, rows: (first, last) edges of the wall in cells.
    """
    scene = bpy.context.scene
    width, height = (columns[1] - columns[0]) * COLUMN, (rows[1] - rows[0]) * ROW
    center = ((columns[0] + columns[1]) / 2, (rows[0] + rows[1]) / 2)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", max(width, height)
    x, _, z = spot(*center)
    camera.location, camera.rotation_euler = (x, -30, z), (math.pi / 2, 0, 0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    _sun("Key", (math.radians(48), 0, math.radians(-38)), 2.6, 25)
    _sun("Fill", (math.radians(70), 0, math.radians(50)), 0.7, 90)
    _ground(scene, background=0.42, ambient=0.55)
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x = round(width / COLUMN * pixels_per_cell)
    scene.render.resolution_y = round(height / COLUMN * pixels_per_cell)


def render(path, samples):
    """Renders the scene with Cycles on the CPU."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.max_bounces = 1
    scene.cycles.use_denoising = False
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)


def _legend_mesh(width, height, steps):
    xs = np.linspace(-width / 2, width / 2, steps + 1)
    points = [(x, 0, z) for x in xs for z in (-height / 2, height / 2)]
    mesh = bpy.data.meshes.new("Legend")
    mesh.from_pydata(points, [], [(2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1) for i in range(steps)])
    write_ratio(mesh, ((np.arange(steps) + 0.5) / steps * 2 - 1) * HEAT_RANGE)
    return mesh


def _material(name):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Roughness"].default_value = 0.65
    shader.inputs["Specular IOR Level"].default_value = 0.25
    return material, material.node_tree.nodes, material.node_tree.links.new


def _set_stops(ramp):
    while len(ramp.elements) < len(HEAT_STOPS):
        ramp.elements.new(0.5)
    for element, (position, color) in zip(ramp.elements, HEAT_STOPS, strict=True):
        element.position, element.color = position, (*color, 1)


def _ink(color):
    name = "Ink " + " ".join(f"{value:.2f}" for value in color)
    if name not in bpy.data.materials:
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        nodes = material.node_tree.nodes
        glow = nodes.new("ShaderNodeEmission")
        glow.inputs["Color"].default_value = (*color, 1)
        material.node_tree.links.new(glow.outputs[0], nodes["Material Output"].inputs["Surface"])
    return bpy.data.materials[name]


def _sun(name, rotation, strength, softness):
    light = bpy.data.lights.new(name, "SUN")
    light.energy, light.angle = strength, math.radians(softness)
    shape = bpy.data.objects.new(name, light)
    shape.rotation_euler = rotation
    bpy.context.scene.collection.objects.link(shape)


def _ground(scene, background, ambient):
    """A world whose background, as the camera sees it, differs from its light."""
    scene.world = bpy.data.worlds.get("Ground")
    if scene.world is not None:
        return
    world = scene.world = bpy.data.worlds.new("Ground")
    world.use_nodes = True
    nodes, link = world.node_tree.nodes, world.node_tree.links.new
    seen, lighting = nodes["Background"], nodes.new("ShaderNodeBackground")
    seen.inputs["Color"].default_value = (background, background, background, 1)
    lighting.inputs["Strength"].default_value = ambient
    path, mix = nodes.new("ShaderNodeLightPath"), nodes.new("ShaderNodeMixShader")
    link(path.outputs["Is Camera Ray"], mix.inputs[0])
    link(lighting.outputs[0], mix.inputs[1])
    link(seen.outputs[0], mix.inputs[2])
    link(mix.outputs[0], nodes["World Output"].inputs["Surface"])
