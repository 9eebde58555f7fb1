# SPDX-License-Identifier: GPL-3.0-or-later
"""The base of the operators on the landmarks of the active object."""

from typing import TYPE_CHECKING, Any

import bpy
from bpy.props import IntProperty

from ..blender.types import MeshObject, OperatorMixin, Status
from ..landmarks.objects import NONE, CannotPair, active_source

GIVEN: Any = {"SKIP_SAVE"}  # for this call alone, not remembered for the next


class LandmarkOperator(OperatorMixin):
    """A mixin for operators with `run(context, source)`; it reports the reason if that raises `CannotPair`.

    `pairs` and `active` name the list of the source that it works on and the index of its active entry.
    """

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)
    if TYPE_CHECKING:
        index: int

        def run(self, context: bpy.types.Context, source: MeshObject) -> Status: ...

    pairs, active, noun = "authalic_landmarks", "authalic_landmark_index", "pair"

    def execute(self, context: bpy.types.Context) -> Status:
        try:
            return self.run(context, active_source(context))
        except CannotPair as problem:
            self.report({"ERROR"}, self.worded(str(problem)))
            return {"CANCELLED"}

    def worded(self, problem: str) -> str:
        """The problem as it is reported."""
        return problem

    def chosen(self, source: MeshObject) -> int:
        """The index of the pair to work on."""
        index, count = self.index, len(getattr(source, self.pairs))
        index = getattr(source, self.active) if index == NONE else index
        if not 0 <= index < count:
            last = f"; its {count} are 0 to {count - 1}" if count else ""
            raise CannotPair(f"{source.name} has no {self.noun} {index}{last}")
        return index


def index_property(what: str = "the pair", meaning: str = "-1 for the active one") -> Any:
    """A property for the index of a pair in its list."""
    return IntProperty(
        name="Index",
        description=f"The index of {what} in the list, from 0. {meaning}",
        min=NONE,
        default=NONE,
        options=GIVEN,
    )
