# SPDX-License-Identifier: GPL-3.0-or-later
"""What files keep of the lists of landmarks, which may be of any type in a file from a stranger.

Blender takes what is stored under the name of a list for its entries. Where that are no groups of properties,
some versions end with an error of memory as the list is used. So it is removed as a file is opened or data
are appended.
"""

from typing import Any

import bpy
from bpy.app.handlers import persistent

_LISTS = ("authalic_landmarks", "authalic_landmark_curves")
# Since Blender 4.3 it is said when data were appended or linked.
_HANDLERS = [name for name in ("load_post", "blend_import_post") if hasattr(bpy.app.handlers, name)]


@persistent  # type: ignore[untyped-decorator]
def drop_misfits(*_: object) -> None:
    """Removes the lists of all objects that are none."""
    for obj in bpy.data.objects:
        properties = _properties(obj)
        for name in _LISTS:
            if properties is not None and name in properties and not _is_list(properties[name]):
                del properties[name]


def _properties(obj: Any) -> Any:
    """Where Blender keeps the values of the properties that extensions define; None if there are none."""
    return obj.bl_system_properties_get() if hasattr(obj, "bl_system_properties_get") else obj


def _is_list(value: Any) -> bool:
    return isinstance(value, list) and all(hasattr(entry, "keys") for entry in value)


def register() -> None:
    for name in _HANDLERS:
        getattr(bpy.app.handlers, name).append(drop_misfits)


def unregister() -> None:
    for name in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(drop_misfits)
