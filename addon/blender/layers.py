# SPDX-License-Identifier: GPL-3.0-or-later
"""The layers of a transfer as arrays: UV maps, vertex groups, color attributes, shape keys."""

from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ..surfaces.arrays import Floats, Integers, Reals
from . import shape_keys, uv_maps
from .types import MeshObject

UV_MAP, GROUP, COLOR, KEY = "UV map", "vertex group", "color attribute", "shape key"
_NO_WEIGHT = 1e-6
_ASIDE = "authalic replaced"  # the name of a color attribute while another takes its own


@dataclass
class Layer:
    """A layer of a mesh: values (n, d) of its vertices, or (c, d) of its corners if `of_corners`.

    The values of a shape key are displacements. `detail` depends on the kind.
    """

    kind: str
    name: str
    values: Reals
    of_corners: bool = False
    detail: tuple[Any, ...] = ()


def read_uv_maps(obj: MeshObject, active_only: bool) -> list[Layer]:
    """All UV maps of an object, or the active one."""
    maps = obj.data.uv_layers
    names = [uv_map.name for uv_map in maps if not active_only or uv_map == maps.active]
    return [Layer(UV_MAP, name, uv_maps.read(obj.data, name), True) for name in names]


@dataclass
class KeyDetail:
    """What a shape key has besides its displacements: its slider's range and value, whether it is muted, the
    interpolation to the next key, the vertex group that masks it ("" for none), and the key it is relative to
    ("" for the first)."""

    slider: tuple[float, float]
    value: float
    is_muted: bool
    interpolation: Any
    mask: str
    relative_to: str


def read_vertex_groups(obj: MeshObject) -> list[Layer]:
    """All vertex groups of an object; vertices outside have the weight 0."""
    weights = np.zeros((len(obj.vertex_groups), len(obj.data.vertices), 1), np.float32)
    for vertex in obj.data.vertices if len(weights) else ():
        for entry in vertex.groups:
            if entry.group < len(weights):
                weights[entry.group, vertex.index] = entry.weight
    return [Layer(GROUP, group.name, weights[group.index]) for group in obj.vertex_groups]


def read_color_attributes(obj: MeshObject) -> list[Layer]:
    """The color attributes of vertices and of corners, linear; `detail` is the type and the domain."""
    layers = []
    attribute: Any
    for attribute in obj.data.color_attributes:
        if attribute.domain in ("POINT", "CORNER"):
            values = np.empty(4 * len(attribute.data), np.float32)
            attribute.data.foreach_get("color", values)
            detail = attribute.data_type, attribute.domain
            of_corners = attribute.domain == "CORNER"
            layers.append(Layer(COLOR, attribute.name, values.reshape(-1, 4), of_corners, detail))
    return layers


def read_shape_keys(obj: MeshObject, but: Collection[str]) -> list[Layer]:
    """An object's shape keys without those named, as displacements; `detail` is a `KeyDetail`."""
    blocks = obj.data.shape_keys
    if blocks is None or not blocks.use_relative:
        return []
    chosen = [key for key in blocks.key_blocks[1:] if key.name not in but]
    return [
        Layer(
            KEY,
            key.name,
            shape_keys.coordinates(key) - shape_keys.coordinates(key.relative_key),
            detail=(_detail(key, blocks.reference_key),),
        )
        for key in chosen
    ]


def _detail(key: bpy.types.ShapeKey, first: bpy.types.ShapeKey) -> KeyDetail:
    relative = "" if key.relative_key == first else key.relative_key.name
    return KeyDetail(
        slider=(key.slider_min, key.slider_max),
        value=key.value,
        is_muted=key.mute,
        interpolation=key.interpolation,
        mask=key.vertex_group,
        relative_to=relative,
    )


def why_no_shape_keys(obj: MeshObject) -> str | None:
    """Why the shape keys that an object has cannot be read as displacements, or None."""
    keys = obj.data.shape_keys
    if keys is None or keys.use_relative:
        return None
    return f"shape keys: those of {obj.name} are absolute; turn on Relative in its shape keys"


def writable(obj: MeshObject, layers: Sequence[Layer]) -> tuple[list[Layer], list[str]]:
    """The layers that an object can have, and for each of the others a line that says why not."""
    good: list[Layer] = []
    problems: list[str] = []
    taken: dict[str, str] = {}
    room = uv_maps.MAX_UV_LAYERS - len(obj.data.uv_layers)
    for layer in layers:
        problem = _why_not(obj, layer, taken)
        if problem is None and layer.kind == UV_MAP and layer.name not in obj.data.uv_layers:
            problem = None if room > 0 else f"{obj.name} has no room for more UV maps"
            room -= 1
        if problem is not None:
            problems.append(_line(layer, problem))
            continue
        good.append(layer)
        if layer.kind != KEY:
            taken[layer.name] = layer.kind
    return good, problems


def write(obj: MeshObject, layer: Layer, elements: Integers, values: Floats) -> str | None:
    """Writes values (k, d) of vertices or corners (k,) into a layer of an object; other elements keep theirs.

    Returns None, or a line that says why nothing was written.
    """
    if _WRITERS[layer.kind](obj, layer, elements, values):
        return None
    return _line(layer, f"Blender adds no layer of this name to {obj.name}; rename it on either object")


