# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertex groups that say where seams may run."""

from collections.abc import Sequence
from dataclasses import dataclass

from ..blender import vertex_groups
from ..blender.types import MeshObject
from ..surfaces import seam_costs
from ..surfaces.surface import Surface


class NoGroup(Exception):
    """No object has a vertex group that was named; nothing was changed."""


@dataclass
class SeamGroups:
    """The vertex groups to keep seams off and where they are preferred; empty for none."""

    keep_off: str = ""
    prefer: str = ""

    @property
    def names(self) -> tuple[str, str]:
        return self.keep_off, self.prefer


def check(objects: Sequence[MeshObject], groups: SeamGroups) -> None:
    """Raises `NoGroup` unless one of the objects at least has each group."""
    for name in filter(None, groups.names):
        if not any(name in vertex_groups.names(obj) for obj in objects):
            raise NoGroup(f'No selected object has the vertex group "{name}"; choose another')


def apply(obj: MeshObject, surface: Surface, groups: SeamGroups) -> None:
    """Sets how dear a seam is at each vertex of an object's surface."""
    if any(groups.names):
        weights = [vertex_groups.weights(obj, name) for name in groups.names]
        surface.seam_factors = seam_costs.vertex_factors(*weights)
