# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tables in Markdown that grow on the screen and in a file, and timed calls, for all benches."""

import os
import platform
import statistics
import time
from dataclasses import dataclass

import authalic


class Report:
    """A Markdown file that is printed while it is written."""

    def __init__(self, target):
        self.target = target
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text("", encoding="utf-8")

    def line(self, text=""):
        """Prints a line and writes it at once, so that an interrupted run leaves its measurements."""
        print(text, flush=True)
        with self.target.open("a", encoding="utf-8") as file:
            file.write(text + "\n")

    def section(self, title, note):
        """A heading, and a note that explains the table."""
        self.line(f"\n## {title}\n\n{note}\n")

    def columns(self, names):
        """The head of a table."""
        self.line(row(names))
        self.line(row("---" for _ in names))

    def row(self, cells):
        """A row of the current table."""
        self.line(row(cells))

    def figure(self, path, caption):
        """A picture in the folder of the file, or in a folder there."""
        self.line(f"\n![{caption}]({path.relative_to(self.target.parent).as_posix()})\n")


@dataclass(frozen=True)
class Outcome:
    """The result of a call, or the error that it raised, and the seconds that it took."""

    result: object
    error: str
    seconds: float


class Runs:
    """Calls of the package, each made once however many tables show it."""

    def __init__(self, repeats=1):
        self.repeats = repeats
        self._known = {}

    def __call__(self, function, name, mesh, **options):
        """The outcome of function(*mesh, **options); each mesh has a `name` of its own."""
        key = (function, name, tuple(sorted(options.items())))
        if key not in self._known:
            self._known[key] = attempt(function, mesh, options, self.repeats)
        return self._known[key]


def attempt(function, mesh, options, repeats):
    """A timed call in which the package's own errors are outcomes."""
    try:
        result, seconds = timed(function, mesh, options, repeats)
    except (authalic.MeshError, authalic.SolverError) as error:
        return Outcome(None, f"{type(error).__name__}: {error}".replace("|", "/").replace("\n", " "), 0.0)
    return Outcome(result, "", seconds)


def timed(function, mesh, options, repeats):
    """The result of a call, and the median of its seconds."""
    seconds = []
    for _ in range(repeats):
        began = time.perf_counter()
        result = function(*mesh, **options)
        seconds.append(time.perf_counter() - began)
    return result, statistics.median(seconds)


def machine():
    """The machine on which the seconds were measured."""
    return f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores"


def row(cells):
    """A row of a Markdown table."""
    return "| " + " | ".join(map(str, cells)) + " |"


def scientific(value):
    """A figure as the papers print energies; nothing for None."""
    return "" if value is None else f"{value:.2e}"


def fixed(value, digits):
    """A figure with so many decimals; nothing for None."""
    return "" if value is None else f"{value:.{digits}f}"


def plain(value):
    """A count; nothing for None."""
    return "" if value is None else str(value)
