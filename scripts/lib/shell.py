# SPDX-License-Identifier: MIT OR Apache-2.0
"""Paths of the project, messages, and commands."""

from __future__ import annotations

import argparse
import hashlib
import os
import re
import shlex
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Iterable, Mapping, Sequence

ROOT = Path(__file__).resolve().parents[2]
VENVS = ROOT / ".venv"
DIST = ROOT / "dist"
OUT = ROOT / "out"
DATA = Path(os.environ.get("AUTHALIC_DATA") or ROOT.parent / "shared" / "data")
"""The folder of real meshes; it need not exist."""
PYTHONPATH = {
    "PYTHONPATH": os.pathsep.join(str(ROOT / place) for place in ("scripts/lib", "scripts/examples", "tests"))
}
"""The variable with which `python -m` finds the packages `bench` and `demo` and what they import."""
EXIT_SECONDS = 60
"""How long to wait for the interpreter to end: Blender as a module has been seen to hang there."""


class Unavailable(Exception):
    """Something this machine lacks; the message says what and what to do about it."""


class CommandFailed(Exception):
    """A command that ended with an error; its output has been kept."""

    def __init__(self, command: Sequence[object], code: int, output: str = "") -> None:
        super().__init__(f"`{shlex.join(map(str, command))}` ended with code {code}")
        self.output = output


def say(message: str) -> None:
    """Prints one line at once, so that lines and the output of commands keep their order."""
    print(message, flush=True)


def warn(message: str) -> None:
    """Prints one line about something that is left out."""
    say(f"note: {message}")


def run(
    command: Sequence[object],
    env: Mapping[str, str] | None = None,
    log: Path | None = None,
    report: Path | None = None,
) -> str:
    """Runs a command in the project's root and returns its output (stdout and stderr together).

    With `log` the output also goes to that file as it comes. `report` is a file that the command writes when
    its work is done; a command that does not end soon after is killed. Raises CommandFailed with the output.
    """
    words = [str(word) for word in command]
    process = subprocess.Popen(
        words, cwd=str(ROOT), env={**os.environ, **(env or {})}, text=True, errors="replace",
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    if report is not None:
        threading.Thread(target=_kill_after_report, args=(process, report), daemon=True).start()
    lines = []
    with open(str(log or os.devnull), "a", encoding="utf-8") as sink:
        for line in process.stdout or ():
            lines.append(line)
            sink.write(line)
            sink.flush()
    code = process.wait()
    if code != 0:
        raise CommandFailed(words, code, "".join(lines))
    return "".join(lines)


def show(command: Sequence[object], env: Mapping[str, str] | None = None) -> None:
    """Runs a command in the project's root and lets its output through."""
    words = [str(word) for word in command]
    code = subprocess.run(words, cwd=str(ROOT), env={**os.environ, **(env or {})}).returncode
    if code != 0:
        raise CommandFailed(words, code)


def _kill_after_report(process: subprocess.Popen[str], report: Path) -> None:
    while process.poll() is None and not report.exists():
        time.sleep(0.5)
    try:
        process.wait(EXIT_SECONDS)
    except subprocess.TimeoutExpired:
        warn(f"process {process.pid} wrote its report but did not end within {EXIT_SECONDS} s: killed")
        process.kill()


def tail(text: str, count: int) -> str:
    """The last `count` lines of a text."""
    return "\n".join(text.rstrip().splitlines()[-count:])


def version() -> str:
    """The project's version, which stands in the Cargo workspace only."""
    line = re.search(r'(?m)^version = "([^"]+)"', (ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    if line is None:
        raise SystemExit("Cargo.toml has no workspace version")
    return line.group(1)


def files_below(*places: str) -> list[Path]:
    """Every file at or below the given places of the project, sorted, without caches."""
    files: list[Path] = []
    for place in places:
        path = ROOT / place
        files += [path] if path.is_file() else [p for p in path.rglob("*") if p.is_file()]
    return sorted(path for path in files if "__pycache__" not in path.parts)


def content_hash(paths: Iterable[Path], *extra: str) -> str:
    """A hash of the names and contents of files, and of further strings."""
    digest = hashlib.sha256()
    for path in paths:
        name = path.relative_to(ROOT).as_posix() if ROOT in path.parents else path.name
        digest.update(name.encode() + b"\0" + path.read_bytes() + b"\0")
    for text in extra:
        digest.update(text.encode() + b"\0")
    return digest.hexdigest()


def options_parser(doc: str | None) -> argparse.ArgumentParser:
    """A command's parser, with the command's module documentation as its help."""
    return argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)


def main(command: object) -> None:
    """Runs a command's main function and turns its exceptions into a message and an exit code."""
    try:
        code = command()  # type: ignore[operator]
    except KeyboardInterrupt:
        sys.exit(130)
    except Unavailable as reason:
        sys.exit(f"cannot go on: {reason}")
    except CommandFailed as failure:
        sys.exit(f"{tail(failure.output, 60)}\nfailed: {failure}")
    sys.exit(code)
