# SPDX-License-Identifier: MIT OR Apache-2.0
"""Versions of Blender, Python and numpy, and the tests that run with each."""

from __future__ import annotations

import shlex
import shutil
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Sequence

import debian
import distribution
import environment
import windows
from environment import Environment
from shell import ROOT, VENVS, CommandFailed, Unavailable, run, say, version
from steps import Count, TestsFailed, run_pytest

PREVIOUS = "0.1.0"
# Version 0.1.0 as it was used: before the extension's files were moved, and at its end.
_PREVIOUS_COMMITS = ("7ea7610", "ecac7ea")
BLENDERS = ("4.2", "4.5", "5.0", "5.1", "5.2", "5.3")
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
_PARTS = ("test_1_before.py", "test_2_update.py", "test_3_restart.py", "test_4_after.py")
_FOLDER = "tests/compatibility"
_SITE = "authalic_site"
"""What Blender calls the remote repository from which version 0.1.0 is updated too."""
# numpy by name of the requirements; the oldest has no wheels for Python 3.13 and newer.
_NUMPYS = {"oldest": "numpy-1.26", "newest": "numpy-2"}
_ONLY_NEWEST = ("3.13", "3.14")
# What a version of Python or numpy could break: types and layouts of arrays, threads, signals, processes.
_FEW = (
    *("contract", "arrays", "surface", "errors", "results", "processes", "disk_map", "free_outline"),
    *("threads", "memory", "hostile"),
)
_DEBIAN = "sid"
"""The release of Debian with a Python that is newer than this machine's."""


@dataclass(frozen=True)
class Row:
    """A version, what was run with it, and how that ended."""

    what: str
    tests: str
    outcome: str
    is_failed: bool = False


def versions() -> list[str]:
    """The names of all versions, of Blender and of Python."""
    return [*BLENDERS, *PYTHONS]


def table(rows: Sequence[Row]) -> str:
    """The results as Markdown."""
    lines = [f"| {row.what} | {row.tests} | {row.outcome} |" for row in rows]
    return "\n".join(["| version | tests | outcome |", "|---|---|---|", *lines]) + "\n"


def check_blenders(only: Sequence[str], wheel: Path, folder: Path, is_brief: bool) -> list[Row]:
    """The update in each Blender, then, unless it is brief, all tests of the extension."""
    wanted = [name for name in BLENDERS if name in only]
    if not wanted:
        return []
    archive = distribution.build_zip(wheel, environment.any_blender())
    previous = {commit: _previous_archive(folder, commit) for commit in _PREVIOUS_COMMITS}
    rows = []
    for name in wanted:
        for commit, old in previous.items():
            log = folder / f"blender-{name}-{commit}.log"
            what = f"update from {PREVIOUS} ({commit})"
            rows.append(_row(f"Blender {name}", what, _update, name, archive, old, log))
        commit, old = list(previous.items())[-1]
        what = f"the same from {commit} by a remote repository"
        log = folder / f"blender-{name}-repository.log"
        rows.append(_row(f"Blender {name}", what, _update, name, archive, old, log, _SITE))
        log = folder / f"blender-{name}.log"
        if not is_brief:
            rows.append(_row(f"Blender {name}", "all tests", _suite, name, archive, log))
    return rows


def check_pythons(only: Sequence[str], wheel: Path, folder: Path, is_brief: bool) -> list[Row]:
    """The tests of the package in each Python, with the oldest and the newest numpy that it has."""
    rows = []
    for name in (name for name in PYTHONS if name in only):
        for age, requirements in _NUMPYS.items():
            if age == "newest" or name not in _ONLY_NEWEST:
                log = folder / f"python-{name}-{requirements}.log"
                what = f"Python {name}, {age} numpy"
                is_few = is_brief or name == PYTHONS[-1]
                tests, places = ("the tests of --brief", _few()) if is_few else ("all tests", ("tests/api",))
                rows.append(_row(what, tests, _package, name, requirements, wheel, places, log))
    return rows


