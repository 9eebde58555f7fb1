# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's key: Ctrl Alt U unwraps, where U opens Blender's own menu of unwraps.

It is free in Blender's key maps, and can be changed in the preferences (Keymap, search for Authalic).
"""

from typing import Any

import bpy

_KEY: dict[str, Any] = {"type": "U", "value": "PRESS", "ctrl": True, "alt": True}
_KEY_MAPS: tuple[tuple[str, Any], ...] = (("Mesh", "EMPTY"), ("UV Editor", "EMPTY"))
_items: list[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]] = []


def register() -> None:
    configuration = bpy.context.window_manager.keyconfigs.addon
    if configuration is None:  # Blender runs without key maps
        return
    for name, space in _KEY_MAPS:
        keys: Any = configuration.keymaps.new(name=name, space_type=space)
        _items.append((keys, keys.keymap_items.new("authalic.unwrap", **_KEY)))


def unregister() -> None:
    while _items:
        keys, item = _items.pop()
        keys.keymap_items.remove(item)
