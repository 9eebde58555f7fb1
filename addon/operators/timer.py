# SPDX-License-Identifier: GPL-3.0-or-later
"""A timer for what follows options, meshes and UVs without a call from what may change."""

from collections.abc import Callable
from typing import Any

import bpy


def _of_first_window(windows: Any) -> dict[str, Any]:
    return {"window": windows[0]}


class Timer:
    """Calls `tick(context)` every `interval` seconds, as long as that says that there is to be another.

    `place(windows)` is what of the context to override: a timer has no window of its own.
    """

    def __init__(
        self,
        tick: Callable[[bpy.types.Context], bool],
        interval: float,
        place: Callable[[Any], dict[str, Any]] = _of_first_window,
    ) -> None:
        self._tick, self._interval, self._place = tick, interval, place
        self._function = self._beat  # Blender knows a timer by the function object

    def start(self) -> None:
        """Starts to tick, where there are windows and it does not tick already."""
        if not bpy.app.background and not bpy.app.timers.is_registered(self._function):
            bpy.app.timers.register(self._function, persistent=True)

    def stop(self) -> None:
        if bpy.app.timers.is_registered(self._function):
            bpy.app.timers.unregister(self._function)

    def _beat(self) -> float | None:
        windows = bpy.context.window_manager.windows
        if not windows:
            return None
        with bpy.context.temp_override(**self._place(windows)):
            return self._interval if self._tick(bpy.context) else None
