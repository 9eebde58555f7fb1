# SPDX-License-Identifier: GPL-3.0-or-later
"""The image that a mesh is being textured with."""

from typing import Any

import bpy

Size = tuple[int, int]
"""Pixels in width and in height."""


def active(context: bpy.types.Context) -> bpy.types.Image | None:
    """The image of the UV editor, or that of the active texture node of the active material."""
    space: Any = context.space_data
    if space is not None and space.type == "IMAGE_EDITOR" and _has_pixels(space.image):
        image: bpy.types.Image = space.image
        return image
    return _of_material(context.object)


def size(image: bpy.types.Image) -> Size:
    """The size of an image; that of its first tile where it has several."""
    pixels: Any = image.size
    return int(pixels[0]), int(pixels[1])


def aspect(image: bpy.types.Image | None) -> float:
    """The width of an image over its height; 1 without one."""
    width, height = size(image) if image is not None else (1, 1)
    return width / height


def tile(image: bpy.types.Image | None) -> tuple[int, int]:
    """Column and row of the active UDIM tile of an image; those of the first one where it has no tiles."""
    chosen = image.tiles.active if image is not None and image.source == "TILED" else None
    if chosen is None:
        return 0, 0
    row, column = divmod(chosen.number - 1001, 10)
    return column, row


def _of_material(obj: bpy.types.Object | None) -> bpy.types.Image | None:
    material = obj.active_material if obj is not None else None
    if material is None or material.node_tree is None:
        return None
    nodes = material.node_tree.nodes
    candidates: list[Any] = [nodes.active, *nodes]
    images = [node.image for node in candidates if node is not None and node.type == "TEX_IMAGE"]
    shown: bpy.types.Image | None = next(filter(_has_pixels, images), None)
    return shown


def _has_pixels(image: bpy.types.Image | None) -> bool:
    """Whether an image has a size, and is no render, which nothing is textured with."""
    if image is None or image.type in {"RENDER_RESULT", "COMPOSITING"}:
        return False
    return min(size(image)) > 0
