# SPDX-License-Identifier: MIT OR Apache-2.0
"""Fixtures: surfaces in files, and the command in this process and in one of its own."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest
from api import meshes

from authalic.cli import main
from authalic.io import MeshData, write_mesh


class Result(NamedTuple):
    """How a command ended."""

    code: int
    out: str
    err: str

    @property
    def record(self):
        return json.loads(self.out)

    @property
    def error(self):
        return json.loads(self.err)["error"]


@pytest.fixture
def folder(tmp_path):
    """A folder with a closed surface, one with a boundary and one with a handle."""
    write_mesh(tmp_path / "ball.obj", MeshData(*meshes.bumpy_ball()))
    write_mesh(tmp_path / "cap.obj", MeshData(*meshes.bumpy_cap()))
    write_mesh(tmp_path / "torus.obj", MeshData(*meshes.torus()))
    return tmp_path


@pytest.fixture
def run(capsys, folder, monkeypatch):
    """run("sphere", "ball.obj") runs the command in `folder`."""
    monkeypatch.chdir(folder)

    def run_command(*words):
        capsys.readouterr()
        code = main([str(word) for word in words])
        captured = capsys.readouterr()
        return Result(code, captured.out, captured.err)

    return run_command


def start(code, folder, **options):
    """Starts Python code in a process of its own, in a folder, with its output in pipes."""
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    command = [sys.executable, "-c", code]
    if os.name == "posix":
        options["preexec_fn"] = _hear_interrupts
    return subprocess.Popen(command, cwd=folder, env=environment, **pipes, **options)


def _hear_interrupts():
    """What a shell starts in the background ignores Ctrl-C, and so would what that starts."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def names(folder: Path):
    """All files in a folder and below."""
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
