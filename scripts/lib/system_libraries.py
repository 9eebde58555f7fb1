# SPDX-License-Identifier: MIT OR Apache-2.0
"""The system libraries that Blender as a Python module needs on Linux. Run as root, it installs them."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

from shell import CommandFailed, Unavailable, run, say, tail

DEBIAN_PACKAGES = (
    "libx11-6", "libxrender1", "libxfixes3", "libxi6", "libxkbcommon0", "libsm6", "libice6", "libgl1",
    "libxxf86vm1", "libgomp1", "libegl1",
)  # fmt: skip


def make_bpy_import(python: Path) -> None:
    """Makes `import bpy` work: installs Debian packages as root, else says what to type."""
    problem = _import_problem(python)
    if problem is not None and "cannot open shared object file" in problem:
        install(problem)
        problem = _import_problem(python)
    if problem is not None:
        raise Unavailable(f"`import bpy` fails: {tail(problem, 3)}")


def install(problem: str) -> None:
    """Installs Debian packages as root. `problem` is the message to give where that is impossible."""
    packages = " ".join(DEBIAN_PACKAGES)
    if not shutil.which("apt-get") or not hasattr(os, "geteuid") or os.geteuid() != 0:
        raise Unavailable(
            f"Blender lacks a system library: {tail(problem, 1)}. "
            f"Type `sudo apt-get install {packages}`, or what your system calls these packages"
        )
    say("installing the system libraries that Blender needs ...")
    env = {"DEBIAN_FRONTEND": "noninteractive"}
    try:
        run(["apt-get", "update"], env)
        run(["apt-get", "-o", "DPkg::Lock::Timeout=300", "install", "-y", *DEBIAN_PACKAGES], env)
    except CommandFailed as failure:
        raise Unavailable(f"apt-get could not install {packages}:\n{tail(failure.output, 5)}") from failure


def _import_problem(python: Path) -> str | None:
    # os._exit, because some versions hang when the interpreter ends
    code = "import bpy, os; os._exit(0)"
    answer = subprocess.run([str(python), "-c", code], capture_output=True, text=True, timeout=300)
    return None if answer.returncode == 0 else answer.stderr or f"exit code {answer.returncode}"


if __name__ == "__main__":
    install("this installs all of them")
