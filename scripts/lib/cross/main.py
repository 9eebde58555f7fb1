# SPDX-License-Identifier: MIT OR Apache-2.0
"""The steps for each platform, and the closing table."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Sequence

from cross import bits, wheel
from cross.machine import cargo, prepare, run_inside, versions
from cross.platforms import NATIVE, PLATFORMS, Platform
from shell import OUT, CommandFailed, Unavailable, say, tail
from steps import count_cargo

FOLDER = OUT / "cross"
_EXAMPLE = ("--release", "--locked", "--package", "authalic", "--example", "bits")
# Examples in the documentation are left out: rustdoc would compile each by itself.
_TESTS = ("--release", "--locked", "--package", "authalic", "--lib", "--tests", "--no-fail-fast")


@dataclass(frozen=True)
class Row:
    """A platform, a step, and how it ended."""

    platform: str
    step: str
    outcome: str
    is_failed: bool = False


def compare_bits(name: str, words: Sequence[str], log: Path) -> str:
    """Runs the example on the platform and here, by one compiler: the standard library changes too."""
    here = bits.read(run_inside(["cargo", "run", *_EXAMPLE, "--target", NATIVE], log))
    there = bits.read(cargo(PLATFORMS[name], ["run", *_EXAMPLE], log))
    differences = bits.compare(here, there)
    text = bits.table(differences, name)
    (FOLDER / f"{name}-bits.md").write_text(text, encoding="utf-8")
    say(text)
    return bits.summary(differences)


def run_tests(name: str, words: Sequence[str], log: Path) -> str:
    """The unit tests and the tests from outside of the crate, but for those that take too long."""
    skipped = [word for test in PLATFORMS[name].slow_tests for word in ("--skip", test)]
    output = cargo(PLATFORMS[name], ["test", *_TESTS, "--", *words, *([] if words else skipped)], log)
    count = count_cargo(output)
    left_out = ", ".join(PLATFORMS[name].slow_tests)
    without = f", without those named {left_out}" if left_out and not words else ""
    return f"{count.passed} passed, {count.failed} failed, {count.skipped} ignored{without}"


def check_wheel(name: str, words: Sequence[str], log: Path) -> str:
    """Builds the wheel and looks at what it holds and loads."""
    return wheel.check(PLATFORMS[name], log)


STEPS: dict[str, Callable[[str, Sequence[str], Path], str]] = {
    "bits": compare_bits,
    "tests": run_tests,
    "wheel": check_wheel,
}
WHAT = {
    "bits": "the bits of maps, seams and registrations, beside those on this machine",
    "tests": "the tests of the crate",
    "wheel": "the wheel: its name, and the libraries that it loads",
}


def check(platforms: Sequence[str], steps: Sequence[str], words: Sequence[str]) -> int:
    """Does the steps for the platforms; 1 if any has failed, and not where one could not be had."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    rows = [row for name in platforms for row in _check_platform(name, PLATFORMS[name], steps, words)]
    text = table(rows)
    (FOLDER / "table.md").write_text(text, encoding="utf-8")
    say(text)
    return 1 if any(row.is_failed for row in rows) else 0


def table(rows: Sequence[Row]) -> str:
    """The outcomes as Markdown."""
    lines = [f"| {row.platform} | {row.step} | {row.outcome} |" for row in rows]
    return "\n".join(["| platform | step | outcome |", "|---|---|---|", *lines]) + "\n"


def _check_platform(name: str, platform: Platform, steps: Sequence[str], words: Sequence[str]) -> list[Row]:
    log = FOLDER / f"{name}.log"
    log.write_text("", encoding="utf-8")
    say(f"======== {name}: {platform.what}")
    try:
        prepare(platform, log)
        say(", ".join(versions(log)))
    except Unavailable as reason:
        say(str(reason))
        return [Row(name, step, f"not done: {tail(str(reason), 1)}") for step in steps]
    return [_perform(name, step, words) for step in STEPS if step in steps]


def _perform(name: str, step: str, words: Sequence[str]) -> Row:
    """Does a step, and says how it ended."""
    log = FOLDER / f"{name}-{step}.log"
    log.write_text("", encoding="utf-8")
    say(f"-------- {step}: {WHAT[step]}")
    began, is_failed = time.monotonic(), False
    try:
        outcome = STEPS[step](name, words, log)
    except Unavailable as reason:
        say(str(reason))
        outcome = f"not done: {tail(str(reason), 1)}"
    except CommandFailed as failure:
        say(tail(failure.output, 40))
        count = count_cargo(failure.output)
        counted = f"{count.passed} passed, {count.failed} failed; " if count.failed else ""
        outcome, is_failed = f"FAILED: {counted}see {log.name}", True
    say(f"{outcome}  ({time.monotonic() - began:.0f} s)")
    return Row(name, step, outcome, is_failed)
