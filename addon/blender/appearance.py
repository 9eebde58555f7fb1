# SPDX-License-Identifier: GPL-3.0-or-later
"""Modifiers and shape keys that make an object look unlike its mesh."""

import bpy

from .types import MeshObject

_UNMOVED = 1e-6  # values of shape keys that change nothing
# Modifiers that leave the shape of a mesh as it is.
_SHAPELESS = {"COLLISION", "DATA_TRANSFER", "NORMAL_EDIT", "PARTICLE_SYSTEM", "WEIGHTED_NORMAL"} | {
    *("UV_PROJECT", "UV_WARP", "VERTEX_WEIGHT_EDIT", "VERTEX_WEIGHT_MIX", "VERTEX_WEIGHT_PROXIMITY")
}


def deformers(obj: MeshObject, but: str | None) -> list[str]:
    """The modifiers and shape keys that change the shape of an object, in words; not the key named `but`."""
    blocks = obj.data.shape_keys.key_blocks[1:] if obj.data.shape_keys else ()
    shown = [key for key in blocks if key.name != but and not key.mute and abs(key.value) > _UNMOVED]
    shaping = [modifier for modifier in obj.modifiers if _shapes(modifier)]
    return [
        *(f'shape key "{key.name}"' for key in shown),
        *(f'modifier "{modifier.name}"' for modifier in shaping),
    ]


def _shapes(modifier: bpy.types.Modifier) -> bool:
    return modifier.show_viewport and modifier.type not in _SHAPELESS and not _smooths_only(modifier)


def _smooths_only(modifier: bpy.types.Modifier) -> bool:
    """Whether it is Blender's own Shade Auto Smooth, which only splits normals."""
    group = getattr(modifier, "node_group", None)
    return group is not None and group.name.startswith("Smooth by Angle")