def masks(layers: Sequence[Layer]) -> set[str]:
    """The names of the vertex groups that mask shape keys."""
    return {layer.detail[0].mask for layer in layers if layer.kind == KEY} - {""}


def relate(obj: MeshObject, layers: Sequence[Layer]) -> list[str]:
    """Makes shape keys that were written to an object relative to the same keys as where they come from.

    Returns a line for each that cannot be.
    """
    keys = {layer.name: layer.detail[0].relative_to for layer in layers if layer.kind == KEY}
    known = {name: relative for name, relative in keys.items() if relative in keys}
    loose = [name for name, relative in keys.items() if relative and name not in known]
    if known:
        loose += shape_keys.make_relative(obj, known)
    return [f"{KEY} {name} is relative to the first key here" for name in loose]


def _line(layer: Layer, problem: str) -> str:
    return f"{layer.kind} {layer.name}: {problem}"


def _why_not(obj: MeshObject, layer: Layer, taken: dict[str, str]) -> str | None:
    """The name conflict that prevents adding this layer, or None. `taken` {name: kind} is added before it."""
    mesh = obj.data
    if layer.kind == KEY:
        return shape_keys.why_not(mesh, layer.name)
    collections = {GROUP: obj.vertex_groups, UV_MAP: mesh.uv_layers, COLOR: mesh.color_attributes}
    existing = collections[layer.kind].get(layer.name)
    if existing is not None and (layer.kind != COLOR or _is_alike(existing, layer)):
        return None
    # UV maps, colors and vertex groups share their names; a color of another type is replaced.
    if layer.name in obj.vertex_groups or (existing is None and layer.name in mesh.attributes):
        return f"{obj.name} has another attribute of this name; rename that"
    if layer.name in taken:
        return f"{obj.name} gets a {taken[layer.name]} of this name; rename one of them on the target"
    return None


def _is_alike(attribute: bpy.types.Attribute, layer: Layer) -> bool:
    return (attribute.data_type, attribute.domain) == layer.detail


def _added(collection: Any, layer: Layer, **kind: str) -> Any:
    """A new layer of the same name in a collection; None if Blender adds none of this name."""
    added = None
    with suppress(RuntimeError):  # bpy passes on an error report so
        added = collection.new(name=layer.name, **kind)
    if added is not None and added.name != layer.name:
        collection.remove(added)
        added = None
    return added


def _write_uv_map(obj: MeshObject, layer: Layer, corners: Integers, uv: Floats) -> bool:
    mesh = obj.data
    with uv_maps.active_stays(mesh, layer.name):
        if layer.name not in mesh.uv_layers and _added(mesh.uv_layers, layer) is None:
            return False
        uv_maps.write(mesh, layer.name, corners, uv.astype(np.float32))
    return True


def _write_group(obj: MeshObject, layer: Layer, vertices: Integers, weights: Floats) -> bool:
    group = obj.vertex_groups.get(layer.name) or _added(obj.vertex_groups, layer)
    if group is None:
        return False
    group.remove(vertices.tolist())
    weights = np.clip(weights[:, 0], 0, 1)
    some = weights > _NO_WEIGHT
    for vertex, weight in zip(vertices[some].tolist(), weights[some].tolist(), strict=True):
        group.add((vertex,), weight, "REPLACE")
    return True


def _write_color(obj: MeshObject, layer: Layer, elements: Integers, colors: Floats) -> bool:
    attributes = obj.data.color_attributes
    attribute: Any = attributes.get(layer.name)
    if attribute is None or not _is_alike(attribute, layer):
        attribute = _added_color(attributes, layer)
    if attribute is None:
        return False
    values = np.empty((len(attribute.data), 4), np.float32)
    attribute.data.foreach_get("color", values.ravel())
    values[elements] = np.maximum(colors, 0)
    attribute.data.foreach_set("color", values.ravel())
    obj.data.update()
    return True


def _added_color(attributes: Any, layer: Layer) -> Any:
    """A new color attribute in place of one of another type; if Blender adds none, None."""
    aside: str | None = None
    old: Any = attributes.get(layer.name)
    if old is not None:
        old.name = _ASIDE
        aside = old.name
    is_added = _added(attributes, layer, type=layer.detail[0], domain=layer.detail[1]) is not None
    if aside is not None and is_added:
        attributes.remove(attributes[aside])
    elif aside is not None:
        attributes[aside].name = layer.name
    # Adding and removing layers moves the others, so that it has to be found again.
    return attributes[layer.name] if is_added else None


def _write_key(obj: MeshObject, layer: Layer, vertices: Integers, displacements: Floats) -> bool:
    detail: KeyDetail = layer.detail[0]
    positions = shape_keys.read(obj).positions
    positions[vertices] += displacements
    shape_keys.write(obj, layer.name, positions)
    key = obj.data.shape_keys.key_blocks[layer.name]
    key.slider_min, key.slider_max = detail.slider
    key.value, key.mute, key.vertex_group = detail.value, detail.is_muted, detail.mask
    key.interpolation = detail.interpolation
    return True


_WRITERS = {UV_MAP: _write_uv_map, GROUP: _write_group, COLOR: _write_color, KEY: _write_key}
