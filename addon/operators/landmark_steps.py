# SPDX-License-Identifier: GPL-3.0-or-later
"""What was done to pairs of landmarks while they were picked, which can be taken back step by step."""

from dataclasses import dataclass

from ..blender.types import MeshObject
from ..landmarks import points as landmark_points


@dataclass(frozen=True)
class Added:
    """A pair that was added, and its vertices."""

    name: str
    source_vertex: int
    target_vertex: int

    def take_back(self, source: MeshObject) -> str:
        """Undoes the step and returns what was done."""
        listed = source.authalic_landmarks
        if listed and listed[-1].name == self.name:
            landmark_points.remove(source, len(listed) - 1)
        return f"Removed {self.name}"


@dataclass(frozen=True)
class Moved:
    """A pair, by its number in the list, that was moved on one side from a vertex to another."""

    name: str
    index: int
    side: str
    before: int
    after: int

    def take_back(self, source: MeshObject) -> str:
        """Undoes the step and returns what was done."""
        if self.index < len(source.authalic_landmarks):
            landmark_points.move(source, self.index, self.side, self.before)
        return f"Moved {self.name} back"


Step = Added | Moved


@dataclass
class Drag:
    """A pair, by its number in the list, that the mouse drags on one side from one vertex over others."""

    index: int
    side: str
    start: int
    vertex: int


def summary(steps: list[Step]) -> str:
    """The report of all steps, to be read before the names of the objects."""
    added = sum(isinstance(step, Added) for step in steps)
    moved = len({(step.index, step.side) for step in steps if isinstance(step, Moved)})
    return f"Picked {added} landmarks" + (f" and moved {moved}" if moved else "")
