# SPDX-License-Identifier: GPL-3.0-or-later
"""The path of selected edges in edit mode, and which end it starts at."""

from collections.abc import Sequence

import numpy as np

from .. import messages
from ..blender import selection, vertex_positions
from ..blender.types import MeshObject
from ..surfaces.arrays import Floats, Path
from . import paths
from .objects import CannotPair

_WHAT = "select the edges of one open path or of one closed loop"


def path(obj: MeshObject) -> tuple[Path, bool] | None:
    """The path along the selected edges of an object, from the end that is nearer to the active element.

    Also returns whether an active element says where it starts. None where no edge is selected in edit mode.
    Raises `CannotPair` where the edges are no single path.
    """
    if not obj.data.is_editmode:
        return None
    edges = selection.edges(obj)
    if not edges:
        return None
    try:
        ordered = paths.ordered(edges)
    except paths.NoPath as problem:
        count = messages.count(len(edges), "selected edge")
        raise CannotPair(f"The {count} of {obj.name} {problem}; {_WHAT}") from None
    return _from_active(ordered, selection.active_vertices(obj))


def like(obj: MeshObject, path: Path, partner: MeshObject, partner_path: Path) -> Path:
    """An open path of an object in the direction that a path of its partner has in the world."""
    if paths.is_closed(path) or paths.is_closed(partner_path):
        return path
    return path[::-1] if _chord(obj, path) @ _chord(partner, partner_path) < 0 else path


def _from_active(path: Path, active: Sequence[int]) -> tuple[Path, bool]:
    """The path from the end that is nearer to the active vertices, and whether there is such an end."""
    near = [vertex for vertex in active if vertex in path]
    if not near:
        return path, False
    if paths.is_closed(path):
        return paths.started(path, near[0]), True
    middle = sum(path.index(vertex) for vertex in near) / len(near)
    if 2 * middle == len(path) - 1:
        return path, False
    return (path[::-1] if 2 * middle > len(path) - 1 else path), True


def _chord(obj: MeshObject, path: Path) -> Floats:
    """From the start to the end in the world."""
    start, end = vertex_positions.undeformed(obj, (path[0], path[-1]))
    chord: Floats = np.array(obj.matrix_world)[:3, :3] @ (end - start)
    return chord
