# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that could not be registered because vertices lie on each other, and their merge."""

from ..blender import editability, merging
from ..blender.types import MeshObject
from ..landmarks import point_marks

_names: set[str] = set()


class CannotMerge(Exception):
    """There is nothing to merge, or it cannot be; nothing was changed."""


def remember(name: str) -> None:
    """Keeps the name of an object whose vertices lie on each other."""
    _names.add(name)


def is_unjoined(obj: MeshObject) -> bool:
    """Whether the last registration of an object found vertices that lie on each other."""
    return obj.name in _names


def forget(obj: MeshObject) -> None:
    """Its vertices are joined, or its mesh is another one."""
    _names.discard(obj.name)


def forget_all() -> None:
    """Forgets all, as where another file is opened."""
    _names.clear()


def merge(obj: MeshObject) -> int:
    """Merges the vertices of open edges that lie on each other; returns how many are gone.

    Those with landmarks stay. Raises `CannotMerge` and then changes nothing.
    """
    if reason := editability.why_not_mesh(obj):
        raise CannotMerge(f"{obj.name}: {reason}")
    marked = [vertex for vertices in point_marks.find(obj.data).values() for vertex in vertices]
    count = merging.merge_open_edges(obj, marked)
    forget(obj)
    if not count:
        raise CannotMerge(f"{obj.name} has no vertices of open edges that lie on each other")
    return count
