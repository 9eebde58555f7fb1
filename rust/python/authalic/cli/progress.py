# SPDX-License-Identifier: MIT OR Apache-2.0
"""How far a run is: a bar on a terminal, now and then a line elsewhere, on stderr."""

import sys
import time
from types import TracebackType
from typing import Any

INTERVAL = 2.0
"""Seconds between lines."""


class ProgressBar:
    """Shows the progress of one call of the library; `with` ends it.

    Parameters
    ----------
    title : str
        What is computed.
    quiet : bool
        Show nothing.
    """

    def __init__(self, title: str, quiet: bool = False) -> None:
        self._title, self._quiet = title, quiet
        self._bar: Any = None
        self._task: Any = None
        self._shown = time.monotonic()

    def __call__(self, fraction: float, message: str) -> None:
        """The progress function that the library takes."""
        if self._bar is not None:
            self._bar.update(self._task, completed=fraction, description=f"{self._title}: {message}")
        elif not self._quiet and time.monotonic() - self._shown >= INTERVAL:
            self._shown = time.monotonic()
            print(f"{self._title}: {100 * fraction:.0f} % {message}", file=sys.stderr, flush=True)

    def announce(self, address: str) -> None:
        """Shows where the run can be watched."""
        if self._bar is not None:
            self._bar.console.print(f"{self._title}: dashboard {address}")
        elif not self._quiet:
            print(f"{self._title}: dashboard {address}", file=sys.stderr, flush=True)

    def __enter__(self) -> "ProgressBar":
        if not self._quiet and sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import Progress

            self._bar = Progress(console=Console(stderr=True), transient=True)
            self._task = self._bar.add_task(self._title, total=1.0)
            self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()
