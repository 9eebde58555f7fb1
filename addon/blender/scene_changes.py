# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether any geometry has changed since something was looked at, so that drawing need not look again."""

import bpy
from bpy.app.handlers import persistent

_count, _looks = 0, 0


def count() -> int:
    """A number that changes with every change of a mesh, its shape keys or modifiers."""
    return _count


def looks() -> int:
    """A number that changes also with every change of a selection in edit mode, and of materials."""
    return _looks


def note() -> None:
    """Counts a change that Blender reports later, if at all."""
    global _count, _looks
    _count, _looks = _count + 1, _looks + 1


@persistent  # type: ignore[untyped-decorator]
def _look(_scene: bpy.types.Scene, graph: bpy.types.Depsgraph) -> None:
    if any(update.is_updated_geometry and not _is_collection(update) for update in graph.updates):
        note()
    elif any(isinstance(update.id, bpy.types.Mesh) for update in graph.updates):
        _look_again()


def _look_again() -> None:
    global _looks
    _looks += 1


def _is_collection(update: bpy.types.DepsgraphUpdate) -> bool:
    """Whether only a collection was updated, as where data that nothing uses are removed."""
    return isinstance(update.id, bpy.types.Collection)


@persistent  # type: ignore[untyped-decorator]
def _changed(*_: object) -> None:
    note()


_HANDLERS = (
    ("depsgraph_update_post", _look),
    ("frame_change_post", _changed),
    ("load_post", _changed),
    ("undo_post", _changed),
    ("redo_post", _changed),
)


def register() -> None:
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
