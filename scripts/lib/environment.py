# SPDX-License-Identifier: MIT OR Apache-2.0
"""The Python environments in .venv/: made on first use, reused while their requirements stay the same."""

from __future__ import annotations

import contextlib
import os
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Iterator

import pythons
import system_libraries
from shell import ROOT, VENVS, CommandFailed, Unavailable, content_hash, run, say, tail, warn

REQUIREMENTS = ROOT / "scripts" / "requirements"
_SCHEME = "1"  # a new value makes every environment anew


@dataclass(frozen=True)
class Environment:
    """An environment that is ready to be used."""

    name: str
    folder: Path
    requirements: str
    """The requirements file's stem, e.g. "bpy-5.2"."""

    @property
    def python(self) -> Path:
        return self.tool("python")

    def tool(self, name: str) -> Path:
        """A program of the environment."""
        return self.folder / (f"Scripts/{name}.exe" if os.name == "nt" else f"bin/{name}")

    @property
    def label(self) -> str:
        """Its name in messages: "Blender 5.2" rather than "bpy-5"."""
        return self.requirements.replace("bpy-", "Blender ")


def dev() -> Environment:
    """The environment for building, checking and measuring."""
    return _ensure("dev", "dev", *pythons.find(*_newest_supported()))


def build() -> Environment:
    """The environment that builds the sdist and the wheels of a release."""
    return _ensure("build", "build", *pythons.find(*_newest_supported()))


def docs() -> Environment:
    """The environment that builds the documentation."""
    return _ensure("docs", "docs", *pythons.find(*_newest_supported()))


def release() -> Environment:
    """The environment that inspects wheels and sdists."""
    return _ensure("release", "release", *pythons.find(*_newest_supported()))


def blender_oldest() -> Environment:
    """Blender 4.2 LTS as a Python module."""
    return _ensure_blender("bpy-4.2", "bpy-4.2", *pythons.find("3.11"))


def blender_newest() -> Environment:
    """The newest Blender as a Python module that this machine's Pythons allow."""
    try:
        return _ensure_blender("bpy-5", "bpy-5.2", *pythons.find("3.13"))
    except Unavailable as reason:
        warn(f"Blender 5.2 is not used: {reason}. Blender 5.0 is used instead.")
    return _ensure_blender("bpy-5", "bpy-5.0", *pythons.find("3.11"))


def blender(version: str) -> Environment:
    """Blender of a version such as "4.5" as a Python module."""
    # Version 5.2 is the one that `blender_newest` takes.
    name = "bpy-5" if version == "5.2" else f"bpy-{version}"
    python = "3.11" if version < "5.1" else "3.13"
    return _ensure_blender(name, f"bpy-{version}", *pythons.find(python))


def package(python: str, requirements: str) -> Environment:
    """The environment for the tests of the package with a version of Python, and the requirements' numpy."""
    return _ensure(f"python-{python}-{requirements}", requirements, *pythons.find(python))


def any_blender() -> Environment:
    """The newest Blender, or the oldest supported one if there is no other."""
    try:
        return blender_newest()
    except Unavailable as reason:
        warn(f"Blender 5 is not used: {reason}. Blender 4.2 is used instead.")
    return blender_oldest()


def add(environment: Environment, requirements: str, *options: str) -> None:
    """Installs a further requirements file into an environment, once; `options` are for pip."""
    path = REQUIREMENTS / f"{requirements}.txt"
    stamp = environment.folder / f"{requirements}.stamp"
    wanted = content_hash(_with_constraints(path))
    if _read(stamp) != wanted:
        run([environment.python, "-m", "pip", "install", "--quiet", *options, "-r", path])
        stamp.write_text(wanted)


def _newest_supported() -> tuple[str, ...]:
    # 3.14 is left out: the pinned tools have not been tried with it.
    return tuple(version for version in pythons.NEWEST_FIRST if version != "3.14")


def _ensure_blender(name: str, requirements: str, python: Path, version: str) -> Environment:
    environment = _ensure(name, requirements, python, version)
    stamp = environment.folder / "imports.stamp"
    with _lock(name):
        if not stamp.exists():
            system_libraries.make_bpy_import(environment.python)
            stamp.touch()
    return environment


def _ensure(name: str, requirements: str, python: Path, version: str) -> Environment:
    environment = Environment(name, VENVS / name, requirements)
    stamp = environment.folder / "installed.stamp"
    wanted = content_hash(_with_constraints(REQUIREMENTS / f"{requirements}.txt"), version, _SCHEME)
    with _lock(name):
        if _read(stamp) != wanted or not environment.python.exists():
            _create(environment, python, version)
            stamp.write_text(wanted)
    return environment


def _create(environment: Environment, python: Path, version: str) -> None:
    path = REQUIREMENTS / f"{environment.requirements}.txt"
    say(f"setting up .venv/{environment.name} (Python {version}, {environment.requirements}.txt) ...")
    began = time.monotonic()
    try:
        run([python, "-m", "venv", "--clear", environment.folder])
        run(
            [environment.python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", path]
        )
    except CommandFailed as failure:
        raise Unavailable(
            f"the packages of {path.name} could not be installed:\n{tail(failure.output, 5)}"
        ) from failure
    say(f"  done in {time.monotonic() - began:.0f} s")


def _with_constraints(path: Path) -> list[Path]:
    """A requirements file, and the one whose versions it takes over."""
    takes_over = "\n-c dev.txt\n" in path.read_text(encoding="utf-8")
    return [path, REQUIREMENTS / "dev.txt"] if takes_over else [path]


def _read(path: Path) -> str:
    return path.read_text(encoding="utf-8") if path.exists() else ""


@contextlib.contextmanager
def _lock(name: str) -> Iterator[None]:
    """Keeps two commands that run at the same time from making the same environment."""
    VENVS.mkdir(exist_ok=True)
    with open(VENVS / f"{name}.lock", "w") as file:
        with contextlib.suppress(ImportError):  # Windows has no fcntl, and goes without a lock
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX)
        yield
