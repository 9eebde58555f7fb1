# SPDX-License-Identifier: MIT OR Apache-2.0
"""Finds Python interpreters that work: on PATH, from pyenv, from uv, and in the usual folders."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Iterator

from shell import Unavailable

NEWEST_FIRST = ("3.14", "3.13", "3.12", "3.11")
_USUAL_FOLDERS = ("/usr/bin", "/usr/local/bin", "/opt/homebrew/bin")
# ensurepip is a package of its own on Debian: without it an interpreter cannot make environments.
_PROBE = (
    "import sys, sysconfig, venv, ensurepip; "
    "threads = 't' if sysconfig.get_config_var('Py_GIL_DISABLED') else ''; "
    "print('%d.%d' % sys.version_info[:2] + threads)"
)


def candidates(version: str) -> Iterator[Path]:
    """Files that may be the interpreter of a version such as "3.11" or "3.14t", best guess first.

    The t means free threads: a Python without a global lock.
    """
    names = (f"python{version}.exe", "python.exe") if os.name == "nt" else (f"python{version}",)
    if version.rstrip("t") == f"{sys.version_info[0]}.{sys.version_info[1]}":
        yield Path(sys.executable)
    for folder in (*os.environ.get("PATH", "").split(os.pathsep), *_USUAL_FOLDERS):
        yield from (Path(folder) / name for name in names)
    pyenv = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv")
    yield from _newest(pyenv / "versions", f"{version}.*/bin/python")
    uv = os.environ.get("UV_PYTHON_INSTALL_DIR") or Path.home() / ".local/share/uv/python"
    yield from _newest(Path(uv), f"cpython-{version}.*/bin/python{version}")


def works(python: Path, version: str) -> bool:
    """Whether a file runs, has this version, and can make environments (a pyenv shim may not run)."""
    if not os.access(str(python), os.X_OK):
        return False
    try:
        answer = subprocess.run([str(python), "-c", _PROBE], capture_output=True, text=True, timeout=30)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return answer.returncode == 0 and answer.stdout.strip() == version


def find(*versions: str) -> tuple[Path, str]:
    """The first interpreter that works, in the order of `versions`, and its version."""
    for version in versions:
        for python in dict.fromkeys(candidates(version)):
            if works(python, version):
                return python, version
    wanted = " or ".join(versions)
    raise Unavailable(
        f"no Python {wanted} that runs and has the modules venv and ensurepip "
        f"(install it, e.g. `apt-get install python{versions[-1]} python{versions[-1]}-venv`)"
    )


def _newest(folder: Path, pattern: str) -> list[Path]:
    def number(path: Path) -> list[int]:
        name = path.relative_to(folder).parts[0]
        return [int(digits) for digits in "".join(c if c.isdigit() else " " for c in name).split()]

    return sorted(folder.glob(pattern), key=number, reverse=True)
