# SPDX-License-Identifier: GPL-3.0-or-later
"""What is transferred between meshes: UV maps, vertex groups, colour attributes, shape keys as arrays."""

from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from . import meshes as mesh_io
from . import shape_keys

UV_MAP, GROUP, COLOUR, KEY = "UV map", "vertex group", "colour attribute", "shape key"
_NO_WEIGHT = 1e-6
_ASIDE = "authalic replaced"  # what a colour attribute is called while another takes its name


@dataclass
class Item:
    """A layer of a mesh: values (n, d) of its vertices, or (c, d) of its corners if `of_corners`.

    Those of a shape key are displacements. `detail` is what else there is to know of its kind.
    """

    kind: str
    name: str
    values: np.ndarray
    of_corners: bool = False
    detail: tuple = ()


def uv_maps(obj, active_only):
    """All of an object's mesh, or the active one."""
    layers = obj.data.uv_layers
    names = [layer.name for layer in layers if not active_only or layer == layers.active]
    return [Item(UV_MAP, name, mesh_io.read_uv(obj.data, name), True) for name in names]


def vertex_groups(obj):
    """All of an object, 0 for vertices that are not in them."""
    weights = np.zeros((len(obj.vertex_groups), len(obj.data.vertices), 1), np.float32)
    for vertex in obj.data.vertices if len(weights) else ():
        for entry in vertex.groups:
            if entry.group < len(weights):
                weights[entry.group, vertex.index] = entry.weight
    return [Item(GROUP, group.name, weights[group.index]) for group in obj.vertex_groups]


def colour_attributes(obj):
    """Those of a mesh's vertices and of its corners, linear; `detail` is the type and the domain."""
    found = []
    for attribute in obj.data.color_attributes:
        if attribute.domain in ("POINT", "CORNER"):
            values = np.empty(4 * len(attribute.data), np.float32)
            attribute.data.foreach_get("color", values)
            detail = attribute.data_type, attribute.domain
            of_corners = attribute.domain == "CORNER"
            found.append(Item(COLOUR, attribute.name, values.reshape(-1, 4), of_corners, detail))
    return found


def keys(obj, but):
    """An object's shape keys, but those named, as displacements; `detail` is the slider's range."""
    blocks = obj.data.shape_keys
    if blocks is None or not blocks.use_relative:
        return []
    chosen = [key for key in blocks.key_blocks[1:] if key.name not in but]
    return [
        Item(
            KEY,
            key.name,
            shape_keys.coordinates(key) - shape_keys.coordinates(key.relative_key),
            detail=(key.slider_min, key.slider_max),
        )
        for key in chosen
    ]


def writable(obj, items):
    """The items that an object can have, and for each of the others a line that says why not."""
    good, problems, taken = [], [], {}
    room = mesh_io.MAX_UV_LAYERS - len(obj.data.uv_layers)
    for item in items:
        problem = _why_not(obj, item, taken)
        if problem is None and item.kind == UV_MAP and item.name not in obj.data.uv_layers:
            problem = None if room > 0 else f"{obj.name} has no room for more UV maps"
            room -= 1
        if problem is not None:
            problems.append(_line(item, problem))
            continue
        good.append(item)
        if item.kind != KEY:
            taken[item.name] = item.kind
    return good, problems


def write(obj, item, elements, values):
    """Writes values (k, d) of vertices or corners (k,) into the layer of an item; others keep theirs.

    Returns None, or a line that says why nothing of the item was written.
    """
    if _WRITERS[item.kind](obj, item, elements, values):
        return None
    return _line(item, f"Blender adds no layer of this name to {obj.name}; rename it on either object")


def _line(item, problem):
    return f"{item.kind} {item.name}: {problem}"


def _why_not(obj, item, taken):
    """What an object has that is in the way of an item, or will have as `taken` {name: kind}; or None."""
    mesh = obj.data
    if item.kind == KEY:
        return shape_keys.why_not(mesh, item.name)
    layers = {GROUP: obj.vertex_groups, UV_MAP: mesh.uv_layers, COLOUR: mesh.color_attributes}[item.kind]
    own = layers.get(item.name)
    if own is not None and (item.kind != COLOUR or _is_alike(own, item)):
        return None
    # UV maps, colours and vertex groups share their names; a colour of another type is replaced.
    if item.name in obj.vertex_groups or (own is None and item.name in mesh.attributes):
        return f"{obj.name} has another attribute of this name; rename that"
    if item.name in taken:
        return f"{obj.name} gets a {taken[item.name]} of this name; rename one of them on the target"
    return None


def _is_alike(attribute, item):
    return (attribute.data_type, attribute.domain) == item.detail


def _added(layers, item, **kind):
    """A new layer of an item's name, or None, and then none was added."""
    made = None
    with suppress(RuntimeError):  # how bpy passes on an error report
        made = layers.new(name=item.name, **kind)
    if made is not None and made.name != item.name:
        layers.remove(made)
        made = None
    return made


def _write_uv_map(obj, item, corners, uv):
    mesh, active = obj.data, obj.data.uv_layers.active
    before = active.name if active else item.name
    if item.name not in mesh.uv_layers and _added(mesh.uv_layers, item) is None:
        return False
    mesh_io.write_uv(mesh, item.name, corners, uv.astype(np.float32))
    mesh.uv_layers.active = mesh.uv_layers[before]
    return True


def _write_group(obj, item, vertices, weights):
    group = obj.vertex_groups.get(item.name) or _added(obj.vertex_groups, item)
    if group is None:
        return False
    group.remove(vertices.tolist())
    weights = np.clip(weights[:, 0], 0, 1)
    some = weights > _NO_WEIGHT
    for vertex, weight in zip(vertices[some].tolist(), weights[some].tolist(), strict=True):
        group.add((vertex,), weight, "REPLACE")
    return True


def _write_colour(obj, item, elements, colours):
    attributes = obj.data.color_attributes
    found = attributes.get(item.name)
    if found is None or not _is_alike(found, item):
        found = _added_colour(attributes, item)
    if found is None:
        return False
    values = np.empty((len(found.data), 4), np.float32)
    found.data.foreach_get("color", values.ravel())
    values[elements] = np.maximum(colours, 0)
    found.data.foreach_set("color", values.ravel())
    obj.data.update()
    return True


def _added_colour(attributes, item):
    """A new colour attribute in place of one of another type, or None, and then that one stays."""
    aside, old = None, attributes.get(item.name)
    if old is not None:
        old.name = _ASIDE
        aside = old.name
    is_added = _added(attributes, item, type=item.detail[0], domain=item.detail[1]) is not None
    if aside is not None and is_added:
        attributes.remove(attributes[aside])
    elif aside is not None:
        attributes[aside].name = item.name
    # Adding and removing layers moves the others, so that it has to be found again.
    return attributes[item.name] if is_added else None


def _write_key(obj, item, vertices, displacements):
    shown = obj.active_shape_key_index
    positions = shape_keys.read(obj).positions
    positions[vertices] += displacements
    shape_keys.write(obj, item.name, positions)
    key = obj.data.shape_keys.key_blocks[item.name]
    key.slider_min, key.slider_max = item.detail
    obj.active_shape_key_index = shown
    return True


_WRITERS = {UV_MAP: _write_uv_map, GROUP: _write_group, COLOUR: _write_colour, KEY: _write_key}
