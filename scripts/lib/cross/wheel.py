# SPDX-License-Identifier: MIT OR Apache-2.0
"""The wheel of another platform, built here, and what it loads."""

from __future__ import annotations

import re
import shutil
import zipfile
from pathlib import Path

import environment
from cross.machine import cargo, run_inside
from cross.platforms import Platform
from release.inspection import problems_of_contents
from shell import OUT, CommandFailed


def check(platform: Platform, log: Path) -> str:
    """Builds and inspects the wheel; its name and the libraries that it loads. Raises CommandFailed."""
    wheel = _build(platform, log)
    libraries = _libraries(platform, wheel, log)
    problems = [*problems_of_contents(wheel), *_problems_of_name(platform, wheel)]
    problems += [f"{wheel.name} loads {name}" for name in platform.strange_libraries(libraries)]
    if problems:
        raise CommandFailed(["inspect", wheel.name], 1, "\n".join(problems))
    return f"{wheel.name} loads {', '.join(libraries)}"


def _build(platform: Platform, log: Path) -> Path:
    """The environment's maturin runs in the Debian system; it needs no Python of the platform."""
    maturin = environment.build().tool("maturin")
    folder = OUT / "cross" / platform.triple
    shutil.rmtree(folder, ignore_errors=True)
    words = ["build", "--release", "--locked", "--out", folder, "--auditwheel", "skip"]
    cargo(platform, [*words, "--interpreter", "python3.11"], log, str(maturin))
    [wheel] = folder.glob("*.whl")
    return wheel


def _problems_of_name(platform: Platform, wheel: Path) -> list[str]:
    ending = f"-cp311-abi3-{platform.wheel}.whl"
    return [] if wheel.name.endswith(ending) else [f"{wheel.name} does not end with {ending}"]


def _libraries(platform: Platform, wheel: Path, log: Path) -> list[str]:
    """The names of the libraries that the native module in a wheel loads."""
    with zipfile.ZipFile(str(wheel)) as archive:
        [name] = [name for name in archive.namelist() if re.search(r"/_native\.[\w.-]*(so|pyd)$", name)]
        module = Path(archive.extract(name, str(wheel.parent)))
    headers = run_inside([f"{platform.tools}objdump", "-p", module], log)
    return sorted(set(re.findall(r"(?m)^\s*(?:DLL Name:|NEEDED)\s+(\S+)$", headers)))
