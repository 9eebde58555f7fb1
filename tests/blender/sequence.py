# SPDX-License-Identifier: GPL-3.0-or-later
"""A random sequence of actions, its log, and the steps of undo."""

import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import states
from states import State


class Sequence:
    """A sequence of random actions; `log` has a line for each."""

    def __init__(self, seed: int, folder: Path) -> None:
        self.random = random.Random(seed)
        self.log: list[str] = []
        self._folder = folder
        # the states at the steps of undo, and the present step
        self._history: list[State] = []
        self._now = -1
        self._has_gone = False

    def say(self, text: str) -> None:
        self.log.append(text)

    def perform(self, action: Callable[["Sequence"], None]) -> None:
        """Performs an action, as one step of undo unless it goes through these."""
        self.say(action.__name__)
        self._has_gone = False
        action(self)
        if not self._has_gone:
            self.push()

    def push(self) -> None:
        """Pushes a step of undo, which operators called from a script do not."""
        bpy.ops.ed.undo_push(message=self.log[-1])
        self.pushed()

    def pushed(self) -> None:
        """Notes a step of undo that has been pushed, by an action itself instead of for it."""
        self._has_gone = True
        del self._history[self._now + 1 :]
        self._history.append(states.read())
        self._now += 1

    def step(self, by: int, operator: Callable[[], Any]) -> None:
        """Goes back or forth in the history of undo."""
        self._has_gone = True
        if not 0 <= self._now + by < len(self._history):
            return
        operator()
        self._now += by
        difference = states.difference(self._history[self._now], states.read())
        assert not difference, f"not as it was: {difference}"

    def forget(self) -> None:
        """Starts a new history, as after a file is opened."""
        self._history, self._now = [], -1

    def path(self, name: str) -> str:
        return str(self._folder / name)

    def object(self, only: Callable[[Any], bool] = lambda obj: True) -> Any:
        """Any mesh object for which `only` holds; None if there is none."""
        found = [obj for obj in bpy.context.view_layer.objects if obj.type == "MESH" and only(obj)]
        return self.random.choice(sorted(found, key=lambda obj: obj.name)) if found else None