def _row(what: str, tests: str, check: Callable[..., Count], *arguments: object) -> Row:
    """Runs a check with its arguments, and says how it ended."""
    say(f"-------- {what}: {tests}")
    began = time.monotonic()
    try:
        count = check(*arguments)
        outcome, is_failed = f"{count.passed} passed, {count.skipped} skipped", False
    except Unavailable as reason:
        return Row(what, tests, f"not run: {str(reason).splitlines()[0]}")
    except TestsFailed as failure:
        outcome, is_failed = f"{failure.count.passed} passed, {failure.count.failed} FAILED: {failure}", True
    except CommandFailed as failure:
        outcome, is_failed = f"FAILED: {failure}", True
    say(f"{outcome}  ({time.monotonic() - began:.0f} s)")
    return Row(what, tests, outcome, is_failed)


def _update(name: str, archive: Path, previous: Path, log: Path, repository: str = "user_default") -> Count:
    """Version 0.1.0, the update, and the time after: one Blender after the other in the same profile."""
    blender = environment.blender(name)
    variables = distribution.fresh_profile(archive, log.with_suffix(".profile"))
    files = log.with_suffix(".files")
    shutil.rmtree(files, ignore_errors=True)
    files.mkdir()
    variables.update(
        AUTHALIC_OLD_ZIP=str(previous),
        AUTHALIC_VERSION=version(),
        AUTHALIC_COMPATIBILITY=str(files),
        AUTHALIC_REPOSITORY=repository,
        AUTHALIC_BLENDER_EXT=str(distribution.tool_for_extensions(blender)),
        PYTHONPATH=str(ROOT / "tests" / "blender"),
    )
    count = Count()
    for part in _PARTS:
        count += run_pytest(blender, (f"{_FOLDER}/{part}",), variables, log)
    return count


def _suite(name: str, archive: Path, log: Path) -> Count:
    variables = distribution.fresh_profile(archive, log.with_suffix(".suite"))
    return run_pytest(environment.blender(name), ("tests/blender",), variables, log)


def _package(name: str, requirements: str, wheel: Path, places: tuple[str, ...], log: Path) -> Count:
    try:
        where = environment.package(name, requirements)
    except Unavailable:
        if name != PYTHONS[-1]:
            raise
        where = _of_debian(name, requirements, wheel, log)
    else:
        distribution.install_wheel(wheel, where, log)
    return run_pytest(where, places, {}, log)


def _few() -> tuple[str, ...]:
    return tuple(f"tests/api/test_{name}.py" for name in _FEW)


def _of_debian(name: str, requirements: str, wheel: Path, log: Path) -> Environment:
    """An environment whose `python` is that of a Debian system, which sees the project's folder."""
    system = windows.system(_DEBIAN, log)
    if not (system / "usr" / "bin" / f"python{name}").exists():
        raise Unavailable(f"Debian {_DEBIAN} in {system} has no Python {name}")
    target = Environment(f"python-{name}", VENVS / f"python-{name}", requirements)
    shutil.rmtree(target.folder, ignore_errors=True)
    target.python.parent.mkdir(parents=True)
    packages = target.folder / "packages"
    pip = [environment.dev().python, "-m", "pip", "install", "--quiet", "--target", packages]
    tags = [f"--platform=manylinux_2_{minor}_x86_64" for minor in range(17, 36)]
    only = ["--only-binary=:all:", f"--python-version={name}", *tags]
    run([*pip, *only, "-r", environment.REQUIREMENTS / f"{requirements}.txt", wheel], log=log)
    variables = {"PYTHONPATH": str(packages)}
    command = debian.command(system, [f"python{name}"], [ROOT], variables, ROOT)
    target.python.write_text(f'#!/bin/sh\nexec {shlex.join(command)} "$@"\n', encoding="utf-8")
    target.python.chmod(0o755)
    return target


def _previous_archive(folder: Path, commit: str) -> Path:
    """The extension's zip of version 0.1.0, which is built from a commit once."""
    archive = folder / f"authalic-{PREVIOUS}-{commit}.zip"
    if archive.exists():
        return archive
    say(f"building version {PREVIOUS} from commit {commit} ...")
    source = folder / "previous"
    shutil.rmtree(source, ignore_errors=True)
    source.mkdir()
    try:
        packed = folder / "previous.tar"
        run(["git", "archive", f"--output={packed}", commit])
        run(["tar", "-xf", packed, "-C", source])
    except CommandFailed as failure:
        missing = f"commit {commit} is not in this clone (`git fetch --unshallow`)"
        raise Unavailable(missing) from failure
    distribution.build_previous(source, PREVIOUS, archive, environment.dev(), environment.any_blender())
    shutil.rmtree(source)  # a gigabyte of objects
    return archive
