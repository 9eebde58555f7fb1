# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests in a real window: Blender of a small Debian system that is kept, on a virtual screen.

Making the system takes a minute, 1.3 GB, root, and Debian's package tools.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Sequence

import debian
from shell import DIST, OUT, ROOT, Unavailable, say, tail

FOLDER = ROOT / "tests" / "gui"
PICTURES = OUT / "gui"
SUITE = os.environ.get("AUTHALIC_GUI_SUITE") or "trixie"
SECONDS = 400
# What inside.sh ends with where Blender cannot open a window.
_NO_WINDOW = 77
_PACKAGES = (
    "blender", "python3-numpy", "xvfb", "xauth", "imagemagick", "libgl1-mesa-dri", "libegl1", "libglx-mesa0",
    "fonts-dejavu-core",
)  # fmt: skip
_HELPERS = ("driver", "start")


def scripts() -> list[str]:
    """The names of all scripts."""
    return sorted(path.stem for path in FOLDER.glob("*.py") if path.stem not in _HELPERS)


def run_scripts(archive: Path, names: Sequence[str], log: Path) -> tuple[int, int]:
    """Runs scripts in a window, with the extension's zip; the numbers of checks that passed and failed.

    The lines of the checks go to `log`, screenshots to out/gui. Scripts that fail are run once more, because
    on a busy machine an event may come too late. Raises Unavailable where there is no Debian system, or no
    window.
    """
    root = system(SUITE, log)
    lines = _run_once(root, archive, names, log)
    again = [name for name in names if not _is_passed(lines.get(name, []))]
    if again:
        with open(str(log), "a", encoding="utf-8") as sink:
            sink.write(f"once more: {', '.join(again)}\n")
        lines.update({name: ["FAILED"] for name in again})
        lines.update(_run_once(root, archive, again, log))
    every = [line for name in names for line in lines[name]]
    return sum(line.startswith("ok ") for line in every), sum(line.startswith("FAILED") for line in every)


def _is_passed(lines: Sequence[str]) -> bool:
    return bool(lines) and not any(line.startswith("FAILED") for line in lines)


def _run_once(root: Path, archive: Path, names: Sequence[str], log: Path) -> dict[str, list[str]]:
    """The lines of the checks of each script that came to its end."""
    work = Path(tempfile.mkdtemp(prefix="authalic-gui-", dir=str(root / "tmp")))
    try:
        _prepare(work, archive)
        _start(root, work, names)
        return _by_script(_collect(work, log))
    finally:
        shutil.rmtree(str(work), ignore_errors=True)


def _by_script(lines: Sequence[str]) -> dict[str, list[str]]:
    """Lines by the scripts that are named after them."""
    found: dict[str, list[str]] = {}
    own: list[str] = []
    for line in lines:
        if line.startswith("-- "):
            found[line[3:].split(":")[0]] = own
            own = []
        else:
            own.append(line)
    return found


def _by_hand() -> None:
    """Runs the scripts named on the command line with the zip in dist/."""
    archive = max(DIST.glob("authalic-*.zip"), key=lambda path: path.stat().st_mtime)
    log = PICTURES / "window.log"
    PICTURES.mkdir(parents=True, exist_ok=True)
    log.write_text("")
    passed, failed = run_scripts(archive, sys.argv[1:] or scripts(), log)
    say(f"{log.read_text(encoding='utf-8')}{passed} passed, {failed} failed")
    sys.exit(1 if failed else 0)


def _prepare(work: Path, archive: Path) -> None:
    shutil.copy(str(archive), str(work / "extension.zip"))
    for path in FOLDER.iterdir():
        if path.suffix in (".py", ".sh"):
            shutil.copy(str(path), str(work))


def _start(root: Path, work: Path, names: Sequence[str]) -> None:
    """Runs inside.sh in the system; what Blender says goes to a file beside it."""
    inside = f"/{work.relative_to(root)}"
    command = ["chroot", root, "bash", "-c", f"cd {inside} && exec bash inside.sh {SECONDS}"]
    env = {**os.environ, "AUTHALIC_GUI_SCRIPTS": " ".join(names)}
    with open(str(work / "blender.log"), "w") as output:
        done = subprocess.run(
            list(map(str, command)), env=env, stdout=output, stderr=subprocess.STDOUT, timeout=SECONDS + 400
        )
    if done.returncode == _NO_WINDOW:
        text = (work / "blender.log").read_text(encoding="utf-8", errors="replace")
        raise Unavailable(f"Blender cannot open a window in {root}:\n{tail(text, 5)}")


def _collect(work: Path, log: Path) -> list[str]:
    """Keeps the pictures and logs; the lines of the checks."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    for path in (*work.glob("*.png"), *work.glob("*.log")):
        shutil.copy(str(path), str(PICTURES))
    checks = work / "checks.log"
    text = checks.read_text(encoding="utf-8") if checks.exists() else ""
    if not text.endswith("END\n"):
        output = (work / "blender.log").read_text(encoding="utf-8", errors="replace")
        text += f"Blender did not reach the end of the scripts:\n{tail(output, 30)}\n"
    with open(str(log), "a", encoding="utf-8") as sink:
        sink.write(text)
    return text.splitlines()


def system(suite: str, log: Path) -> Path:
    """The folder of a Debian system with Blender and Python, which is made on first use."""
    return debian.system(suite, suite, _PACKAGES, log)


if __name__ == "__main__":
    _by_hand()
