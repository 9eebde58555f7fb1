# SPDX-License-Identifier: GPL-3.0-or-later
"""Why data cannot be written: Blender takes changes of linked data and of overrides, but saves none."""

import bpy

from .types import MeshObject

_LOCAL = "make it local first (Object > Relations > Make Local)"


def why_not_mesh(obj: MeshObject) -> str | None:
    """Why the mesh of an object cannot be written, or None; read behind the name of the object."""
    return _worded("its mesh", obj.data)


def why_not_object(obj: MeshObject) -> str | None:
    """Why what is kept on an object itself, as its landmarks, cannot be written, or None."""
    return _worded("the object", obj)


def is_writable(data: bpy.types.ID) -> bool:
    """Whether Blender keeps changes of some data; overrides are editable, but only in a few properties."""
    return data.is_editable and data.override_library is None


def _worded(what: str, data: bpy.types.ID) -> str | None:
    if is_writable(data):
        return None
    if data.override_library is not None:
        return f"{what} is a library override, which keeps no such changes; {_LOCAL}"
    return f"{what} is linked from another file; {_LOCAL}"
